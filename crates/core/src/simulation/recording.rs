//! Result of a run: the traces of its systems, its events, and the balances of groups of systems.

use super::certificate::Check;
use super::group_balance::GroupBalance;
use super::trace::Trace;
use crate::dynamics::Momentum;
use serde::{Deserialize, Serialize};

/// Result of a run: traces of the systems, records of the events, and balances of groups of systems.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    /// Trace of each system, in the order of the systems.
    pub systems: Vec<Trace>,
    /// Records of the events that happened, in order of time.
    pub events: Vec<EventRecord>,
    /// Balances of momentum and energy of the groups that have several systems.
    pub groups: Vec<GroupBalance>,
}

impl Recording {
    /// Returns the trace of the only system of a run with one robot.
    ///
    /// # Panics
    /// If the run has several systems.
    pub fn only(self) -> Trace {
        let mut systems = self.systems;
        assert_eq!(systems.len(), 1, "the run has several systems; use one entry of `systems`");
        systems.remove(0)
    }

    /// Returns the number of rows in the trace of the first system.
    pub fn rows(&self) -> usize {
        self.systems.first().map_or(0, Trace::rows)
    }
}

/// Kind of an event: which change of a connection, a contact or a brake happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum EventKind {
    /// Frames of two systems were connected.
    Capture,
    /// The connection that a capture had established was removed.
    Release,
    /// The first links of a contact began to touch.
    TouchDown,
    /// The last touching links of a contact separated.
    LiftOff,
    /// A brake was engaged.
    Engage,
    /// A brake was disengaged.
    Disengage,
}

impl EventKind {
    /// All kinds of events.
    pub const ALL: [Self; 6] =
        [Self::Capture, Self::Release, Self::TouchDown, Self::LiftOff, Self::Engage, Self::Disengage];

    /// Returns the name of the kind in results and messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Capture => "capture",
            Self::Release => "release",
            Self::TouchDown => "touch_down",
            Self::LiftOff => "lift_off",
            Self::Engage => "engage",
            Self::Disengage => "disengage",
        }
    }

    /// Returns true for a touch-down or a lift-off.
    pub fn is_of_contact(self) -> bool {
        matches!(self, Self::TouchDown | Self::LiftOff)
    }
}

/// Record of an event that happened, with the errors of its momentum and energy balances.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EventRecord {
    /// Name of the event, or of the contact.
    pub name: String,
    /// Kind of the event.
    pub kind: EventKind,
    /// Simulation time of the event, s.
    pub time: f64,
    /// Indices in the world of the two systems, beginning with the capturing system. For a contact, those of
    /// the systems whose links touched first, in the order of the sides. For a brake, both entries are the
    /// index of its system.
    pub systems: [usize; 2],
    /// Impulse on the second system and the systems connected to it, axes of W: linear, N s, then angular
    /// about `point`, N m s. For a lift-off, the impulse of the contact on the links of its second side since
    /// the touch-down; for a touch-down, zero. For a brake, the impulse with which it stops the link that its
    /// joint moves, along or about the axis of the joint.
    pub impulse: [f64; 6],
    /// Point at which the impulse acts, in W, m; for a contact, the point of contact; for a brake, the origin
    /// of the link that its joint moves.
    pub point: [f64; 3],
    /// Kinetic energy lost, J; negative if a spring added energy. For a lift-off, the energy dissipated since
    /// the touch-down; for a touch-down, zero.
    pub energy_lost: f64,
    /// Changes of the linear and of the angular momentum of the group, relative to the sums of the magnitudes
    /// of the momenta of its bodies; zero for a contact, whose forces on both sides act at one point.
    pub momentum_error: [f64; 2],
    /// Relative velocity and relative angular velocity of the connected frames after a capture, as fractions
    /// of those before the capture, or of 1 m/s and 1 rad/s if these are larger; zero for other events and
    /// with an external engine.
    pub twist_left: [f64; 2],
    /// Error of the energy balance, relative to the larger of the kinetic energies before and after the
    /// event. For a capture, the change of the kinetic energy is compared with `½ Δvᵀ M Δv`, for a release
    /// with the work of the spring, and for a brake with the energy that its impulse dissipates. Zero while a
    /// seating motion prescribes the motion of joints.
    pub energy_error: f64,
    /// For a lift-off of a contact without an impact law, the largest normal force since the touch-down, N;
    /// otherwise `None`. It is the largest value at the end of a step, or the maximum of the parabola through
    /// three such values.
    #[serde(default)]
    pub peak_force: Option<f64>,
}

/// Largest relative error that passes a check of [`EventRecord::checks`].
pub const AUDIT: f64 = 1e-11;

impl EventRecord {
    /// Returns the checks of the momentum and energy balances and, for a capture, of the relative velocities
    /// that remain after it. Touch-downs and lift-offs have no checks, because the balances of the group
    /// contain their momentum and energy at every row.
    pub fn checks(&self) -> Vec<Check> {
        if self.kind.is_of_contact() {
            return Vec::new();
        }
        let momentum = [
            ("linear_momentum_error_rel", self.momentum_error[0]),
            ("angular_momentum_error_rel", self.momentum_error[1]),
        ];
        let twist = [
            ("relative_velocity_left_rel", self.twist_left[0]),
            ("relative_rotation_left_rel", self.twist_left[1]),
        ];
        let twist = twist.into_iter().filter(|_| self.kind == EventKind::Capture);
        let lines = momentum.into_iter().chain(twist).chain([("energy_error_rel", self.energy_error)]);
        lines.map(|(name, value)| Check { name, value, gate: AUDIT }).collect()
    }

    /// Returns true if every check of [`EventRecord::checks`] passes.
    pub fn passed(&self) -> bool {
        self.checks().iter().all(Check::passed)
    }
}

/// Traces, events and balances of one group.
#[derive(Clone, Debug, Default)]
pub(super) struct GroupRecording {
    pub(super) systems: Vec<Trace>,
    pub(super) events: Vec<EventRecord>,
    pub(super) balance: GroupBalance,
}

impl Recording {
    /// Combines the recordings of groups, given with the systems of each group, into the recording of a run.
    pub(super) fn of<'g>(parts: impl Iterator<Item = (&'g [usize], GroupRecording)>) -> Self {
        let (mut systems, mut all) = (Vec::new(), Self::default());
        for (numbers, GroupRecording { systems: traces, events, balance }) in parts {
            systems.extend(numbers.iter().copied().zip(traces));
            all.events.extend(events);
            if numbers.len() > 1 {
                all.groups.push(balance.of_systems(numbers));
            }
        }
        systems.sort_by_key(|(number, _)| *number);
        all.systems = systems.into_iter().map(|(_, trace)| trace).collect();
        all.events.sort_by(|a, b| a.time.total_cmp(&b.time));
        all
    }
}

/// Totals of a group that the current trees do not contain, because the integrals of trees start at zero when
/// they are assembled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Ledger {
    /// Time integral of the external forces, N s, and of their moments about the centres of mass of the
    /// trees, N m s.
    pub(super) impulse: Momentum<f64>,
    pub(super) work: f64,
    pub(super) dissipated: f64,
}
