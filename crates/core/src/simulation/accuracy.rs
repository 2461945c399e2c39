//! Measurement of the accuracy of steps during a run, for the certificate of the run.

use super::environment_loads::EnvironmentLoads;
use super::equations::EquationsOfMotion;
use super::error::SimulationError;
use super::estimates::Estimates;
use super::every_step::{EveryStep, SavedChecks};
use super::integrator::{FirstStage, Stages};
use super::mover::Mover;
use super::state::State;
use super::step_doubling::{Errors, StepDoubling};
use super::tree::Tree;
use super::tree_state::TreeState;
use crate::model::Model;
use crate::spatial::Scalar;

type Equations<'a, S> = EquationsOfMotion<'a, S, EnvironmentLoads>;

/// Error estimates for runs with a fixed-step integrator of the native engine. An adaptive integrator
/// estimates its errors itself; the errors of an external engine are not estimated.
pub(super) struct Accuracy<S> {
    doubling: Option<StepDoubling<S>>,
    /// Checks that are evaluated at every step, one entry per tree; empty with an adaptive integrator or an
    /// external engine, and if the recorded rows are sufficient for these checks.
    every_step: Vec<EveryStep>,
    /// True if the certificate checks the base rows of inverse dynamics for the current step.
    is_recorded: bool,
}

impl<S: Scalar> Accuracy<S> {
    /// Creates the error estimates of `trees` before their first step. `doubles` is true if step doubling
    /// estimates the errors of steps, and `checks` is true if the checks of the certificate are evaluated at
    /// every step. `steps` is the planned number of steps; `None` for an open-ended run.
    pub(super) fn of(
        trees: &[Tree<'_, S>],
        state: &State<S>,
        (doubles, checks): (bool, bool),
        steps: Option<usize>,
    ) -> Result<Self, SimulationError> {
        let checked = trees.iter().filter(|_| checks).enumerate();
        let every_step = checked.map(|(number, tree)| EveryStep::new(number, &tree.model));
        let every_step = every_step.collect::<Result<_, _>>()?;
        let doubling = doubles.then(|| StepDoubling::new(trees, state, steps));
        Ok(Self { doubling, every_step, is_recorded: false })
    }

    /// Returns the arguments `doubles` and `checks` with which [`Accuracy::of`] creates the same measurements
    /// for other trees.
    pub(super) fn measures(&self) -> (bool, bool) {
        (self.doubling.is_some(), !self.every_step.is_empty())
    }

    /// Returns the errors and checks accumulated so far for the tree with index `number`.
    pub(super) fn save(&self, number: usize) -> (Option<Errors>, Option<SavedChecks>) {
        let errors = self.doubling.as_ref().map(|doubling| doubling.errors[number].clone());
        (errors, self.every_step.get(number).map(EveryStep::save))
    }

    /// Restores the values that [`Accuracy::save`] returned for the tree with index `number`.
    pub(super) fn restore(&mut self, number: usize, (errors, checks): (Option<Errors>, Option<SavedChecks>)) {
        if let (Some(doubling), Some(errors)) = (&mut self.doubling, errors) {
            doubling.errors[number] = errors;
        }
        if let (Some(every_step), Some(checks)) = (self.every_step.get_mut(number), checks) {
            every_step.restore(checks);
        }
    }

    /// Completes the checks of the last step, which ended at time `t`, s. Requires that the base twists in
    /// `state` have been projected onto the momentum, and that `equations` contain the kinematics of `state`.
    pub(super) fn end_step(&mut self, t: f64, state: &State<S>, equations: &Equations<'_, S>) {
        if !self.every_step.is_empty() {
            self.end_checked_step(t, state, equations);
        }
    }

    #[cold]
    fn end_checked_step(&mut self, t: f64, state: &State<S>, equations: &Equations<'_, S>) {
        for (every_step, (state, tree)) in self.every_step.iter_mut().zip(pairs(state, &equations.trees)) {
            every_step.end(t, state, tree);
        }
    }

    /// Excludes the last step of the tree with index `number` from the checks.
    pub(super) fn skip_step(&mut self, number: usize) {
        if let Some(every_step) = self.every_step.get_mut(number) {
            every_step.skip();
        }
    }

    /// Starts the measurements of the step with index `step` over `interval`, s, before that step is
    /// computed.
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
        if is_due || !self.every_step.is_empty() {
            self.measure_start(is_due.then_some(step), interval, state, equations, mover)?;
        }
        Ok(())
    }

    /// Stores the start of a step over `interval`, s, for the checks, and probes the step with the index
    /// `probed` if it is not `None`.
    #[cold]
    fn measure_start(
        &mut self,
        probed: Option<usize>,
        interval: (f64, f64),
        state: &State<S>,
        equations: &mut Equations<'_, S>,
        mover: &mut Mover<'_, S>,
    ) -> Result<(), SimulationError> {
        let EquationsOfMotion { trees, loads, .. } = equations;
        for (every_step, (state, tree)) in self.every_step.iter_mut().zip(pairs(state, trees)) {
            if probed.is_some() {
                every_step.record_start(interval.0, state, tree, loads)?;
            }
            every_step.start(interval.0, state, tree);
        }
        let parts = (probed, &mut self.doubling, mover.integration());
        if let (Some(step), Some(doubling), Some(integration)) = parts {
            // if step doubling fails, the step fails too and reports the error
            let _ = doubling.probe(step, interval, state, equations, integration);
        }
        Ok(())
    }

    /// Adds the completed step over `interval`, s, which ended at `state`, to the acceleration jumps and the
    /// checks. `is_smooth` is true if only a change of the joint torques can make the accelerations
    /// discontinuous at the start of the step. Overwrites `buffers`. Does nothing with an external engine.
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
            let steps = integration.stages.ends().zip(&equations.trees);
            for (errors, (ends, tree)) in doubling.errors.iter_mut().zip(steps) {
                errors.jumps.add_step(&ends, &tree.command, h, is_smooth);
            }
        }
        if self.every_step.is_empty() {
            return Ok(());
        }
        self.check_step(interval, state, equations, &integration.stages, buffers)
    }

    /// Adds the completed step over `interval`, s, which ended at `state`, to the checks.
    #[cold]
    fn check_step(
        &mut self,
        interval: (f64, f64),
        state: &State<S>,
        equations: &mut Equations<'_, S>,
        stages: &Stages<S>,
        buffers: &mut (State<S>, Stages<S>),
    ) -> Result<(), SimulationError> {
        for (every_step, ends) in self.every_step.iter_mut().zip(stages.ends()) {
            every_step.add_stages(&ends);
        }
        if self.is_recorded {
            self.complete_rows(equations, stages, EveryStep::complete_start);
            if state.is_finite() {
                return self.record_end(interval, state, equations, buffers);
            }
        }
        Ok(())
    }

    /// Records the end of a step whose base rows of inverse dynamics are checked. Writes the state at the
    /// end, with projected base twists, and its accelerations to the buffers `(end, stages)`.
    #[cold]
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
        let EquationsOfMotion { trees, loads, .. } = equations;
        for (every_step, (state, tree)) in self.every_step.iter_mut().zip(pairs(end, trees)) {
            every_step.record_end(interval.1, state, tree, loads)?;
        }
        stages.evaluate_first(equations, end);
        self.complete_rows(equations, stages, EveryStep::complete_end);
        Ok(())
    }

    /// Adds the acceleration of the first stage to the last row of the checks of each tree, which completes
    /// the row.
    fn complete_rows(
        &mut self,
        equations: &Equations<'_, S>,
        stages: &Stages<S>,
        complete: fn(&mut EveryStep, &Model, &FirstStage<S>),
    ) {
        let firsts = stages.first.iter().zip(&equations.trees);
        for (every_step, (first, tree)) in self.every_step.iter_mut().zip(firsts) {
            complete(every_step, &tree.model, first);
        }
    }

    /// Returns the error estimates of the tree with index `number` after `steps` steps. `rotation_error` is
    /// the accumulated attitude error of an adaptive integrator, rad; `None` for a fixed-step integrator and
    /// for an external engine.
    pub(super) fn estimates(&self, number: usize, steps: usize, rotation_error: Option<f64>) -> Estimates {
        let checks = self.every_step.get(number).map(EveryStep::checks);
        let Some(doubling) = &self.doubling else {
            return Estimates { turn: rotation_error, drifts: Vec::new(), checks };
        };
        let errors = &doubling.errors[number];
        let drifts = (0..errors.drifts.len()).map(|i| errors.drift(i, steps)).collect();
        Estimates { turn: Some(errors.turn(steps)), drifts, checks }
    }
}

/// Returns the state of each tree paired with the tree.
fn pairs<'a, 's, S>(
    state: &'a State<S>,
    trees: &'a [Tree<'s, S>],
) -> impl Iterator<Item = (&'a TreeState<S>, &'a Tree<'s, S>)> {
    state.trees.iter().zip(trees)
}
