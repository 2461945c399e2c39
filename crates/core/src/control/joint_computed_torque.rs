//! Joint-space computed torque.

use super::computed_torque::zero_within_goal_error;
use super::control_law::{ControlLaw, JointCommand};
use super::error::ControlError;
use super::gains::PerJoint;
use crate::model::Model;
use crate::reference::JointSample;

/// Joint-space computed torque on the reduced model. If it compensates all external wrenches and friction, it
/// produces `q̈ = q̈d + kd (q̇d − q̇) + kp (qd − q)` exactly for any motion of the base.
///
/// The torques are `τ = M* q̈ + c* − Q* + f` with the desired positions `qd` and the symbols of
/// [`ComputedTorque`](super::ComputedTorque); the error `e = qd − q` then obeys `ë + kd ė + kp e = 0`. The
/// joint drives compensate Coulomb friction, from rest and through reversals. Joint angles are not wrapped:
/// after a full turn the error is 2π rad.
#[derive(Clone, Debug)]
pub struct JointComputedTorque {
    /// Gain `kp` of the position error, 1/s².
    pub kp: PerJoint,
    /// Gain `kd` of the rate error, 1/s.
    pub kd: PerJoint,
    /// True if the law compensates the wrenches of the environment.
    pub compensate_environment: bool,
    /// True if damping and Coulomb friction of the joints are compensated: damping at control ticks, Coulomb
    /// friction by the joint drives at every instant.
    pub compensate_friction: bool,
}

impl JointComputedTorque {
    /// Creates a law with one gain `kp` (1/s²) and one gain `kd` (1/s) for all joints, which compensates the
    /// environment and friction.
    pub fn new(kp: f64, kd: f64) -> Self {
        Self { kp: kp.into(), kd: kd.into(), compensate_environment: true, compensate_friction: true }
    }

    /// Checks the gains for a group of `count` joints.
    ///
    /// # Errors
    /// [`ControlError`] if the number of gains is neither 1 nor `count`, or if a gain is negative, not finite
    /// or too large.
    pub fn check(&self, count: usize) -> Result<(), ControlError> {
        self.kp.check("kp", count)?;
        self.kd.check("kd", count)
    }
}

impl ControlLaw for JointComputedTorque {
    fn check_group(&self, _: &str, joints: &[usize], _: &Model) -> Result<(), ControlError> {
        self.check(joints.len())
    }

    fn joint_command(&self) -> JointCommand {
        JointCommand::Acceleration
    }

    fn compensates_environment(&self) -> Option<bool> {
        Some(self.compensate_environment)
    }

    fn compensates_friction(&self) -> bool {
        self.compensate_friction
    }

    fn joint_acceleration(&self, place: usize, error: f64, rate: f64, desired: &JointSample) -> f64 {
        let rate_error = desired.v[place] - rate;
        desired.a[place] + self.kd.at(place) * rate_error + self.kp.at(place) * error
    }

    fn desired_acceleration(&self, place: usize, acceleration: f64) -> f64 {
        zero_within_goal_error(acceleration, self.kp.at(place))
    }
}
