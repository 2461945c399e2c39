//! The loop.

use super::driver::Driver;
use super::error::{RunFailure, SimulationError};
use super::integrator::Stages;
use super::plant::Plant;
use super::probe::Probe;
use super::recorder::Recorder;
use super::schedule::Schedule;
use super::settings::Simulation;
use super::state::State;
use super::surroundings::Surroundings;
use super::trace::{GoalResult, Trace};
use crate::control::{ControlError, Stack};
use crate::environment::{DifferentialGravity, Effect};
use crate::model::Model;
use crate::reference::TaskReference;
use crate::spatial::{Fused, InstructionSet, Scalar};
use std::ops::ControlFlow;
use std::sync::Arc;

/// Called with the simulated time now and then; `Break` stops the run with what it has.
pub type Monitor<'a> = &'a mut dyn FnMut(f64) -> ControlFlow<()>;

/// How many steps pass between two calls of the monitor.
const MONITOR_EVERY: usize = 64;

impl Simulation {
    /// Runs from the given state for `duration` seconds; the same bits at every call.
    ///
    /// # Errors
    /// What [`Simulation::check`] finds, a state that is no longer finite, a monitor that breaks,
    /// or what orbit, environment or controller refuse; the trace so far comes along.
    pub fn run(&mut self, duration: f64, monitor: Monitor<'_>) -> Result<Trace, RunFailure> {
        let fail = |error| RunFailure { error, trace: Box::default() };
        self.check().map_err(fail)?;
        if !(duration.is_finite() && duration > 0.0) {
            return Err(fail(SimulationError::NotPositive { name: "duration", value: duration }));
        }
        match InstructionSet::current() {
            InstructionSet::Baseline => self.run_with::<f64>(duration, monitor),
            InstructionSet::Fused | InstructionSet::Wide => self.run_with::<Fused>(duration, monitor),
        }
    }

    fn run_with<S: Scalar>(&mut self, duration: f64, monitor: Monitor<'_>) -> Result<Trace, RunFailure> {
        let fail = |error| RunFailure { error, trace: Box::default() };
        let model = Arc::clone(&self.model);
        let effects = self.all_effects();
        let events = effects.iter().flat_map(|effect| effect.event_times()).collect();
        let schedule = Schedule::new(self.time_step, duration, self.control_period, events)
            .switching(self.control.switch_times());
        let surroundings = Surroundings::new(&model, effects, self.orbit.clone());
        let numbers = |x: &[f64]| x.iter().map(|x| S::of(*x)).collect::<Vec<S>>();
        let mut plant = Plant::<S, _>::new(&model, surroundings);
        let mut run = Run {
            state: State::at(&model, &mut plant.data, numbers(&self.q), numbers(&self.v)),
            plant,
            tracked: (self.tool, self.reference.as_ref()),
            recorder: Recorder::new(
                rows(&schedule, self.record_every),
                (model.nq(), model.nv()),
                self.tool,
                self.reference.is_some() || self.control.tracks(self.tool),
                self.orbit.is_some(),
                self.record_every == 1,
                self.control.controls(),
            )
            .map_err(fail)?,
            driver: Driver::new(&mut self.control, self.reference.as_ref(), &model, self.time_step)
                .map_err(fail)?,
        };
        let mut stages = Stages::new(&model, &run.state, self.integrator);
        let outcome = run.all(schedule, &mut stages, self.record_every, duration, monitor);
        let mut trace = run.recorder.trace;
        trace.results = run.driver.stack().map_or_else(Vec::new, |stack| goal_results(stack, &model));
        match outcome {
            Ok(()) => Ok(trace),
            Err(error) => Err(RunFailure { error, trace: Box::new(trace) }),
        }
    }

    /// The effects of the scenario, and gravity where there is a planet.
    fn all_effects(&self) -> Vec<Arc<dyn Effect>> {
        let mut effects = self.effects.clone();
        if self.orbit.as_ref().is_some_and(|orbit| orbit.mu().is_some()) {
            effects.push(Arc::new(DifferentialGravity::default()));
        }
        effects
    }
}

/// How many rows to make room for.
fn rows(schedule: &Schedule, record_every: usize) -> usize {
    let steps = if record_every == 1 { schedule.stretches() } else { schedule.grid_steps() / record_every };
    steps.saturating_add(2)
}

/// What came of the goals.
fn goal_results<S: Scalar>(stack: &Stack<'_, S>, model: &Model) -> Vec<GoalResult> {
    let with_goal = stack.controls().iter().enumerate().filter(|(_, control)| control.goal.is_some());
    with_goal
        .map(|(i, control)| {
            let outcome = stack.outcome(i);
            let component = outcome.miss().map(|miss| match control.task() {
                Some(_) => ["position", "attitude"][miss.component].to_owned(),
                None => model.joints()[control.joints[miss.component]].name.clone(),
            });
            GoalResult { name: control.name.clone(), outcome, component }
        })
        .collect()
}

/// A run under way.
struct Run<'a, S> {
    state: State<S>,
    plant: Plant<'a, S, Surroundings>,
    driver: Driver<'a, S>,
    recorder: Recorder,
    /// The tool of the run and its reference.
    tracked: (Option<usize>, Option<&'a TaskReference>),
}

impl<S: Scalar> Run<'_, S> {
    fn all(
        &mut self,
        mut schedule: Schedule,
        stages: &mut Stages<S>,
        record_every: usize,
        duration: f64,
        monitor: Monitor<'_>,
    ) -> Result<(), SimulationError> {
        self.plant.settle(&mut self.state);
        self.plant.prime(&self.state);
        let (mut count, mut probe) = (0, Probe::new(&self.state));
        while let Some(stretch) = schedule.next() {
            let interval = (stretch.start, stretch.end);
            let begun = self.begin(stages, stretch.start, interval, stretch.is_control_tick);
            begun.map_err(|error| self.name_divergence(error, stages, stretch.start))?;
            // a step cut short by an event is a step: with all of them recorded, jumps lie at rows
            let is_row = record_every == 1 || stretch.grid_step.is_some_and(|step| step % record_every == 0);
            if is_row {
                self.record(stretch.start)?;
            }
            // a probe that fails is a step that will: the step tells
            let _ = probe.look(count, interval, &self.state, &mut self.plant, stages);
            let result = stages.step(&mut self.plant, &mut self.state, interval);
            if is_row {
                self.recorder.accelerated(stages.first_acceleration());
            }
            result.map_err(|error| self.name_divergence(error, stages, stretch.start))?;
            self.recorder.trace.work_done += (self.state.work - stages.start_work()).value().abs();
            if !self.state.is_finite() {
                return Err(self.diverged(stages, stretch.start));
            }
            count += 1;
            self.recorder.trace.attitude_step_doubling = Some(probe.estimate(count));
            if count % MONITOR_EVERY == 0 && monitor(stretch.end).is_break() {
                self.end(stages, stretch.end, schedule.is_control_tick())?;
                return Err(SimulationError::Interrupted { time: stretch.end });
            }
        }
        self.end(stages, duration, schedule.is_control_tick())
    }

    /// Kinematics, wrenches and torques at the start of a step.
    fn begin(
        &mut self,
        stages: &Stages<S>,
        t: f64,
        interval: (f64, f64),
        is_control_tick: bool,
    ) -> Result<(), SimulationError> {
        self.plant.settle(&mut self.state);
        if !self.state.is_finite() {
            return Err(self.diverged(stages, t));
        }
        let Self { state, plant, driver, .. } = self;
        if is_control_tick && !driver.compensates() {
            plant.data.clear_external();
            driver.ask(t, state, plant)?;
        }
        plant.surround(t, interval, &state.q)?;
        if is_control_tick && driver.compensates() {
            driver.ask(t, state, plant)?;
        }
        Ok(())
    }

    /// What a state that ran away brings about elsewhere is called by its name: a built-in law that
    /// overflows, an orbit or an effect asked about places that are none.
    fn name_divergence(&self, error: SimulationError, stages: &Stages<S>, t: f64) -> SimulationError {
        let is_overflow = matches!(&error, SimulationError::Control(ControlError::TorqueNotFinite { .. }))
            && self.driver.is_built_in();
        if is_overflow || !self.state.is_finite() || !stages.is_finite() {
            self.diverged(stages, t)
        } else {
            error
        }
    }

    /// The error that carries the last finite state.
    fn diverged(&self, stages: &Stages<S>, time: f64) -> SimulationError {
        let now = [&self.state.q, &self.state.v].map(|x| x.iter().map(|x| x.value()).collect());
        let [q, v] = if self.state.is_finite() { now } else { stages.start() };
        SimulationError::Diverged { time, q, v }
    }

    fn record(&mut self, t: f64) -> Result<(), SimulationError> {
        let orbit = self.plant.surroundings.orbit_state(t)?;
        let desired = self.driver.desired(t, &self.state, &self.plant, self.tracked)?;
        self.recorder.row(t, &self.state, &self.plant, orbit, desired);
        if let Some(stack) = self.driver.stack() {
            self.recorder.tracked(stack);
        }
        Ok(())
    }

    /// The last row: the state at the end, with the torque that would be held from there.
    fn end(&mut self, stages: &mut Stages<S>, t: f64, is_control_tick: bool) -> Result<(), SimulationError> {
        let begun = self.begin(stages, t, (t, t), is_control_tick);
        begun.map_err(|error| self.name_divergence(error, stages, t))?;
        self.record(t)?;
        stages.accelerate(&mut self.plant, &self.state);
        self.recorder.accelerated(stages.first_acceleration());
        Ok(())
    }
}
