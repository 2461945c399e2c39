//! State of a run between two steps. A run restored to this state continues with bit-identical results.

use super::accuracy::Accuracy;
use super::checkpoint::{Checkpoint, Progress, SavedControllers, SystemProgress};
use super::checkpoint_error::CheckpointError;
use super::environment_loads::EnvironmentLoads;
use super::equations::EquationsOfMotion;
use super::error::SimulationError;
use super::integrator::Stages;
use super::layout::Layout;
use super::mover::Mover;
use super::only::only_mut;
use super::run_system::RunSystem;
use super::schedule::Schedule;
use super::state::State;
use super::trace::Trace;
use super::tree::Tree;
use crate::earth::Earth;
use crate::spatial::Scalar;
use std::sync::Arc;

/// State of a run in progress. Steps are in `step.rs`, the recording of rows in `record.rs`, and the evaluation at
/// times within a step in `look_ahead.rs`.
pub(super) struct RunState<'a, S> {
    /// Names of the systems and of their joints; all lists with one entry per system have this order.
    pub(super) layout: Layout,
    /// State at the current cut, the instant at which the current step begins.
    pub(super) state: State<S>,
    pub(super) equations: EquationsOfMotion<'a, S, EnvironmentLoads>,
    /// Controllers and recorder of each system.
    pub(super) systems: Vec<RunSystem<'a, S>>,
    pub(super) mover: Mover<'a, S>,
    pub(super) schedule: Schedule,
    pub(super) record_every: usize,
    /// True if every step is recorded as a row of the trace.
    pub(super) has_every_step: bool,
    pub(super) accuracy: Accuracy<S>,
    /// Steps taken so far.
    pub(super) steps: usize,
    /// Current time, s: the current cut, or a time within the step that begins at the cut.
    pub(super) time: f64,
    /// True if the controllers have been updated at the current cut.
    pub(super) controllers_updated: bool,
    /// Only rows before this time are recorded, s; infinity except while [`RunState::peek`] takes trial steps.
    pub(super) records_before: f64,
    /// Buffers for the state and the stages of rows that are not at the start of a step.
    pub(super) row_buffers: (State<S>, Stages<S>),
    /// Distance of the base from the origin of W beyond which a system changes to a local reference orbit, m.
    pub(super) rereference_beyond: f64,
    pub(super) earth: Option<Arc<Earth>>,
}

impl<S: Scalar> RunState<'_, S> {
    /// Returns the state of everything that a step changes, except the controllers.
    pub(super) fn progress(&self) -> Progress {
        let (step_control, idle_steps) = self.mover.save();
        let systems = self.systems.iter().zip(&self.equations.trees).enumerate();
        let progress = |(number, (run, system)): (usize, (&RunSystem<'_, S>, &Tree<'_, S>))| {
            let (errors, checks) = self.accuracy.save(number);
            let trace = &run.recorder.trace;
            let (rows, work_done) = (trace.rows(), trace.work_done);
            SystemProgress { rows, modes: system.modes.save(), errors, checks, work_done }
        };
        Progress {
            steps: self.steps,
            cursor: self.schedule.cursor(),
            state: self.state.map(|x| x.value()),
            step_control,
            idle_steps,
            systems: systems.map(progress).collect(),
        }
    }

    /// Restores the state that [`RunState::progress`] returned and removes the rows recorded since then.
    pub(super) fn restore(&mut self, progress: Progress) {
        self.state = progress.state.map(|x| S::of(*x));
        self.schedule.set_cursor(progress.cursor);
        self.steps = progress.steps;
        self.mover.restore((progress.step_control, progress.idle_steps));
        let systems = self.systems.iter_mut().zip(&mut self.equations.trees);
        for (number, (saved, (run, system))) in progress.systems.into_iter().zip(systems).enumerate() {
            system.modes.restore(&saved.modes);
            self.accuracy.restore(number, (saved.errors, saved.checks));
            run.recorder.truncate(saved.rows);
            run.recorder.trace.work_done = saved.work_done;
        }
    }

    /// Returns a checkpoint of the current state. The rows recorded so far are not part of it.
    pub(super) fn checkpoint(&self) -> Result<Checkpoint, SimulationError> {
        let systems = self.systems.iter().zip(&self.equations.trees);
        let systems = systems.map(|(run, system)| run.save_controllers(system)).collect::<Result<_, _>>()?;
        let controllers = SavedControllers { controllers_updated: self.controllers_updated, systems };
        let local_reference = self.equations.loads.local_reference().cloned();
        Ok(Checkpoint::new(self.time, self.schedule.clone(), self.progress(), local_reference, controllers))
    }

    /// Restores the state of a checkpoint; `trace` holds the rows recorded before it.
    pub(super) fn resume(&mut self, from: Checkpoint, trace: Trace) -> Result<(), SimulationError> {
        from.check(&self.layout, &self.schedule, trace.rows())?;
        let (time, progress, local_reference, saved) = from.into_parts();
        self.check_estimates(&progress)?;
        only_mut(&mut self.systems).recorder.resume(trace)?;
        self.restore(progress);
        self.time = time;
        if let Some(local) = local_reference {
            self.equations.loads.set_local_reference(local)?;
        }
        self.controllers_updated = saved.controllers_updated;
        let systems = self.systems.iter_mut().zip(&mut self.equations.trees);
        for (saved, (run, system)) in saved.systems.into_iter().zip(systems) {
            run.load_controllers(saved, system)?;
        }
        Ok(())
    }

    /// Checks that the checkpoint contains error estimates if, and only if, this run computes them.
    fn check_estimates(&self, progress: &Progress) -> Result<(), CheckpointError> {
        for (number, saved) in progress.systems.iter().enumerate() {
            let (errors, checks) = self.accuracy.save(number);
            if errors.is_some() != saved.errors.is_some() || checks.is_some() != saved.checks.is_some() {
                let (name, expected) = ("sets of error estimates", usize::from(errors.is_some()));
                return Err(CheckpointError::OtherSize { name, got: 1 - expected, expected });
            }
        }
        Ok(())
    }

    /// Adds to the traces the results that do not follow from the rows: error estimates, changes of the reference
    /// orbit and outcomes of goals.
    pub(super) fn conclude(&mut self) {
        let control = self.mover.save().0;
        let local = self.equations.loads.local_reference();
        let systems = self.systems.iter_mut().zip(&self.equations.trees);
        for (number, (run, system)) in systems.enumerate() {
            let rotation_error = control.as_ref().map(|control| control.trees[number].rotation_error);
            let results = run.goal_results(system.model);
            let trace = &mut run.recorder.trace;
            self.accuracy.conclude(number, self.steps, rotation_error, trace);
            trace.rereferenced = local.map_or_else(Vec::new, |local| local.times.clone());
            trace.results = results;
        }
    }
}
