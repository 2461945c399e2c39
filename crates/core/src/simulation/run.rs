//! The loop.

use super::checkpoint::Checkpoint;
use super::driver::Driver;
use super::engine::Foreign;
use super::error::SimulationError;
use super::follow::{Follower, Started};
use super::integrator::Stages;
use super::plant::Plant;
use super::probe::Probe;
use super::recorder::Recorder;
use super::schedule::Schedule;
use super::state::State;
use super::stepping::Stepper;
use super::surroundings::Surroundings;
use super::trace::Trace;
use crate::control::ControlError;
use crate::reference::TaskReference;
use crate::spatial::{Scalar, Vec3};
use std::ops::ControlFlow;

/// A run between two steps.
pub struct Moment<'a> {
    /// Time reached, s.
    pub time: f64,
    /// The rows so far.
    pub trace: &'a Trace,
    checkpoint: &'a dyn Fn() -> Result<Checkpoint, ControlError>,
}

impl Moment<'_> {
    /// What the run can go on from, with the rows so far: see [`Simulation::resume`](super::Simulation::resume).
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
    /// The certificate's checks of every step, where rows are sparse.
    pub(super) follower: Option<Box<Follower>>,
    /// What moves the robot in the place of `stepper`.
    pub(super) foreign: Option<Foreign<'a>>,
    pub(super) schedule: Schedule,
    pub(super) steps: usize,
    /// Distance of the base from W's origin at which the robot gets a reference of its own, m.
    pub(super) rereference_beyond: f64,
}

impl<S: Scalar> Run<'_, S> {
    pub(super) fn all(&mut self, record_every: usize, monitor: Monitor<'_>) -> Result<(), SimulationError> {
        while let Some(stretch) = self.schedule.next() {
            let interval = (stretch.start, stretch.end);
            if self.is_far() {
                self.plant.rereference(stretch.start, &mut self.state)?;
                self.follower.iter_mut().for_each(|follower| follower.forget());
            }
            let begun = self.begin(stretch.start, interval, stretch.is_control_tick);
            begun.map_err(|error| self.name_divergence(error, stretch.start))?;
            // a step cut short by an event is a step: with all of them recorded, jumps lie at rows
            let is_dense = self.recorder.trace.has_every_step;
            let is_row = is_dense || stretch.grid_step.is_some_and(|step| step % record_every == 0);
            if is_row {
                self.record(stretch.start)?;
            }
            let is_smooth = !stretch.is_event && !self.plant.contacts.is_active();
            let stepped = self.step(interval, (is_row, is_smooth), record_every);
            stepped.map_err(|error| self.name_divergence(error, stretch.start))?;
            if !self.state.is_finite() {
                return Err(self.diverged(stretch.start));
            }
            // another engine may take its time
            let is_time = self.foreign.is_some() || self.steps.is_multiple_of(MONITOR_EVERY);
            if is_time && self.look(monitor).is_break() {
                let time = self.schedule.now();
                self.end(time)?;
                return Err(SimulationError::Interrupted { time });
            }
        }
        self.end(self.schedule.now())
    }

    /// Whether the robot should have a reference of its own.
    fn is_far(&self) -> bool {
        Vec3::from_slice(&self.state.q).norm().value() > self.rereference_beyond
    }

    /// One step from a state that [`Run::begin`] prepared, and the rows within it.
    fn step(
        &mut self,
        interval: (f64, f64),
        (is_row, is_smooth): (bool, bool),
        record_every: usize,
    ) -> Result<(), SimulationError> {
        if self.foreign.is_some() {
            return self.step_foreign(interval, is_row);
        }
        let is_window = self.follower.is_some() && self.probe.is_due(self.steps);
        if is_window {
            self.open_window(interval.0)?;
        }
        let Self { state, plant, stepper, probe, recorder, follower, .. } = self;
        let started = follower.as_ref().map(|_| Started::at(interval.0, state, plant));
        if stepper.memory().is_none() {
            // a probe that fails is a step that will: the step tells
            let _ = probe.look(self.steps, interval, state, plant, &mut stepper.stages);
        }
        let result = stepper.advance(plant, state, interval);
        let stages = &stepper.stages;
        if is_row {
            recorder.accelerated(plant.model, stages.first_acceleration());
        }
        let reached = result?;
        if stepper.stages.pair.is_none() {
            probe.found.watch.step(stages, &plant.command, reached - interval.0, is_smooth);
        }
        if let (Some(follower), Some(started)) = (follower, started) {
            follower.open(started, stages);
        }
        recorder.trace.work_done += (state.work - stages.start_work()).value().abs();
        self.steps += 1;
        if is_window {
            self.close_window(interval.0, reached)?;
        }
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

    /// Puts into the trace what only the run knows for its certificate: by how much attitude, joints and base may be
    /// wrong after the steps so far, and the checks of every step. Nothing is known of another engine's.
    pub(super) fn conclude(&mut self) {
        let Self { probe, stepper, follower, recorder: Recorder { trace, .. }, .. } = self;
        trace.pair_checks = follower.as_ref().map(|follower| follower.checks());
        if self.foreign.is_some() {
            return;
        }
        if let Some(memory) = stepper.memory() {
            trace.attitude_step_doubling = Some(memory.turn);
            return;
        }
        let found = &probe.found;
        trace.attitude_step_doubling = Some(found.turn(self.steps));
        trace.step_doubling = (0..found.drifts.len()).map(|i| found.drift(i, self.steps)).collect();
    }

    /// Shows the run to its monitor.
    fn look(&self, monitor: Monitor<'_>) -> ControlFlow<()> {
        let (time, trace) = (self.schedule.now(), &self.recorder.trace);
        let checkpoint = || {
            let (counts, probe) = ((trace.rows(), self.steps), self.probe.found.clone());
            let command = (&self.plant.command[..], self.plant.contacts.asked());
            let memory = self.stepper.memory().unwrap_or_default();
            let stepper = (memory, self.stepper.cuts);
            let (schedule, controls) = (&self.schedule, self.driver.save()?);
            let (done, own) = (trace.work_done, self.plant.surroundings.own());
            let follower = self.follower.as_ref().map(|follower| follower.save());
            let certificate = (probe, follower);
            Ok(Checkpoint::new(
                &self.state,
                command,
                schedule,
                counts,
                stepper,
                certificate,
                done,
                own,
                controls,
            ))
        };
        monitor(&Moment { time, trace, checkpoint: &checkpoint })
    }

    /// Takes up where a checkpoint was made.
    pub(super) fn go_on_from(&mut self, from: &Checkpoint, trace: Trace) -> Result<(), SimulationError> {
        from.check(self.plant.model, &self.schedule, trace.rows())?;
        self.state = from.state();
        self.schedule = from.schedule.clone();
        self.steps = from.steps;
        self.probe.found = from.probe.clone();
        self.stepper.go_on_from(from.memory, from.cuts);
        self.recorder.go_on_from(trace)?;
        self.recorder.trace.work_done = from.work_done;
        if let (Some(follower), Some(bits)) = (&mut self.follower, &from.follower) {
            follower.load(bits)?;
        }
        if let Some(own) = &from.own_reference {
            self.plant.surroundings.follow(own.clone())?;
        }
        self.plant.command.iter_mut().zip(&from.command).for_each(|(to, from)| *to = S::of(*from));
        self.plant.contacts.asked_mut().copy_from_slice(&from.asked);
        self.driver.load(&from.controls)
    }

    /// Kinematics, wrenches and torques at the start of a step.
    pub(super) fn begin(
        &mut self,
        t: f64,
        interval: (f64, f64),
        is_control_tick: bool,
    ) -> Result<(), SimulationError> {
        self.settle();
        if !self.state.is_finite() {
            return Err(self.diverged(t));
        }
        if let Some(follower) = &mut self.follower {
            follower.close(t, &self.state, &self.plant);
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
        match self.foreign {
            Some(_) => plant.contacts.compensate_by_rate(&state.v),
            None => plant.decide(&state.q, &state.v),
        }
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
    pub(super) fn diverged(&self, time: f64) -> SimulationError {
        let now = [&self.state.q, &self.state.v].map(|x| x.iter().map(|x| x.value()).collect());
        let [q, v] = if self.state.is_finite() { now } else { self.stepper.stages.start() };
        SimulationError::Diverged { time, q, v }
    }
}
