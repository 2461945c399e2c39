//! Interface of the run of a group of systems, independent of the scalar type of the run.

use super::attached::AttachedControl;
use super::checkpoint::GroupCheckpoint;
use super::equations::EquationsOfMotion;
use super::error::SimulationError;
use super::external_control::ExternalControl;
use super::recording::{EventRecord, GroupRecording};
use super::run_state::RunState;
use super::singularity_watch::SingularLoop;
use super::trace::Trace;
use super::wrench_commands::WrenchCommand;
use crate::control::ExternalCommand;
use crate::spatial::Scalar;
use std::ops::ControlFlow;

/// Callback that is called repeatedly during an advance with the time reached, s. If it returns `Break`, the
/// advance stops at that time.
pub type Monitor<'a> = &'a mut dyn FnMut(f64) -> ControlFlow<()>;

/// Run of a group of systems, independent of its scalar type. Systems are specified by their index in the
/// group.
pub(super) trait Steps: Send {
    fn time(&self) -> f64;
    fn duration(&self) -> Option<f64>;
    fn check_time(&self, t: f64) -> Result<(), SimulationError>;
    fn advance_to(&mut self, t: f64, monitor: Monitor<'_>) -> Result<ControlFlow<()>, SimulationError>;
    fn read_state(&mut self, system: usize, q: &mut [f64], v: &mut [f64]) -> Result<(), SimulationError>;
    fn check_command(&self, system: usize, tau: &[Option<f64>]) -> Result<(), SimulationError>;
    fn command(&mut self, system: usize, tau: &[Option<f64>]) -> Result<(), SimulationError>;
    fn send(&mut self, system: usize, control: &str, command: ExternalCommand)
    -> Result<(), SimulationError>;
    fn check_send(
        &self,
        system: usize,
        control: &str,
        command: &ExternalCommand,
    ) -> Result<(), SimulationError>;
    fn check_wrench(
        &self,
        system: usize,
        frame: usize,
        wrench: &WrenchCommand,
    ) -> Result<(), SimulationError>;
    fn wrench(&mut self, system: usize, frame: usize, wrench: WrenchCommand) -> Result<(), SimulationError>;
    /// Returns the controls of a system that follow external commands.
    fn external(&self, system: usize) -> Vec<ExternalControl>;
    /// Returns the names of the events of the group.
    fn events(&self) -> Vec<String>;
    /// Returns the records of the events that have happened.
    fn records(&self) -> &[EventRecord];
    /// Returns the controls whose frames are rigidly connected to the frames that they follow.
    fn attached_controls(&self) -> Vec<AttachedControl>;
    /// Returns the closed loops and mimic joints that have been in, or near, a singular configuration.
    fn singular_loops(&self) -> &[SingularLoop];
    /// Returns the index of the event with this name, or an error if the event cannot be triggered; `None` if
    /// the group has no such event.
    fn check_trigger(&self, name: &str) -> Result<Option<usize>, SimulationError>;
    fn trigger(&mut self, event: usize) -> Result<(), SimulationError>;
    fn checkpoint(&self) -> Result<GroupCheckpoint, SimulationError>;
    fn rows(&self, system: usize) -> &Trace;
    /// Removes all rows of each system except the first one and the last `keep`. If `is_checked`, at least 16
    /// last rows remain and the certificate still includes the removed rows.
    fn drop_rows(&mut self, keep: usize, is_checked: bool);
    fn recording(&mut self) -> Result<GroupRecording, SimulationError>;
    /// Returns the row of each system at the current time.
    fn present_rows(&mut self) -> Result<Vec<Trace>, SimulationError>;
    /// Adds a row at the current time.
    fn record_current_time(&mut self) -> Result<(), SimulationError>;
    /// Removes the rows and event records of the run so far and returns them, with the error estimates, the
    /// outcomes of goals and the balance of the group.
    fn take_rows(&mut self) -> GroupRecording;
}

impl<S: Scalar> Steps for RunState<'_, S> {
    fn time(&self) -> f64 {
        self.time
    }

    fn duration(&self) -> Option<f64> {
        self.schedule.duration()
    }

    fn check_time(&self, t: f64) -> Result<(), SimulationError> {
        if !t.is_finite() {
            return Err(SimulationError::TimeNotFinite { t });
        }
        if self.schedule.is_later(self.time, t) {
            return Err(SimulationError::PastTime { t, time: self.time });
        }
        if let Some(end) = self.duration().filter(|end| self.schedule.is_later(t, *end)) {
            return Err(SimulationError::AfterEnd { t, end });
        }
        if let Some(earth) = &self.earth {
            earth.covers(t)?;
        }
        Ok(())
    }

    fn advance_to(&mut self, t: f64, monitor: Monitor<'_>) -> Result<ControlFlow<()>, SimulationError> {
        RunState::advance_to(self, t, monitor)
    }

    fn read_state(&mut self, system: usize, q: &mut [f64], v: &mut [f64]) -> Result<(), SimulationError> {
        RunState::read_state(self, system, q, v)
    }

    fn check_command(&self, system: usize, tau: &[Option<f64>]) -> Result<(), SimulationError> {
        RunState::check_command(self, system, tau)
    }

    fn command(&mut self, system: usize, tau: &[Option<f64>]) -> Result<(), SimulationError> {
        RunState::command(self, system, tau)
    }

    fn send(
        &mut self,
        system: usize,
        control: &str,
        command: ExternalCommand,
    ) -> Result<(), SimulationError> {
        RunState::send(self, system, control, command)
    }

    fn check_send(
        &self,
        system: usize,
        control: &str,
        command: &ExternalCommand,
    ) -> Result<(), SimulationError> {
        RunState::check_send(self, system, control, command)
    }

    fn check_wrench(
        &self,
        system: usize,
        frame: usize,
        wrench: &WrenchCommand,
    ) -> Result<(), SimulationError> {
        RunState::check_wrench(self, system, frame, wrench)
    }

    fn wrench(&mut self, system: usize, frame: usize, wrench: WrenchCommand) -> Result<(), SimulationError> {
        RunState::wrench(self, system, frame, wrench)
    }

    fn external(&self, system: usize) -> Vec<ExternalControl> {
        RunState::external(self, system)
    }

    fn attached_controls(&self) -> Vec<AttachedControl> {
        RunState::attached_controls(self)
    }

    fn singular_loops(&self) -> &[SingularLoop] {
        &self.singular_loops
    }

    fn records(&self) -> &[EventRecord] {
        &self.events.records
    }

    fn events(&self) -> Vec<String> {
        self.events.list.iter().map(|event| event.name.clone()).collect()
    }

    fn check_trigger(&self, name: &str) -> Result<Option<usize>, SimulationError> {
        let Some(number) = self.events.find(name) else { return Ok(None) };
        self.events.check_trigger(number).map(|()| Some(number))
    }

    fn trigger(&mut self, event: usize) -> Result<(), SimulationError> {
        self.cut_at_current_time()?;
        self.events.states[event].due = Some(self.time);
        self.events_changed();
        Ok(())
    }

    fn checkpoint(&self) -> Result<GroupCheckpoint, SimulationError> {
        RunState::checkpoint(self)
    }

    fn rows(&self, system: usize) -> &Trace {
        &self.systems[system].recorder.trace
    }

    fn drop_rows(&mut self, keep: usize, is_checked: bool) {
        let Self { systems, equations, state, .. } = self;
        let EquationsOfMotion { trees, members, .. } = &*equations;
        for (number, run) in systems.iter_mut().enumerate() {
            if is_checked {
                let (_, own) = members.system(number, trees, &state.trees);
                run.recorder.drop_checked_rows(keep, &own.model);
            } else {
                run.recorder.drop_rows(keep);
            }
        }
    }

    fn recording(&mut self) -> Result<GroupRecording, SimulationError> {
        RunState::recording(self)
    }

    fn present_rows(&mut self) -> Result<Vec<Trace>, SimulationError> {
        RunState::present_rows(self)
    }

    fn record_current_time(&mut self) -> Result<(), SimulationError> {
        RunState::record_current_time(self)
    }

    fn take_rows(&mut self) -> GroupRecording {
        self.conclude();
        let systems = self.systems.iter_mut().map(|run| std::mem::take(&mut run.recorder.trace)).collect();
        let (events, balance) = (std::mem::take(&mut self.events.records), std::mem::take(&mut self.balance));
        GroupRecording { systems, events, balance }
    }
}
