//! Static and kinetic friction of the joints with given efforts.

use super::{ControllerSet, active_loops};
use crate::control::control_law::JointCommand;
use crate::model::{BASE_NV, Model};
use crate::spatial::Scalar;

/// Rate, rad/s (m/s), at which friction reaches its full value in an engine without static friction; below
/// this rate, friction is proportional to the rate.
const CREEP: f64 = 1e-2;

impl<S: Scalar> ControllerSet<'_, S> {
    /// Adds damping and friction to the loads of the joints with given efforts. Joints with static friction
    /// that are at rest are assumed to stick, unless the engine has no static friction.
    pub(super) fn assume_friction(&mut self, model: &Model) {
        for (j, joint) in model.joints().iter().enumerate() {
            if self.commands[j] != JointCommand::Effort {
                continue;
            }
            let rate = self.v[BASE_NV + j];
            self.dynamics.load[j] += rate * joint.damping;
            if self.friction_creeps {
                self.dynamics.load[j] += joint.friction * (rate / CREEP).clamp(-1.0, 1.0);
            } else if rate != 0.0 {
                self.dynamics.load[j] += joint.friction * rate.signum();
            } else if joint.static_friction > 0.0 {
                self.commands[j] = JointCommand::Held;
            }
        }
    }

    /// Releases the first held joint whose holding torque exceeds its static friction. The joint then slips
    /// against that torque, and the kinetic friction has the direction of the torque. Returns false if there
    /// is no such joint. Requires the accelerations of all joints.
    pub(super) fn release_joint(&mut self, model: &Model) -> bool {
        let Self { dynamics, tau, commands, known, looped, .. } = self;
        let mut loops = active_loops(known, looped);
        let mut holding_torque = |j: usize| match &mut loops {
            Some(loops) => loops.holding_torque(j),
            None => dynamics.holding_torque(j, tau[j]),
        };
        let mut slips = |j: &usize| {
            commands[*j] == JointCommand::Held
                && holding_torque(*j).abs() > model.joints()[*j].static_friction
        };
        let Some(j) = (0..commands.len()).find(&mut slips) else { return false };
        // kinetic friction replaces the holding torque λ and has its direction: τ − l, l = … − f sign(λ)
        let holding = holding_torque(j);
        self.dynamics.load[j] -= model.joints()[j].friction * holding.signum();
        self.commands[j] = JointCommand::Effort;
        true
    }
}
