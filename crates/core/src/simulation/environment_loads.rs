//! Computation of the wrenches that environment effects exert on the bodies of all systems.

use super::body_states::{LoadedSystem, bodies_of};
use super::error::SimulationError;
use super::external_loads::ExternalLoads;
use super::local_reference::{LocalReference, Shift};
use super::members::{Members, Place};
use super::reference_cache::{Instant, ReferenceCache};
use super::state::State;
use super::tree::Tree;
use super::wrench_commands::WrenchCommands;
use crate::earth::Earth;
use crate::environment::{
    Bodies, DifferentialGravity, Effect, EnvironmentError, GravityMode, Reference, Scene, Wrench, Wrenches,
};
use crate::gravity::Gravity;
use crate::model::Model;
use crate::orbit::{Numerical, Orbit, OrbitState};
use crate::spatial::Scalar;
use nalgebra::Vector3;
use std::ops::Range;
use std::sync::Arc;

/// Environment effects on all systems of a run, the reference orbit, and the workspace for the evaluation of
/// the effects.
#[derive(Debug)]
pub(super) struct EnvironmentLoads {
    effects: Vec<Arc<dyn Effect>>,
    /// Wrenches that the caller of the stepper has commanded.
    pub(super) commands: WrenchCommands,
    reads_velocities: bool,
    /// Orbit on which the origin of W moves; `None` for a run without an orbit.
    reference: Option<Arc<dyn Orbit>>,
    /// Reference orbit in free fall that replaces `reference` after the robot has drifted far from it; `None`
    /// before.
    local_reference: Option<LocalReference>,
    /// Cached states of the current reference orbit, which is either `reference` or the local reference
    /// orbit.
    cache: ReferenceCache,
    gravity: Option<Arc<Gravity>>,
    /// True if the current reference orbit is in free fall in exactly the gravity field of the run.
    in_free_fall: bool,
    earth: Option<Arc<Earth>>,
    gravity_mode: GravityMode,
    /// Start and end of the current step, s.
    interval: (f64, f64),
    bodies: Bodies,
    wrenches: Wrenches,
    /// Wrenches of the effects that also act on the reference orbit. Used only in `Carried` mode.
    common: Wrenches,
}

impl EnvironmentLoads {
    /// Creates the loads of `effects` on the bodies of systems, given by their indices in the world and their
    /// models.
    pub(super) fn new(
        (numbers, models): (&[usize], &[&Model]),
        effects: Vec<Arc<dyn Effect>>,
        orbit: Option<Arc<dyn Orbit>>,
        gravity: Option<Arc<Gravity>>,
        earth: Option<Arc<Earth>>,
        gravity_mode: GravityMode,
    ) -> Self {
        let bodies = bodies_of(numbers, models);
        Self {
            reads_velocities: effects.iter().any(|effect| effect.reads_velocities()),
            effects,
            commands: WrenchCommands::default(),
            in_free_fall: orbit.as_deref().is_some_and(|orbit| obeys(orbit, gravity.as_ref())),
            reference: orbit.clone(),
            local_reference: None,
            cache: ReferenceCache::new(orbit),
            gravity,
            earth,
            gravity_mode,
            interval: (f64::NAN, f64::NAN),
            wrenches: Wrenches::on(&bodies),
            common: Wrenches::on(&bodies),
            bodies,
        }
    }

    /// Returns the local reference orbit about which the robot is integrated, if there is one.
    pub(super) fn local_reference(&self) -> Option<&LocalReference> {
        self.local_reference.as_ref()
    }

    /// Sets `local`, an orbit in free fall, as the current reference orbit. Without a gravity field, does
    /// nothing.
    pub(super) fn set_local_reference(&mut self, local: LocalReference) -> Result<(), SimulationError> {
        let (Some(gravity), Some(&time)) = (&self.gravity, local.times.last()) else { return Ok(()) };
        let orbit = Numerical::new(local.position.into(), local.velocity.into(), time, Arc::clone(gravity));
        let orbit = orbit.map_err(|source| SimulationError::Orbit { time, source })?;
        self.in_free_fall = obeys(&orbit, self.gravity.as_ref());
        self.cache = ReferenceCache::new(Some(Arc::new(orbit)));
        self.local_reference = Some(local);
        Ok(())
    }

    /// Returns the transformation at `t`, s, of the state of the robot `model` from the frame of its local
    /// reference orbit to W; `None` if there is no local reference orbit.
    pub(super) fn shift(&mut self, t: f64, model: &Model) -> Result<Option<Shift>, SimulationError> {
        if self.local_reference.is_none() {
            return Ok(None);
        }
        let Some(state) = self.reference_state(t)? else { return Ok(None) };
        let (Some(reference), Some(local)) = (&self.reference, &self.local_reference) else {
            return Ok(None);
        };
        let (reference, rate) = state_and_rate(&**reference, t)?;
        Ok(Some(Shift::between(local, &state, &reference, rate, model.mass())))
    }

    /// Returns true if the run has a reference orbit.
    pub(super) fn has_orbit(&self) -> bool {
        self.cache.orbit().is_some()
    }

    /// Returns the state of the current reference orbit at `t`, s, in which the velocity is the time
    /// derivative of the position; `None` without an orbit.
    pub(super) fn origin_state(&self, t: f64) -> Result<Option<OrbitState>, SimulationError> {
        let found = self.cache.orbit().map(|orbit| state_and_rate(orbit, t)).transpose()?;
        Ok(found.map(|(state, velocity)| OrbitState { velocity, ..state }))
    }

    /// Returns the state of the current reference orbit at `t`, s; `None` without an orbit.
    pub(super) fn reference_state(&mut self, t: f64) -> Result<Option<OrbitState>, SimulationError> {
        if !self.has_orbit() {
            return Ok(None);
        }
        Ok(self.cache.at(t, self.interval.1)?.state)
    }

    /// Returns the difference between the gravity at the reference orbit and the acceleration of that orbit,
    /// `g(r_ref) − r̈_ref`, at `t`, s, in m/s², W axes; `None` without an orbit or a planet.
    pub(super) fn reference_residual(&mut self, t: f64) -> Result<Option<Vector3<f64>>, SimulationError> {
        let Some(state) = self.reference_state(t)? else { return Ok(None) };
        let in_free_fall = self.in_free_fall;
        let reference = Reference { state: &state, gravity: self.gravity.as_deref(), in_free_fall };
        DifferentialGravity::residual(t, &reference)
            .map_err(|source| SimulationError::Environment { time: t, source })
    }

    /// Writes to `self.wrenches` the sum of the wrenches of the effects with these indices on `self.bodies`
    /// at `t`, s.
    fn sum_effects(&mut self, t: f64, effects: Range<usize>) -> Result<(), SimulationError> {
        let is_carried = self.gravity_mode == GravityMode::Carried;
        self.wrenches.clear();
        if is_carried {
            self.common.clear();
        }
        let in_free_fall = self.in_free_fall;
        let Instant { state, ephemeris, .. } = self.cache.at(t, self.interval.1)?;
        let gravity = self.gravity.as_deref();
        let reference = state.as_ref().map(|state| Reference { state, gravity, in_free_fall });
        let mut scene = Scene::new(self.interval, t, &self.bodies, ephemeris);
        // assigned in place, because the scene is large
        (scene.reference, scene.earth) = (reference, self.earth.as_deref());
        for effect in &self.effects[effects] {
            let is_common = is_carried && effect.acts_on_reference();
            let wrenches = if is_common { &mut self.common } else { &mut self.wrenches };
            effect
                .add_wrenches(&scene, wrenches)
                .map_err(|source| SimulationError::Environment { time: t, source })?;
        }
        if is_carried {
            self.add_relative_to_reference()
                .map_err(|source| SimulationError::Environment { time: t, source })?;
        }
        Ok(())
    }

    /// Adds the common wrenches to `self.wrenches` without the part that accelerates all bodies equally: each
    /// force `Fₖ` becomes `Fₖ − mₖ ΣF/Σm`, with the masses `mₖ` of the bodies.
    fn add_relative_to_reference(&mut self) -> Result<(), EnvironmentError> {
        let total: Vector3<f64> = self.common.iter().map(|wrench| wrench.force).sum();
        let acceleration = total / self.bodies.iter().map(|(_, body)| body.mass).sum::<f64>();
        for (wrench, (index, body)) in self.common.iter().zip(self.bodies.iter()) {
            // Fₖ − mₖ ΣF/Σm
            let force = wrench.force - acceleration * body.mass;
            self.wrenches.add(index, Wrench { force, ..wrench })?;
        }
        Ok(())
    }

    /// Adds the commanded wrenches on `self.bodies` at `t`, s, to `self.wrenches`.
    fn add_commands(&mut self, t: f64) -> Result<(), SimulationError> {
        let added = self.commands.add_to(&self.bodies, &mut self.wrenches);
        added.map_err(|source| SimulationError::Environment { time: t, source })
    }

    /// Returns the number of effects.
    pub(super) fn effect_count(&self) -> usize {
        self.effects.len()
    }

    /// Returns the wrench of one effect on each body at `t`, s, for the body states gathered last. The index
    /// after the last effect selects the commanded wrenches.
    pub(super) fn wrenches_of(&mut self, effect: usize, t: f64) -> Result<&Wrenches, SimulationError> {
        let count = self.effects.len();
        self.sum_effects(t, effect.min(count)..(effect + 1).min(count))?;
        if effect >= count {
            self.add_commands(t)?;
        }
        Ok(&self.wrenches)
    }
}

/// Returns true if an orbit is in free fall in exactly this gravity field.
fn obeys(orbit: &dyn Orbit, gravity: Option<&Arc<Gravity>>) -> bool {
    orbit.gravity().zip(gravity).is_some_and(|(own, all)| Arc::ptr_eq(own, all))
}

/// Returns the state of an orbit at `t`, s, and the time derivative of its position, m/s, which may differ
/// from the velocity in that state.
fn state_and_rate(orbit: &dyn Orbit, t: f64) -> Result<(OrbitState, Vector3<f64>), SimulationError> {
    let with_rate = |state| orbit.rate_of_position(t, &state).map(|rate| (state, rate));
    orbit.state(t).and_then(with_rate).map_err(|source| SimulationError::Orbit { time: t, source })
}

impl EnvironmentLoads {
    /// Computes the wrenches of the effects on the bodies of `systems` at `t`, s, in a step over `interval`,
    /// s, and writes them to the data of the systems. `systems` must contain all systems of these loads.
    /// Without effects, does nothing.
    pub(super) fn apply_to<S: Scalar>(
        &mut self,
        systems: &mut [LoadedSystem<'_, S>],
        t: f64,
        interval: (f64, f64),
    ) -> Result<(), SimulationError> {
        if self.effects.is_empty() {
            return Ok(());
        }
        for (number, system) in systems.iter().enumerate() {
            system.gather_bodies(number, self.reads_velocities, &mut self.bodies);
        }
        self.interval = interval;
        self.sum_effects(t, 0..self.effects.len())?;
        for (number, system) in systems.iter_mut().enumerate() {
            system.scatter_wrenches(number, &self.wrenches);
        }
        Ok(())
    }
}

impl<S: Scalar> ExternalLoads<S> for EnvironmentLoads {
    #[inline(never)]
    fn apply(
        &mut self,
        trees: &mut [Tree<'_, S>],
        members: &mut Members<'_, S>,
        state: &State<S>,
        t: f64,
        interval: (f64, f64),
    ) -> Result<(), SimulationError> {
        members.follow(trees, &state.trees);
        let Members { places, parts } = members;
        for (number, place) in places.iter().enumerate() {
            let system = match *place {
                Place::Tree(tree) => trees[tree].loaded(&state.trees[tree].q),
                Place::Part(part) => parts[part].loaded(),
            };
            system.gather_bodies(number, self.reads_velocities, &mut self.bodies);
        }
        self.interval = interval;
        self.sum_effects(t, 0..self.effects.len())?;
        self.add_commands(t)?;
        for (number, place) in places.iter().enumerate() {
            let mut system = match *place {
                Place::Tree(tree) => trees[tree].loaded(&state.trees[tree].q),
                Place::Part(part) => parts[part].loaded(),
            };
            system.scatter_wrenches(number, &self.wrenches);
        }
        parts.iter().for_each(|part| trees[part.tree].data.clear_external());
        parts.iter().for_each(|part| part.add_wrenches_to(&mut trees[part.tree]));
        Ok(())
    }

    fn is_active(&self) -> bool {
        !(self.effects.is_empty() && self.commands.is_empty())
    }
}
