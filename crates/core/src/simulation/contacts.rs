//! What Coulomb friction and stops do to the joints: who stands still, who slips which way.

use crate::model::Model;
use crate::spatial::Real;

/// How far beyond a limit a joint still counts as at it, rad (m).
pub(super) const AT_LIMIT: f64 = 1e-12;

/// Modes of the joints during a step; they follow from the state at its start alone.
///
/// A joint at rest is one whose rate is exactly zero. With friction `f`, or at a stop, it is locked
/// while the torque `λ` that this takes lies within [`Contacts::room`].
#[derive(Clone, Debug)]
pub(crate) struct Contacts {
    /// Coulomb friction, N m (N).
    friction: Vec<f64>,
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
        let friction: Vec<f64> = model.joints().iter().map(|joint| joint.friction).collect();
        let free = (f64::NEG_INFINITY, f64::INFINITY);
        let limits: Vec<(f64, f64)> = model
            .joints()
            .iter()
            .map(|joint| joint.limits.position.filter(|_| stops.is_some()).unwrap_or(free))
            .collect();
        let is_active = friction.iter().any(|f| *f > 0.0) || limits.iter().any(|limits| *limits != free);
        Self {
            friction,
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
    pub(super) fn drag(&self, j: usize) -> f64 {
        self.friction[j] * self.direction[j]
    }

    pub(super) fn friction(&self, j: usize) -> f64 {
        self.friction[j]
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

    /// Torques that hold a joint at rest: `−f..f`, and whatever a stop has to push.
    pub(super) fn room(&self, j: usize, q: f64) -> (f64, f64) {
        let (f, stop) = (self.friction[j], self.stop(j, q));
        let lowest = if stop > 0.0 { f64::NEG_INFINITY } else { -f };
        let highest = if stop < 0.0 { f64::INFINITY } else { f };
        (lowest, highest)
    }

    /// Modes as far as position and rate tell: joints at rest are locked, to be seen.
    pub(super) fn guess<S: Real>(&mut self, q: &[S], v: &[S]) {
        for j in 0..self.locked.len() {
            let (q, rate) = (q[j + 7].lane(0), v[j + 6].lane(0));
            let is_held = self.friction[j] > 0.0 || self.stop(j, q) != 0.0;
            self.locked[j] = rate == 0.0 && is_held;
            self.direction[j] = if rate == 0.0 { 0.0 } else { rate.signum() };
        }
        self.any_locked = self.locked.contains(&true);
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
