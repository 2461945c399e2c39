//! Laws of single joints: computed torque in joint space, and PID.

use super::error::ControlError;
use super::gains::PerJoint;
use crate::reference::JointSample;

/// Joint-space computed torque on the reduced model: `q̈ = q̈d + kd (q̇d − q̇) + kp (qd − q)`, exactly,
/// whatever the base does.
///
/// `τ = M* q̈ + c* − Q* + f`, so that the error obeys `ë + kd ė + kp e = 0`. Coulomb friction is compensated by
/// the drives, from rest and through reversals as well. Positions are compared as
/// numbers: a joint that turns on and on is one turn away from where it was.
#[derive(Clone, Debug)]
pub struct JointComputedTorque {
    /// `kp`, 1/s².
    pub kp: PerJoint,
    /// `kd`, 1/s.
    pub kd: PerJoint,
    /// Whether the wrenches of the environment are known to the law and compensated.
    pub compensate_environment: bool,
    /// Whether the joints' damping and Coulomb friction are known and compensated: the damping at control
    /// ticks, Coulomb friction by the drives at every instant.
    pub compensate_friction: bool,
}

impl JointComputedTorque {
    /// A law with one gain `kp` (1/s²) and one `kd` (1/s) for all joints.
    pub fn new(kp: f64, kd: f64) -> Self {
        Self { kp: kp.into(), kd: kd.into(), compensate_environment: true, compensate_friction: true }
    }

    /// Checks the gains for a group of `count` joints.
    ///
    /// # Errors
    /// [`ControlError`] for gains of another number, negative or not finite.
    pub fn check(&self, count: usize) -> Result<(), ControlError> {
        self.kp.check("kp", count)?;
        self.kd.check("kd", count)
    }

    /// `q̈` of the joint at `place` with `rate` and position error `error`.
    #[inline(always)]
    pub(super) fn command(&self, place: usize, error: f64, rate: f64, desired: &JointSample) -> f64 {
        let lag = desired.v[place] - rate;
        desired.a[place] + self.kd.at(place) * lag + self.kp.at(place) * error
    }
}

/// What the reference of a [`JointPid`] says, after the interfaces of ROS Control.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interface {
    /// Joint positions: `e = qd − q`, `ė = q̇d − q̇`.
    #[default]
    Position,
    /// Joint rates: `e = q̇d − q̇`, `ė` by the difference since the last tick.
    Velocity,
    /// The efforts themselves, N m (N): the reference's positions are taken for them.
    Effort,
}

/// A PID for each joint: `τ = p e + i ∫e dt + d ė`.
///
/// The integral is summed at control ticks, `e Δt`, its share of the effort kept within `i_limit`; while
/// the effort is at its limit it does not grow further into it (anti-windup). Friction is not compensated: a
/// joint that sticks waits for the integral.
#[derive(Clone, Debug)]
pub struct JointPid {
    /// What the reference says.
    pub interface: Interface,
    /// `p`, N m per rad (rad/s).
    pub p: PerJoint,
    /// `i`, N m per rad s (rad).
    pub i: PerJoint,
    /// `d`, N m s per rad (rad/s).
    pub d: PerJoint,
    /// Largest share of the integral, N m (N); infinite where it has no limit.
    pub i_limit: PerJoint,
    /// Largest effort, N m (N); infinite where it has no limit.
    pub effort_limit: PerJoint,
}

/// What a [`JointPid`] remembers between ticks, per joint.
#[derive(Clone, Debug, Default)]
pub(super) struct PidMemory {
    /// The integral's share of the effort, N m.
    pub(super) integral: Vec<f64>,
    /// Error at the last tick; NaN before the first.
    pub(super) previous: Vec<f64>,
}

impl JointPid {
    /// A PID with these gains for all joints and without limits.
    pub fn new(interface: Interface, p: f64, i: f64, d: f64) -> Self {
        let free = PerJoint::from(f64::INFINITY);
        let (i_limit, effort_limit) = (free.clone(), free);
        Self { interface, p: p.into(), i: i.into(), d: d.into(), i_limit, effort_limit }
    }

    /// Checks the gains for a group of `count` joints.
    ///
    /// # Errors
    /// [`ControlError`] for gains of another number, negative or not finite.
    pub fn check(&self, count: usize) -> Result<(), ControlError> {
        for (name, gains) in [("p", &self.p), ("i", &self.i), ("d", &self.d)] {
            gains.check(name, count)?;
            if self.interface == Interface::Effort && gains.is_used() {
                return Err(ControlError::GainOfEffort { name });
            }
        }
        self.i_limit.check_limit("i_limit", count)?;
        self.effort_limit.check_limit("effort_limit", count)
    }

    /// Effort of the joint at `place`, at `(q, rate)`, `dt` s after the last tick.
    pub(super) fn effort(
        &self,
        place: usize,
        (q, rate): (f64, f64),
        desired: &JointSample,
        dt: f64,
        memory: &mut PidMemory,
    ) -> f64 {
        let (lag, previous) = (desired.v[place] - rate, memory.previous[place]);
        let (error, slope) = match self.interface {
            Interface::Position => (desired.q[place] - q, lag),
            Interface::Velocity if previous.is_finite() && dt > 0.0 => (lag, (lag - previous) / dt),
            Interface::Velocity => (lag, 0.0),
            Interface::Effort => return clamp(desired.q[place], self.effort_limit.at(place)),
        };
        memory.previous[place] = error;
        let limit = self.effort_limit.at(place);
        let before = memory.integral[place];
        let after = clamp(before + self.i.at(place) * error * dt, self.i_limit.at(place));
        // τ = p e + i ∫e dt + d ė
        let rest = self.p.at(place) * error + self.d.at(place) * slope;
        let winds_up = (rest + after).abs() > limit && (after - before) * (rest + after) > 0.0;
        memory.integral[place] = if winds_up { before } else { after };
        clamp(rest + memory.integral[place], limit)
    }
}

/// The nearest number within `±limit`.
fn clamp(x: f64, limit: f64) -> f64 {
    x.max(-limit).min(limit)
}
