//! Measures the accuracy of the steps during a run, for its certificate.

use super::environment_loads::EnvironmentLoads;
use super::equations::EquationsOfMotion;
use super::error::SimulationError;
use super::every_step::{EveryStep, SavedChecks};
use super::integrator::{FirstStage, Stages};
use super::mover::Mover;
use super::state::State;
use super::step_doubling::{Errors, StepDoubling};
use super::system::System;
use super::system_state::SystemState;
use super::trace::Trace;
use crate::model::Model;
use crate::spatial::Scalar;

type Equations<'a, S> = EquationsOfMotion<'a, S, EnvironmentLoads>;

/// Estimates of the error of fixed native steps. An adaptive integrator estimates its own, and nothing is known of
/// the steps of an external engine.
pub(super) struct Accuracy<S> {
    doubling: Option<StepDoubling<S>>,
    /// Checks of every step for each system; empty where every step is a row.
    every_step: Vec<EveryStep>,
    /// Whether the base rows of the present step are checked.
    is_recorded: bool,
}

impl<S: Scalar> Accuracy<S> {
    pub(super) fn new(doubling: Option<StepDoubling<S>>, every_step: Vec<EveryStep>) -> Self {
        Self { doubling, every_step, is_recorded: false }
    }

    /// Returns the sums so far of a system.
    pub(super) fn save(&self, number: usize) -> (Option<Errors>, Option<SavedChecks>) {
        let errors = self.doubling.as_ref().map(|doubling| doubling.errors[number].clone());
        (errors, self.every_step.get(number).map(EveryStep::save))
    }

    /// Continues from [`Accuracy::save`].
    pub(super) fn restore(&mut self, number: usize, (errors, checks): (Option<Errors>, Option<SavedChecks>)) {
        if let (Some(doubling), Some(errors)) = (&mut self.doubling, errors) {
            doubling.errors[number] = errors;
        }
        if let (Some(every_step), Some(checks)) = (self.every_step.get_mut(number), checks) {
            every_step.restore(checks);
        }
    }

    /// Ends the last step at a state on its momentum whose kinematics are in `equations`.
    pub(super) fn end_step(&mut self, t: f64, state: &State<S>, equations: &Equations<'_, S>) {
        for (every_step, (state, system)) in self.every_step.iter_mut().zip(pairs(state, &equations.systems))
        {
            every_step.end(t, state, system);
        }
    }

    /// Leaves out the last step of a system.
    pub(super) fn skip_step(&mut self, number: usize) {
        if let Some(every_step) = self.every_step.get_mut(number) {
            every_step.skip();
        }
    }

    /// Starts step number `step` over `interval`, before it is taken.
    pub(super) fn start_step(
        &mut self,
        step: usize,
        interval: (f64, f64),
        state: &State<S>,
        equations: &mut Equations<'_, S>,
        mover: &mut Mover<'_, S>,
    ) -> Result<(), SimulationError> {
        let is_due = self.doubling.as_ref().is_some_and(|doubling| doubling.is_due(step));
        self.is_recorded = is_due && !self.every_step.is_empty();
        let EquationsOfMotion { systems, loads } = equations;
        for (every_step, (state, system)) in self.every_step.iter_mut().zip(pairs(state, systems)) {
            if is_due {
                every_step.record_start(interval.0, state, system, loads)?;
            }
            every_step.start(interval.0, state, system);
        }
        if let (Some(doubling), Some(integration)) = (&mut self.doubling, mover.integration()) {
            // if the probe fails, so does the step, which reports it
            let _ = doubling.probe(step, interval, state, equations, integration);
        }
        Ok(())
    }

    /// Measures the step taken over `interval` to `state`; `is_smooth`: neither an event nor an impact is at its start.
    pub(super) fn measure_step(
        &mut self,
        interval: (f64, f64),
        is_smooth: bool,
        state: &State<S>,
        equations: &mut Equations<'_, S>,
        mover: &mut Mover<'_, S>,
        buffers: &mut (State<S>, Stages<S>),
    ) -> Result<(), SimulationError> {
        let Some(integration) = mover.integration() else { return Ok(()) };
        if let Some(doubling) = &mut self.doubling {
            let h = interval.1 - interval.0;
            let steps = integration.stages.ends().zip(&equations.systems);
            for (errors, (ends, system)) in doubling.errors.iter_mut().zip(steps) {
                errors.jumps.add_step(&ends, &system.command, h, is_smooth);
            }
        }
        for (every_step, ends) in self.every_step.iter_mut().zip(integration.stages.ends()) {
            every_step.add_stages(&ends);
        }
        if self.is_recorded {
            self.complete_rows(equations, &integration.stages, EveryStep::complete_start);
            if state.is_finite() {
                return self.record_end(interval, state, equations, buffers);
            }
        }
        Ok(())
    }

    /// Records the end of a step whose base rows are checked. `buffers` receive the state at the end on its momentum,
    /// and its acceleration.
    fn record_end(
        &mut self,
        interval: (f64, f64),
        state: &State<S>,
        equations: &mut Equations<'_, S>,
        (end, stages): &mut (State<S>, Stages<S>),
    ) -> Result<(), SimulationError> {
        end.copy_from(state);
        equations.project_momentum(end);
        equations.apply_loads(interval.1, interval, end)?;
        let EquationsOfMotion { systems, loads } = equations;
        for (every_step, (state, system)) in self.every_step.iter_mut().zip(pairs(end, systems)) {
            every_step.record_end(interval.1, state, system, loads)?;
        }
        stages.evaluate_first(equations, end);
        self.complete_rows(equations, stages, EveryStep::complete_end);
        Ok(())
    }

    /// Completes the last row of the checks of each system with the acceleration in the first stage.
    fn complete_rows(
        &mut self,
        equations: &Equations<'_, S>,
        stages: &Stages<S>,
        complete: fn(&mut EveryStep, &Model, &FirstStage<S>),
    ) {
        let firsts = stages.first.iter().zip(&equations.systems);
        for (every_step, (first, system)) in self.every_step.iter_mut().zip(firsts) {
            complete(every_step, system.model, first);
        }
    }

    /// Writes the estimates for a system after `steps` steps to its trace; `rotation_error` is that of an adaptive
    /// integrator, rad.
    pub(super) fn conclude(
        &self,
        number: usize,
        steps: usize,
        rotation_error: Option<f64>,
        trace: &mut Trace,
    ) {
        trace.pair_checks = self.every_step.get(number).map(EveryStep::checks);
        trace.attitude_step_doubling = rotation_error;
        if let Some(doubling) = &self.doubling {
            let errors = &doubling.errors[number];
            trace.attitude_step_doubling = Some(errors.turn(steps));
            trace.step_doubling = (0..errors.drifts.len()).map(|i| errors.drift(i, steps)).collect();
        }
    }
}

/// Returns the state of each system with the system.
fn pairs<'a, 's, S>(
    state: &'a State<S>,
    systems: &'a [System<'s, S>],
) -> impl Iterator<Item = (&'a SystemState<S>, &'a System<'s, S>)> {
    state.systems.iter().zip(systems)
}
