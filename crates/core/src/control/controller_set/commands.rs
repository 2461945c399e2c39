//! External commands to the controls of a run.

use super::ControllerSet;
use crate::control::control::Control;
use crate::control::control_state::Phase;
use crate::control::error::ControlError;
use crate::control::external_command::ExternalCommand;
use crate::model::{BASE_NQ, BASE_NV};
use crate::spatial::Scalar;

impl<S: Scalar> ControllerSet<'_, S> {
    /// Returns the controls that follow external commands.
    pub fn external(&self) -> impl Iterator<Item = &Control> {
        self.controls.iter().filter(|control| control.law.external().is_some())
    }

    /// Sends a command to the control `name` at `now`, s. The command takes effect at the next update; a
    /// trajectory with a later start takes effect at its start.
    ///
    /// # Errors
    /// The errors of [`ControllerSet::check_send`]; after an error, nothing has changed.
    pub fn send(&mut self, name: &str, command: ExternalCommand, now: f64) -> Result<(), ControlError> {
        let number = self.check_send(name, &command, now)?;
        if let Some(law) = self.controls[number].law.external_mut() {
            law.send(command, now);
        }
        Ok(())
    }

    /// Returns the index of the control `name` if it accepts a command at `now`, s.
    ///
    /// # Errors
    /// [`ControlError`] for a command that is invalid or that requires gains which the law does not have, and
    /// for a control that does not exist, does not follow commands or has ended.
    pub fn check_send(&self, name: &str, command: &ExternalCommand, now: f64) -> Result<usize, ControlError> {
        let names =
            |list: &mut dyn Iterator<Item = &Control>| list.map(|control| control.name.clone()).collect();
        let Some(number) = self.controls.iter().position(|control| control.name == name) else {
            let known = names(&mut self.external());
            return Err(ControlError::UnknownControl { name: name.to_owned(), known });
        };
        let control = name.to_owned();
        if self.states[number].memory.phase == Phase::Over || self.controls[number].end <= now {
            return Err(ControlError::ControlEnded { control });
        }
        let count = self.controls[number].joints.len();
        let Some(law) = self.controls[number].law.external() else {
            let known = names(&mut self.external());
            return Err(ControlError::NotExternal { control, known });
        };
        law.check_command(command, name, count, now)?;
        Ok(number)
    }

    /// Returns true if a command that was sent is due at `t`, s.
    pub fn has_due_command(&self, t: f64) -> bool {
        let now = t + self.same_instant;
        let is_due = |control: &Control| control.law.external().is_some_and(|law| law.has_due_command(now));
        self.controls.iter().any(is_due)
    }

    /// Sets whether the next update repeats the previous one at the same time and state. Laws that command
    /// efforts, except those that follow external commands, are then not evaluated again and keep their
    /// torques, because a second evaluation would update the state of a law, such as an integral, twice.
    pub fn set_repeated(&mut self, is_repeated: bool) {
        self.is_repeated = is_repeated;
    }

    /// Applies the commands and timeouts of the active controls that are due at `t`, s. Returns true if any
    /// were due.
    pub(super) fn follow_commands(&mut self, t: f64) -> bool {
        let Self { controls, states, same_instant, q, v, .. } = self;
        let mut has_changed = false;
        for (control, state) in controls.iter_mut().zip(states) {
            let now = t + *same_instant;
            if state.is_running() && control.law.external().is_some_and(|law| law.is_due(now)) {
                state.take_joints(control, &q[BASE_NQ..], &v[BASE_NV..]);
                if let Some(law) = control.law.external_mut() {
                    law.follow(t, now, &mut state.desired);
                }
                has_changed = true; // the desired motion is evaluated again
            }
        }
        has_changed
    }
}
