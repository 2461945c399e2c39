//! The push of sunlight.

use super::eight::on_lanes;
use super::shadow::sunlit;
use super::surfaces::{SurfaceError, Surfaces, not_negative};
use super::wrenches::Push;
use super::{Effect, EnvironmentError, Scene, Wrenches};
use crate::spatial::{Real, Vec3};
use nalgebra::Vector3;

/// Radiation pressure on every covered body, with its torque, and the Earth's shadow.
///
/// A face of area `A` and outward normal `n` feels `F = -P A cos θ [(1 - ρs) ŝ + 2 (ρs cos θ + ρd/3) n]` at its
/// centroid where `cos θ = n·ŝ > 0`, a cannonball `F = -P C_R A ŝ` at the centre of mass. `ŝ` points to the Sun,
/// `P = ν (Φ/c) (1 au/d)²` with the true distance `d` of the Sun and the share `ν` of its disc that the Earth leaves
/// free. No part shadows another; light from the Earth is left out.
///
/// The shadow is looked at in every stage of a step: no step ends at its edge. A penumbra (some 8 s in low orbit) is
/// smooth enough for steps of a second; long fixed steps miss its edge by a share of a step, adaptive ones shorten.
///
/// Source: Montenbruck and Gill, Satellite Orbits, Springer 2000, section 3.4.
#[derive(Clone, Debug, PartialEq)]
pub struct RadiationPressure {
    surfaces: Surfaces,
    flux: f64,
    earth_radius: Option<f64>,
}

const NAME: &str = "radiation pressure";

/// Mean solar flux at 1 au, W/m². Source: Kopp and Lean, Geophysical Research Letters 38, 2011 (1360.8).
pub const SOLAR_FLUX: f64 = 1361.0;

/// Equatorial radius of the Earth, m: what casts the shadow. Source: WGS84.
pub const SHADOW_RADIUS: f64 = 6_378_137.0;

/// Distance from the base over which the light is the same, m: a penumbra changes by 1 part in 600 over it in a low
/// orbit, where one is 60 km wide; the direction by 7e-10 rad.
const REACH: f64 = 100.0;

const ASTRONOMICAL_UNIT: f64 = 149_597_870_700.0;
const SPEED_OF_LIGHT: f64 = 299_792_458.0;

impl RadiationPressure {
    /// Light of [`SOLAR_FLUX`] on these surfaces, shadowed by an Earth of [`SHADOW_RADIUS`].
    pub fn new(surfaces: Surfaces) -> Self {
        Self { surfaces, flux: SOLAR_FLUX, earth_radius: Some(SHADOW_RADIUS) }
    }

    /// Whether a flux, W/m², and an Earth's radius, m, make sense.
    ///
    /// # Errors
    /// [`SurfaceError::Value`] where one is negative or not finite, or the radius below 100 km.
    pub fn check(flux: f64, earth_radius: f64) -> Result<(), SurfaceError> {
        not_negative("flux", flux).and(a_planets(earth_radius)).map(drop)
    }

    /// The light at `r`, with the Sun at `sun`, both from the Earth's centre, m.
    fn light(&self, r: &Vector3<f64>, sun: &Vector3<f64>) -> Light<f64> {
        let to_sun = sun - r;
        let distance = to_sun.norm();
        let share = self.earth_radius.map_or(1.0, |radius| sunlit(r, sun, radius));
        // P = ν (Φ/c) (1 au/d)²
        let ratio = ASTRONOMICAL_UNIT / distance;
        Light {
            to_sun: (to_sun / distance).into(),
            pressure: share * self.flux / SPEED_OF_LIGHT * ratio * ratio,
        }
    }

    /// The same with another flux at 1 au, W/m².
    ///
    /// # Errors
    /// [`SurfaceError::Value`] where it is negative or not finite.
    pub fn with_flux(self, flux: f64) -> Result<Self, SurfaceError> {
        Ok(Self { flux: not_negative("flux", flux)?, ..self })
    }

    /// The same with a shadow cast by an Earth of this radius, m; without shadow if none.
    ///
    /// # Errors
    /// [`SurfaceError::Value`] where it is below 100 km or not finite.
    pub fn with_shadow(self, earth_radius: Option<f64>) -> Result<Self, SurfaceError> {
        let earth_radius = earth_radius.map(a_planets).transpose()?;
        Ok(Self { earth_radius, ..self })
    }
}

/// Unit vector to the Sun, and what its light presses with, N/m².
#[derive(Clone, Copy)]
struct Light<S> {
    to_sun: Vec3<S>,
    pressure: S,
}

impl<S: Real> Light<S> {
    /// Another one on each body.
    #[inline(always)]
    fn from_lanes(light: impl Fn(usize) -> Light<f64>) -> Self {
        Self { to_sun: Vec3::from_lanes(|i| light(i).to_sun), pressure: S::from_lanes(|i| light(i).pressure) }
    }
}

fn a_planets(radius: f64) -> Result<f64, SurfaceError> {
    if radius.is_finite() && radius >= 1e5 {
        return Ok(radius);
    }
    let expected = "a radius of at least 1e5 m (in metres, not kilometres)";
    Err(SurfaceError::Value { name: "earth_radius", value: radius, expected })
}

impl Effect for RadiationPressure {
    fn name(&self) -> &str {
        NAME
    }

    fn requires_orbit(&self) -> bool {
        true
    }

    fn counts_once_on(&self, body: usize) -> bool {
        self.surfaces.cover(body)
    }

    fn acts_on_reference(&self) -> bool {
        true
    }

    fn reads_velocities(&self) -> bool {
        false
    }

    /// # Errors
    /// [`EnvironmentError::NoPlanet`], [`EnvironmentError::NoEarth`], and an Earth without epoch.
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        on_lanes!(scene.bodies.len(), S => self.add::<S>(scene, wrenches))
    }
}

impl RadiationPressure {
    fn add<S: Real>(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        let (reference, earth) = scene.reference_and_earth(NAME)?;
        let (sun, base) = (scene.sun(earth)?, scene.bodies.com_of_base());
        let at_base = self.light(&(reference.position + base), &sun);
        let near = |com: Vector3<f64>| (com - base).norm_squared() <= REACH * REACH;
        let on_each = |coms: Vec3<S>| {
            Light::<S>::from_lanes(|i| match coms.lane(i).to_nalgebra() {
                com if near(com) => at_base,
                com => self.light(&(reference.position + com), &sun),
            })
        };
        scene.push::<S>(
            wrenches,
            #[inline(always)]
            |group| {
                let Some(surfaces) = self.surfaces.around(group.first) else { return Ok(Push::nothing()) };
                let com = group.coms::<S>();
                let offset = com - Vec3::of(&base.into());
                let is_far = S::any(S::of(REACH * REACH).less(offset.dot(offset)));
                let light = if is_far { on_each(com) } else { Light::from_lanes(|_| at_base) };
                let rot_wk = group.rot_wk::<S>();
                let push = surfaces.shine(group.offset(), rot_wk.transpose_mul(light.to_sun));
                Ok(push.turned(&rot_wk) * light.pressure)
            },
        )
    }
}
