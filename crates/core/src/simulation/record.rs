//! Rows of a run: at the starts of steps, within steps, at impacts and at the end.

use super::environment_loads::EnvironmentLoads;
use super::equations::EquationsOfMotion;
use super::error::SimulationError;
use super::integrator::Stages;
use super::mover::Mover;
use super::run_state::RunState;
use super::run_system::RunSystem;
use super::schedule::Interval;
use super::state::State;
use crate::spatial::Scalar;

impl<S: Scalar> RunState<'_, S> {
    /// Returns true if a row is due at the start of `interval`. If every step is recorded, this includes the steps
    /// that start at an event, so that discontinuities coincide with rows.
    pub(super) fn is_row_due(&self, interval: &Interval) -> bool {
        let is_due = |step: usize| step.is_multiple_of(self.record_every);
        interval.start < self.records_before
            && (self.has_every_step || interval.grid_step.is_some_and(is_due))
    }

    /// Adds a row of every system for the current state, whose kinematics are in the equations of motion.
    pub(super) fn record(&mut self, t: f64) -> Result<(), SimulationError> {
        add_rows(&mut self.systems, &mut self.equations, t, &self.state)
    }

    /// Adds the rows whose times lie within the last step, before the current cut.
    pub(super) fn record_within_step(&mut self) -> Result<(), SimulationError> {
        while let Some((step, t)) = self.schedule.next_grid_step_passed() {
            if t >= self.records_before {
                break;
            }
            if step.is_multiple_of(self.record_every) {
                self.record_within(t)?;
            }
        }
        Ok(())
    }

    /// Adds a row at `t` within the last step, from the dense output of the adaptive integrator.
    pub(super) fn record_within(&mut self, t: f64) -> Result<(), SimulationError> {
        let Self { equations, mover, systems, row_buffers: (state, stages), .. } = self;
        if let Some(integration) = mover.integration() {
            integration.interpolate(t, state);
        }
        equations.project_momentum(state);
        equations.apply_loads(t, (t, t), state)?;
        add_rows(systems, equations, t, state)?;
        add_accelerations(systems, equations, state, stages);
        Ok(())
    }

    /// Applies the impacts of joints that reach their stops. If every step is recorded, there is one row before the
    /// impacts and one after them, at the same time.
    pub(super) fn impacts(&mut self, t: f64, interval: (f64, f64)) -> Result<(), SimulationError> {
        let mut pairs = self.equations.trees.iter().zip(&self.state.trees);
        if !pairs.any(|(system, state)| system.modes.is_active() && system.first_impact(state).is_some()) {
            return Ok(());
        }
        if self.has_every_step && t < self.records_before {
            self.equations.apply_loads(t, interval, &self.state)?;
            self.record(t)?;
            let Self { state, equations, row_buffers: (_, stages), systems, .. } = self;
            add_accelerations(systems, equations, state, stages);
            equations.project_momentum(state);
        }
        self.mover.resolve_impacts(&mut self.equations, &mut self.state);
        Ok(())
    }

    /// Adds the last row: the state at the current cut, with the torques that would be held in a further step.
    pub(super) fn record_end(&mut self) -> Result<(), SimulationError> {
        let t = self.schedule.now();
        let following = self.schedule.following().map(|(interval, _)| interval.end);
        let interval = Interval {
            start: t,
            end: following.unwrap_or(t),
            is_control_tick: self.schedule.is_control_tick(),
            grid_step: None,
            is_event: false,
        };
        let begun = self.begin(&interval, t);
        begun.map_err(|error| self.name_divergence(error, t))?;
        self.record(t)?;
        let Self { state, equations, mover, row_buffers: (_, stages), systems, .. } = self;
        if mover.is_external() {
            let asked = mover.advance(equations, state, (t, t)); // a step of zero length
            complete_rows(systems, mover, equations);
            return asked.map(|_| ());
        }
        add_accelerations(systems, equations, state, stages);
        Ok(())
    }
}

/// Adds the accelerations to the rows at the start of the last step.
pub(super) fn complete_rows<S: Scalar>(
    systems: &mut [RunSystem<'_, S>],
    mover: &Mover<'_, S>,
    equations: &EquationsOfMotion<'_, S, EnvironmentLoads>,
) {
    for (number, (run, system)) in systems.iter_mut().zip(&equations.trees).enumerate() {
        mover.complete_row(number, &mut run.recorder, system.model);
    }
}

/// Adds a row of every system, without its acceleration, for a state whose kinematics are in the equations of motion.
fn add_rows<S: Scalar>(
    systems: &mut [RunSystem<'_, S>],
    equations: &mut EquationsOfMotion<'_, S, EnvironmentLoads>,
    t: f64,
    state: &State<S>,
) -> Result<(), SimulationError> {
    let EquationsOfMotion { trees: moved, loads } = equations;
    let orbit = loads.reference_state(t)?;
    for ((run, system), state) in systems.iter_mut().zip(moved).zip(&state.trees) {
        run.add_row(t, state, system, loads, orbit)?;
    }
    Ok(())
}

/// Completes the last rows with the accelerations at `state`. Expects its kinematics and loads in the equations of
/// motion.
fn add_accelerations<S: Scalar>(
    systems: &mut [RunSystem<'_, S>],
    equations: &mut EquationsOfMotion<'_, S, EnvironmentLoads>,
    state: &State<S>,
    stages: &mut Stages<S>,
) {
    stages.evaluate_first(equations, state);
    for ((run, system), first) in systems.iter_mut().zip(&equations.trees).zip(&stages.first) {
        run.recorder.record_acceleration(system.model, &first.acceleration);
    }
}
