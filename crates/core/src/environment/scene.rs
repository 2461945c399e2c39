//! What an effect sees of the robot and of the orbit at one instant.

use nalgebra::{Matrix3, Vector3};

use super::EnvironmentError;
use super::error::Place;
use crate::earth::Earth;
use crate::gravity::{Gravity, Nearby, Station, smallest_radius_cubed};
use crate::orbit::OrbitState;

/// One body of the robot, in `W`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Mass, kg.
    pub mass: f64,
    /// Inertia about the centre of mass in the body's own axes, kg m².
    pub inertia: Matrix3<f64>,
    /// Centre of mass, m.
    pub com: Vector3<f64>,
    /// Takes components in the body's own axes (those of its [`Node`](crate::model::Node)) to `W`.
    pub rot_wk: Matrix3<f64>,
    /// Origin of the body's axes, m.
    pub origin: Vector3<f64>,
    /// Velocity of the centre of mass, m/s; zero unless an effect [reads it](super::Effect::reads_velocities).
    pub velocity: Vector3<f64>,
    /// Angular velocity, `W` axes, rad/s; likewise.
    pub angular_velocity: Vector3<f64>,
}

/// The reference orbit at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Reference<'a> {
    /// Its state, axes of `I`; `W`'s origin is at its position.
    pub state: OrbitState,
    /// The gravity that acts on robot and reference; `None` around no planet.
    pub gravity: Option<&'a Gravity>,
    /// Whether the reference obeys just that gravity: what then remains of it are differences.
    pub falls_freely: bool,
}

/// All that an effect may look at.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// The step being integrated, s: its middle decides what is switched on.
    pub interval: (f64, f64),
    /// Instant of this evaluation, s of simulation.
    pub time: f64,
    /// The reference orbit now, where the run has one.
    pub reference: Option<Reference<'a>>,
    /// How the Earth turns, where the run says so.
    pub earth: Option<&'a Earth>,
    /// Where and when the step being integrated began: what is dear may be expanded about it.
    pub anchor: Anchor,
    /// The robot's bodies now.
    pub bodies: &'a [BodyState],
}

/// The start of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Anchor {
    /// Its instant, s of simulation.
    pub time: f64,
    /// The robot's centre of mass in `W` then, m.
    pub com: Vector3<f64>,
    /// Position of `W`'s origin then, axes of `I`, m.
    pub origin: Vector3<f64>,
}

/// Force through a body's centre of mass and torque about it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force, `W` axes, N.
    pub force: Vector3<f64>,
    /// Torque about the centre of mass, `W` axes, N m.
    pub torque: Vector3<f64>,
}

impl<'a> Scene<'a> {
    /// Middle of the step being integrated, s.
    pub fn middle(&self) -> f64 {
        0.5 * (self.interval.0 + self.interval.1)
    }

    /// Each body with its wrench.
    ///
    /// # Errors
    /// [`EnvironmentError::WrongLength`] when there is not one wrench per body.
    pub fn paired<'w>(
        &self,
        wrenches: &'w mut [Wrench],
    ) -> Result<impl Iterator<Item = (&'a BodyState, &'w mut Wrench)>, EnvironmentError> {
        let (expected, got) = (self.bodies.len(), wrenches.len());
        if expected != got {
            return Err(EnvironmentError::WrongLength { expected, got });
        }
        Ok(self.bodies.iter().zip(wrenches.iter_mut()))
    }

    /// The body with this index and its wrench.
    ///
    /// # Errors
    /// [`EnvironmentError::WrongLength`] and [`EnvironmentError::UnknownBody`].
    pub(super) fn pair<'w>(
        &self,
        wrenches: &'w mut [Wrench],
        body: usize,
    ) -> Result<(&'a BodyState, &'w mut Wrench), EnvironmentError> {
        let (expected, got) = (self.bodies.len(), wrenches.len());
        if expected != got {
            return Err(EnvironmentError::WrongLength { expected, got });
        }
        let unknown = EnvironmentError::UnknownBody { body, count: expected };
        self.bodies.get(body).zip(wrenches.get_mut(body)).ok_or(unknown)
    }

    /// State of the reference around its planet, and how the Earth turns.
    pub(super) fn reference_and_earth(
        &self,
        effect: &'static str,
    ) -> Result<(OrbitState, &'a Earth), EnvironmentError> {
        let reference = self.planet(effect)?.reference;
        Ok((reference, self.earth.ok_or(EnvironmentError::NoEarth { effect })?))
    }

    /// State of the reference and gravity of its planet, the reference being outside it.
    pub(super) fn planet(&self, effect: &'static str) -> Result<Planet<'a>, EnvironmentError> {
        let around = |r: Reference<'a>| Some((r.state, r.gravity?, r.falls_freely));
        let found = self.reference.and_then(around);
        let (reference, gravity, falls_freely) = found.ok_or(EnvironmentError::NoPlanet { effect })?;
        let minimum_cubed = smallest_radius_cubed(gravity.mu());
        let planet = Planet { effect, mu: gravity.mu(), gravity, reference, falls_freely, minimum_cubed };
        planet.outside(Place::Reference, reference.position.norm())?;
        Ok(planet)
    }

    /// Gravity without the planet's point mass, around the robot; none where that is all there is.
    pub(super) fn nearby(
        &self,
        planet: &Planet<'a>,
        differs: bool,
    ) -> Result<Option<Nearby<'a>>, EnvironmentError> {
        if planet.gravity.is_point_mass() {
            return Ok(None);
        }
        let com = center_of_mass(self.bodies);
        let now = Station { time: self.time, origin: planet.reference.position, com };
        let Anchor { time, com, origin } = self.anchor;
        Ok(planet.gravity.nearby(&now, &Station { time, origin, com }, differs)?)
    }
}

/// Centre of mass of a robot in `W`, m: `c = Σ mₖ cₖ / Σ mₖ`.
pub(crate) fn center_of_mass(bodies: &[BodyState]) -> Vector3<f64> {
    let moment: Vector3<f64> = bodies.iter().map(|body| body.com * body.mass).sum();
    moment / bodies.iter().map(|body| body.mass).sum::<f64>()
}

/// The planet of a scene, as one effect sees it.
pub(super) struct Planet<'a> {
    effect: &'static str,
    pub(super) mu: f64,
    pub(super) gravity: &'a Gravity,
    pub(super) reference: OrbitState,
    pub(super) falls_freely: bool,
    minimum_cubed: f64,
}

impl Planet<'_> {
    /// `distance` from the planet's centre, m, if it lies outside the planet.
    pub(super) fn outside(&self, what: Place, distance: f64) -> Result<f64, EnvironmentError> {
        if distance * distance * distance >= self.minimum_cubed {
            return Ok(distance);
        }
        let (effect, minimum) = (self.effect, self.minimum_cubed.cbrt());
        Err(EnvironmentError::InsidePlanet { effect, what, distance, minimum })
    }
}
