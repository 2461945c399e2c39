//! Audit of captures, releases and brakes: momentum, energy and relative motion before and after each event.

use super::equations::EquationsOfMotion;
use super::recording::{EventKind, EventRecord};
use super::run_state::RunState;
use crate::dynamics::{Data, FramePose, frame_pose, frame_velocity, kinematics};
use crate::model::Model;
use crate::spatial::{Force, Motion, Scalar, Vec3};
use crate::world::{Balance, FrameIndex, energy, energy_of_change};

/// Configuration and velocity of a system in its own coordinates.
pub(super) struct Snapshot {
    pub(super) q: Vec<f64>,
    pub(super) v: Vec<f64>,
}

/// Capture, release or change of a brake that has been applied to the current state.
pub(super) struct Applied<'s> {
    /// Index of the event among those of the group.
    pub(super) number: usize,
    pub(super) kind: EventKind,
    /// Time of the event, s.
    pub(super) time: f64,
    /// Capturing and captured frame; for a brake, both entries are the frame with index 0 of its system.
    pub(super) frames: [FrameIndex; 2],
    /// States of all systems before the event.
    pub(super) before: &'s [Snapshot],
    /// Indices of the systems whose change of momentum equals the impulse of the event.
    pub(super) pushed: &'s [usize],
    /// Point in W about which the impulse is stated, m.
    pub(super) point: Vec3<f64>,
    /// Work done by the spring of a release, J; for a brake, minus the energy that it dissipates.
    pub(super) spring_work: f64,
}

/// Sums over all systems, before and after an event.
#[derive(Default)]
struct Sums {
    balances: [Balance; 2],
    /// Kinetic energies before and after the event, J.
    energies: [f64; 2],
    /// Kinetic energy `½ Δvᵀ M Δv` of the changes `Δv` of the velocities, J.
    energy_of_change: f64,
    /// Change of the momentum of the systems `pushed`, N s and N m s.
    impulse: Force<f64>,
}

impl<S: Scalar> RunState<'_, S> {
    /// Returns the record of an event that has been applied to the current state.
    pub(super) fn audit(&self, event: &Applied<'_>) -> EventRecord {
        let after = self.snapshots();
        let Sums { balances, energies, energy_of_change, impulse } = self.sums(event, &after);
        let difference = energies[0] - energies[1];
        // joints with prescribed rates do work during the impulse that neither of the sums contains
        let is_driven = self.equations.trees.iter().any(|tree| !tree.modes.given().is_empty());
        let (energy_lost, expected) = match event.kind {
            _ if is_driven => (difference, difference),
            EventKind::Capture => (energy_of_change, energy_of_change),
            _ => (difference, -event.spring_work),
        };
        let (mut impulse_w, mut point_w) = ([0.0; 6], [0.0; 3]);
        impulse.write(&mut impulse_w);
        event.point.write(&mut point_w);
        EventRecord {
            name: self.events.list[event.number].name.clone(),
            kind: event.kind,
            time: event.time,
            systems: event.frames.map(|place| self.numbers[place.system]),
            impulse: impulse_w,
            point: point_w,
            energy_lost,
            momentum_error: balances[1].error_since(&balances[0]),
            twist_left: self.twist_left(event, &after),
            energy_error: (difference - expected).abs() / energies[0].max(energies[1]).max(f64::MIN_POSITIVE),
            peak_force: None,
        }
    }

    /// Returns the sums over all systems before an event and in the states `after` the event.
    fn sums(&self, event: &Applied<'_>, after: &[Snapshot]) -> Sums {
        let mut sums = Sums::default();
        for system in 0..self.systems.len() {
            let model = self.model(system);
            let states = [&event.before[system], &after[system]];
            let balances = states.map(|state| Balance::of(model, &state.q, &state.v, event.point));
            for (i, state) in states.into_iter().enumerate() {
                sums.balances[i].add(&balances[i]);
                sums.energies[i] += energy(model, &state.q, &state.v);
            }
            if event.pushed.contains(&system) {
                sums.impulse += balances[1].momentum - balances[0].momentum;
            }
            let [before, after] = states;
            sums.energy_of_change += energy_of_change(model, &before.q, &before.v, &after.v);
        }
        sums
    }

    /// Returns the linear and the angular relative velocity of the two frames after a capture, as fractions
    /// of those before the capture, or of 1 m/s and 1 rad/s if these are larger. Returns zeros for other
    /// events and with an external engine.
    fn twist_left(&self, event: &Applied<'_>, after: &[Snapshot]) -> [f64; 2] {
        if event.kind != EventKind::Capture || self.mover.is_external() {
            return [0.0; 2]; // an external engine removes the relative velocity during the next steps
        }
        let [before, after] = [event.before, after].map(|states| self.relative_twist(event.frames, states));
        [relative_to(before.linear, after.linear), relative_to(before.angular, after.angular)]
    }

    /// Returns the model of the system with index `system` in the group.
    pub(super) fn model(&self, system: usize) -> &Model {
        let EquationsOfMotion { trees, members, .. } = &self.equations;
        &members.system(system, trees, &self.state.trees).1.model
    }

    /// Returns the states of all systems. Requires up-to-date states of the parts of trees.
    pub(super) fn snapshots(&self) -> Vec<Snapshot> {
        let EquationsOfMotion { trees, members, .. } = &self.equations;
        let snapshot = |system| {
            let [q, v] = members.system(system, trees, &self.state.trees).0.values();
            Snapshot { q, v }
        };
        (0..self.systems.len()).map(snapshot).collect()
    }

    /// Returns the pose and the twist in W of a frame of a system, given the states of all systems.
    pub(super) fn pose_and_twist(
        &self,
        place: FrameIndex,
        states: &[Snapshot],
    ) -> (FramePose<f64>, Motion<f64>) {
        let (model, Snapshot { q, v }) = (self.model(place.system), &states[place.system]);
        let mut data = Data::<f64>::new(model);
        kinematics(model, &mut data, q, v);
        (frame_pose(model, &data, q, place.frame), frame_velocity(model, &data, q, place.frame))
    }

    /// Returns the twist of the second frame relative to the first, at the origin of the second frame, W
    /// axes, m/s and rad/s.
    fn relative_twist(&self, [by, of]: [FrameIndex; 2], states: &[Snapshot]) -> Motion<f64> {
        let (pose_by, twist_by) = self.pose_and_twist(by, states);
        let (pose_of, twist_of) = self.pose_and_twist(of, states);
        twist_of - twist_by.referred_to(pose_of.pos_w - pose_by.pos_w)
    }
}

/// Returns the magnitude of a velocity after an event relative to the magnitude before it, or relative to 1
/// m/s or 1 rad/s if that is larger.
fn relative_to(before: Vec3<f64>, after: Vec3<f64>) -> f64 {
    after.norm() / before.norm().max(1.0)
}
