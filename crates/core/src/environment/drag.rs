//! Drag of the air that turns with the Earth.

use super::atmosphere::{AirPlace, Atmosphere, AtmosphereError, LocalAir};
use super::eight::on_lanes;
use super::surfaces::Surfaces;
use super::wrenches::Push;
use super::{Effect, EnvironmentError, Scene, Wrenches};
use crate::earth::Earth;
use crate::spatial::{Real, Vec3};
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

    fn counts_once_on(&self, body: usize) -> bool {
        self.surfaces.cover(body)
    }

    fn acts_on_reference(&self) -> bool {
        true
    }

    /// # Errors
    /// [`EnvironmentError::NoPlanet`], [`EnvironmentError::NoEarth`], what the atmosphere refuses.
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        on_lanes!(scene.bodies.len(), S => self.add::<S>(scene, wrenches))
    }
}

impl Drag {
    fn add<S: Real>(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        let (reference, earth) = scene.reference_and_earth(NAME)?;
        let base = reference.position + scene.bodies.com_of_base();
        let air = self.local(earth, scene.time, &base)?;
        let afresh = |r: Vector3<f64>| -> Result<f64, EnvironmentError> {
            Ok(self.atmosphere.density(&AirPlace::new(earth, scene.time, &r)?)?)
        };
        let (origin, velocity) = (Vec3::from(reference.position), Vec3::from(reference.velocity));
        let spin = Vec3::<S>::of(&air.spin.into());
        scene.push::<S>(
            wrenches,
            #[inline(always)]
            |group| {
                let Some(surfaces) = self.surfaces.around(group.first) else { return Ok(Push::nothing()) };
                let r = Vec3::<S>::of(&origin) + group.coms();
                let counts = |i: usize| i < group.count && self.surfaces.cover(group.first + i);
                let density = air.densities(r, counts, afresh)?;
                // v = ṙ - ω⊕ × r of the centre of mass,  w = ω - ω⊕
                let [linear, angular] = group.velocities();
                let (v, w) = (Vec3::<S>::of(&velocity) + linear - spin.cross(r), angular - spin);
                let rot_wk = group.rot_wk::<S>();
                let push = surfaces.blow(group.offset(), rot_wk.transpose_mul(v), rot_wk.transpose_mul(w));
                Ok(push.turned(&rot_wk) * density)
            },
        )
    }
}
