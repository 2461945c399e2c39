//! From the effects of the environment to wrenches on the bodies.

use super::error::SimulationError;
use super::exchange::{Base, bodies_of};
use super::guide::{Guide, Known};
use super::plant::World;
use super::rereference::{OwnReference, Shift};
use crate::dynamics::{Data, base_rotation};
use crate::earth::Earth;
use crate::environment::{
    Bodies, DifferentialGravity, Effect, EnvironmentError, Reference, Scene, Wrench, Wrenches,
};
use crate::gravity::Gravity;
use crate::model::Model;
use crate::orbit::{Numerical, Orbit, OrbitState};
use crate::spatial::{Scalar, Vec3};
use nalgebra::Vector3;
use std::ops::Range;
use std::sync::Arc;

/// The effects of a run, its reference orbit, and room to evaluate them.
#[derive(Debug)]
pub(super) struct Surroundings {
    effects: Vec<Arc<dyn Effect>>,
    reads_velocities: bool,
    /// What W's origin rides on.
    home: Option<Arc<dyn Orbit>>,
    /// What the robot is integrated about: `home`, or its own.
    guide: Guide,
    own: Option<OwnReference>,
    gravity: Option<Arc<Gravity>>,
    earth: Option<Arc<Earth>>,
    /// The step being integrated.
    interval: (f64, f64),
    bodies: Bodies,
    wrenches: Wrenches,
    /// Of effects that a reference which carries the robot along has in its own motion.
    shared: Wrenches,
    is_carried: bool,
}

impl Surroundings {
    pub(super) fn new(
        model: &Model,
        effects: Vec<Arc<dyn Effect>>,
        orbit: Option<Arc<dyn Orbit>>,
        gravity: Option<Arc<Gravity>>,
        earth: Option<Arc<Earth>>,
        is_carried: bool,
    ) -> Self {
        let count = model.nodes().len();
        Self {
            reads_velocities: effects.iter().any(|effect| effect.reads_velocities()),
            effects,
            home: orbit.clone(),
            guide: Guide::new(orbit),
            own: None,
            gravity,
            earth,
            interval: (f64::NAN, f64::NAN),
            bodies: bodies_of(model),
            wrenches: Wrenches::new(count),
            shared: Wrenches::new(count),
            is_carried,
        }
    }

    /// The reference of the robot's own, if it has one.
    pub(super) fn own(&self) -> Option<&OwnReference> {
        self.own.as_ref()
    }

    /// Follows a reference of the robot's own, which falls freely.
    pub(super) fn follow(&mut self, own: OwnReference) -> Result<(), SimulationError> {
        let (Some(gravity), Some(&time)) = (&self.gravity, own.times.last()) else { return Ok(()) };
        let orbit = Numerical::new(own.position.into(), own.velocity.into(), time, Arc::clone(gravity));
        let orbit = orbit.map_err(|source| SimulationError::Orbit { time, source })?;
        self.guide = Guide::new(Some(Arc::new(orbit)));
        self.own = Some(own);
        Ok(())
    }

    /// The way to W from where the robot is integrated, if that is elsewhere.
    pub(super) fn shift(&mut self, t: f64, mass: f64) -> Result<Option<Shift>, SimulationError> {
        if self.own.is_none() {
            return Ok(None);
        }
        let Some(state) = self.orbit_state(t)? else { return Ok(None) };
        let (Some(home), Some(own)) = (&self.home, &self.own) else { return Ok(None) };
        let home = as_it_moves(&**home, t)?;
        Ok(Some(Shift::between(own, &state, &home, mass)))
    }

    /// State of the reference at `t` with the rate of its position for a velocity, if the run has one.
    pub(super) fn origin(&self, t: f64) -> Result<Option<OrbitState>, SimulationError> {
        self.guide.orbit().map(|orbit| as_it_moves(orbit, t)).transpose()
    }

    /// State of the reference at `t`, if the run has one.
    pub(super) fn orbit_state(&mut self, t: f64) -> Result<Option<OrbitState>, SimulationError> {
        Ok(self.guide.at(t, self.interval.1)?.state)
    }

    /// Whether the reference obeys the very gravity of the run.
    fn falls_freely(&self) -> bool {
        let obeyed = self.guide.orbit().and_then(|orbit| orbit.gravity());
        obeyed.zip(self.gravity.as_ref()).is_some_and(|(own, all)| Arc::ptr_eq(own, all))
    }

    /// What of gravity the reference does not follow, m/s², where there is a planet.
    pub(super) fn residual(&mut self, t: f64) -> Result<Option<Vector3<f64>>, SimulationError> {
        let Some(state) = self.orbit_state(t)? else { return Ok(None) };
        let falls_freely = self.falls_freely();
        let reference = Reference { state, gravity: self.gravity.as_deref(), falls_freely };
        DifferentialGravity::residual(t, &reference)
            .map_err(|source| SimulationError::Environment { time: t, source })
    }

    /// Adds up what these effects do at `t` to the bodies that were looked at last.
    fn feel(&mut self, t: f64, effects: Range<usize>) -> Result<(), SimulationError> {
        self.wrenches.clear();
        if self.is_carried {
            self.shared.clear();
        }
        let falls_freely = self.falls_freely();
        let Known { state, heavens, .. } = self.guide.at(t, self.interval.1)?;
        let gravity = self.gravity.as_deref();
        let reference = state.map(|state| Reference { state, gravity, falls_freely });
        let mut scene = Scene::new(self.interval, t, &self.bodies, heavens);
        (scene.reference, scene.earth) = (reference, self.earth.as_deref()); // in place: it is large
        for effect in &self.effects[effects] {
            let is_shared = self.is_carried && effect.acts_on_reference();
            let wrenches = if is_shared { &mut self.shared } else { &mut self.wrenches };
            effect
                .add_wrenches(&scene, wrenches)
                .map_err(|source| SimulationError::Environment { time: t, source })?;
        }
        if self.is_carried {
            self.leave_out_what_is_shared()
                .map_err(|source| SimulationError::Environment { time: t, source })?;
        }
        Ok(())
    }

    /// Adds the shared wrenches less the acceleration they give the whole robot: `Fₖ − mₖ ΣF/Σm`.
    fn leave_out_what_is_shared(&mut self) -> Result<(), EnvironmentError> {
        let total: Vector3<f64> = self.shared.iter().map(|wrench| wrench.force).sum();
        let acceleration = total / self.bodies.iter().map(|body| body.mass).sum::<f64>();
        for (k, (wrench, body)) in self.shared.iter().zip(self.bodies.iter()).enumerate() {
            let force = wrench.force - acceleration * body.mass;
            self.wrenches.add(k, Wrench { force, ..wrench })?;
        }
        Ok(())
    }

    /// The wrench of one effect on each body, as they were looked at last, at `t`.
    pub(super) fn wrenches_of(&mut self, effect: usize, t: f64) -> Result<&Wrenches, SimulationError> {
        self.feel(t, effect..effect + 1)?;
        Ok(&self.wrenches)
    }
}

/// State of an orbit, its velocity the rate of its position.
fn as_it_moves(orbit: &dyn Orbit, t: f64) -> Result<OrbitState, SimulationError> {
    let moving = |state: OrbitState| {
        let velocity = orbit.rate_of_position(t, &state)?;
        Ok(OrbitState { velocity, ..state })
    };
    orbit.state(t).and_then(moving).map_err(|source| SimulationError::Orbit { time: t, source })
}

impl<S: Scalar> World<S> for Surroundings {
    fn apply(
        &mut self,
        data: &mut Data<S>,
        q: &[S],
        carried: Vec3<S>,
        t: f64,
        interval: (f64, f64),
    ) -> Result<(), SimulationError> {
        if self.effects.is_empty() {
            return Ok(());
        }
        let base = Base { rot_wb: base_rotation(q), origin: Vec3::from_slice(q), carried };
        base.look(data, self.reads_velocities, &mut self.bodies);
        self.interval = interval;
        self.feel(t, 0..self.effects.len())?;
        base.hand_over(&self.wrenches, data);
        Ok(())
    }

    fn acts(&self) -> bool {
        !self.effects.is_empty()
    }
}
