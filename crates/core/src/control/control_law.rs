//! Interface of the control laws.

use super::error::ControlError;
use super::fingers::{Finger, FingerForce};
use super::grip_memory::GripMemory;
use super::observation::Observation;
use super::pseudo_inverse::PseudoInverse;
use crate::model::Model;
use crate::reference::JointSample;
use crate::spatial::Motion;
use serde::{Deserialize, Serialize};

/// Interface of a control law for a group of joints. Each law implements it in the file of its type. The
/// default methods are those of a law that commands efforts and compensates nothing.
pub(super) trait ControlLaw {
    /// Checks that the law applies to a group of joints (indices). `control` is the name of the control for
    /// messages.
    fn check_group(&self, control: &str, joints: &[usize], model: &Model) -> Result<(), ControlError>;

    /// Returns the kind of command that the law gives to its joints.
    fn joint_command(&self) -> JointCommand {
        JointCommand::Effort
    }

    /// Returns the joint quantity that the joint reference commands.
    fn interface(&self) -> Interface {
        Interface::Position
    }

    /// Returns true if the law uses the tracking error of its control: by default, if it commands
    /// accelerations, or if it moves a frame by efforts.
    fn uses_error(&self) -> bool {
        self.joint_command() != JointCommand::Effort || self.needs_jacobian()
    }

    /// Returns true if the law needs the Jacobian of its frame to compute efforts.
    fn needs_jacobian(&self) -> bool {
        false
    }

    /// Returns true if the law compensates environmental wrenches; `None` if it has no such option.
    fn compensates_environment(&self) -> Option<bool> {
        None
    }

    /// Returns true if the law compensates damping and Coulomb friction of its joints.
    fn compensates_friction(&self) -> bool {
        false
    }

    /// Writes the efforts of the `k` joints of the group to `tau`, `(k,)`, N m (N). A law that commands
    /// accelerations does not change `tau`.
    fn efforts(
        &mut self,
        _input: &EffortInput<'_>,
        _work: EffortWork<'_>,
        _tau: &mut [f64],
    ) -> Result<(), ControlError> {
        Ok(())
    }

    /// Returns the acceleration, rad/s² (m/s²), that the law commands for the joint at index `place` of the
    /// group, from its tracking error, its rate, rad/s (m/s), and the desired motion of the group. Used for
    /// [`JointCommand::Acceleration`].
    fn joint_acceleration(&self, _place: usize, _error: f64, _rate: f64, _desired: &JointSample) -> f64 {
        0.0
    }

    /// Returns the effort, N m (N), that is added to the torque of the joint at index `place` of the group;
    /// `None` if nothing is added. Used for [`JointCommand::Acceleration`].
    fn feedforward(&self, _place: usize) -> Option<f64> {
        None
    }

    /// Returns the acceleration, m/s² and rad/s², that the law commands for the tracked frame, from its pose
    /// error, its velocity error and the desired acceleration. Used for [`JointCommand::Task`].
    fn task_acceleration(
        &self,
        _error: Motion<f64>,
        _velocity_error: Motion<f64>,
        desired: Motion<f64>,
    ) -> Motion<f64> {
        desired
    }

    /// Returns the damping that is used when the joint accelerations are computed from the tasks. Used for
    /// [`JointCommand::Task`].
    fn task_damping(&self) -> TaskDamping {
        TaskDamping::default()
    }

    /// Returns the desired acceleration, rad/s² (m/s²), on which the friction compensation of the joint at
    /// index `place` of the group is based. Zero means that the joint may stay at rest.
    fn desired_acceleration(&self, _place: usize, acceleration: f64) -> f64 {
        acceleration
    }

    /// Prepares the law for a new run.
    fn reset(&mut self) -> Result<(), ControlError> {
        Ok(())
    }

    /// Returns the state of a user-defined controller for a checkpoint; empty for other laws.
    fn save(&self) -> Result<Vec<u8>, ControlError> {
        Ok(Vec::new())
    }

    /// Restores the state that [`ControlLaw::save`] returned.
    fn load(&mut self, _saved: &[u8]) -> Result<(), ControlError> {
        Ok(())
    }
}

/// Kind of command that a joint receives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum JointCommand {
    /// The effort is given by a law or by the caller of a stepper.
    Effort,
    /// Friction holds the joint at rest.
    Held,
    /// A law gives the acceleration.
    Acceleration,
    /// The acceleration follows from the tasks.
    Task,
}

/// Quantity that a joint reference commands; the names are those of the interfaces of ROS Control. `e` and
/// `ė` are the error and its rate in a PID law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interface {
    /// Joint positions: `e = qd − q`, `ė = q̇d − q̇`.
    #[default]
    Position,
    /// Joint rates: `e = q̇d − q̇`; `ė` is the backward difference of `e` since the last control tick.
    Velocity,
    /// Efforts, N m (N): the values of the reference are efforts instead of positions.
    Effort,
}

/// Damping that is used when joint accelerations are computed from task accelerations.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TaskDamping {
    /// Threshold `λ₀` of `tr[(J Jᵀ)⁻¹]^(-1/2)` below which the pseudo-inverse of the Jacobian `J` is damped.
    pub(super) pseudo_inverse: f64,
    /// Damping `k` of joint motion that does not affect the task, 1/s.
    pub(super) null_space: f64,
    /// Damping `κ` of the part of the joint rates that the damped pseudo-inverse suppresses, 1/s.
    pub(super) suppressed: f64,
}

/// Input of the laws that command efforts.
pub(super) struct EffortInput<'a> {
    /// Name of the control.
    pub(super) control: &'a str,
    /// Time, model and state of the robot, joints of the group, and desired pose and motion of the tracked
    /// frame.
    pub(super) observation: Observation<'a>,
    /// Time since the last control tick, s; zero at the first tick.
    pub(super) elapsed: f64,
    /// Desired motion of the joints of the group.
    pub(super) desired: &'a JointSample,
    /// Tracking error of the control, of length [`Control::width`](super::Control::width), and velocity error
    /// of its tracked frame, m/s and rad/s; the latter is zero unless the law needs the Jacobian.
    pub(super) error: (&'a [f64], Motion<f64>),
    /// Columns, `(6, k)`, that belong to the joints of the group in the generalized Jacobian of the tracked
    /// frame or, for a reference relative to the base, in its Jacobian relative to the base. Up to date only
    /// if the law needs the Jacobian.
    pub(super) jacobian: &'a [f64],
    /// Rates of the `k` joints of the group, `(k,)`, rad/s (m/s).
    pub(super) rates: &'a [f64],
    /// Fingers that the group moves, and the contact forces on each of them; empty unless the law is a
    /// [`GripForce`](super::GripForce).
    pub(super) fingers: (&'a [Finger], &'a [FingerForce]),
}

/// State and workspace of the laws that command efforts.
pub(super) struct EffortWork<'a> {
    pub(super) pid: &'a mut PidMemory,
    /// State of a grip-force law; `None` for other laws.
    pub(super) grip: Option<&'a mut GripMemory>,
    pub(super) inverse: &'a mut PseudoInverse<f64>,
    /// Workspace with one number per joint, `(n,)`.
    pub(super) scratch: &'a mut [f64],
}

/// State of PID controllers between control ticks, with one entry per joint of the group.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct PidMemory {
    /// Effort of the integral term, N m (N).
    pub(super) integral: Vec<f64>,
    /// Position error, rad (m), or rate error, rad/s (m/s), at the last tick; `None` before the first tick.
    pub(super) previous: Vec<Option<f64>>,
}
