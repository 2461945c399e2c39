//! Aerodynamic drag in an atmosphere that rotates with the Earth.

use super::atmosphere::{Atmosphere, AtmosphereError, AtmospherePoint, LocalAtmosphere};
use super::body_index::BodyIndex;
use super::effect::Effect;
use super::error::EnvironmentError;
use super::scene::Scene;
use super::soa::on_lanes;
use super::surfaces::Surfaces;
use super::wrenches::Wrenches;
use crate::earth::Earth;
use crate::spatial::{Real, Vec3};
use nalgebra::Vector3;
use std::sync::{Arc, Mutex, PoisonError};

/// Effect that applies drag forces and torques to every body with a surface.
///
/// The force on a face with area `A` and outward normal `n` is `F = -½ ρ C_D A (n·u)₊ u` at the centroid,
/// where `ρ` is the density, `C_D` the drag coefficient and `x₊ = max(x, 0)`. The force on a cannonball is
/// `F = -½ ρ C_D A |u| u` at the centre of mass. `u = v + ω × c - ω⊕ × r` is the velocity of this point
/// relative to an atmosphere that rotates with the Earth, at the rate `ω⊕`; `v` is the velocity of the
/// centre of mass, `ω` the angular velocity of the body, `c` the position of the point relative to the
/// centre of mass, and `r` its position relative to the Earth's centre. `u` is assumed to be uniform over
/// a face, cylinder or sphere. Parts do not shadow each other.
///
/// The density is computed at the last multiple of 1/8 s, at the point of a grid of 128 m that is nearest to
/// the base of each system, and is extrapolated with the scale height up to 160 m from that point. The
/// relative error is at most 1e-4 where the model is smooth. For bodies farther away, the model is evaluated
/// at the body. The grid point depends only on position and time.
///
/// Source: Montenbruck and Gill, Satellite Orbits, Springer 2000, section 3.5.
#[derive(Debug)]
pub struct Drag {
    atmosphere: Arc<dyn Atmosphere>,
    surfaces: Surfaces,
    /// Most recent local atmosphere of each system, which depends only on its time and centre.
    cached: Mutex<Vec<Option<LocalAtmosphere>>>,
}

const NAME: &str = "drag";

impl Drag {
    /// Creates the effect from an atmosphere and the surfaces of the bodies.
    pub fn new(atmosphere: Arc<dyn Atmosphere>, surfaces: Surfaces) -> Self {
        let cached = Mutex::new(vec![None; surfaces.system_count()]);
        Self { atmosphere, surfaces, cached }
    }

    /// Returns the local atmosphere about the grid point nearest to `r` at the last grid time, or about `r`
    /// itself at time `t`, s, if the model is not defined there. `r` is the position, axes of `I`, m, of the
    /// base of the system with index `system`.
    fn local(
        &self,
        system: usize,
        earth: &Earth,
        t: f64,
        r: &Vector3<f64>,
    ) -> Result<LocalAtmosphere, AtmosphereError> {
        let (time, centre) = LocalAtmosphere::grid_point(t, r);
        // The lock is released while the model is evaluated, because runs may share this effect.
        let cached = || self.cached.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(local) = cached()[system].filter(|local| local.is_about(time, &centre)) {
            return Ok(local);
        }
        let about = |time: f64, r: &Vector3<f64>| LocalAtmosphere::new(&*self.atmosphere, earth, time, r);
        let local = about(time, &centre).or_else(|_| about(t, r))?;
        cached()[system] = Some(local);
        Ok(local)
    }
}

impl Effect for Drag {
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

    /// Adds the drag on every body with a surface.
    ///
    /// # Errors
    /// [`EnvironmentError::NoPlanet`] and [`EnvironmentError::NoEarth`] for a scene without a planet or an
    /// Earth, [`EnvironmentError::InsidePlanet`] if the reference is below ground,
    /// [`EnvironmentError::Atmosphere`] if the density cannot be computed, and
    /// [`EnvironmentError::OtherBodies`] if `wrenches` belongs to different bodies.
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        on_lanes!(scene.bodies.len(), S => self.add::<S>(scene, wrenches))
    }
}

impl Drag {
    fn add<S: Real>(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        let (reference, earth) = scene.reference_and_earth(NAME)?;
        let model = |r: Vector3<f64>| -> Result<f64, EnvironmentError> {
            Ok(self.atmosphere.density(&AtmospherePoint::new(earth, scene.time, &r)?)?)
        };
        let (r_ref, v_ref) = (Vec3::from(reference.position), Vec3::from(reference.velocity));
        for system in self.surfaces.systems_of(scene) {
            let base = reference.position + scene.bodies.base_com(system);
            let local = self.local(system.number, earth, scene.time, &base)?;
            let earth_rate = Vec3::<S>::of(&local.earth_rate.into());
            self.surfaces.add_lanes::<S>(
                scene,
                system,
                wrenches,
                #[inline(always)]
                |surfaces, group| {
                    let r = Vec3::<S>::of(&r_ref) + group.coms();
                    let counts = |i: usize| i < group.count && self.surfaces.covers(group.body(i));
                    let density = local.densities(r, counts, model)?;
                    // velocities relative to the atmosphere: v = ṙ - ω⊕ × r of the centre of mass, w = ω - ω⊕
                    let [linear, angular] = group.velocities();
                    let (v, w) = (Vec3::<S>::of(&v_ref) + linear - earth_rate.cross(r), angular - earth_rate);
                    let rot_wk = group.rot_wk::<S>();
                    let (v_k, w_k) = (rot_wk.transpose_mul(v), rot_wk.transpose_mul(w));
                    Ok(surfaces.drag(group.offset(), v_k, w_k).rotated(&rot_wk) * density)
                },
            )?;
        }
        Ok(())
    }
}
