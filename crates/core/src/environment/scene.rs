//! What an effect sees of the robot and of the orbit at one instant.

use nalgebra::Vector3;

use super::EnvironmentError;
use super::bodies::Bodies;
use super::eight_bodies::Group;
use super::error::Place;
use super::wrenches::{Push, Wrenches};
use crate::earth::Earth;
use crate::gravity::{Gravity, Nearby, Sky, Station, lowest_ground_cubed};
use crate::orbit::OrbitState;
use crate::spatial::Real;
use std::cell::OnceCell;

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

/// What depends on the instant and the reference alone, found at the first look: stages of a step, and steps, share it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Heavens {
    sky: OnceCell<Sky>,
    sun: OnceCell<Vector3<f64>>,
}

impl Heavens {
    /// Nothing is known any more: they stand for another time or place.
    pub(crate) fn forget(&mut self) {
        self.sky.take();
        self.sun.take();
    }
}

/// All that an effect may look at.
#[derive(Clone, Debug)]
pub struct Scene<'a> {
    /// The step being integrated, s: its middle decides what is switched on.
    pub interval: (f64, f64),
    /// Instant of this evaluation, s of simulation.
    pub time: f64,
    /// The reference orbit now, where the run has one.
    pub reference: Option<Reference<'a>>,
    /// How the Earth turns, where the run says so.
    pub earth: Option<&'a Earth>,
    /// The robot's bodies now.
    pub bodies: &'a Bodies,
    heavens: &'a Heavens,
    /// What effects look at one after the other: the field by itself, and where differences are asked for.
    near: [OnceCell<Nearby<'a>>; 2],
}

impl Scene<'_> {
    /// Shows effects the bodies at `time` in a step over `interval`, s, beside a reference orbit and above an Earth where
    /// there are: what a run does at every stage of a step.
    pub fn show<R>(
        interval: (f64, f64),
        time: f64,
        bodies: &Bodies,
        reference: Option<Reference<'_>>,
        earth: Option<&Earth>,
        look: impl FnOnce(&Scene<'_>) -> R,
    ) -> R {
        let heavens = Heavens::default();
        look(&Scene { reference, earth, ..Scene::new(interval, time, bodies, &heavens) })
    }
}

impl<'a> Scene<'a> {
    /// The bodies at `time` in a step over `interval`; no orbit, no Earth. `heavens` are those of that time and reference.
    pub(crate) fn new(interval: (f64, f64), time: f64, bodies: &'a Bodies, heavens: &'a Heavens) -> Self {
        Self { interval, time, reference: None, earth: None, bodies, heavens, near: Default::default() }
    }

    /// Middle of the step being integrated, s.
    pub fn middle(&self) -> f64 {
        0.5 * (self.interval.0 + self.interval.1)
    }

    /// Adds what acts on the bodies, found for as many at once as `S` has lanes.
    ///
    /// # Errors
    /// [`EnvironmentError::WrongLength`] when there is not one wrench per body, and what `push` says.
    #[inline(always)]
    pub(super) fn push<S: Real>(
        &self,
        wrenches: &mut Wrenches,
        push: impl Fn(&Group<'a>) -> Result<Push<S>, EnvironmentError>,
    ) -> Result<(), EnvironmentError> {
        let (expected, got) = (self.bodies.len(), wrenches.len());
        if expected != got {
            return Err(EnvironmentError::WrongLength { expected, got });
        }
        S::enter(
            #[inline(always)]
            || {
                for group in self.bodies.groups::<S>() {
                    wrenches.add_lanes(group.first, push(&group)?);
                }
                Ok(())
            },
        )
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
        let minimum_cubed = lowest_ground_cubed(gravity.mu());
        let planet = Planet { effect, mu: gravity.mu(), gravity, reference, falls_freely, minimum_cubed };
        planet.outside(Place::Reference, reference.position.norm())?;
        Ok(planet)
    }

    /// Gravity without the planet's point mass, around the robot; none where that is all there is.
    pub(super) fn nearby(
        &self,
        planet: &Planet<'a>,
        differs: bool,
    ) -> Result<Option<&Nearby<'a>>, EnvironmentError> {
        if planet.gravity.is_point_mass() {
            return Ok(None);
        }
        let near = || -> Result<Nearby<'a>, EnvironmentError> {
            let OrbitState { position, velocity, .. } = planet.reference;
            let travel = velocity.norm() * (self.interval.1 - self.interval.0);
            let (time, origin, com) = (self.time, position.into(), self.bodies.center_of_mass());
            let sky = found(&self.heavens.sky, || planet.gravity.sky(time, origin))?;
            let station = Station { time, origin, com, travel };
            Ok(planet.gravity.nearby(&station, sky, differs)?)
        };
        found(&self.near[usize::from(differs)], near).map(Some)
    }

    /// Position of the Sun from the Earth's centre, axes of `I`, m.
    pub(super) fn sun(&self, earth: &Earth) -> Result<Vector3<f64>, EnvironmentError> {
        Ok(*found(&self.heavens.sun, || earth.sun(self.time))?)
    }
}

/// What the cell holds, or is given now.
fn found<T, E>(cell: &OnceCell<T>, find: impl FnOnce() -> Result<T, E>) -> Result<&T, E> {
    match cell.get() {
        Some(known) => Ok(known),
        None => find().map(|it| cell.get_or_init(|| it)),
    }
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
    /// Refuses bodies that are below ground; `distance` from its centre, m.
    #[inline(always)]
    pub(super) fn all_outside<S: Real>(
        &self,
        group: &Group<'_>,
        distance: S,
    ) -> Result<(), EnvironmentError> {
        if S::any((distance * distance * distance).less(S::of(self.minimum_cubed))) {
            for (i, k) in (group.first..).take(group.count).enumerate() {
                self.outside(Place::Body(k), distance.lane(i))?;
            }
        }
        Ok(())
    }

    /// Refuses a `distance` from the planet's centre, m, at which all is ground.
    pub(super) fn outside(&self, what: Place, distance: f64) -> Result<(), EnvironmentError> {
        if distance * distance * distance >= self.minimum_cubed {
            return Ok(());
        }
        let (effect, minimum) = (self.effect, self.minimum_cubed.cbrt());
        Err(EnvironmentError::InsidePlanet { effect, what, distance, minimum })
    }
}
