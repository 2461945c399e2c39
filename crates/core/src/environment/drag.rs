//! Drag of the air that turns with the Earth.

use super::atmosphere::{AirPlace, Atmosphere, AtmosphereError, LocalAir};
use super::lanes::{OneByOne, add_push};
use super::surfaces::Surfaces;
use super::{Effect, EnvironmentError, Scene, Wrench};
use crate::earth::Earth;
use crate::spatial::{Scalar, Vec3};
use nalgebra::Vector3;
use std::sync::{Arc, Mutex, PoisonError};

/// Drag on every covered body, with its torque.
///
/// A face of area `A` and outward normal `n` feels `F = -½ ρ C_D A (n·u)₊ u` at its centroid, a cannonball
/// `F = -½ ρ C_D A |u| u` at the centre of mass. `u = v + ω × c - ω⊕ × r` is the velocity of that point in air that
/// turns with the Earth, the same all over a face, tube or ball. No part shadows another.
///
/// The density is computed at points of a grid of 128 m and 1/8 s, at the one next to the robot's base, and follows the
/// scale height from there, within 160 m: wrong by at most 1e-4 of itself where the model is smooth. For bodies farther away it is computed
/// afresh. Which point it is follows from place and time alone.
///
/// Source: Montenbruck and Gill, Satellite Orbits, Springer 2000, section 3.5.
#[derive(Debug)]
pub struct Drag {
    atmosphere: Arc<dyn Atmosphere>,
    surfaces: Surfaces,
    /// The last local air: a pure function of its own time and centre.
    known: Mutex<Option<LocalAir>>,
}

const NAME: &str = "drag";

impl Drag {
    /// Drag of this air on these surfaces.
    pub fn new(atmosphere: Arc<dyn Atmosphere>, surfaces: Surfaces) -> Self {
        Self { atmosphere, surfaces, known: Mutex::new(None) }
    }

    /// The air about the point of the grid next to `r`, or about `r` itself at the edge of a model.
    fn local(&self, earth: &Earth, t: f64, r: &Vector3<f64>) -> Result<LocalAir, AtmosphereError> {
        let (time, centre) = LocalAir::grid_point(t, r);
        // not held while the model is evaluated: other runs may share it
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(air) = known().filter(|air| air.is_about(time, &centre)) {
            return Ok(air);
        }
        let made = |time: f64, r: &Vector3<f64>| LocalAir::new(&*self.atmosphere, earth, time, r);
        let air = made(time, &centre).or_else(|_| made(t, r))?;
        *known() = Some(air);
        Ok(air)
    }
}

impl Effect for Drag {
    fn name(&self) -> &str {
        NAME
    }

    fn requires_orbit(&self) -> bool {
        true
    }

    fn acts_on_reference(&self) -> bool {
        true
    }

    /// # Errors
    /// [`EnvironmentError::NoPlanet`], [`EnvironmentError::NoEarth`], what the atmosphere refuses.
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut [Wrench]) -> Result<(), EnvironmentError> {
        self.add_one_by_one(scene, wrenches)
    }
}

impl OneByOne for Drag {
    fn add<S: Scalar>(&self, scene: &Scene<'_>, wrenches: &mut [Wrench]) -> Result<(), EnvironmentError> {
        let (reference, earth) = scene.reference_and_earth(NAME)?;
        let near = scene.bodies.first().map_or_else(Vector3::zeros, |body| body.com);
        let air = self.local(earth, scene.time, &(reference.position + near))?;
        let afresh = |r: Vector3<f64>| -> Result<f64, EnvironmentError> {
            Ok(self.atmosphere.density(&AirPlace::new(earth, scene.time, &r)?)?)
        };
        let (origin, velocity) = (Vec3::from(reference.position), Vec3::from(reference.velocity));
        let spin = Vec3::<S>::of(&air.spin.into());
        S::enter(
            #[inline(always)]
            || {
                for (group, wrenches) in scene.groups::<S>(wrenches)? {
                    let Some(surface) = self.surfaces.of_body(group.first) else { continue };
                    let r = Vec3::<S>::of(&origin) + group.vectors(|body| &body.com);
                    let density = air.densities(r, afresh)?;
                    // v = ṙ - ω⊕ × r of the centre of mass,  w = ω - ω⊕
                    let v = Vec3::<S>::of(&velocity) + group.vectors(|body| &body.velocity) - spin.cross(r);
                    let w = group.vectors(|body| &body.angular_velocity) - spin;
                    let rot_wk = group.rot_wk::<S>();
                    let push = surface.blow(rot_wk.transpose_mul(v), rot_wk.transpose_mul(w));
                    add_push(wrenches, push.turned(&rot_wk) * density);
                }
                Ok(())
            },
        )
    }
}
