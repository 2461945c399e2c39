//! Solar radiation pressure.

use super::body_index::BodyIndex;
use super::effect::Effect;
use super::error::EnvironmentError;
use super::scene::Scene;
use super::shadow::sunlit;
use super::soa::on_lanes;
use super::surfaces::{SurfaceError, Surfaces, not_negative};
use super::wrenches::Wrenches;
use crate::spatial::{Real, Vec3};
use nalgebra::Vector3;

/// Effect that applies the force and torque of sunlight to every body with a surface, reduced in the shadow
/// of the Earth.
///
/// The force on a face with area `A` and outward normal `n` is `F = -P A cos θ [(1 - ρs) ŝ + 2 (ρs cos θ +
/// ρd/3) n]` at the centroid if `cos θ = n·ŝ > 0`, with the fractions `ρs` and `ρd` of the light that are
/// reflected specularly and diffusely. The force on a cannonball with the cross-section `A` and the
/// reflectivity `C_R` is `F = -P C_R A ŝ` at the centre of mass. The unit vector `ŝ` points to the Sun. `P =
/// ν (Φ/c) (1 au/d)²` with the flux `Φ` at 1 au, the speed of light `c`, the distance `d` of the Sun, and the
/// fraction `ν` of the solar disc that the Earth does not occult. Parts do not shadow each other. Light
/// reflected by the Earth is neglected.
///
/// The shadow is evaluated at every stage of a step; steps do not end at its edge. A penumbra, which takes
/// about 8 s in a low orbit, is smooth enough for steps of 1 s. Longer fixed steps resolve the penumbra only
/// coarsely; adaptive steps become shorter there.
///
/// Source: Montenbruck and Gill, Satellite Orbits, Springer 2000, section 3.4.
#[derive(Clone, Debug, PartialEq)]
pub struct RadiationPressure {
    surfaces: Surfaces,
    flux: f64,
    earth_radius: Option<f64>,
}

const NAME: &str = "radiation pressure";

/// Mean solar flux at 1 au, W/m², rounded. Source: Kopp and Lean, Geophysical Research Letters 38, 2011, who
/// give 1360.8 W/m².
pub const SOLAR_FLUX: f64 = 1361.0;

/// Equatorial radius of the Earth, which is used for the shadow, m. Source: WGS84.
pub const SHADOW_RADIUS: f64 = 6_378_137.0;

/// Distance from the centre of mass of the base within which the light is assumed to be uniform, m.
///
/// Within this distance, in a low orbit with a penumbra 60 km wide, `ν` changes by at most 1/600 and the
/// direction of the light by at most 7e-10 rad.
const UNIFORM_RADIUS: f64 = 100.0;

const ASTRONOMICAL_UNIT: f64 = 149_597_870_700.0;
const SPEED_OF_LIGHT: f64 = 299_792_458.0;

impl RadiationPressure {
    /// Creates the effect for these surfaces, with the flux [`SOLAR_FLUX`] and the shadow of an Earth with
    /// [`SHADOW_RADIUS`].
    pub fn new(surfaces: Surfaces) -> Self {
        Self { surfaces, flux: SOLAR_FLUX, earth_radius: Some(SHADOW_RADIUS) }
    }

    /// Checks a flux, W/m², and a radius of the Earth, m.
    ///
    /// # Errors
    /// [`SurfaceError::Value`] if a value is negative or not finite, or if the radius is below 100 km.
    pub fn check(flux: f64, earth_radius: f64) -> Result<(), SurfaceError> {
        not_negative("flux", flux).and(planet_radius(earth_radius)).map(drop)
    }

    /// Returns the unit vector to the Sun and the radiation pressure, N/m², at `r`, with the Sun at `sun`;
    /// both positions are from the Earth's centre, axes of `I`, m.
    fn light(&self, r: &Vector3<f64>, sun: &Vector3<f64>) -> Light<f64> {
        let to_sun = sun - r;
        let distance = to_sun.norm();
        let fraction = self.earth_radius.map_or(1.0, |radius| sunlit(r, sun, radius));
        // P = ν (Φ/c) (1 au/d)²
        let ratio = ASTRONOMICAL_UNIT / distance;
        Light {
            to_sun: (to_sun / distance).into(),
            pressure: fraction * self.flux / SPEED_OF_LIGHT * ratio * ratio,
        }
    }

    /// Returns the same effect with a different flux at 1 au, W/m².
    ///
    /// # Errors
    /// [`SurfaceError::Value`] if `flux` is negative or not finite.
    pub fn with_flux(self, flux: f64) -> Result<Self, SurfaceError> {
        Ok(Self { flux: not_negative("flux", flux)?, ..self })
    }

    /// Returns the same effect with the shadow of an Earth of the given radius, m; `None` disables the
    /// shadow.
    ///
    /// # Errors
    /// [`SurfaceError::Value`] if the radius is below 100 km or not finite.
    pub fn with_shadow(self, earth_radius: Option<f64>) -> Result<Self, SurfaceError> {
        let earth_radius = earth_radius.map(planet_radius).transpose()?;
        Ok(Self { earth_radius, ..self })
    }
}

/// Unit vector to the Sun, and radiation pressure, N/m².
#[derive(Clone, Copy)]
struct Light<S> {
    to_sun: Vec3<S>,
    pressure: S,
}

impl<S: Real> Light<S> {
    /// Stores the light that reaches several bodies, one body per lane; `light(i)` returns the light of lane
    /// `i`.
    #[inline(always)]
    fn from_lanes(light: impl Fn(usize) -> Light<f64>) -> Self {
        Self { to_sun: Vec3::from_lanes(|i| light(i).to_sun), pressure: S::from_lanes(|i| light(i).pressure) }
    }
}

/// Returns `radius`, m, or an error if it is below 100 km or not finite.
fn planet_radius(radius: f64) -> Result<f64, SurfaceError> {
    if radius.is_finite() && radius >= 1e5 {
        return Ok(radius);
    }
    let expected = "a finite radius of at least 1e5 m (in metres, not kilometres)";
    Err(SurfaceError::Value { name: "earth_radius", value: radius, expected })
}

impl Effect for RadiationPressure {
    fn name(&self) -> &str {
        NAME
    }

    fn requires_orbit(&self) -> bool {
        true
    }

    fn acts_on(&self, system: usize) -> bool {
        self.surfaces.covers_system(system)
    }

    fn counts_once_on(&self, body: BodyIndex) -> bool {
        self.surfaces.covers(body)
    }

    fn acts_on_reference(&self) -> bool {
        true
    }

    fn reads_velocities(&self) -> bool {
        false
    }

    /// Adds the radiation pressure on every body with a surface.
    ///
    /// # Errors
    /// [`EnvironmentError::NoPlanet`] and [`EnvironmentError::NoEarth`] for a scene without a planet or an
    /// Earth, [`EnvironmentError::InsidePlanet`] if the reference is below ground,
    /// [`EnvironmentError::Earth`] without an epoch or outside the span of the Sun's positions, and
    /// [`EnvironmentError::OtherBodies`] if `wrenches` belongs to different bodies.
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        on_lanes!(scene.bodies.len(), S => self.add::<S>(scene, wrenches))
    }
}

impl RadiationPressure {
    fn add<S: Real>(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        let (reference, earth) = scene.reference_and_earth(NAME)?;
        let sun = scene.sun(earth)?;
        for system in self.surfaces.systems_of(scene) {
            let base = scene.bodies.base_com(system);
            let at_base = self.light(&(reference.position + base), &sun);
            let near = |com: Vector3<f64>| (com - base).norm_squared() <= UNIFORM_RADIUS * UNIFORM_RADIUS;
            let on_each = |coms: Vec3<S>| {
                Light::<S>::from_lanes(|i| match coms.lane(i).to_nalgebra() {
                    com if near(com) => at_base,
                    com => self.light(&(reference.position + com), &sun),
                })
            };
            self.surfaces.add_lanes::<S>(
                scene,
                system,
                wrenches,
                #[inline(always)]
                |surfaces, group| {
                    let com = group.coms::<S>();
                    let offset = com - Vec3::of(&base.into());
                    let is_far = S::any(S::of(UNIFORM_RADIUS * UNIFORM_RADIUS).less(offset.dot(offset)));
                    let light = if is_far { on_each(com) } else { Light::from_lanes(|_| at_base) };
                    let rot_wk = group.rot_wk::<S>();
                    let to_sun_k = rot_wk.transpose_mul(light.to_sun);
                    Ok(surfaces.pressure(group.offset(), to_sun_k).rotated(&rot_wk) * light.pressure)
                },
            )?;
        }
        Ok(())
    }
}
