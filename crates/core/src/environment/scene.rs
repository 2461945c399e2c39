//! Scene in which effects are evaluated: robots, reference orbit and Earth at one instant.

use nalgebra::Vector3;

use super::bodies::Bodies;
use super::body_block::LaneGroup;
use super::body_index::SystemRows;
use super::error::{EnvironmentError, ScenePoint};
use super::wrenches::{WrenchLanes, Wrenches};
use crate::earth::Earth;
use crate::gravity::{FieldPoint, Gravity, LocalField, Sky, lowest_ground_cubed};
use crate::orbit::OrbitState;
use crate::spatial::Real;
use std::cell::OnceCell;

/// State of the reference orbit at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Reference<'a> {
    /// State of the reference, axes of `I`; the origin of `W` is at its position.
    pub state: &'a OrbitState,
    /// Gravity that acts on the robots and the reference; `None` without a planet.
    pub gravity: Option<&'a Gravity>,
    /// True if the reference is in free fall in exactly this gravity, so that only differences of gravity act
    /// in `W`.
    pub in_free_fall: bool,
}

/// Cache of quantities that depend only on the instant and the reference. They are computed on first use
/// and shared by the stages and steps that evaluate this instant.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ephemeris {
    sky: OnceCell<Sky>,
    sun: OnceCell<Vector3<f64>>,
}

impl Ephemeris {
    /// Clears all values, which is required before the instant or the reference changes.
    pub(crate) fn clear(&mut self) {
        self.sky.take();
        self.sun.take();
    }
}

/// State of robots, reference orbit and Earth at one instant.
#[derive(Clone, Debug)]
pub struct Scene<'a> {
    /// Start and end of the step being integrated, s; its middle determines which wrenches are active.
    pub interval: (f64, f64),
    /// Simulation time of this evaluation, s.
    pub time: f64,
    /// Reference orbit at this instant; `None` if the run has none.
    pub reference: Option<Reference<'a>>,
    /// Earth with its rotation; `None` if the run has no Earth.
    pub earth: Option<&'a Earth>,
    /// States of the bodies at this instant.
    pub bodies: &'a Bodies,
    ephemeris: &'a Ephemeris,
    /// Local gravity fields shared by the effects: the first for accelerations, the second for differences
    /// from the reference.
    local_fields: [OnceCell<LocalField<'a>>; 2],
}

impl Scene<'_> {
    /// Calls `evaluate` with the scene of `bodies` at `time`, s, within a step over `interval` (start and
    /// end, s), and returns its result.
    ///
    /// Runs evaluate their effects in this way at every stage of a step.
    pub fn with<R>(
        interval: (f64, f64),
        time: f64,
        bodies: &Bodies,
        reference: Option<Reference<'_>>,
        earth: Option<&Earth>,
        evaluate: impl FnOnce(&Scene<'_>) -> R,
    ) -> R {
        let ephemeris = Ephemeris::default();
        evaluate(&Scene { reference, earth, ..Scene::new(interval, time, bodies, &ephemeris) })
    }
}

impl<'a> Scene<'a> {
    /// Creates a scene without a reference orbit and without an Earth; `ephemeris` must belong to `time`
    /// and to the reference that is set later.
    pub(crate) fn new(interval: (f64, f64), time: f64, bodies: &'a Bodies, ephemeris: &'a Ephemeris) -> Self {
        let local_fields = Default::default();
        Self { interval, time, reference: None, earth: None, bodies, ephemeris, local_fields }
    }

    /// Returns the middle of the step being integrated, s.
    pub fn middle(&self) -> f64 {
        0.5 * (self.interval.0 + self.interval.1)
    }

    /// Adds to `wrenches` the wrenches that `wrench_of` returns for each group of bodies, one body per lane
    /// of `S`.
    ///
    /// # Errors
    /// [`EnvironmentError::OtherBodies`] if `wrenches` belongs to different bodies; the errors of
    /// `wrench_of`.
    #[inline(always)]
    pub(super) fn add_lanes<S: Real>(
        &self,
        wrenches: &mut Wrenches,
        wrench_of: impl Fn(&LaneGroup<'a>) -> Result<WrenchLanes<S>, EnvironmentError>,
    ) -> Result<(), EnvironmentError> {
        self.add_lanes_to(self.bodies.systems(), wrenches, wrench_of)
    }

    /// Adds wrenches to the bodies of some systems, as [`Scene::add_lanes`] does for all systems.
    #[inline(always)]
    pub(super) fn add_lanes_to<S: Real>(
        &self,
        systems: &[SystemRows],
        wrenches: &mut Wrenches,
        wrench_of: impl Fn(&LaneGroup<'a>) -> Result<WrenchLanes<S>, EnvironmentError>,
    ) -> Result<(), EnvironmentError> {
        if self.bodies.layout != wrenches.layout {
            let (expected, got) = (self.bodies.layout.to_string(), wrenches.layout.to_string());
            return Err(EnvironmentError::OtherBodies { expected, got });
        }
        S::enter(
            #[inline(always)]
            || {
                for system in systems {
                    for group in self.bodies.groups::<S>(*system) {
                        wrenches.add_lanes(group.row, wrench_of(&group)?);
                    }
                }
                Ok(())
            },
        )
    }

    /// Returns the state of the reference orbit and the Earth, or an error if the scene has no planet or no
    /// Earth, or if the reference is below ground.
    pub(super) fn reference_and_earth(
        &self,
        effect: &'static str,
    ) -> Result<(OrbitState, &'a Earth), EnvironmentError> {
        let reference = self.planet(effect)?.reference;
        Ok((*reference, self.earth.ok_or(EnvironmentError::NoEarth { effect })?))
    }

    /// Returns the planet of the reference orbit, or an error if there is none or the reference is below
    /// ground.
    pub(super) fn planet(&self, effect: &'static str) -> Result<Planet<'a>, EnvironmentError> {
        let found = self.reference.and_then(|reference| Some((reference, reference.gravity?)));
        let (Reference { state, in_free_fall, .. }, gravity) =
            found.ok_or(EnvironmentError::NoPlanet { effect })?;
        let (mu, minimum_cubed) = (gravity.mu(), lowest_ground_cubed(gravity.mu()));
        let planet = Planet { effect, mu, gravity, reference: state, in_free_fall, minimum_cubed };
        planet.check_above_ground(ScenePoint::Reference, state.position.norm())?;
        Ok(planet)
    }

    /// Returns the gravity near the robot, excluding the planet's point mass; `None` if there is only the
    /// point mass.
    ///
    /// With `tide_only`, the result also provides the difference from the gravity at the reference, which is
    /// the tide.
    pub(super) fn local_field(
        &self,
        planet: &Planet<'a>,
        tide_only: bool,
    ) -> Result<Option<&LocalField<'a>>, EnvironmentError> {
        if planet.gravity.is_point_mass() {
            return Ok(None);
        }
        let expand = || -> Result<LocalField<'a>, EnvironmentError> {
            let OrbitState { position, velocity, .. } = *planet.reference;
            let travel = velocity.norm() * (self.interval.1 - self.interval.0);
            let (time, r_ref, com) = (self.time, position.into(), self.bodies.center_of_mass());
            let sky = get_or_try_init(&self.ephemeris.sky, || planet.gravity.sky(time, r_ref))?;
            let point = FieldPoint { time, r_ref, com, travel };
            Ok(planet.gravity.local_field(&point, sky, tide_only)?)
        };
        get_or_try_init(&self.local_fields[usize::from(tide_only)], expand).map(Some)
    }

    /// Returns the position of the Sun from the Earth's centre, axes of `I`, m.
    pub(super) fn sun(&self, earth: &Earth) -> Result<Vector3<f64>, EnvironmentError> {
        Ok(*get_or_try_init(&self.ephemeris.sun, || earth.sun(self.time))?)
    }
}

/// Returns the value of the cell, which is computed and stored first if the cell is empty.
fn get_or_try_init<T, E>(cell: &OnceCell<T>, compute: impl FnOnce() -> Result<T, E>) -> Result<&T, E> {
    match cell.get() {
        Some(value) => Ok(value),
        None => compute().map(|value| cell.get_or_init(|| value)),
    }
}

/// Planet of a scene, with the name of the effect for which it is evaluated.
pub(super) struct Planet<'a> {
    effect: &'static str,
    pub(super) mu: f64,
    pub(super) gravity: &'a Gravity,
    pub(super) reference: &'a OrbitState,
    pub(super) in_free_fall: bool,
    minimum_cubed: f64,
}

impl Planet<'_> {
    /// Returns an error if a body of `group` is below ground; `distance` holds the bodies' distances from
    /// the planet's centre, m.
    #[inline(always)]
    pub(super) fn check_group_above_ground<S: Real>(
        &self,
        group: &LaneGroup<'_>,
        distance: S,
    ) -> Result<(), EnvironmentError> {
        if S::any((distance * distance * distance).less(S::of(self.minimum_cubed))) {
            for i in 0..group.count {
                self.check_above_ground(ScenePoint::Body(group.body(i)), distance.lane(i))?;
            }
        }
        Ok(())
    }

    /// Returns an error if a point at `distance` from the planet's centre, m, is certainly below ground.
    pub(super) fn check_above_ground(&self, what: ScenePoint, distance: f64) -> Result<(), EnvironmentError> {
        if distance * distance * distance >= self.minimum_cubed {
            return Ok(());
        }
        let (effect, minimum) = (self.effect, self.minimum_cubed.cbrt());
        Err(EnvironmentError::InsidePlanet { effect, what, distance, minimum })
    }
}
