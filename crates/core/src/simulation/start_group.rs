//! Creation of the run of a group of systems from the settings of a simulation.

use super::accuracy::Accuracy;
use super::connections::Connections;
use super::contacts::Contacts;
use super::controllers::Controllers;
use super::engine::Engine;
use super::environment_loads::EnvironmentLoads;
use super::equations::EquationsOfMotion;
use super::error::SimulationError;
use super::events::Events;
use super::external_engine::ExternalEngine;
use super::group_balance::GroupBalance;
use super::integrator::{Integrator, Stages, StepSettings};
use super::loop_rows::recorded_loops;
use super::modes::StepMethod;
use super::mover::Mover;
use super::recompile::follow_centers;
use super::recorder::{RecordOptions, Recorder};
use super::recording::Ledger;
use super::run_state::RunState;
use super::run_system::RunSystem;
use super::schedule::{Clock, LONGEST_INTERVAL, Schedule};
use super::state::State;
use super::tree::Tree;
use super::wrench_commands::WRENCH_COMMAND;
use crate::contact::{Contact, ContactSteps};
use crate::control::Control;
use crate::earth::Earth;
use crate::environment::{Effect, GravityMode};
use crate::gravity::Gravity;
use crate::model::Model;
use crate::orbit::Orbit;
use crate::reference::MovingFrame;
use crate::spatial::Scalar;
use crate::world::{Action, Event, FrameIndex, Layout, System, When, systems_of};
use std::borrow::Cow;
use std::sync::Arc;

/// Number of rows for which memory is reserved in a run without a planned end, and at most in a run from
/// which the caller removes rows.
pub(super) const ROWS_OF_OPEN_RUN: usize = 1024;

/// Settings that all systems of a simulation have in common.
#[derive(Clone)]
pub(super) struct Shared {
    pub(super) orbit: Option<Arc<dyn Orbit>>,
    /// Gravity field of the run; `None` without a planet.
    pub(super) gravity: Option<Arc<Gravity>>,
    pub(super) earth: Option<Arc<Earth>>,
    pub(super) gravity_mode: GravityMode,
    /// Effects, including gravity.
    pub(super) effects: Vec<Arc<dyn Effect>>,
    /// Name of the column of each effect in the trace.
    pub(super) effect_names: Vec<String>,
    pub(super) time_step: f64,
    pub(super) has_engine: bool,
    pub(super) integrator: Integrator,
    pub(super) tolerance: f64,
    pub(super) rereference_beyond: f64,
    pub(super) record_wrenches: bool,
    /// True if wrenches are recorded and a control follows external commands.
    pub(super) takes_commands: bool,
    pub(super) record_every: usize,
    /// Contacts. In the settings of a group, they specify systems by their index in the group.
    pub(super) contacts: Vec<Contact>,
    pub(super) contact_steps: ContactSteps,
    /// Largest number of rows for which memory is reserved.
    pub(super) most_rows: usize,
}

impl Shared {
    /// Returns the settings of the group of systems with the indices `numbers` in the world, with only those
    /// effects and contacts that act on systems of the group.
    pub(super) fn of_group(&self, numbers: &[usize]) -> Self {
        let is_own = |effect: &Arc<dyn Effect>| numbers.iter().any(|&system| effect.acts_on(system));
        let named = self.effects.iter().zip(&self.effect_names).filter(|(effect, _)| is_own(effect));
        let (effects, effect_names) = named.map(|(effect, name)| (Arc::clone(effect), name.clone())).unzip();
        let contacts = self.contacts.iter().filter_map(|contact| contact.in_group(numbers)).collect();
        Self { effects, effect_names, contacts, ..self.clone() }
    }

    /// Creates the run of `systems`, whose indices in the world are `numbers`, at its initial state.
    /// `duration` is the planned end of the run, s; `None` for an open-ended run.
    pub(super) fn run_state<'a, S: Scalar>(
        &self,
        duration: Option<f64>,
        numbers: &[usize],
        systems: Vec<&'a mut System>,
        events: &[Event],
        engine: Option<&'a mut (dyn Engine + 'static)>,
    ) -> Result<RunState<'a, S>, SimulationError> {
        let events = events_of(numbers, events);
        let schedule = self.schedule(duration, &systems, &events.list);
        let rows = self.row_count(&schedule).min(self.most_rows);
        let (is_native, is_adaptive) = (engine.is_none(), self.is_adaptive());
        let has_every_step = self.record_every == 1 && !is_adaptive;
        // the rows of a system contain neither the accelerations that torques on the rest of its tree cause,
        // nor the accelerations just before contact friction changes from its static to its kinetic value
        let has_friction =
            self.contacts.iter().any(|contact| contact.law.is_some_and(|law| law.friction.is_some()));
        let rows_suffice = has_every_step && ((events.list.is_empty() && !has_friction) || !is_native);
        let rereference_beyond = self.local_reference_distance(&systems);
        let step_settings = self.step_settings(duration, &systems);
        let layout = Layout::new(systems.iter().map(|system| (&*system.name, &*system.model)));
        let named = systems.iter().map(|system| (&*system.name, &*system.model));
        let connections = Connections::new(named, !events.list.is_empty())?;
        let start = |system: &&mut System| Ok::<_, SimulationError>(system.closed_start()?.map(|x| lift(&x)));
        let starts = systems.iter().map(start).collect::<Result<Vec<_>, _>>()?;
        let moving_frames = moving_frames_of(numbers, &systems);
        let (mut trees, mut members, mut models) = (Vec::new(), Vec::new(), Vec::new());
        for (number, system) in systems.into_iter().enumerate() {
            let (model, tree, run) =
                self.run_system((number, numbers), (system, &events.list), (rows, rows_suffice))?;
            models.push(model);
            trees.push(tree);
            members.push(run);
        }
        let mut equations = EquationsOfMotion::<S, _>::new(trees, self.environment_loads(numbers, &models));
        let mut state = State::at(&mut equations.trees, starts.into_iter().map(<(Vec<S>, Vec<S>)>::from));
        equations.contacts = Contacts::new(&self.contacts, self.contact_steps);
        state.contacts = equations.contacts.states();
        if is_native {
            follow_centers(&equations.trees, &mut state.trees);
        }
        let is_fixed = is_native && !is_adaptive;
        let measures = (is_fixed, is_fixed && !rows_suffice);
        let accuracy = Accuracy::of(&equations.trees, &state, measures, schedule.grid_steps())?;
        let mover = match engine {
            None => Mover::Native(StepMethod::new(&state, &step_settings)),
            Some(engine) => {
                equations.contacts.follow_engine();
                Mover::External(ExternalEngine::new(engine, &models, &equations.contacts.names))
            }
        };
        let mut run = RunState {
            layout,
            numbers: numbers.to_vec(),
            row_buffers: (state.clone(), Stages::new(&state)),
            row_states: Vec::new(),
            accuracy,
            state,
            equations,
            systems: members,
            connections,
            moving_frames,
            events,
            ledger: Ledger::default(),
            balance: GroupBalance::default(),
            mover,
            step_settings,
            schedule,
            record_every: self.record_every,
            has_every_step,
            steps: 0,
            time: 0.0,
            controllers_updated: false,
            keeps_commands: false,
            has_event: false,
            records_before: f64::INFINITY,
            rereference_beyond,
            earth: self.earth.clone(),
            singular_loops: Vec::new(),
            loop_rows: Vec::new(),
        };
        run.find_latches();
        run.pass_brakes();
        Ok(run)
    }

    /// Creates the tree, the controllers and the recorder of the system with index `number` in the group, and
    /// returns them with the model of the system. `numbers` are the indices in the world of the systems of
    /// the group. The recorder reserves memory for `rows` rows; `rows_suffice` is true if these rows are
    /// sufficient for the checks that compare successive steps.
    fn run_system<'a, S: Scalar>(
        &self,
        (number, numbers): (usize, &[usize]),
        (system, events): (&'a mut System, &[Event]),
        (rows, rows_suffice): (usize, bool),
    ) -> Result<(&'a Model, Tree<'a, S>, RunSystem<'a, S>), SimulationError> {
        let System { model, controls, tool, reference, stops, knows, brakes, .. } = system;
        let model: &'a Model = model;
        let stops = stops.filter(|_| !self.has_engine); // an external engine has its own stops
        let knows: Vec<usize> = knows.iter().filter_map(|&system| local(numbers, system)).collect();
        let mut options = self.record_options(model, controls, *tool, reference.is_some());
        let own = self.contacts.iter().filter(|contact| contact.first_system() == Some(number));
        options.contacts = own.map(|contact| contact.name.clone()).collect();
        options.loops = recorded_loops(number, model, events);
        let loops = options.loops.clone();
        let recorder = Recorder::new(rows, (number, model), options, controls, rows_suffice)?;
        let tracked = (*tool, reference.as_ref());
        let mut controllers = Controllers::new(controls, tracked, model, self.time_step, !knows.is_empty())?;
        controllers.set.check_internal_forces(model, &loops)?;
        controllers.set.check_fingers(model, &self.touching_bodies(number, model))?;
        if self.has_engine {
            controllers.set.assume_creeping_friction();
        }
        let (known_members, held, settled) = (Vec::new(), None, None);
        let run = RunSystem {
            controllers,
            recorder,
            held,
            is_due: false,
            knows,
            known_members,
            settled,
            brakes: brakes.clone(),
        };
        Ok((model, Tree::new(Cow::Borrowed(model), stops).with_brakes(brakes), run))
    }

    /// Returns the settings of the integrator for systems that are integrated together until `duration`, s.
    fn step_settings(&self, duration: Option<f64>, systems: &[&mut System]) -> StepSettings {
        let Self { integrator, tolerance, time_step, .. } = *self;
        let controlled = systems.iter().filter(|system| !system.controls.is_empty());
        let periods = controlled.map(|system| system.control_period.unwrap_or(time_step));
        let control_period = periods.reduce(f64::min).unwrap_or(0.0);
        let duration = duration.unwrap_or(LONGEST_INTERVAL * time_step);
        StepSettings { integrator, tolerance, time_step, control_period, duration }
    }

    /// Creates the loads of the environment on the bodies of systems with these indices in the world and
    /// these models.
    pub(super) fn environment_loads(&self, numbers: &[usize], models: &[&Model]) -> EnvironmentLoads {
        EnvironmentLoads::new(
            (numbers, models),
            self.effects.clone(),
            self.orbit.clone(),
            self.gravity.clone(),
            self.earth.clone(),
            self.gravity_mode,
        )
    }

    /// Returns the quantities that the run records in addition to the state of a system.
    fn record_options(
        &self,
        model: &Model,
        controls: &[Control],
        tool: Option<usize>,
        has_reference: bool,
    ) -> RecordOptions {
        let compensates_friction = controls.iter().any(|control| control.law.compensates_friction());
        let mut frames = controls.iter().filter_map(|control| control.law.task());
        let tracks_tool = frames.any(|(frame, _)| Some(frame) == tool);
        RecordOptions {
            tool,
            has_reference: has_reference || tracks_tool,
            effects: self.recorded_effects(),
            has_orbit: self.orbit.is_some(),
            compensates_friction: compensates_friction && model.has_friction() && !self.has_engine,
            contacts: Vec::new(),
            loops: Vec::new(),
            records_residual: self.gravity.is_some() && self.gravity_mode == GravityMode::Carried,
        }
    }

    /// Returns the names of the effects whose wrenches are recorded, followed by the name of the commanded
    /// wrenches if a control follows external commands; empty if wrenches are not recorded.
    fn recorded_effects(&self) -> Vec<String> {
        let effects = self.effect_names.iter().filter(|_| self.record_wrenches).cloned();
        effects.chain(self.takes_commands.then(|| WRENCH_COMMAND.to_owned())).collect()
    }

    /// Returns the distance from the origin of W beyond which a system changes to a local reference orbit, m;
    /// infinity if it must keep the reference orbit of the run.
    fn local_reference_distance(&self, systems: &[&mut System]) -> f64 {
        let is_allowed = self.gravity_mode == GravityMode::True
            && self.gravity.is_some()
            && !self.has_engine
            && systems.len() == 1
            && !systems.iter().any(|system| tracks_world(system));
        if is_allowed { self.rereference_beyond } else { f64::INFINITY }
    }

    fn is_adaptive(&self) -> bool {
        self.integrator == Integrator::DormandPrince
    }

    /// Returns the indices of the bodies of the system with index `system` in the group on which contacts may
    /// exert compliant normal forces.
    fn touching_bodies(&self, system: usize, model: &Model) -> Vec<usize> {
        let with_forces = self.contacts.iter().filter(|contact| contact.law.is_some());
        let sides = with_forces.flat_map(|contact| contact.sides.iter().flatten());
        let own = sides.filter(|side| side.frame.system == system);
        own.map(|side| model.frames()[side.frame.frame].body).collect()
    }

    /// Creates the schedule of a run with the planned end `duration`, s. Steps of an adaptive integrator end
    /// at grid points only if there are latches or contacts, and at control ticks only if there are controls.
    fn schedule(&self, duration: Option<f64>, systems: &[&mut System], events: &[Event]) -> Schedule {
        // in `Carried` mode, the acceleration of the reference orbit, including its jumps, does not act on
        // the robot
        let orbit = self.orbit.iter().filter(|_| self.gravity_mode == GravityMode::True);
        let jumps = orbit.flat_map(|orbit| orbit.event_times());
        let times = events.iter().filter_map(|event| event.when.time());
        let effects = self.effects.iter().flat_map(|effect| effect.event_times());
        let clock = |system: &&mut System| {
            let has_ticks = !self.is_adaptive() || !system.controls.is_empty();
            let period = if has_ticks { system.control_period.unwrap_or(self.time_step) } else { f64::MAX };
            Clock { period, switches: system.controls.iter().flat_map(Control::switch_times).collect() }
        };
        let clocks = systems.iter().map(clock).collect();
        let schedule =
            Schedule::new(self.time_step, duration, clocks, effects.chain(jumps).chain(times).collect());
        // the conditions of latches and contacts are evaluated at the ends of steps, which must therefore not
        // be too long
        let has_latches = events.iter().any(|event| matches!(event.when, When::Latch(_)));
        if self.is_adaptive() && !has_latches && self.contacts.is_empty() {
            schedule.without_grid_steps()
        } else {
            schedule
        }
    }

    /// Returns the number of rows for which the recorder reserves memory.
    fn row_count(&self, schedule: &Schedule) -> usize {
        let steps = match self.record_every {
            1 => schedule.intervals(),
            every => schedule.grid_steps().map(|steps| steps / every),
        };
        steps.map_or(ROWS_OF_OPEN_RUN, |steps| steps.saturating_add(2))
    }
}

/// Returns true if the reference of the tool or a control may depend on the position of the robot in W.
fn tracks_world(system: &System) -> bool {
    system.reference.is_some()
        || system.controls.iter().any(|Control { law, .. }| {
            law.joint_reference().is_none() && law.external().is_none() && law.grip().is_none()
        })
}

/// Returns the index in the group of the system with the index `system` in the world; `None` if it belongs to
/// another group.
fn local(numbers: &[usize], system: usize) -> Option<usize> {
    numbers.iter().position(|number| *number == system)
}

fn lift<S: Scalar>(x: &[f64]) -> Vec<S> {
    x.iter().map(|x| S::of(*x)).collect()
}

/// Returns the frames of systems of the group in which references of the group are given; see
/// [`RunState::moving_frames`].
fn moving_frames_of(numbers: &[usize], systems: &[&mut System]) -> Vec<(FrameIndex, MovingFrame)> {
    let moving = systems.iter().flat_map(|system| system.moving_frames());
    let place = |moving: &MovingFrame| {
        let system = local(numbers, moving.system)?;
        Some((FrameIndex { system, frame: moving.frame }, moving.clone()))
    };
    moving.filter_map(place).collect()
}

/// Returns the events of the systems with the indices `numbers` in the world, with systems and events
/// specified by their index in the group.
fn events_of(numbers: &[usize], events: &[Event]) -> Events {
    let is_own =
        |event: &usize| systems_of(events, *event).iter().all(|&system| local(numbers, system).is_some());
    let own: Vec<usize> = (0..events.len()).filter(is_own).collect();
    let event_number = |event: usize| own.iter().position(|number| *number == event).unwrap_or(0);
    let place = |place: FrameIndex| FrameIndex { system: local(numbers, place.system).unwrap_or(0), ..place };
    let renumbered = |number: &usize| {
        let mut event = events[*number].clone();
        if let When::After { event: other, .. } = &mut event.when {
            *other = event_number(*other);
        }
        match &mut event.action {
            Action::Capture { by, of, .. } => (*by, *of) = (place(*by), place(*of)),
            Action::Release { capture, .. } => *capture = event_number(*capture),
            Action::Engage(brake) | Action::Disengage(brake) => {
                brake.system = local(numbers, brake.system).unwrap_or(0);
            }
        }
        event
    };
    Events::new(own.iter().map(renumbered).collect(), own.clone())
}

/// Returns a unique column name for each effect: its name with underscores instead of spaces, to which `_2`,
/// `_3`, … is appended if the name is already used.
pub(super) fn column_names(effects: &[Arc<dyn Effect>]) -> Vec<String> {
    let mut names: Vec<String> = Vec::with_capacity(effects.len());
    for effect in effects {
        let name = effect.name().replace(' ', "_");
        let is_taken = |name: &String| names.contains(name);
        let numbered = (2..).map(|k| format!("{name}_{k}")).find(|name| !is_taken(name));
        names.push(if is_taken(&name) { numbered.unwrap_or_default() } else { name });
    }
    names
}
