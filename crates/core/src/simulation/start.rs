//! Start of a run: systems that may interact form groups, each of which is a separate run.

use super::checkpoint::Checkpoint;
use super::environment_loads::EnvironmentLoads;
use super::error::{RunFailure, SimulationError};
use super::recording::Recording;
use super::settings::Simulation;
use super::start_group::{ROWS_OF_OPEN_RUN, Shared, column_names};
use super::stepper::{Group, Stepper};
use super::trace::Trace;
use crate::control::Begin;
use crate::environment::{DifferentialGravity, Effect};
use crate::gravity::Gravity;
use crate::model::Model;
use crate::spatial::{Fused, InstructionSet, Scalar};
use crate::world::{groups, systems_of};
use std::sync::Arc;

impl Simulation {
    /// Runs the simulation for `duration`, s, from the initial state. Repeated calls give bit-identical
    /// results.
    ///
    /// # Errors
    /// The errors of [`Simulation::start`] and [`Stepper::advance_to`]. The failure contains the rows
    /// recorded before the error.
    pub fn run(&mut self, duration: f64) -> Result<Recording, RunFailure> {
        let mut stepper = self.start(Some(duration)).map_err(RunFailure::at_start)?;
        let advanced = stepper.advance_to(duration);
        let recording = stepper.finish()?;
        match advanced {
            Ok(()) => Ok(recording),
            Err(error) => Err(RunFailure { error, recording: Box::new(recording) }),
        }
    }

    /// Starts a run that the caller advances. `duration` is the planned end of the run, s, or `None` for an
    /// open-ended run. The last step ends at `duration`. The step sizes of the adaptive integrator and the
    /// number of step-doubling probes also depend on `duration`.
    ///
    /// # Errors
    /// The errors of [`Simulation::check`], [`SimulationError::NotPositive`] for a duration that is not
    /// positive and finite, [`SimulationError::Earth`] if the orientation data of the Earth do not cover the
    /// run, [`SimulationError::Control`] for controls that the models or the loads do not permit,
    /// [`SimulationError::TooManyRows`] if the rows do not fit in memory, and [`SimulationError::Contacts`]
    /// for bodies that overlap at the start although their contact does not permit it.
    pub fn start(&mut self, duration: Option<f64>) -> Result<Stepper<'_>, SimulationError> {
        self.start_from(duration, None, usize::MAX)
    }

    /// Starts or resumes a run from which the caller regularly removes rows with
    /// [`Stepper::drop_checked_rows`], so that memory is reserved for at most 1024 rows. `from` contains the
    /// checkpoint from which the run is resumed and the rows of each system, from which
    /// [`drop_checked_rows`](super::drop_checked_rows) may already have removed rows; `None` starts a run.
    /// `duration` is the planned end of the run, s, as in [`Simulation::start`] and [`Simulation::resume`].
    ///
    /// # Errors
    /// The errors of [`Simulation::start`] and [`Simulation::resume`].
    pub fn start_streaming(
        &mut self,
        duration: Option<f64>,
        from: Option<(Checkpoint, Vec<Trace>)>,
    ) -> Result<Stepper<'_>, SimulationError> {
        let duration = duration.or(from.as_ref().and_then(|(checkpoint, _)| checkpoint.duration()));
        self.start_from(duration, from, ROWS_OF_OPEN_RUN)
    }

    /// Resumes a run of the same simulation from a checkpoint and the rows of each system recorded before it.
    /// The results are bit-identical to those of an uninterrupted run. `duration` is the planned end of the
    /// run, s; `None` selects that of the checkpoint.
    ///
    /// # Errors
    /// The errors of [`Simulation::start`], and [`SimulationError::Checkpoint`] for a checkpoint of a run
    /// with different systems, a different schedule or a different instruction set, for a damaged checkpoint,
    /// and for `rows` that do not belong to it.
    pub fn resume(
        &mut self,
        duration: Option<f64>,
        from: Checkpoint,
        rows: Vec<Trace>,
    ) -> Result<Stepper<'_>, SimulationError> {
        self.start_from(duration.or(from.duration()), Some((from, rows)), usize::MAX)
    }

    fn start_from(
        &mut self,
        duration: Option<f64>,
        from: Option<(Checkpoint, Vec<Trace>)>,
        most_rows: usize,
    ) -> Result<Stepper<'_>, SimulationError> {
        self.check()?;
        duration.map_or(Ok(()), |duration| SimulationError::check_positive("duration", duration))?;
        if let Some(earth) = &self.earth {
            earth.covers(0.0).and_then(|()| earth.covers(duration.unwrap_or(0.0)))?;
        }
        match InstructionSet::current() {
            InstructionSet::Baseline => self.start_with::<f64>(duration, from, most_rows),
            InstructionSet::Fused | InstructionSet::Wide => {
                self.start_with::<Fused>(duration, from, most_rows)
            }
        }
    }

    fn start_with<S: Scalar>(
        &mut self,
        duration: Option<f64>,
        from: Option<(Checkpoint, Vec<Trace>)>,
        most_rows: usize,
    ) -> Result<Stepper<'_>, SimulationError> {
        let groups = match self.engine {
            None => groups(self.systems.len(), &self.events, &self.links()),
            Some(_) => vec![(0..self.systems.len()).collect()], // an external engine advances all systems at once
        };
        let count = self.systems.len();
        let resumed = match from {
            Some((checkpoint, rows)) => {
                let mut rows: Vec<_> = rows.into_iter().map(Some).collect();
                rows.resize_with(count, || None);
                Some((checkpoint.into_groups(groups.len())?, rows))
            }
            None => None,
        };
        let (mut checkpoints, mut rows) = match resumed {
            Some((checkpoints, rows)) => (checkpoints.into_iter().map(Some).collect(), rows),
            None => (vec![], vec![]),
        };
        let (time_step, settings) = (self.time_step, Shared { most_rows, ..self.settings() });
        let Self { systems, events, engine, .. } = self;
        let mut systems: Vec<_> = systems.iter_mut().map(Some).collect();
        let mut engine = engine.as_deref_mut();
        let mut runs = Vec::new();
        for (number, numbers) in groups.into_iter().enumerate() {
            let own: Vec<_> = numbers.iter().filter_map(|&system| systems[system].take()).collect();
            let names: Vec<_> = own.iter().map(|system| system.name.clone()).collect();
            let settings = settings.of_group(&numbers);
            let mut run = settings.run_state::<S>(duration, &numbers, own, events, engine.take())?;
            match checkpoints.get_mut(number).and_then(Option::take) {
                None => {
                    run.mover.kinematics(&mut run.equations, &mut run.state);
                    run.equations.start_contacts(&names, &mut run.state)?;
                }
                Some(checkpoint) => {
                    let own = numbers.iter().map(|&system| rows[system].take().unwrap_or_default());
                    run.resume(checkpoint, own.collect())?;
                }
            }
            runs.push(Group { numbers, run: Box::new(run) });
        }
        Ok(Stepper::new(runs, time_step))
    }

    /// Returns the settings that all systems have in common.
    fn settings(&self) -> Shared {
        let effects = self.all_effects();
        Shared {
            effect_names: column_names(&effects),
            effects,
            orbit: self.orbit.clone(),
            gravity: self.gravity(),
            earth: self.earth.clone(),
            gravity_mode: self.gravity_mode,
            time_step: self.time_step,
            has_engine: self.engine.is_some(),
            integrator: self.integrator,
            tolerance: self.tolerance,
            rereference_beyond: self.rereference_beyond,
            record_wrenches: self.record_wrenches,
            takes_commands: self.record_wrenches && self.has_external(),
            record_every: self.record_every,
            contacts: self.contacts.clone(),
            contact_steps: self.contact_steps,
            most_rows: usize::MAX,
        }
    }

    /// Returns pairs of systems, as indices in the world, that interact although no event connects them:
    /// because they may touch, or because a control of one system waits for an event that involves the other
    /// system or tracks a frame of the other system.
    pub(super) fn links(&self) -> Vec<(usize, usize)> {
        let waiting = self.systems.iter().enumerate().flat_map(|(system, declared)| {
            declared.controls.iter().filter_map(move |control| match control.begin {
                Begin::AfterEvent(event) => Some((system, event)),
                _ => None,
            })
        });
        let links = waiting.filter_map(|(system, event)| {
            let events = self.events.get(event).map(|_| systems_of(&self.events, event))?;
            events.first().map(|first| (system, *first))
        });
        let tracks = self.systems.iter().enumerate().flat_map(|(system, declared)| {
            declared.moving_frames().map(move |moving| (system, moving.system))
        });
        let touching = self.contacts.iter().flat_map(|contact| {
            let systems = contact.systems();
            systems.windows(2).map(|pair| (pair[0], pair[1])).collect::<Vec<_>>()
        });
        links.chain(tracks).chain(touching).collect()
    }

    /// Returns the gravity field of the simulation: the given field, or by default that of the orbit or, if
    /// the orbit has none, that of a point mass. Returns `None` without a planet.
    fn gravity(&self) -> Option<Arc<Gravity>> {
        let orbit = self.orbit.as_ref()?;
        let mu = orbit.mu()?;
        let given = self.gravity.as_ref().or(orbit.gravity());
        Some(given.cloned().unwrap_or_else(|| Arc::new(Gravity::point_mass(mu))))
    }

    /// Returns true if a control follows external commands.
    fn has_external(&self) -> bool {
        let mut controls = self.systems.iter().flat_map(|system| &system.controls);
        controls.any(|control| control.law.external().is_some())
    }

    /// Returns the loads of the environment on the bodies of all systems.
    pub(super) fn environment_loads(&self) -> EnvironmentLoads {
        let models: Vec<&Model> = self.systems.iter().map(|system| &*system.model).collect();
        let numbers: Vec<usize> = (0..models.len()).collect();
        self.settings().environment_loads(&numbers, &models)
    }

    /// Returns the effects of the simulation, followed by gravity if the orbit is around a planet.
    pub(super) fn all_effects(&self) -> Vec<Arc<dyn Effect>> {
        let mut effects = self.effects.clone();
        if self.orbit.as_ref().is_some_and(|orbit| orbit.mu().is_some()) {
            effects.push(Arc::new(DifferentialGravity { gravity_mode: self.gravity_mode }));
        }
        effects
    }
}
