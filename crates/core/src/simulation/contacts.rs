//! What Coulomb friction and stops do to the joints: who stands still, who slips which way.

use crate::model::{JointProperties, Model};
use crate::spatial::Real;

/// How far beyond a limit a joint still counts as at it, rad (m).
pub(super) const AT_LIMIT: f64 = 1e-12;

/// Rate within which the compensation for another engine turns its direction, rad/s (m/s).
const TURN: f64 = 1e-2;

/// Acceleration above which that compensation counts on a joint at rest to move, rad/s² (m/s²).
const START: f64 = 1e-2;

/// Modes of the joints during a step; they follow from the state at its start and from what the control law
/// asked for.
///
/// A joint at rest is one whose rate is exactly zero. With static friction `fs`, or at a stop, it is locked
/// while the torque `λ` that this takes lies within [`Contacts::room`]; it moves against the kinetic friction.
///
/// A law that compensates Coulomb friction says for each of its joints which acceleration it asks for. The
/// joint's drive then adds the torque of the friction itself: while the joint moves, the kinetic friction in the
/// direction of its rate, which changes sign at the instant where the rate does; at rest, where the law asks for
/// an acceleration, the static friction in the direction in which the law's torque pushes. So friction leaves
/// nothing of itself in the motion, and holds the joints that the law leaves at rest.
#[derive(Clone, Debug)]
pub(crate) struct Contacts {
    /// Kinetic friction, N m (N).
    friction: Vec<f64>,
    /// Static friction, N m (N), at least the kinetic one.
    static_friction: Vec<f64>,
    /// Acceleration that a law asks for, rad/s² (m/s²), of the joints whose friction it compensates; zero where
    /// a joint at rest is to stay there.
    asked: Vec<Option<f64>>,
    /// Positions that stops allow, rad (m); infinite without.
    limits: Vec<(f64, f64)>,
    /// Share of the rate that a stop gives back.
    pub(super) restitution: f64,
    is_active: bool,
    locked: Vec<bool>,
    any_locked: bool,
    /// Direction of slip of those with friction: −1, 0 or 1.
    direction: Vec<f64>,
}

impl Contacts {
    pub(super) fn new(model: &Model, stops: Option<f64>) -> Self {
        let n = model.joint_count();
        let of_joints = |get: fn(&JointProperties) -> f64| model.joints().iter().map(get).collect();
        let friction = of_joints(|joint| joint.friction);
        let static_friction: Vec<f64> = of_joints(|joint| joint.static_friction);
        let free = (f64::NEG_INFINITY, f64::INFINITY);
        let limits: Vec<(f64, f64)> = model
            .joints()
            .iter()
            .map(|joint| joint.limits.position.filter(|_| stops.is_some()).unwrap_or(free))
            .collect();
        let is_active =
            static_friction.iter().any(|f| *f > 0.0) || limits.iter().any(|limits| *limits != free);
        Self {
            friction,
            static_friction,
            asked: vec![None; n],
            limits,
            restitution: stops.unwrap_or(0.0),
            is_active,
            locked: vec![false; n],
            any_locked: false,
            direction: vec![0.0; n],
        }
    }

    /// Whether any joint has friction or stops.
    pub(crate) fn is_active(&self) -> bool {
        self.is_active
    }

    /// The joints that stand still, if any does.
    pub(super) fn locked(&self) -> Option<&[bool]> {
        self.any_locked.then_some(&self.locked[..])
    }

    /// Which joints stand still, `(n,)`.
    pub(super) fn modes(&self) -> &[bool] {
        &self.locked
    }

    pub(super) fn is_locked(&self, j: usize) -> bool {
        self.locked[j]
    }

    pub(super) fn lock(&mut self, j: usize) {
        (self.locked[j], self.direction[j], self.any_locked) = (true, 0.0, true);
    }

    /// Lets a joint slip in a direction.
    pub(super) fn release(&mut self, j: usize, direction: f64) {
        (self.locked[j], self.direction[j]) = (false, direction);
        self.any_locked = self.locked.contains(&true);
    }

    /// Friction as it acts during the step, against the slip, N m (N).
    fn drag(&self, j: usize) -> f64 {
        self.friction[j] * self.direction[j]
    }

    /// What the drive adds to the law's torque during the step, N m (N); `None` where no law compensates.
    pub(super) fn compensation(&self, j: usize) -> Option<f64> {
        self.asked[j].map(|_| self.drag(j))
    }

    /// Friction less its compensation: they cancel, N m (N).
    pub(super) fn remaining_drag(&self, j: usize) -> f64 {
        if self.asked[j].is_some() { 0.0 } else { self.drag(j) }
    }

    /// Accelerations asked for, of the joints whose friction the control law compensates.
    pub(crate) fn asked(&self) -> &[Option<f64>] {
        &self.asked
    }

    /// As [`Contacts::asked`], for the law.
    pub(crate) fn asked_mut(&mut self) -> &mut [Option<f64>] {
        &mut self.asked
    }

    /// Whether the joint has any friction.
    pub(super) fn has_friction(&self, j: usize) -> bool {
        self.static_friction[j] > 0.0
    }

    /// Largest torque that friction leaves for a joint at rest to be held by: none where the drive breaks it
    /// away, N m (N).
    pub(super) fn holding_friction(&self, j: usize) -> f64 {
        if self.asked[j].is_some_and(|a| a != 0.0) { 0.0 } else { self.static_friction[j] }
    }

    pub(super) fn direction(&self, j: usize) -> f64 {
        self.direction[j]
    }

    pub(super) fn limits(&self, j: usize) -> (f64, f64) {
        self.limits[j]
    }

    /// Which stop a joint at `q` stands at: 1 the upper, −1 the lower, 0 none.
    pub(super) fn stop(&self, j: usize, q: f64) -> f64 {
        let (lower, upper) = self.limits[j];
        f64::from(q >= upper) - f64::from(q <= lower)
    }

    /// Torques that hold a joint at rest: `−fs..fs`, and whatever a stop has to push.
    pub(super) fn room(&self, j: usize, q: f64) -> (f64, f64) {
        let (f, stop) = (self.holding_friction(j), self.stop(j, q));
        let lowest = if stop > 0.0 { f64::NEG_INFINITY } else { -f };
        let highest = if stop < 0.0 { f64::INFINITY } else { f };
        (lowest, highest)
    }

    /// Modes as far as position and rate tell: joints at rest are locked, to be seen.
    pub(super) fn guess<S: Real>(&mut self, q: &[S], v: &[S]) {
        for j in 0..self.locked.len() {
            let (q, rate) = (q[j + 7].lane(0), v[j + 6].lane(0));
            let is_held = self.has_friction(j) || self.stop(j, q) != 0.0;
            self.locked[j] = rate == 0.0 && is_held;
            self.direction[j] = if rate == 0.0 { 0.0 } else { rate.signum() };
        }
        self.any_locked = self.locked.contains(&true);
    }

    /// Compensation for an engine that has its own friction and is given torques held over its steps.
    ///
    /// Such friction creeps instead of sticking, and the sign of a small rate is chance: within ±[`TURN`] the
    /// compensation goes over from one direction to the other, about the way that the law asks a joint at rest
    /// to start (in full from an acceleration of [`START`] on).
    pub(super) fn compensate_by_rate<S: Real>(&mut self, v: &[S]) {
        for (j, asked) in self.asked.iter().enumerate() {
            let start = asked.map_or(0.0, |a| (a / START).clamp(-1.0, 1.0));
            self.direction[j] = (2.0 * v[j + 6].lane(0) / TURN + start).clamp(-1.0, 1.0);
        }
    }

    /// Power that damping and friction take, `Σ (b q̇ + f s) q̇`, W.
    #[inline(always)]
    pub(super) fn loss<S: Real>(&self, model: &Model, v: &[S]) -> S {
        let mut sum = S::of(0.0);
        for (j, joint) in model.joints().iter().enumerate() {
            let torque = v[j + 6] * S::of(joint.damping) + S::of(self.drag(j));
            sum += torque * v[j + 6];
        }
        sum
    }
}
