//! The loop.

use super::checkpoint::Checkpoint;
use super::driver::Driver;
use super::error::{RunFailure, SimulationError};
use super::integrator::{Integrator, Stages};
use super::plant::Plant;
use super::probe::Probe;
use super::recorder::{Extras, Recorder};
use super::schedule::Schedule;
use super::settings::Simulation;
use super::state::State;
use super::stepping::{Stepper, Stepping};
use super::surroundings::Surroundings;
use super::trace::{GoalResult, Trace};
use crate::control::{ControlError, ControlLaw, Stack};
use crate::environment::{DifferentialGravity, Effect, ReferenceMotion};
use crate::model::Model;
use crate::reference::TaskReference;
use crate::spatial::{Fused, InstructionSet, Scalar};
use std::ops::ControlFlow;
use std::sync::Arc;

/// A run between two steps.
pub struct Moment<'a> {
    /// Time reached, s.
    pub time: f64,
    /// The rows so far.
    pub trace: &'a Trace,
    checkpoint: &'a dyn Fn() -> Result<Checkpoint, ControlError>,
}

impl Moment<'_> {
    /// What the run can go on from, with the rows so far: see [`Simulation::resume`].
    ///
    /// # Errors
    /// What a user's controller raises when it is asked to save what it remembers.
    pub fn checkpoint(&self) -> Result<Checkpoint, ControlError> {
        (self.checkpoint)()
    }
}

/// Looks at the run now and then; `Break` stops it with what it has.
pub type Monitor<'a> = &'a mut dyn FnMut(&Moment<'_>) -> ControlFlow<()>;

/// How many steps pass between two calls of the monitor.
const MONITOR_EVERY: usize = 64;

impl Simulation {
    /// Runs from the given state for `duration` seconds; the same bits at every call.
    ///
    /// # Errors
    /// What [`Simulation::check`] finds, a state that is no longer finite, a monitor that breaks,
    /// or what orbit, environment or controller refuse; the trace so far comes along.
    pub fn run(&mut self, duration: f64, monitor: Monitor<'_>) -> Result<Trace, RunFailure> {
        self.go(duration, None, monitor)
    }

    /// Goes on from a checkpoint of a run of the same simulation for the same `duration`, with the rows that it
    /// had recorded; the same bits as if it had not stopped.
    ///
    /// # Errors
    /// As [`Simulation::run`], and a checkpoint of another robot, schedule or instruction set.
    pub fn resume(
        &mut self,
        duration: f64,
        from: (&Checkpoint, Trace),
        monitor: Monitor<'_>,
    ) -> Result<Trace, RunFailure> {
        self.go(duration, Some(from), monitor)
    }

    fn go(
        &mut self,
        duration: f64,
        from: Option<(&Checkpoint, Trace)>,
        monitor: Monitor<'_>,
    ) -> Result<Trace, RunFailure> {
        let fail = |error| RunFailure { error, trace: Box::default() };
        self.check().map_err(fail)?;
        if !(duration.is_finite() && duration > 0.0) {
            return Err(fail(SimulationError::NotPositive { name: "duration", value: duration }));
        }
        match InstructionSet::current() {
            InstructionSet::Baseline => self.go_with::<f64>(duration, from, monitor),
            InstructionSet::Fused | InstructionSet::Wide => self.go_with::<Fused>(duration, from, monitor),
        }
    }

    fn go_with<S: Scalar>(
        &mut self,
        duration: f64,
        from: Option<(&Checkpoint, Trace)>,
        monitor: Monitor<'_>,
    ) -> Result<Trace, RunFailure> {
        let fail = |error| RunFailure { error, trace: Box::default() };
        let model = Arc::clone(&self.model);
        let effects = self.all_effects();
        let jumps = self.orbit.iter().flat_map(|orbit| orbit.event_times());
        let events = effects.iter().flat_map(|effect| effect.event_times()).chain(jumps).collect();
        let schedule = self.schedule(duration, events);
        let surroundings = Surroundings::new(&model, effects, self.orbit.clone());
        let numbers = |x: &[f64]| x.iter().map(|x| S::of(*x)).collect::<Vec<S>>();
        let mut plant = Plant::<S, _>::new(&model, surroundings, self.stops);
        let state = State::at(&model, &mut plant.data, numbers(&self.q), numbers(&self.v));
        let planet = self.orbit.as_ref().and_then(|orbit| orbit.mu());
        let extras = Extras {
            tool: self.tool,
            has_reference: self.reference.is_some() || self.control.tracks(self.tool),
            has_orbit: self.orbit.is_some(),
            carried_around: planet.filter(|_| self.reference_motion == ReferenceMotion::Carried),
        };
        let is_dense = self.record_every == 1 && !self.is_adaptive();
        let controls = self.control.controls();
        let recorder = Recorder::new(rows(&schedule, self.record_every), &model, extras, controls, is_dense);
        let Self { integrator, tolerance, time_step, .. } = *self;
        let how = Stepping { integrator, tolerance, time_step, duration };
        let mut run = Run {
            stepper: Stepper::new(&model, &state, &how),
            between: (
                state.clone(),
                Stages::new(&model, &state, &Stepping { integrator: Integrator::Rk4, ..how }),
            ),
            probe: Probe::new(&state),
            state,
            plant,
            tracked: (self.tool, self.reference.as_ref()),
            driver: Driver::new(&mut self.control, self.reference.as_ref(), &model, time_step)
                .map_err(fail)?,
            recorder: recorder.map_err(fail)?,
            schedule,
            steps: 0,
        };
        match from {
            None => run.plant.settle(&mut run.state),
            Some((checkpoint, trace)) => run.go_on_from(checkpoint, trace).map_err(fail)?,
        }
        let outcome = run.all(self.record_every, monitor);
        let mut trace = run.recorder.trace;
        trace.results = run.driver.stack().map_or_else(Vec::new, |stack| goal_results(stack, &model));
        match outcome {
            Ok(()) => Ok(trace),
            Err(error) => Err(RunFailure { error, trace: Box::new(trace) }),
        }
    }

    fn is_adaptive(&self) -> bool {
        self.integrator == Integrator::DormandPrince
    }

    /// An adaptive integrator steps over the grid, and where nothing asks for ticks over them too.
    fn schedule(&self, duration: f64, events: Vec<f64>) -> Schedule {
        let asks = !matches!(self.control, ControlLaw::None);
        let period = if self.is_adaptive() && !asks { Some(f64::MAX) } else { self.control_period };
        let schedule =
            Schedule::new(self.time_step, duration, period, events).switching(self.control.switch_times());
        if self.is_adaptive() { schedule.over_the_grid() } else { schedule }
    }

    /// The effects of the scenario, and gravity where there is a planet.
    fn all_effects(&self) -> Vec<Arc<dyn Effect>> {
        let mut effects = self.effects.clone();
        if self.orbit.as_ref().is_some_and(|orbit| orbit.mu().is_some()) {
            effects.push(Arc::new(DifferentialGravity { motion: self.reference_motion }));
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
pub(super) struct Run<'a, S> {
    pub(super) state: State<S>,
    pub(super) plant: Plant<'a, S, Surroundings>,
    pub(super) driver: Driver<'a, S>,
    /// The tool of the run and its reference.
    pub(super) tracked: (Option<usize>, Option<&'a TaskReference>),
    pub(super) recorder: Recorder,
    pub(super) stepper: Stepper<S>,
    /// For rows within a step.
    pub(super) between: (State<S>, Stages<S>),
    pub(super) probe: Probe<S>,
    pub(super) schedule: Schedule,
    pub(super) steps: usize,
}

impl<S: Scalar> Run<'_, S> {
    fn all(&mut self, record_every: usize, monitor: Monitor<'_>) -> Result<(), SimulationError> {
        while let Some(stretch) = self.schedule.next() {
            let interval = (stretch.start, stretch.end);
            let begun = self.begin(stretch.start, interval, stretch.is_control_tick);
            begun.map_err(|error| self.name_divergence(error, stretch.start))?;
            // a step cut short by an event is a step: with all of them recorded, jumps lie at rows
            let is_dense = self.recorder.trace.has_every_step;
            let is_row = is_dense || stretch.grid_step.is_some_and(|step| step % record_every == 0);
            if is_row {
                self.record(stretch.start)?;
            }
            let stepped = self.step(interval, is_row, record_every);
            stepped.map_err(|error| self.name_divergence(error, stretch.start))?;
            if !self.state.is_finite() {
                return Err(self.diverged(stretch.start));
            }
            if self.steps.is_multiple_of(MONITOR_EVERY) && self.look(monitor).is_break() {
                let time = self.schedule.now();
                self.end(time)?;
                return Err(SimulationError::Interrupted { time });
            }
        }
        self.end(self.schedule.now())
    }

    /// One step from a state that [`Run::begin`] prepared, and the rows within it.
    fn step(
        &mut self,
        interval: (f64, f64),
        is_row: bool,
        record_every: usize,
    ) -> Result<(), SimulationError> {
        let Self { state, plant, stepper, probe, recorder, .. } = self;
        if stepper.memory().is_none() {
            // a probe that fails is a step that will: the step tells
            let _ = probe.look(self.steps, interval, state, plant, &mut stepper.stages);
        }
        let result = stepper.advance(plant, state, interval);
        let stages = &stepper.stages;
        if is_row {
            recorder.accelerated(stages.first_acceleration());
        }
        let reached = result?;
        recorder.trace.work_done += (state.work - stages.start_work()).value().abs();
        self.steps += 1;
        self.estimate();
        if reached < interval.1 {
            self.schedule.cut(reached);
        }
        while let Some((step, t)) = self.schedule.passed(reached) {
            if step.is_multiple_of(record_every) {
                self.record_between(t)?;
            }
        }
        Ok(())
    }

    /// Says by how much the attitude may be wrong after the steps so far.
    fn estimate(&mut self) {
        let doubling = || self.probe.estimate(self.steps);
        let estimate = self.stepper.memory().map_or_else(doubling, |memory| memory.turn);
        self.recorder.trace.attitude_step_doubling = Some(estimate);
    }

    /// Shows the run to its monitor.
    fn look(&self, monitor: Monitor<'_>) -> ControlFlow<()> {
        let (time, trace) = (self.schedule.now(), &self.recorder.trace);
        let checkpoint = || {
            let (counts, probe) = ((trace.rows(), self.steps), self.probe.numbers());
            let (command, memory) = (&self.plant.command, self.stepper.memory().unwrap_or_default());
            let stepper = (memory, self.stepper.cuts);
            let (schedule, controls) = (&self.schedule, self.driver.save()?);
            let done = trace.work_done;
            Ok(Checkpoint::new(&self.state, command, schedule, counts, stepper, probe, done, controls))
        };
        monitor(&Moment { time, trace, checkpoint: &checkpoint })
    }

    /// Takes up where a checkpoint was made.
    fn go_on_from(&mut self, from: &Checkpoint, trace: Trace) -> Result<(), SimulationError> {
        from.check(self.plant.model, &self.schedule, trace.rows())?;
        self.state = from.state();
        self.schedule = from.schedule.clone();
        self.steps = from.steps;
        self.probe.go_on_from(from.probe);
        self.stepper.go_on_from(from.memory, from.cuts);
        self.recorder.go_on_from(trace)?;
        self.recorder.trace.work_done = from.work_done;
        self.estimate(); // no step may follow
        self.plant.command.iter_mut().zip(&from.command).for_each(|(to, from)| *to = S::of(*from));
        self.driver.load(&from.controls)
    }

    /// Kinematics, wrenches and torques at the start of a step.
    pub(super) fn begin(
        &mut self,
        t: f64,
        interval: (f64, f64),
        is_control_tick: bool,
    ) -> Result<(), SimulationError> {
        self.plant.settle(&mut self.state);
        if !self.state.is_finite() {
            return Err(self.diverged(t));
        }
        self.bounce(t, interval)?;
        let Self { state, plant, driver, .. } = self;
        if is_control_tick && !driver.compensates() {
            plant.data.clear_external();
            driver.ask(t, state, plant)?;
        }
        plant.surround(t, interval, &state.q)?;
        if is_control_tick && driver.compensates() {
            driver.ask(t, state, plant)?;
        }
        plant.decide(&state.q, &state.v);
        Ok(())
    }

    /// What a state that ran away brings about elsewhere is called by its name: a built-in law that
    /// overflows, an orbit or an effect asked about places that are none.
    pub(super) fn name_divergence(&self, error: SimulationError, t: f64) -> SimulationError {
        let is_overflow = matches!(&error, SimulationError::Control(ControlError::TorqueNotFinite { .. }))
            && self.driver.is_built_in();
        if is_overflow || !self.state.is_finite() || !self.stepper.stages.is_finite() {
            self.diverged(t)
        } else {
            error
        }
    }

    /// The error that carries the last finite state.
    fn diverged(&self, time: f64) -> SimulationError {
        let now = [&self.state.q, &self.state.v].map(|x| x.iter().map(|x| x.value()).collect());
        let [q, v] = if self.state.is_finite() { now } else { self.stepper.stages.start() };
        SimulationError::Diverged { time, q, v }
    }
}
