//! From the settings of a run to a run under way.

use super::checkpoint::Checkpoint;
use super::driver::Driver;
use super::engine::Foreign;
use super::error::{RunFailure, SimulationError};
use super::follow::Follower;
use super::integrator::{Integrator, Stages};
use super::plant::Plant;
use super::probe::Probe;
use super::recorder::{Extras, Recorder};
use super::run::{Monitor, Run};
use super::schedule::Schedule;
use super::settings::Simulation;
use super::state::State;
use super::stepping::{Stepper, Stepping};
use super::surroundings::Surroundings;
use super::trace::{GoalResult, Trace};
use crate::control::{Control, ControlLaw, Stack};
use crate::environment::{DifferentialGravity, Effect, ReferenceMotion};
use crate::gravity::Gravity;
use crate::model::Model;
use crate::spatial::{Fused, InstructionSet, Scalar};
use std::sync::Arc;

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
        if let Some(earth) = &self.earth {
            earth.covers(0.0).and_then(|()| earth.covers(duration)).map_err(|error| fail(error.into()))?;
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
        let (effects, gravity) = (self.all_effects(), self.gravity());
        // one that carries the robot along is felt through its tides alone
        let falls = self.reference_motion == ReferenceMotion::True;
        let jumps = self.orbit.iter().filter(|_| falls).flat_map(|orbit| orbit.event_times());
        let events = effects.iter().flat_map(|effect| effect.event_times()).chain(jumps).collect();
        let names = if self.record_wrenches { column_names(&effects) } else { Vec::new() };
        let may_rereference = falls && gravity.is_some() && self.engine.is_none() && !self.looks_at_world();
        let rereference_beyond = if may_rereference { self.rereference_beyond } else { f64::INFINITY };
        let schedule = self.schedule(duration, events);
        let surroundings = self.surroundings();
        let numbers = |x: &[f64]| x.iter().map(|x| S::of(*x)).collect::<Vec<S>>();
        let stops = self.stops.filter(|_| self.engine.is_none()); // an engine has its own
        let mut plant = Plant::<S, _>::new(&model, surroundings, stops);
        let state = State::at(&model, &mut plant.data, numbers(&self.q), numbers(&self.v));
        let is_compensated = self.control.compensates_friction() && model.has_friction();
        let extras = Extras {
            tool: self.tool,
            has_reference: self.reference.is_some() || self.control.tracks(self.tool),
            effects: names,
            has_orbit: self.orbit.is_some(),
            compensates_friction: is_compensated && self.engine.is_none(),
            is_carried: gravity.is_some() && !falls,
        };
        let is_dense = self.record_every == 1 && !self.is_adaptive();
        let is_followed = !is_dense && !self.is_adaptive() && self.engine.is_none();
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
            probe: Probe::new(&state, schedule.grid_steps()),
            follower: is_followed.then(|| Follower::new(&model).map(Box::new)).transpose().map_err(fail)?,
            foreign: self.engine.as_deref_mut().map(|engine| Foreign::new(engine, &model)),
            state,
            plant,
            tracked: (self.tool, self.reference.as_ref()),
            driver: Driver::new(&mut self.control, self.reference.as_ref(), &model, time_step)
                .map_err(fail)?,
            recorder: recorder.map_err(fail)?,
            schedule,
            steps: 0,
            rereference_beyond,
        };
        if run.foreign.is_some() {
            run.driver.expect_creeping_friction();
        }
        match from {
            None => run.settle(),
            Some((checkpoint, trace)) => run.go_on_from(checkpoint, trace).map_err(fail)?,
        }
        let outcome = run.all(self.record_every, monitor);
        run.conclude();
        let mut trace = run.recorder.trace;
        trace.rereferenced = run.plant.surroundings.own().map_or_else(Vec::new, |own| own.times.clone());
        trace.results = run.driver.stack().map_or_else(Vec::new, |stack| goal_results(stack, &model));
        match outcome {
            Ok(()) => Ok(trace),
            Err(error) => Err(RunFailure { error, trace: Box::new(trace) }),
        }
    }

    /// Whether a control knows where in W the robot is: then it must stay there.
    fn looks_at_world(&self) -> bool {
        let joints_alone = |control: &Control| control.joint_reference().is_some();
        match &self.control {
            ControlLaw::None => self.reference.is_some(),
            ControlLaw::Stack(controls) => !controls.iter().all(joints_alone),
            ControlLaw::ComputedTorque(_) | ControlLaw::User(_) => true,
        }
    }

    /// The field chosen, else the one that the orbit obeys, else that of a point mass, where there is a planet.
    fn gravity(&self) -> Option<Arc<Gravity>> {
        let orbit = self.orbit.as_ref()?;
        let mu = orbit.mu()?;
        let given = self.gravity.as_ref().or(orbit.gravity());
        Some(given.cloned().unwrap_or_else(|| Arc::new(Gravity::point_mass(mu))))
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

    /// All that acts on the bodies, to be evaluated.
    pub(super) fn surroundings(&self) -> Surroundings {
        let is_carried = self.reference_motion == ReferenceMotion::Carried;
        let (orbit, earth) = (self.orbit.clone(), self.earth.clone());
        Surroundings::new(&self.model, self.all_effects(), orbit, self.gravity(), earth, is_carried)
    }

    /// The effects of the scenario, and gravity where there is a planet.
    pub(super) fn all_effects(&self) -> Vec<Arc<dyn Effect>> {
        let mut effects = self.effects.clone();
        if self.orbit.as_ref().is_some_and(|orbit| orbit.mu().is_some()) {
            effects.push(Arc::new(DifferentialGravity { motion: self.reference_motion }));
        }
        effects
    }
}

/// A name for every effect's column: its own, with a number from the second of that name on.
fn column_names(effects: &[Arc<dyn Effect>]) -> Vec<String> {
    let mut names: Vec<String> = Vec::with_capacity(effects.len());
    for effect in effects {
        let name = effect.name().replace(' ', "_");
        let is_taken = |name: &String| names.contains(name);
        let numbered = (2..).map(|k| format!("{name}_{k}")).find(|name| !is_taken(name));
        names.push(if is_taken(&name) { numbered.unwrap_or_default() } else { name });
    }
    names
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
