//! Joint-space control that follows external commands.

use super::control_law::{ControlLaw, EffortInput, EffortWork, Interface, JointCommand};
use super::error::ControlError;
use super::external_command::{ExternalCommand, Setpoint};
use super::joint_computed_torque::JointComputedTorque;
use crate::model::Model;
use crate::reference::JointSample;
use serde::{Deserialize, Serialize};

/// Law of joints that follow external commands, which are sent with
/// [`Stepper::send`](crate::simulation::Stepper::send).
///
/// A command is held until the next command. If a command has positions or rates, the torque is that of
/// [`JointComputedTorque`], `τ = M* (a + kd (vd − q̇) + kp (qd − q)) + c* − Q* + f`, with the commanded
/// positions `qd`, rates `vd` and accelerations `a`, plus the commanded effort. Without positions there is no
/// position term; without accelerations `a = 0`. For constant positions without rates `vd = 0`; a trajectory
/// without rates is interpolated linearly. If a command has only efforts, they are the torques.
///
/// Before the first command, the law holds the initial positions of its group if `kp` is positive for all
/// joints. Otherwise it damps the rates if `kd` is positive for all joints; if neither is the case, it exerts
/// no torque.
#[derive(Clone, Debug)]
pub struct External {
    /// Computed-torque law that is used for commands with positions or rates.
    pub law: JointComputedTorque,
    /// Time after the last command, or after the end of the last trajectory, at which `on_timeout` applies,
    /// s; `None` for no timeout. Until a trajectory with a later start begins, the timeout of the running
    /// command applies.
    pub timeout: Option<f64>,
    /// Behaviour after the timeout.
    pub on_timeout: OnTimeout,
    pub(super) memory: ExternalMemory,
}

/// Behaviour of an [`External`] law when no further command is received.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OnTimeout {
    /// Hold the commanded positions or, after a command without positions, the positions at the timeout.
    #[default]
    Hold,
    /// Damp the joint rates with the gain `kd` until the joints are at rest.
    Damp,
    /// Exert no torque.
    Zero,
}

/// State of an [`External`] law, which a checkpoint stores.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct ExternalMemory {
    /// Command that has not yet taken effect, preceded by the time, s, at which it was sent; `None` without
    /// such a command.
    pending: Option<(f64, ExternalCommand)>,
    current: ExternalCommand,
    /// Time at which the current command times out, s; `None` without a timeout. The deadline of a pending
    /// command is set when the command takes effect.
    deadline: Option<f64>,
}

impl Default for ExternalMemory {
    fn default() -> Self {
        Self { pending: None, current: ExternalCommand::Setpoint(Setpoint::default()), deadline: None }
    }
}

impl External {
    /// Creates a law with the gains of `law` and without a timeout.
    pub fn new(law: JointComputedTorque) -> Self {
        Self { law, timeout: None, on_timeout: OnTimeout::Hold, memory: ExternalMemory::default() }
    }

    /// Returns the quantity that the law can track with its gains: positions if `kp` is positive for all
    /// joints, otherwise rates if `kd` is, and otherwise efforts.
    pub fn interface(&self) -> Interface {
        match (self.law.kp.is_positive(), self.law.kd.is_positive()) {
            (true, _) => Interface::Position,
            (false, true) => Interface::Velocity,
            (false, false) => Interface::Effort,
        }
    }

    /// Checks the gains and the timeout for a group of `count` joints.
    ///
    /// # Errors
    /// [`ControlError`] if a gain is invalid, if the timeout is not positive and finite, or if the behaviour
    /// after the timeout requires a gain that is not positive for all joints (`kp` and `kd` to hold, `kd` to
    /// damp).
    pub fn check(&self, count: usize) -> Result<(), ControlError> {
        self.law.check(count)?;
        let Some(timeout) = self.timeout else { return Ok(()) };
        if !(timeout.is_finite() && timeout > 0.0) {
            return Err(ControlError::Timeout { value: timeout });
        }
        let lacks =
            |gain: &'static str, used_by: &'static str| Err(ControlError::TimeoutGain { gain, used_by });
        match self.on_timeout {
            OnTimeout::Hold if !self.law.kp.is_positive() => lacks("kp", "hold"),
            OnTimeout::Hold if !self.law.kd.is_positive() => lacks("kd", "hold"),
            OnTimeout::Damp if !self.law.kd.is_positive() => lacks("kd", "damp"),
            _ => Ok(()),
        }
    }

    /// Checks a command for the `count` joints of control `control` that is sent at `now`, s.
    pub(super) fn check_command(
        &self,
        command: &ExternalCommand,
        control: &str,
        count: usize,
        now: f64,
    ) -> Result<(), ControlError> {
        command.check(control, count, now)?;
        let (has_position, has_velocity) = match command {
            ExternalCommand::Setpoint(setpoint) => (setpoint.position.is_some(), setpoint.velocity.is_some()),
            ExternalCommand::Trajectory(_) => (true, false),
        };
        let lacks = |gain, of| Err(ControlError::CommandGain { control: control.to_owned(), gain, of });
        if has_position && !self.law.kp.is_positive() {
            return lacks("kp", "positions");
        }
        if has_velocity && !self.law.kd.is_positive() {
            return lacks("kd", "velocities");
        }
        Ok(())
    }

    /// Stores a checked command that is sent at `now`, s. The new command replaces one that has not yet taken
    /// effect.
    pub(super) fn send(&mut self, command: ExternalCommand, now: f64) {
        self.memory.pending = Some((now, command));
    }

    /// Returns true if a command takes effect at `now`, s, or earlier.
    pub(super) fn has_due_command(&self, now: f64) -> bool {
        self.memory.pending.as_ref().is_some_and(|(sent, command)| command.begin(*sent) <= now)
    }

    /// Sets the behaviour before the first command; `q` contains the initial positions of the group, rad (m).
    pub(super) fn start(&mut self, q: impl Iterator<Item = f64>) {
        let zeros = |q: Vec<f64>| vec![0.0; q.len()];
        let setpoint = match External::interface(self) {
            Interface::Position => Setpoint::position(q.collect()),
            Interface::Velocity => Setpoint::velocity(zeros(q.collect())),
            Interface::Effort => Setpoint::default(),
        };
        self.memory.current = ExternalCommand::Setpoint(setpoint);
    }

    /// Returns true if a command, or the timeout, takes effect at `now`, s, or earlier.
    pub(super) fn is_due(&self, now: f64) -> bool {
        self.has_due_command(now) || self.memory.deadline.is_some_and(|deadline| deadline <= now)
    }

    /// Applies the command that is due at the control tick at `t`, s, or otherwise the timeout. Times up to
    /// `now`, s, are treated as equal to `t`; `state` holds the positions and rates of the group.
    pub(super) fn follow(&mut self, t: f64, now: f64, state: &mut JointSample) {
        let memory = &mut self.memory;
        if let Some((sent, command)) = memory.pending.take_if(|(sent, command)| command.begin(*sent) <= now) {
            memory.deadline = self.timeout.map(|timeout| command.end(sent) + timeout);
            let before = std::mem::replace(&mut memory.current, command);
            if let ExternalCommand::Trajectory(trajectory) = &mut memory.current {
                before.sample(t, state);
                trajectory.start_from(t, state);
            }
            return;
        }
        memory.deadline = None;
        memory.current = ExternalCommand::Setpoint(match self.on_timeout {
            OnTimeout::Hold => {
                Setpoint::position(memory.current.last_position().unwrap_or(&state.q).to_vec())
            }
            OnTimeout::Damp => Setpoint::velocity(vec![0.0; state.q.len()]),
            OnTimeout::Zero => Setpoint::default(),
        });
    }

    /// Computes the desired motion at `t`, s, as [`ExternalCommand::sample`] does. On entry `out` holds the
    /// positions and rates of the group.
    pub(super) fn sample(&self, t: f64, out: &mut JointSample) {
        self.memory.current.sample(t, out);
    }

    /// Returns the state of the law for a checkpoint.
    pub(super) fn memory(&self) -> &ExternalMemory {
        &self.memory
    }

    /// Restores the state of a law for `count` joints. Returns false if the state is invalid for these
    /// joints.
    pub(super) fn restore(&mut self, memory: &ExternalMemory, control: &str, count: usize) -> bool {
        let fits = |command: &ExternalCommand| {
            let is_none = *command == ExternalCommand::Setpoint(Setpoint::default());
            is_none || command.check_sizes(control, count)
        };
        let ExternalMemory { pending, current, .. } = memory;
        let is_own = fits(current) && pending.as_ref().is_none_or(|(_, command)| fits(command));
        if is_own {
            self.memory.clone_from(memory);
        }
        is_own
    }

    fn effort(&self, place: usize) -> Option<f64> {
        match &self.memory.current {
            ExternalCommand::Setpoint(Setpoint { effort: Some(effort), .. }) => Some(effort[place]),
            _ => None,
        }
    }
}

impl ControlLaw for External {
    fn check_group(&self, _: &str, joints: &[usize], _: &Model) -> Result<(), ControlError> {
        self.check(joints.len())
    }

    fn joint_command(&self) -> JointCommand {
        if self.memory.current.is_effort() { JointCommand::Effort } else { JointCommand::Acceleration }
    }

    fn uses_error(&self) -> bool {
        true
    }

    fn compensates_environment(&self) -> Option<bool> {
        self.law.compensates_environment()
    }

    fn compensates_friction(&self) -> bool {
        self.law.compensates_friction()
    }

    fn efforts(
        &mut self,
        _: &EffortInput<'_>,
        _: EffortWork<'_>,
        tau: &mut [f64],
    ) -> Result<(), ControlError> {
        tau.iter_mut().enumerate().for_each(|(place, tau)| *tau = self.effort(place).unwrap_or(0.0));
        Ok(())
    }

    fn joint_acceleration(&self, place: usize, error: f64, rate: f64, desired: &JointSample) -> f64 {
        self.law.joint_acceleration(place, error, rate, desired)
    }

    fn feedforward(&self, place: usize) -> Option<f64> {
        self.effort(place)
    }

    fn desired_acceleration(&self, place: usize, acceleration: f64) -> f64 {
        self.law.desired_acceleration(place, acceleration)
    }

    fn reset(&mut self) -> Result<(), ControlError> {
        self.memory = ExternalMemory::default();
        Ok(())
    }
}
