//! Interface of the control laws.

use super::error::ControlError;
use super::observation::Observation;
use super::pseudo_inverse::PseudoInverse;
use crate::model::Model;
use crate::reference::JointSample;
use crate::spatial::Motion;
use serde::{Deserialize, Serialize};

/// Interface of a control law on a group of joints. Each law implements it in its own file; the defaults are
/// those of a law that commands efforts and compensates nothing.
pub(super) trait ControlLaw {
    /// Checks that the law applies to a group of joints; `control` is its name in messages.
    fn check_group(&self, control: &str, joints: &[usize], model: &Model) -> Result<(), ControlError>;

    /// Returns the kind of command that the law gives its joints.
    fn joint_command(&self) -> JointCommand {
        JointCommand::Effort
    }

    /// Returns the quantity of the joints that the joint reference commands.
    fn interface(&self) -> Interface {
        Interface::Position
    }

    /// Returns true if the law uses the tracking error of its control, as laws do that command accelerations or move a
    /// frame by efforts.
    fn uses_error(&self) -> bool {
        self.joint_command() != JointCommand::Effort || self.needs_jacobian()
    }

    /// Returns true if the law requires the Jacobian of its frame to compute efforts.
    fn needs_jacobian(&self) -> bool {
        false
    }

    /// Returns true if the law compensates the wrenches of the environment; `None` if it has no such option.
    fn compensates_environment(&self) -> Option<bool> {
        None
    }

    /// Returns true if the law compensates damping and Coulomb friction of its joints.
    fn compensates_friction(&self) -> bool {
        false
    }

    /// Computes the efforts of the group, `(k,)`, N m (N). A law that commands accelerations does not change
    /// `tau`.
    fn efforts(
        &mut self,
        _input: &EffortInput<'_>,
        _work: EffortWork<'_>,
        _tau: &mut [f64],
    ) -> Result<(), ControlError> {
        Ok(())
    }

    /// Returns the acceleration of the joint at `place` in the group, for [`JointCommand::Acceleration`].
    fn joint_acceleration(&self, _place: usize, _error: f64, _rate: f64, _desired: &JointSample) -> f64 {
        0.0
    }

    /// Returns the effort that is added to the torque of the joint at `place` in the group, N m (N), for
    /// [`JointCommand::Acceleration`].
    fn feedforward(&self, _place: usize) -> Option<f64> {
        None
    }

    /// Returns the acceleration of the tracked frame, for [`JointCommand::Task`], from its pose error, its velocity
    /// error and the desired acceleration.
    fn task_acceleration(
        &self,
        _error: Motion<f64>,
        _velocity_error: Motion<f64>,
        desired: Motion<f64>,
    ) -> Motion<f64> {
        desired
    }

    /// Returns the damping of the solution for the joints, for [`JointCommand::Task`].
    fn task_damping(&self) -> TaskDamping {
        TaskDamping::default()
    }

    /// Returns the desired acceleration for the friction compensation of the joint at `place` in the group:
    /// zero if a joint at rest may stay there.
    fn desired_acceleration(&self, _place: usize, acceleration: f64) -> f64 {
        acceleration
    }

    /// Prepares the law for a new run.
    fn reset(&mut self) -> Result<(), ControlError> {
        Ok(())
    }

    /// Returns the state of a user's controller for a checkpoint.
    fn save(&self) -> Result<Vec<u8>, ControlError> {
        Ok(Vec::new())
    }

    /// Restores the state that [`ControlLaw::save`] returned.
    fn load(&mut self, _saved: &[u8]) -> Result<(), ControlError> {
        Ok(())
    }
}

/// Command of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum JointCommand {
    /// The effort is given.
    Effort,
    /// Friction holds the joint at rest.
    Held,
    /// The acceleration is given.
    Acceleration,
    /// The tasks determine the acceleration.
    Task,
}

/// Quantity that a joint reference commands, as the interfaces of ROS Control.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interface {
    /// Joint positions: `e = qd − q`, `ė = q̇d − q̇`.
    #[default]
    Position,
    /// Joint rates: `e = q̇d − q̇`, `ė` is the backward difference of `e` since the last control tick.
    Velocity,
    /// Efforts, N m (N): the positions of the reference are read as efforts.
    Effort,
}

/// Damping of the joint accelerations that realise a task.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TaskDamping {
    /// Limit `λ₀` of `tr[(J Jᵀ)⁻¹]^(-1/2)` below which the pseudo-inverse of the Jacobian `J` is damped.
    pub(super) pseudo_inverse: f64,
    /// Damping `k` of the self-motion, 1/s.
    pub(super) null_space: f64,
    /// Damping `κ` of the joint rates `D q̇` that the damping of the pseudo-inverse suppresses, 1/s.
    pub(super) suppressed: f64,
}

/// Input of the laws that command efforts.
pub(super) struct EffortInput<'a> {
    /// Name of the control.
    pub(super) control: &'a str,
    /// Time, state of the robot, joints of the group and desired pose of the tracked frame.
    pub(super) observation: Observation<'a>,
    /// Time since the last control tick, s.
    pub(super) elapsed: f64,
    /// Desired motion of the joints of the group.
    pub(super) desired: &'a JointSample,
    /// Tracking error of the control, `(width,)`, and velocity error of its frame, m/s and rad/s.
    pub(super) error: (&'a [f64], Motion<f64>),
    /// Generalized Jacobian of the tracked frame, the columns of the group, `(6, k)`.
    pub(super) jacobian: &'a [f64],
    /// Rates of the joints of the group, `(k,)`, rad/s (m/s).
    pub(super) rates: &'a [f64],
}

/// Memory and workspace of the laws that command efforts.
pub(super) struct EffortWork<'a> {
    pub(super) pid: &'a mut PidMemory,
    pub(super) inverse: &'a mut PseudoInverse<f64>,
    /// Workspace with one number per joint, `(n,)`.
    pub(super) scratch: &'a mut [f64],
}

/// State of PID controllers between control ticks, per joint.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct PidMemory {
    /// Effort of the integral term, N m (N).
    pub(super) integral: Vec<f64>,
    /// Error at the last tick; `None` before the first.
    pub(super) previous: Vec<Option<f64>>,
}
