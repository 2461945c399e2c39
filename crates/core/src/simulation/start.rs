//! Starts a run: creates its state from the settings of a simulation.

use super::accuracy::Accuracy;
use super::checkpoint::Checkpoint;
use super::controllers::Controllers;
use super::engine::ExternalEngine;
use super::environment_loads::EnvironmentLoads;
use super::equations::EquationsOfMotion;
use super::error::{RunFailure, SimulationError};
use super::every_step::EveryStep;
use super::integrator::{Integrator, Stages, StepSettings};
use super::layout::Layout;
use super::modes::StepMethod;
use super::mover::Mover;
use super::recorder::{RecordOptions, Recorder};
use super::run_state::RunState;
use super::run_system::RunSystem;
use super::schedule::{LONGEST_INTERVAL, Schedule};
use super::settings::Simulation;
use super::state::State;
use super::step_doubling::StepDoubling;
use super::stepper::Stepper;
use super::trace::Trace;
use crate::control::Control;
use crate::environment::{DifferentialGravity, Effect, GravityMode};
use crate::gravity::Gravity;
use crate::spatial::{Fused, InstructionSet, Scalar};
use std::sync::Arc;

/// Number of rows for which a run without a planned end reserves memory.
const ROWS_OF_OPEN_RUN: usize = 1024;

impl Simulation {
    /// Runs from the initial state for `duration` seconds; repeated calls give bit-identical results.
    ///
    /// # Errors
    /// The errors of [`Simulation::start`] and [`Stepper::advance_to`]. The failure contains the rows recorded before
    /// it.
    pub fn run(&mut self, duration: f64) -> Result<Trace, RunFailure> {
        let mut stepper = self.start(Some(duration)).map_err(RunFailure::at_start)?;
        let advanced = stepper.advance_to(duration);
        let trace = stepper.finish()?;
        match advanced {
            Ok(()) => Ok(trace),
            Err(error) => Err(RunFailure { error, trace: Box::new(trace) }),
        }
    }

    /// Starts a run that the caller advances. `duration` is the planned end of the run, s, or `None` for an
    /// open-ended run. The last step ends there, and the adaptive integrator and the error estimates are set up for
    /// this duration.
    ///
    /// # Errors
    /// The errors of [`Simulation::check`], [`SimulationError::NotPositive`] for a duration that is not positive, and
    /// [`SimulationError::Earth`] if the orientation data of the Earth do not cover the run.
    pub fn start(&mut self, duration: Option<f64>) -> Result<Stepper<'_>, SimulationError> {
        self.start_from(duration, None)
    }

    /// Resumes a run of the same simulation from a checkpoint and the rows recorded before it. The results are
    /// bit-identical to those of an uninterrupted run. `duration`, s, is by default that of the checkpoint.
    ///
    /// # Errors
    /// The errors of [`Simulation::start`], and [`SimulationError::Checkpoint`] for a checkpoint of another robot,
    /// schedule or instruction set.
    pub fn resume(
        &mut self,
        duration: Option<f64>,
        from: Checkpoint,
        rows: Trace,
    ) -> Result<Stepper<'_>, SimulationError> {
        self.start_from(duration.or(from.duration()), Some((from, rows)))
    }

    fn start_from(
        &mut self,
        duration: Option<f64>,
        from: Option<(Checkpoint, Trace)>,
    ) -> Result<Stepper<'_>, SimulationError> {
        self.check()?;
        duration.map_or(Ok(()), |duration| SimulationError::check_positive("duration", duration))?;
        if let Some(earth) = &self.earth {
            earth.covers(0.0).and_then(|()| earth.covers(duration.unwrap_or(0.0)))?;
        }
        match InstructionSet::current() {
            InstructionSet::Baseline => self.start_with::<f64>(duration, from),
            InstructionSet::Fused | InstructionSet::Wide => self.start_with::<Fused>(duration, from),
        }
    }

    fn start_with<S: Scalar>(
        &mut self,
        duration: Option<f64>,
        from: Option<(Checkpoint, Trace)>,
    ) -> Result<Stepper<'_>, SimulationError> {
        let mut run = self.run_state::<S>(duration)?;
        match from {
            None => run.mover.kinematics(&mut run.equations, &mut run.state),
            Some((checkpoint, rows)) => run.resume(checkpoint, rows)?,
        }
        Ok(Stepper::new(run))
    }

    /// Returns the run at its initial state.
    fn run_state<S: Scalar>(&mut self, duration: Option<f64>) -> Result<RunState<'_, S>, SimulationError> {
        let schedule = self.schedule(duration);
        let (options, rows) = (self.record_options(), self.row_count(&schedule));
        let (is_native, is_adaptive) = (self.engine.is_none(), self.is_adaptive());
        let has_every_step = self.record_every == 1 && !is_adaptive;
        let rereference_beyond = self.local_reference_distance();
        let loads = self.environment_loads();
        let Self { integrator, tolerance, time_step, .. } = *self;
        let horizon = duration.unwrap_or(LONGEST_INTERVAL * time_step);
        let settings = StepSettings { integrator, tolerance, time_step, duration: horizon };

        let layout = self.layout();
        let model = &*self.model;
        let stops = self.stops.filter(|_| is_native); // an external engine has its own
        let mut equations = EquationsOfMotion::<S, _>::new(&[model], loads, stops);
        let numbers = |x: &[f64]| x.iter().map(|x| S::of(*x)).collect::<Vec<S>>();
        let state = State::at(&mut equations.trees, [(numbers(&self.q), numbers(&self.v))]);
        let is_fixed = is_native && !is_adaptive;
        let doubling = is_fixed.then(|| StepDoubling::new(&equations.trees, &state, schedule.grid_steps()));
        let checked = equations.trees.iter().filter(|_| is_fixed && !has_every_step).enumerate();
        let every_step = checked.map(|(number, system)| EveryStep::new(number, system.model));
        let every_step = every_step.collect::<Result<_, _>>()?;
        let recorder = Recorder::new(rows, (0, model), options, &self.controls, has_every_step)?;
        let tool = (self.tool, self.reference.as_ref());
        let mut controllers = Controllers::new(&mut self.controls, tool, model, time_step)?;
        let mover = match self.engine.as_deref_mut() {
            None => Mover::Native(StepMethod::new(&state, &settings)),
            Some(engine) => {
                controllers.set.assume_creeping_friction();
                Mover::External(ExternalEngine::new(engine, model))
            }
        };
        Ok(RunState {
            layout,
            row_buffers: (state.clone(), Stages::new(&state)),
            accuracy: Accuracy::new(doubling, every_step),
            state,
            equations,
            systems: vec![RunSystem { controllers, recorder }],
            mover,
            schedule,
            record_every: self.record_every,
            has_every_step,
            steps: 0,
            time: 0.0,
            controllers_updated: false,
            records_before: f64::INFINITY,
            rereference_beyond,
            earth: self.earth.clone(),
        })
    }

    /// Returns the layout of the run, whose only system is the robot, named after its model.
    pub(super) fn layout(&self) -> Layout {
        Layout::new([(self.model.name(), &*self.model)])
    }

    /// Returns the options for the quantities that the run records in addition to its state.
    fn record_options(&self) -> RecordOptions {
        let compensates_friction = self.controls.iter().any(|control| control.law.compensates_friction());
        let effects = if self.record_wrenches { column_names(&self.all_effects()) } else { Vec::new() };
        RecordOptions {
            tool: self.tool,
            has_reference: self.reference.is_some() || self.tracks_tool(),
            effects,
            has_orbit: self.orbit.is_some(),
            compensates_friction: compensates_friction && self.model.has_friction() && self.engine.is_none(),
            records_residual: self.gravity().is_some() && self.gravity_mode == GravityMode::Carried,
        }
    }

    /// Returns the distance from the origin of W beyond which the robot changes to a local reference orbit, m;
    /// infinity if the robot must keep the reference orbit of the run.
    fn local_reference_distance(&self) -> f64 {
        let is_allowed = self.gravity_mode == GravityMode::True
            && self.gravity().is_some()
            && self.engine.is_none()
            && !self.tracks_world();
        if is_allowed { self.rereference_beyond } else { f64::INFINITY }
    }

    /// Returns true if a control depends on the position of the robot in W.
    fn tracks_world(&self) -> bool {
        self.reference.is_some()
            || self.controls.iter().any(|control| control.law.joint_reference().is_none())
    }

    /// Returns true if a control tracks the tool.
    fn tracks_tool(&self) -> bool {
        let mut frames = self.controls.iter().filter_map(|control| control.law.task());
        frames.any(|(frame, _)| Some(frame) == self.tool)
    }

    /// Returns the gravity field of the simulation: the given one, by default that of the orbit or, if the orbit has
    /// none, that of a point mass. `None` without a planet.
    fn gravity(&self) -> Option<Arc<Gravity>> {
        let orbit = self.orbit.as_ref()?;
        let mu = orbit.mu()?;
        let given = self.gravity.as_ref().or(orbit.gravity());
        Some(given.cloned().unwrap_or_else(|| Arc::new(Gravity::point_mass(mu))))
    }

    fn is_adaptive(&self) -> bool {
        self.integrator == Integrator::DormandPrince
    }

    /// Returns the schedule of the run. Steps of an adaptive integrator do not end at grid points nor, without
    /// controls, at control ticks.
    fn schedule(&self, duration: Option<f64>) -> Schedule {
        // in `Carried` mode the acceleration of the reference orbit, and with it its jumps, does not act on the robot
        let orbit = self.orbit.iter().filter(|_| self.gravity_mode == GravityMode::True);
        let jumps = orbit.flat_map(|orbit| orbit.event_times());
        let effects = self.all_effects();
        let events = effects.iter().flat_map(|effect| effect.event_times()).chain(jumps).collect();
        let has_ticks = !self.is_adaptive() || !self.controls.is_empty();
        let period = if has_ticks { self.control_period } else { Some(f64::MAX) };
        let switches = self.controls.iter().flat_map(Control::switch_times).collect();
        let schedule = Schedule::new(self.time_step, duration, period, events).with_switches(switches);
        if self.is_adaptive() { schedule.without_grid_steps() } else { schedule }
    }

    /// Returns the number of rows for which the recorder reserves memory.
    fn row_count(&self, schedule: &Schedule) -> usize {
        let steps = match self.record_every {
            1 => schedule.intervals(),
            every => schedule.grid_steps().map(|steps| steps / every),
        };
        steps.map_or(ROWS_OF_OPEN_RUN, |steps| steps.saturating_add(2))
    }

    /// Returns the loads of the environment on the bodies.
    pub(super) fn environment_loads(&self) -> EnvironmentLoads {
        let (orbit, earth) = (self.orbit.clone(), self.earth.clone());
        EnvironmentLoads::new(
            &[&self.model],
            self.all_effects(),
            orbit,
            self.gravity(),
            earth,
            self.gravity_mode,
        )
    }

    /// Returns the effects of the scenario, and gravity if the orbit has a planet.
    pub(super) fn all_effects(&self) -> Vec<Arc<dyn Effect>> {
        let mut effects = self.effects.clone();
        if self.orbit.as_ref().is_some_and(|orbit| orbit.mu().is_some()) {
            effects.push(Arc::new(DifferentialGravity { gravity_mode: self.gravity_mode }));
        }
        effects
    }
}

/// Returns a unique column name for each effect: its name, with `_2`, `_3`, … appended where the name is taken.
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
