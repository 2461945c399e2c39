//! Modes of the joints during a step, which result from Coulomb friction, brakes and the stops at position
//! limits.

use super::engaged_brakes::EngagedBrakes;
use crate::model::{BASE_NQ, BASE_NV, JointProperties, Model};
use crate::spatial::Real;
use crate::world::GivenJoint;
use serde::{Deserialize, Serialize};

/// Distance, rad or m, from a position limit within which a joint is treated as being at the limit.
pub(in crate::simulation) const AT_LIMIT: f64 = 1e-12;

/// Width, rad/s or m/s, of the interval of joint rates in which the friction compensation for an external
/// engine changes linearly from one direction to the other.
const TURN: f64 = 1e-2;

/// Requested acceleration, rad/s² or m/s², at and above which the friction compensation for an external
/// engine has its full value on a joint at rest.
const START: f64 = 1e-2;

/// Modes of the joints during a step, which depend on the state at the start of the step and on the
/// accelerations that the control laws request.
///
/// A joint is at rest if its rate is exactly zero. A joint at rest with static friction `fs`, or at a stop,
/// is locked while the torque `λ` required to hold it is within [`JointModes::torque_bounds`]. Kinetic
/// friction opposes the motion of a joint.
///
/// A control law that compensates Coulomb friction provides the acceleration that it requests for each of its
/// joints. The motor of the joint then adds the friction torque. While the joint moves, this is the kinetic
/// friction in the direction of the rate, whose sign changes at the same instant as that of the rate. At
/// rest, if the law requests an acceleration, it is the static friction in the direction of the law's torque.
/// Friction then has no effect on moving joints, but holds the joints that the law keeps at rest.
#[derive(Clone, Debug)]
pub(crate) struct JointModes {
    /// Kinetic friction of each joint, N m or N.
    friction: Vec<f64>,
    /// Static friction of each joint, N m or N, which is at least the kinetic friction.
    static_friction: Vec<f64>,
    /// Accelerations that control laws request for the joints whose friction they compensate, rad/s² or m/s²;
    /// `None` for other joints. Zero means that a joint at rest should remain at rest.
    requested: Vec<Option<f64>>,
    /// Lower and upper position limit of each joint, rad or m; infinite without stops.
    limits: Vec<(f64, f64)>,
    /// Slip torques of the engaged brakes.
    brakes: EngagedBrakes,
    /// Coefficient of restitution of the stops of each joint, from 0 to 1.
    pub(super) restitution: Vec<f64>,
    is_active: bool,
    /// True if the system has brakes, engaged or not.
    has_brakes: bool,
    locked: Vec<bool>,
    any_locked: bool,
    /// Direction of slip of each joint, −1 or 1; 0 for joints that do not slip. For an external engine, a
    /// number from −1 to 1.
    direction: Vec<f64>,
    /// Joints whose positions are prescribed functions of time. They are locked: their accelerations do not
    /// depend on torques.
    given: Vec<GivenJoint>,
    /// Accelerations of the locked joints, `(n,)`, rad/s² or m/s²; empty if all are zero.
    accelerations: Vec<f64>,
}

/// Modes of the joints in the last step, for checkpoints.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::simulation) struct SavedModes {
    pub(in crate::simulation) locked: Vec<bool>,
    pub(in crate::simulation) direction: Vec<f64>,
}

impl JointModes {
    pub(in crate::simulation) fn new(model: &Model, restitution: Option<f64>) -> Self {
        let n = model.joint_count();
        let of_joints = |get: fn(&JointProperties) -> f64| model.joints().iter().map(get).collect();
        let friction = of_joints(|joint| joint.friction);
        let static_friction: Vec<f64> = of_joints(|joint| joint.static_friction);
        let free = (f64::NEG_INFINITY, f64::INFINITY);
        let limits: Vec<(f64, f64)> = model
            .joints()
            .iter()
            .map(|joint| joint.limits.position.filter(|_| restitution.is_some()).unwrap_or(free))
            .collect();
        let is_active =
            static_friction.iter().any(|f| *f > 0.0) || limits.iter().any(|limits| *limits != free);
        Self {
            friction,
            static_friction,
            requested: vec![None; n],
            limits,
            brakes: EngagedBrakes::none(n),
            restitution: vec![restitution.unwrap_or(0.0); n],
            is_active,
            has_brakes: false,
            locked: vec![false; n],
            any_locked: false,
            direction: vec![0.0; n],
            given: Vec::new(),
            accelerations: Vec::new(),
        }
    }

    /// Creates the modes of a tree with `count` joints; the motion of the joints `given` is prescribed. Each
    /// entry of `parts` consists of the modes of some of the joints and their indices in the tree.
    pub(in crate::simulation) fn joined<'m>(
        count: usize,
        given: Vec<GivenJoint>,
        parts: impl Iterator<Item = (&'m Self, &'m [usize])>,
    ) -> Self {
        let (zeros, free) = (vec![0.0; count], (f64::NEG_INFINITY, f64::INFINITY));
        let mut all = Self {
            friction: zeros.clone(),
            static_friction: zeros.clone(),
            requested: vec![None; count],
            limits: vec![free; count],
            brakes: EngagedBrakes::none(count),
            restitution: zeros.clone(),
            is_active: false,
            has_brakes: false,
            locked: vec![false; count],
            any_locked: false,
            direction: zeros.clone(),
            accelerations: if given.is_empty() { Vec::new() } else { zeros },
            given,
        };
        for (part, joints) in parts {
            for (own, &joint) in joints.iter().enumerate() {
                all.friction[joint] = part.friction[own];
                all.static_friction[joint] = part.static_friction[own];
                all.requested[joint] = part.requested[own];
                all.brakes.take(joint, &part.brakes, own);
                (all.limits[joint], all.restitution[joint]) = (part.limits[own], part.restitution[own]);
                (all.locked[joint], all.direction[joint]) = (part.locked[own], part.direction[own]);
            }
            all.is_active |= part.is_active;
            all.has_brakes |= part.has_brakes;
        }
        all.lock_given();
        all
    }

    /// Locks the joints with prescribed motion.
    fn lock_given(&mut self) {
        self.given.iter().for_each(|given| self.locked[given.joint] = true);
        self.any_locked = self.locked.contains(&true);
    }

    /// Prepares the modes of a system with brakes, which are then active even while no brake is engaged.
    pub(in crate::simulation) fn allow_brakes(&mut self) {
        (self.is_active, self.has_brakes) = (true, true);
    }

    /// Returns true if the system has brakes, engaged or not.
    pub(in crate::simulation) fn has_brakes(&self) -> bool {
        self.has_brakes
    }

    /// Engages the brake of joint `j` with this slip torque, N m or N, or disengages the brake (0). A brake
    /// with an infinite slip torque locks the joint, which must be at rest by the start of the next step.
    pub(in crate::simulation) fn set_brake(&mut self, j: usize, slip_torque: f64) {
        self.brakes.set(j, slip_torque);
        self.locked[j] = self.brakes.holds(j);
        self.lock_given();
    }

    /// Returns true if a brake holds joint `j` rigidly.
    pub(in crate::simulation) fn is_held(&self, j: usize) -> bool {
        self.brakes.holds(j)
    }

    /// Returns the indices of the joints that brakes hold rigidly.
    pub(in crate::simulation) fn held(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.locked.len()).filter(|&j| self.brakes.holds(j))
    }

    /// Returns an array, `(n,)`, that is true for the joints whose rates do not change in impacts, because
    /// their motion is prescribed or a brake holds them.
    pub(in crate::simulation) fn kept_in_impacts(&self) -> Vec<bool> {
        (0..self.locked.len()).map(|j| self.is_given(j) || self.is_held(j)).collect()
    }

    /// Returns true if the motion of joint `j` is prescribed.
    pub(super) fn is_given(&self, j: usize) -> bool {
        self.given.iter().any(|given| given.joint == j)
    }

    /// Returns the joints with prescribed motion.
    pub(in crate::simulation) fn given(&self) -> &[GivenJoint] {
        &self.given
    }

    /// Returns the accelerations of the locked joints, `(n,)`, rad/s² or m/s²; empty if all are zero.
    pub(in crate::simulation) fn accelerations(&self) -> &[f64] {
        &self.accelerations
    }

    /// Writes the positions and rates of the joints with prescribed motion at `t`, s, to `q` and `v`.
    pub(in crate::simulation) fn move_given<S: Real>(&self, t: f64, q: &mut [S], v: &mut [S]) {
        for given in &self.given {
            let [position, rate, _] = given.at(t);
            (q[BASE_NQ + given.joint], v[BASE_NV + given.joint]) = (S::of(position), S::of(rate));
        }
    }

    /// Computes the accelerations of the joints with prescribed motion at `t`, s.
    pub(in crate::simulation) fn accelerate_given(&mut self, t: f64) {
        for given in &self.given {
            self.accelerations[given.joint] = given.at(t)[2];
        }
    }

    /// Copies the modes from `tree`, the modes of a tree that contains these joints; `joints` has the index
    /// in the tree of each joint.
    pub(in crate::simulation) fn take(&mut self, tree: &Self, joints: &[usize]) {
        for (own, &joint) in joints.iter().enumerate() {
            (self.locked[own], self.direction[own]) = (tree.locked[joint], tree.direction[joint]);
        }
        self.any_locked = self.locked.contains(&true);
    }

    /// Returns which joints are locked and the directions in which the others slip, `(n,)` each.
    pub(in crate::simulation) fn save(&self) -> SavedModes {
        SavedModes { locked: self.locked.clone(), direction: self.direction.clone() }
    }

    /// Restores the modes that [`JointModes::save`] returned.
    pub(in crate::simulation) fn restore(&mut self, saved: &SavedModes) {
        self.locked.copy_from_slice(&saved.locked);
        self.direction.copy_from_slice(&saved.direction);
        self.any_locked = self.locked.contains(&true);
    }

    /// Returns true if any joint has friction, stops or a brake.
    pub(crate) fn is_active(&self) -> bool {
        self.is_active
    }

    /// Returns an array, `(n,)`, that is true for locked joints; `None` if no joint is locked.
    pub(in crate::simulation) fn locked(&self) -> Option<&[bool]> {
        self.any_locked.then_some(&self.locked[..])
    }

    /// Writes an array, `(n,)`, to `kept` that is true for the joints that a projection onto closed loops
    /// must not move: locked joints, and joints at rest that friction, a brake or a stop can hold. The rate
    /// of a joint that has come to rest must remain exactly zero, because a rounding error of the rate would
    /// be treated as motion. The array is empty if there are no such joints.
    pub(in crate::simulation) fn find_kept_at_rest<S: Real>(&self, q: &[S], v: &[S], kept: &mut Vec<bool>) {
        let is_kept = |j: usize| self.locked[j] || self.is_at_rest(j, q, v);
        kept.clear();
        kept.extend((0..self.locked.len()).map(is_kept));
        if !kept.contains(&true) {
            kept.clear();
        }
    }

    /// Returns true if joint `j` is at rest and friction, a brake or a stop can hold it.
    fn is_at_rest<S: Real>(&self, j: usize, q: &[S], v: &[S]) -> bool {
        let can_be_held =
            || self.has_friction(j) || self.brakes.holds(j) || self.stop(j, q[BASE_NQ + j].lane(0)) != 0.0;
        v[BASE_NV + j].lane(0) == 0.0 && can_be_held()
    }

    /// Returns an array, `(n,)`, that is true for locked joints.
    pub(super) fn is_locked_each(&self) -> &[bool] {
        &self.locked
    }

    pub(super) fn is_locked(&self, j: usize) -> bool {
        self.locked[j]
    }

    /// Sets the direction in which joint `j` slips, −1 or 1, or locks the joint (0).
    pub(super) fn set_slip(&mut self, j: usize, direction: f64) {
        (self.locked[j], self.direction[j]) = (direction == 0.0, direction);
        self.any_locked = self.locked.contains(&true);
    }

    /// Returns the kinetic friction of joint `j` and its brake, N m or N, with the sign of the direction of
    /// slip; it is subtracted from the joint torque.
    fn drag(&self, j: usize) -> f64 {
        (self.friction[j] + self.brakes.torque(j)) * self.direction[j]
    }

    /// Returns the torques that the motors add during the step to compensate friction, `(n,)`, N m or N;
    /// `None` for joints without compensation.
    pub(in crate::simulation) fn compensations(&self) -> impl Iterator<Item = Option<f64>> {
        let drag =
            self.friction.iter().zip(&self.direction).map(|(friction, direction)| friction * direction);
        self.requested.iter().zip(drag).map(|(requested, drag)| requested.map(|_| drag))
    }

    /// Returns the kinetic friction of joint `j` less its compensation, N m or N, with the sign of the
    /// direction of slip. If a law compensates the friction of the joint, this is the friction of the brake.
    pub(in crate::simulation) fn remaining_drag(&self, j: usize) -> f64 {
        if self.requested[j].is_some() { self.brakes.torque(j) * self.direction[j] } else { self.drag(j) }
    }

    /// Returns the accelerations requested for the joints whose friction a control law compensates, `(n,)`,
    /// rad/s² or m/s²; `None` for other joints.
    pub(crate) fn requested(&self) -> &[Option<f64>] {
        &self.requested
    }

    /// Returns the accelerations of [`JointModes::requested`] as a mutable slice, to which control laws
    /// write.
    pub(crate) fn requested_mut(&mut self) -> &mut [Option<f64>] {
        &mut self.requested
    }

    /// Returns true if joint `j` has static friction, or an engaged brake that can slip.
    pub(super) fn has_friction(&self, j: usize) -> bool {
        self.static_friction[j] > 0.0 || self.brakes.torque(j) > 0.0
    }

    /// Returns the largest torque with which friction and a brake that can slip hold joint `j` at rest, N m
    /// or N. The friction of the joint is omitted if the motor compensates it, that is, if a control law
    /// requests a nonzero acceleration.
    pub(super) fn holding_friction(&self, j: usize) -> f64 {
        let friction =
            if self.requested[j].is_some_and(|a| a != 0.0) { 0.0 } else { self.static_friction[j] };
        friction + self.brakes.torque(j)
    }

    pub(super) fn direction(&self, j: usize) -> f64 {
        self.direction[j]
    }

    pub(super) fn limits(&self, j: usize) -> (f64, f64) {
        self.limits[j]
    }

    /// Returns the stop that joint `j` touches at the position `q`, rad or m: 1 for the upper stop, −1 for
    /// the lower stop, 0 for neither.
    pub(super) fn stop(&self, j: usize, q: f64) -> f64 {
        let (lower, upper) = self.limits[j];
        f64::from(q >= upper) - f64::from(q <= lower)
    }

    /// Returns the bounds, N m or N, of the torque with which friction, a brake and a stop hold joint `j` at
    /// rest at the position `q`, rad or m: `−f` and `f` with the torque `f` of
    /// [`JointModes::holding_friction`], but no bound on the side on which a stop pushes. For a joint with
    /// prescribed motion, or one that a brake holds rigidly, both bounds are infinite.
    pub(super) fn torque_bounds(&self, j: usize, q: f64) -> (f64, f64) {
        if self.is_given(j) || self.brakes.holds(j) {
            return (f64::NEG_INFINITY, f64::INFINITY);
        }
        let (f, stop) = (self.holding_friction(j), self.stop(j, q));
        let lowest = if stop > 0.0 { f64::NEG_INFINITY } else { -f };
        let highest = if stop < 0.0 { f64::INFINITY } else { f };
        (lowest, highest)
    }

    /// Sets the initial guess of the modes: joints at rest that friction, a brake or a stop can hold, and
    /// joints with prescribed motion, are locked; all other joints are free.
    pub(super) fn lock_joints_at_rest<S: Real>(&mut self, q: &[S], v: &[S]) {
        for j in 0..self.locked.len() {
            let rate = v[BASE_NV + j].lane(0);
            self.locked[j] = self.is_at_rest(j, q, v);
            self.direction[j] = if rate == 0.0 { 0.0 } else { rate.signum() };
        }
        self.lock_given();
    }

    /// Sets the friction compensation for an external engine, which has a different friction model and holds
    /// torques constant during its steps.
    ///
    /// In such an engine joints creep instead of sticking, and the sign of a small rate is arbitrary. The
    /// compensation therefore changes linearly from one direction to the other over an interval of rates of
    /// width [`TURN`], which is centred at zero if no acceleration is requested. A requested acceleration
    /// shifts this interval against its own direction, by half the width for accelerations of [`START`] and
    /// more, so that a joint at rest is then fully compensated in the direction of the acceleration.
    pub(in crate::simulation) fn compensate_by_rate<S: Real>(&mut self, v: &[S]) {
        for (j, requested) in self.requested.iter().enumerate() {
            let start = requested.map_or(0.0, |a| (a / START).clamp(-1.0, 1.0));
            self.direction[j] = (2.0 * v[BASE_NV + j].lane(0) / TURN + start).clamp(-1.0, 1.0);
        }
    }

    /// Returns the power that damping, friction and brakes dissipate, `Σ (b q̇ + f s) q̇`, W, with the
    /// damping `b`, the Coulomb friction `f` of the joint and of its brake, and the direction of slip `s`.
    #[inline(always)]
    pub(in crate::simulation) fn loss<S: Real>(&self, model: &Model, v: &[S]) -> S {
        self.loss_of(model, v, 0..model.joint_count())
    }

    /// Returns the power that damping, friction and brakes of the given joints dissipate, W.
    #[inline(always)]
    pub(in crate::simulation) fn loss_of<S: Real>(
        &self,
        model: &Model,
        v: &[S],
        joints: impl Iterator<Item = usize>,
    ) -> S {
        let mut sum = S::of(0.0);
        for j in joints {
            let torque = v[BASE_NV + j] * S::of(model.joints()[j].damping) + S::of(self.drag(j));
            sum += torque * v[BASE_NV + j];
        }
        sum
    }
}
