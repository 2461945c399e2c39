//! PID controllers of individual joints.

use super::control_law::{ControlLaw, EffortInput, EffortWork, Interface, PidMemory};
use super::error::ControlError;
use super::gains::PerJoint;
use super::observation::Observation;
use crate::model::{BASE_NQ, Model};
use crate::reference::JointSample;

/// PID controller for each joint of a group: `τ = p e + i ∫e dt + d ė` with the error `e` of the commanded
/// quantity, desired less actual. With the effort interface, the effort is that of the reference.
///
/// The integral increases by `e Δt` at each control tick, with the time `Δt` since the last tick. The effort
/// of the integral term is limited to `±i_limit`, and while the total effort is at `effort_limit` the
/// integral does not increase further in that direction (anti-windup). Friction is not compensated: a joint
/// that sticks does not move until the effort exceeds its static friction.
#[derive(Clone, Debug)]
pub struct JointPid {
    /// Quantity that the reference commands.
    pub interface: Interface,
    /// Proportional gain `p`: N m/rad (N/m for a prismatic joint) or, for errors of the rate, N m s/rad (N
    /// s/m).
    pub p: PerJoint,
    /// Integral gain `i`: the unit of `p` per second.
    pub i: PerJoint,
    /// Derivative gain `d`: the unit of `p` times seconds.
    pub d: PerJoint,
    /// Largest effort of the integral term, N m (N); infinity for no limit.
    pub i_limit: PerJoint,
    /// Largest effort, N m (N); infinity for no limit.
    pub effort_limit: PerJoint,
}

impl JointPid {
    /// Creates a PID law with these gains for all joints and without limits.
    pub fn new(interface: Interface, p: f64, i: f64, d: f64) -> Self {
        let unlimited = PerJoint::from(f64::INFINITY);
        let (i_limit, effort_limit) = (unlimited.clone(), unlimited);
        Self { interface, p: p.into(), i: i.into(), d: d.into(), i_limit, effort_limit }
    }

    /// Checks the gains for a group of `count` joints.
    ///
    /// # Errors
    /// [`ControlError`] if the number of gains or limits is neither 1 nor `count`, a gain is negative, not
    /// finite or too large, a limit is negative or NaN, or a gain is not zero for the effort interface.
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

    /// Computes the effort, N m (N), of the joint at index `place` of the group with the position `q` and the
    /// rate `rate`, `dt` seconds after the last tick, and updates `memory`. For the effort interface, returns
    /// the effort of the reference, limited to `effort_limit`.
    pub(super) fn effort(
        &self,
        place: usize,
        (q, rate): (f64, f64),
        desired: &JointSample,
        dt: f64,
        memory: &mut PidMemory,
    ) -> f64 {
        let (rate_error, previous) = (desired.v[place] - rate, memory.previous[place]);
        let (error, error_rate) = match self.interface {
            Interface::Position => (desired.q[place] - q, rate_error),
            Interface::Velocity if dt > 0.0 => {
                (rate_error, previous.map_or(0.0, |previous| (rate_error - previous) / dt))
            }
            Interface::Velocity => (rate_error, 0.0),
            Interface::Effort => return clamp(desired.q[place], self.effort_limit.at(place)),
        };
        memory.previous[place] = Some(error);
        let limit = self.effort_limit.at(place);
        let before = memory.integral[place];
        let after = clamp(before + self.i.at(place) * error * dt, self.i_limit.at(place));
        // τ = p e + i ∫e dt + d ė
        let proportional_derivative = self.p.at(place) * error + self.d.at(place) * error_rate;
        let effort = proportional_derivative + after;
        let winds_up = effort.abs() > limit && (after - before) * effort > 0.0;
        memory.integral[place] = if winds_up { before } else { after };
        clamp(proportional_derivative + memory.integral[place], limit)
    }
}

impl ControlLaw for JointPid {
    fn check_group(&self, _: &str, joints: &[usize], _: &Model) -> Result<(), ControlError> {
        self.check(joints.len())
    }

    fn interface(&self) -> Interface {
        self.interface
    }

    fn efforts(
        &mut self,
        input: &EffortInput<'_>,
        work: EffortWork<'_>,
        tau: &mut [f64],
    ) -> Result<(), ControlError> {
        let Observation { q, joints, .. } = input.observation;
        for (place, tau) in tau.iter_mut().enumerate() {
            let now = (q[BASE_NQ + joints[place]], input.rates[place]);
            *tau = self.effort(place, now, input.desired, input.elapsed, work.pid);
        }
        Ok(())
    }
}

/// Returns the number in `[-limit, limit]` that is nearest to `x`.
fn clamp(x: f64, limit: f64) -> f64 {
    x.max(-limit).min(limit)
}
