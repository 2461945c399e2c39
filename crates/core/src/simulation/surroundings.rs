//! From the effects of the environment to wrenches on the bodies.

use super::error::SimulationError;
use super::plant::World;
use super::rereference::{OwnReference, Shift};
use crate::dynamics::{Data, base_rotation};
use crate::earth::Earth;
use crate::environment::{BodyState, DifferentialGravity, Effect, Instant, Reference, Scene, Wrench};
use crate::gravity::Gravity;
use crate::model::{Model, Node};
use crate::orbit::{Numerical, Orbit, OrbitState};
use crate::spatial::{Force, Mat3, Scalar, Vec3};
use nalgebra::{Matrix3, Vector3};
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
    orbit: Option<Arc<dyn Orbit>>,
    own: Option<OwnReference>,
    gravity: Option<Arc<Gravity>>,
    earth: Option<Arc<Earth>>,
    /// The step being integrated.
    interval: (f64, f64),
    /// The last instants asked for: the stages of a step share them.
    known: [Known; 3],
    bodies: Vec<BodyState>,
    wrenches: Vec<Wrench>,
    /// Of effects that a reference which carries the robot along has in its own motion.
    shared: Vec<Wrench>,
    is_carried: bool,
}

/// An instant, with the state of the reference there.
#[derive(Clone, Debug)]
struct Known {
    time: f64,
    state: Option<OrbitState>,
    instant: Instant,
}

impl Known {
    fn new(time: f64, state: Option<OrbitState>) -> Self {
        Self { time, state, instant: Instant::default() }
    }

    fn nothing() -> [Self; 3] {
        std::array::from_fn(|_| Self::new(f64::NAN, None))
    }
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
        let at_rest = |node: &Node| BodyState {
            mass: node.mass,
            inertia: node.about_com.to_nalgebra(),
            com: Vector3::zeros(),
            rot_wk: Matrix3::identity(),
            origin: Vector3::zeros(),
            velocity: Vector3::zeros(),
            angular_velocity: Vector3::zeros(),
        };
        Self {
            reads_velocities: effects.iter().any(|effect| effect.reads_velocities()),
            effects,
            home: orbit.clone(),
            orbit,
            own: None,
            gravity,
            earth,
            interval: (f64::NAN, f64::NAN),
            known: Known::nothing(),
            bodies: model.nodes().iter().map(at_rest).collect(),
            wrenches: vec![Wrench::default(); model.nodes().len()],
            shared: vec![Wrench::default(); model.nodes().len()],
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
        self.orbit = Some(Arc::new(orbit.map_err(|source| SimulationError::Orbit { time, source })?));
        self.known = Known::nothing();
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
        self.orbit.as_ref().map(|orbit| as_it_moves(&**orbit, t)).transpose()
    }

    /// State of the reference at `t`, if the run has one.
    pub(super) fn orbit_state(&mut self, t: f64) -> Result<Option<OrbitState>, SimulationError> {
        self.look_up(t)?;
        Ok(self.known[0].state)
    }

    /// Puts what is known of an instant first.
    fn look_up(&mut self, t: f64) -> Result<(), SimulationError> {
        if let Some(place) = self.known.iter().position(|known| known.time == t) {
            self.known[..=place].rotate_right(1);
            return Ok(());
        }
        let state = self.orbit.as_ref().map(|orbit| orbit.state(t)).transpose();
        let state = state.map_err(|source| SimulationError::Orbit { time: t, source })?;
        self.known.rotate_right(1);
        self.known[0] = Known::new(t, state);
        Ok(())
    }

    /// Whether the reference obeys the very gravity of the run.
    fn falls_freely(&self) -> bool {
        let obeyed = self.orbit.as_ref().and_then(|orbit| orbit.gravity());
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
        self.look_up(t)?;
        self.wrenches.fill(Wrench::default());
        if self.is_carried {
            self.shared.fill(Wrench::default());
        }
        let falls_freely = self.falls_freely();
        let Known { state, instant, .. } = &self.known[0];
        let gravity = self.gravity.as_deref();
        let reference = state.map(|state| Reference { state, gravity, falls_freely });
        let scene = Scene::new(self.interval, t, &self.bodies, instant)
            .beside(reference)
            .above(self.earth.as_deref());
        for effect in &self.effects[effects] {
            let is_shared = self.is_carried && effect.acts_on_reference();
            let wrenches = if is_shared { &mut self.shared } else { &mut self.wrenches };
            effect
                .add_wrenches(&scene, wrenches)
                .map_err(|source| SimulationError::Environment { time: t, source })?;
        }
        if self.is_carried {
            self.leave_out_what_is_shared();
        }
        Ok(())
    }

    /// Adds the shared wrenches less the acceleration they give the whole robot: `Fₖ − mₖ ΣF/Σm`.
    fn leave_out_what_is_shared(&mut self) {
        let total: Vector3<f64> = self.shared.iter().map(|wrench| wrench.force).sum();
        let acceleration = total / self.bodies.iter().map(|body| body.mass).sum::<f64>();
        for ((to, from), body) in self.wrenches.iter_mut().zip(&self.shared).zip(&self.bodies) {
            to.force += from.force - acceleration * body.mass;
            to.torque += from.torque;
        }
    }

    /// The wrench of one effect on each body, as they were looked at last, at `t`.
    pub(super) fn wrenches_of(&mut self, effect: usize, t: f64) -> Result<&[Wrench], SimulationError> {
        self.feel(t, effect..effect + 1)?;
        Ok(&self.wrenches)
    }

    /// Fills in what the effects see; returns `R_wb`.
    #[inline(always)]
    fn look<S: Scalar>(&mut self, data: &Data<S>, q: &[S], carried: Vec3<S>) -> Mat3<S> {
        let (rot_wb, origin) = (base_rotation(q), Vec3::from_slice(q));
        for (seen, body) in self.bodies.iter_mut().zip(&data.bodies) {
            seen.com = (rot_wb * body.com_b + origin).to_nalgebra();
            seen.rot_wk = (rot_wb * body.rot_bk).to_nalgebra();
            seen.origin = (rot_wb * body.pos_b + origin).to_nalgebra();
            if self.reads_velocities {
                seen.velocity = (rot_wb * body.velocity.at(body.com_b) + carried).to_nalgebra();
                seen.angular_velocity = (rot_wb * body.velocity.angular).to_nalgebra();
            }
        }
        rot_wb
    }

    /// Turns the wrenches to base axes and adds them to the bodies.
    #[inline(always)]
    fn hand_over<S: Scalar>(&self, data: &mut Data<S>, rot_wb: &Mat3<S>) {
        let vector = |v: &Vector3<f64>| Vec3::new(S::of(v.x), S::of(v.y), S::of(v.z));
        for (body, wrench) in data.bodies.iter_mut().zip(&self.wrenches) {
            let force = rot_wb.transpose_mul(vector(&wrench.force));
            let torque = rot_wb.transpose_mul(vector(&wrench.torque));
            body.external = Force::at(force, torque, body.com_b);
        }
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
        let rot_wb = S::enter(
            #[inline(always)]
            || self.look(data, q, carried),
        );
        self.interval = interval;
        self.feel(t, 0..self.effects.len())?;
        S::enter(
            #[inline(always)]
            || self.hand_over(data, &rot_wb),
        );
        Ok(())
    }
}
