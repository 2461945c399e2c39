//! Advance of a run to any time, and evaluation of the run at that time. A step that ends later is computed
//! as a trial and then undone, so that the steps do not depend on the times at which the run is evaluated.

use super::checkpoint::Progress;
use super::equations::EquationsOfMotion;
use super::error::SimulationError;
use super::members::Place;
use super::recording::GroupRecording;
use super::run_state::RunState;
use super::schedule::{Cursor, Interval};
use super::steps::Monitor;
use super::trace::Trace;
use super::tree::Tree;
use crate::spatial::Scalar;
use std::ops::ControlFlow;

/// Number of steps of a fixed-step integrator between two calls of the monitor.
const MONITOR_EVERY: usize = 64;

impl<S: Scalar> RunState<'_, S> {
    /// Computes all steps that end at or before `t`, s. Stops at the end of a step if `monitor` returns
    /// `Break`.
    pub(super) fn advance_to(
        &mut self,
        t: f64,
        monitor: Monitor<'_>,
    ) -> Result<ControlFlow<()>, SimulationError> {
        let advanced = self.take_steps_to(t, monitor);
        let is_within_step = matches!(advanced, Ok(ControlFlow::Continue(())))
            && self.schedule.is_later(t, self.schedule.now());
        self.time = if is_within_step { t.max(self.time) } else { self.schedule.now() };
        advanced
    }

    fn take_steps_to(&mut self, t: f64, monitor: Monitor<'_>) -> Result<ControlFlow<()>, SimulationError> {
        while self.schedule.is_later(t, self.schedule.now()) {
            let Some((interval, after)) = self.schedule.following() else { break };
            self.rereference_if_far(interval.start)?;
            if self.schedule.is_later(interval.end, t) && !self.step_ends_by(t, &interval, after)? {
                break;
            }
            self.schedule.set_cursor(after);
            self.step(&interval)?;
            let is_due = self.mover.has_long_steps() || self.steps.is_multiple_of(MONITOR_EVERY);
            if is_due && monitor(self.schedule.now()).is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        Ok(ControlFlow::Continue(()))
    }

    /// Returns true if the step in `interval` ends at or before `t`, s, although `interval` ends later. This
    /// happens if the mode of a joint, latch or contact changes, while bodies touch or approach each other,
    /// and if the tolerance requires a shorter step. The function computes the step as a trial, without rows,
    /// and undoes it.
    fn step_ends_by(&mut self, t: f64, interval: &Interval, after: Cursor) -> Result<bool, SimulationError> {
        if !self.mover.may_end_early(&self.equations) {
            return Ok(false);
        }
        self.peek(f64::NEG_INFINITY, |run| {
            run.schedule.set_cursor(after);
            run.step(interval)?;
            Ok(!run.schedule.is_later(run.schedule.now(), t))
        })
    }

    /// Calls `work` and then restores the current state. While `work` runs, only rows before the time
    /// `records_before`, s, are recorded. The state of the controllers, which may be user-defined, is not
    /// restored: if `work` has updated them at the current cut, they are not updated there again.
    fn peek<R>(
        &mut self,
        records_before: f64,
        work: impl FnOnce(&mut Self) -> Result<R, SimulationError>,
    ) -> Result<R, SimulationError> {
        let (before, events): (Progress, usize) = (self.progress(), self.events.records.len());
        self.keeps_commands = !self.controllers_updated;
        self.records_before = records_before;
        let result = work(self);
        self.records_before = f64::INFINITY;
        self.has_event = false;
        self.events.records.truncate(events);
        self.restore(before)?;
        self.controllers_updated = !std::mem::take(&mut self.keeps_commands);
        result
    }

    /// Stores the torques and requested accelerations of every system before the first update of the
    /// controllers in a trial step. Outside trial steps, does nothing.
    pub(super) fn keep_commands(&mut self) {
        if std::mem::take(&mut self.keeps_commands) {
            let held = self.commands();
            self.systems.iter_mut().zip(held).for_each(|(run, held)| run.held = Some(held));
        }
    }

    /// Returns the torques, N m or N, and the requested accelerations, rad/s² or m/s², of the joints of every
    /// system.
    fn commands(&self) -> Vec<(Vec<S>, Vec<Option<f64>>)> {
        let EquationsOfMotion { trees, members, .. } = &self.equations;
        let system = |number| members.system(number, trees, &self.state.trees).1;
        let of = |tree: &Tree<'_, S>| (tree.command.clone(), tree.modes.requested().to_vec());
        (0..self.systems.len()).map(|number| of(system(number))).collect()
    }

    /// Sets the torques, N m or N, and the requested accelerations, rad/s² or m/s², of the joints of every
    /// system.
    fn set_commands(&mut self, commands: Vec<(Vec<S>, Vec<Option<f64>>)>) {
        let EquationsOfMotion { trees, members, .. } = &mut self.equations;
        for (place, (command, requested)) in members.places.iter().zip(commands) {
            let tree = match *place {
                Place::Tree(tree) => &mut trees[tree],
                Place::Part(part) => &mut members.parts[part].own,
            };
            tree.command.copy_from_slice(&command);
            tree.modes.requested_mut().copy_from_slice(&requested);
            if let Place::Part(part) = *place {
                let part = &members.parts[part];
                part.drive(&mut trees[part.tree]);
            }
        }
    }

    /// Calls `record` with the torques that were held before the controllers were updated at the current cut.
    /// A row before a jump at this cut contains these torques, even if a trial step has already updated the
    /// controllers.
    pub(super) fn with_held_commands(
        &mut self,
        record: impl FnOnce(&mut Self) -> Result<(), SimulationError>,
    ) -> Result<(), SimulationError> {
        if !self.controllers_updated {
            return record(self);
        }
        let updated = self.commands();
        let held = self.systems.iter().zip(&updated);
        let held = held.map(|(run, updated)| run.held.as_ref().unwrap_or(updated).clone()).collect();
        self.set_commands(held);
        let result = record(self);
        self.set_commands(updated);
        result
    }

    /// Ends the current step at the current time, so that the next step begins there.
    pub(super) fn cut_at_current_time(&mut self) -> Result<(), SimulationError> {
        while self.schedule.is_later(self.time, self.schedule.now()) {
            let Some((interval, after)) = self.schedule.following() else { break };
            self.schedule.set_cursor(after);
            self.step_to(self.time, &interval)?;
        }
        Ok(())
    }

    /// Writes the configuration, `(nq,)`, and the velocity, `(nv,)`, of a system at the current time,
    /// relative to W, to `q` and `v`.
    pub(super) fn read_state(
        &mut self,
        system: usize,
        q: &mut [f64],
        v: &mut [f64],
    ) -> Result<(), SimulationError> {
        if self.schedule.is_later(self.time, self.schedule.now()) {
            self.peek(f64::NEG_INFINITY, |run| {
                run.step_to_current_time().map(|is_dense| run.copy_state(is_dense))
            })?;
        } else {
            self.copy_state(false);
        }
        let Self { equations, mover, row_buffers: (state, _), time, .. } = self;
        mover.kinematics(equations, state);
        mover.resolve_impacts(equations, state, None)?;
        let EquationsOfMotion { trees, members, loads, .. } = equations;
        members.follow(trees, &state.trees);
        let (state, tree) = members.system(system, trees, &state.trees);
        for (to, from) in [(&mut *q, &state.q), (&mut *v, &state.v)] {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = from.value());
        }
        if let Some(shift) = loads.shift(*time, &tree.model)? {
            shift.transform_state(q, v);
        }
        Ok(())
    }

    /// Writes a state to the row buffer: the dense output of the last step at the current time if `is_dense`,
    /// otherwise the state at the current cut.
    fn copy_state(&mut self, is_dense: bool) {
        let Self { state, mover, row_buffers: (copy, _), time, .. } = self;
        match mover.integration().filter(|_| is_dense) {
            Some(integration) => integration.interpolate(*time, copy),
            None => copy.copy_from(state),
        }
    }

    /// Steps from the current cut to the current time. An adaptive integrator computes its whole step, which
    /// may extend beyond the current time; the function then returns true.
    fn step_to_current_time(&mut self) -> Result<bool, SimulationError> {
        match self.schedule.following() {
            Some((interval, after)) if self.mover.is_adaptive() => {
                self.schedule.set_cursor(after);
                self.step(&interval).map(|()| true)
            }
            _ => self.cut_at_current_time().map(|()| false),
        }
    }

    /// Adds the rows before the current time, and a row at the current time.
    pub(super) fn record_current_time(&mut self) -> Result<(), SimulationError> {
        if !self.schedule.is_later(self.time, self.schedule.now()) {
            return self.record_end();
        }
        self.records_before = self.time; // an adaptive step may end after the current time
        let crossed = self.step_to_current_time();
        self.records_before = f64::INFINITY;
        if crossed? { self.record_within(self.time) } else { self.record_end() }
    }

    /// Returns the row of each system at the current time, as if the run ended there.
    pub(super) fn present_rows(&mut self) -> Result<Vec<Trace>, SimulationError> {
        self.peek(f64::INFINITY, |run| {
            run.record_current_time()?;
            Ok(run.systems.iter().map(|system| system.recorder.last_row()).collect())
        })
    }

    /// Returns the rows recorded so far, plus a row at the current time, as if the run ended there.
    pub(super) fn recording(&mut self) -> Result<GroupRecording, SimulationError> {
        self.peek(f64::INFINITY, |run| {
            run.record_current_time()?;
            run.conclude();
            Ok(GroupRecording {
                systems: run.systems.iter().map(|system| system.recorder.trace.clone()).collect(),
                events: run.events.records.clone(),
                balance: run.balance.clone(),
            })
        })
    }
}
