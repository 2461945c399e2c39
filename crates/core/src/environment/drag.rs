//! Drag of the air that turns with the Earth.

use super::atmosphere::{AirPlace, Atmosphere, AtmosphereError, LocalAir};
use super::surfaces::Surfaces;
use super::{Effect, EnvironmentError, Scene, Wrench};
use crate::earth::Earth;
use crate::spatial::{Fused, InstructionSet, Scalar};
use nalgebra::Vector3;
use std::sync::{Arc, Mutex, PoisonError};

/// Drag on every covered body, with its torque.
///
/// A face of area `A` and outward normal `n` feels `F = -½ ρ C_D A (n·u)₊ u` at its centroid, a cannonball
/// `F = -½ ρ C_D A |u| u` at the centre of mass. `u = v + ω × c - ω⊕ × r` is the velocity of that point in air that
/// turns with the Earth. No part shadows another.
///
/// The density is computed at points of a grid of 64 m and 1/8 s, at the one next to the robot's base, and follows the
/// scale height from there, within 160 m: wrong by at most 1e-4 of itself. For bodies farther away it is computed
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
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(air) = known.filter(|air| air.is_about(time, &centre)) {
            return Ok(air);
        }
        let made = |time: f64, r: &Vector3<f64>| LocalAir::new(&*self.atmosphere, earth, time, r);
        let air = made(time, &centre).or_else(|_| made(t, r))?;
        *known = Some(air);
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
        match InstructionSet::current() {
            InstructionSet::Baseline => self.add::<f64>(scene, wrenches),
            InstructionSet::Fused | InstructionSet::Wide => self.add::<Fused>(scene, wrenches),
        }
    }
}

impl Drag {
    /// As [`Effect::add_wrenches`], in the arithmetic of `S`.
    fn add<S: Scalar>(&self, scene: &Scene<'_>, wrenches: &mut [Wrench]) -> Result<(), EnvironmentError> {
        let (reference, earth) = scene.reference_and_earth(NAME)?;
        let near = scene.bodies.first().map_or_else(Vector3::zeros, |body| body.com);
        let air = self.local(earth, scene.time, &(reference.position + near))?;
        S::enter(
            #[inline(always)]
            || {
                for covering in self.surfaces.coverings() {
                    let (body, wrench) = scene.pair(wrenches, covering.body)?;
                    let r = reference.position + body.com;
                    let density = match air.density(&r) {
                        Some(density) => density,
                        None => self.atmosphere.density(&AirPlace::new(earth, scene.time, &r)?)?,
                    };
                    // v = ṙ - ω⊕ × r of the centre of mass,  w = ω - ω⊕
                    let v = reference.velocity + body.velocity - air.spin.cross(&r);
                    let w = body.angular_velocity - air.spin;
                    let push = covering.blow::<S>(&body.rot_wk, &v, &w);
                    wrench.force += push.force * density;
                    wrench.torque += push.torque * density;
                }
                Ok(())
            },
        )
    }
}
