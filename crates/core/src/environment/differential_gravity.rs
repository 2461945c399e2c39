//! Gravity relative to the reference orbit: the force on each body in `W`.

use nalgebra::Vector3;

use super::body_index::BodyIndex;
use super::effect::Effect;
use super::error::EnvironmentError;
use super::scene::{Reference, Scene};
use super::soa::on_lanes;
use super::wrenches::{WrenchLanes, Wrenches};
use crate::gravity::{point_mass, tide};
use crate::spatial::{Real, Vec3};

/// Treatment of gravity relative to a reference orbit that is not in free fall (`gravity_mode` in YAML and
/// Python).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GravityMode {
    /// The robot falls in the modelled gravity, and so moves away from the reference.
    #[default]
    True,
    /// The robot moves along with the reference: only the tidal part of gravity acts on it, and the common
    /// acceleration caused by drag and radiation pressure is removed.
    Carried,
}

/// Gravity of the planet and of third bodies on every body, relative to the acceleration of the origin of
/// `W`.
///
/// `F_k = m_k [g(r_k) - r̈_ref]`, with the full field `g` and `r_k = r_ref + c_k`, where `c_k` is the centre
/// of mass of body `k` in `W`. If the reference obeys `g`, or in [`GravityMode::Carried`], the force is the
/// tide `m_k [g(r_k) - g(r_ref)]`, computed without cancellation. Each body is treated as a point mass: the
/// second-order force on an extended body is neglected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DifferentialGravity {
    /// Treatment of the part of `r̈_ref` that is not due to gravity.
    pub gravity_mode: GravityMode,
}

const NAME: &str = "gravity";

impl DifferentialGravity {
    /// Returns the residual acceleration `g(r_ref) - r̈_ref` at `t`, s, in m/s², `W` axes.
    ///
    /// The result is exactly zero for a reference in free fall, and `None` without a planet.
    ///
    /// # Errors
    /// [`EnvironmentError::Gravity`] if the field is not defined at the reference.
    pub fn residual(t: f64, reference: &Reference<'_>) -> Result<Option<Vector3<f64>>, EnvironmentError> {
        let Some(gravity) = reference.gravity else { return Ok(None) };
        if reference.in_free_fall {
            return Ok(Some(Vector3::zeros()));
        }
        let state = reference.state;
        Ok(Some(gravity.acceleration(t, &state.position)? - state.acceleration))
    }
}

impl Effect for DifferentialGravity {
    fn name(&self) -> &str {
        NAME
    }

    fn requires_orbit(&self) -> bool {
        true
    }

    fn reads_velocities(&self) -> bool {
        false
    }

    fn counts_once_on(&self, _body: BodyIndex) -> bool {
        true
    }

    /// Adds the differential gravity of every body.
    ///
    /// # Errors
    /// [`EnvironmentError::NoPlanet`] without a planet; [`EnvironmentError::InsidePlanet`] if the reference
    /// or a body is below the lowest possible ground of the planet; [`EnvironmentError::Gravity`] if the
    /// field cannot be evaluated; [`EnvironmentError::OtherBodies`] if `wrenches` belongs to different
    /// bodies.
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        on_lanes!(scene.bodies.len(), S => self.add::<S>(scene, wrenches))
    }
}

impl DifferentialGravity {
    fn add<S: Real>(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        let planet = scene.planet(NAME)?;
        let state = planet.reference;
        // use only the tide g(r) - g(r_ref), because the reference obeys g or its residual is omitted
        let tide_only = planet.in_free_fall || self.gravity_mode == GravityMode::Carried;
        let point_mass_residual = if tide_only {
            Vector3::zeros()
        } else {
            point_mass(planet.mu, &state.position) - state.acceleration
        };
        let field = scene.local_field(&planet, tide_only)?;
        let (r_ref, point_mass_residual) = (Vec3::from(state.position), Vec3::from(point_mass_residual));
        scene.add_lanes::<S>(
            wrenches,
            #[inline(always)]
            |group| {
                let com = group.coms();
                let (tide, distance) = tide(planet.mu, &r_ref, com);
                planet.check_group_above_ground(group, distance)?;
                let perturbation = match field {
                    Some(field) if tide_only => field.difference(com)?,
                    Some(field) => field.acceleration(com)?,
                    None => Vec3::zero(),
                };
                // F = m [(g0(r) - g0(r_ref)) + (g0(r_ref) - r̈_ref) + gp] with g = g0 + gp, the point mass
                // g0, and the field and third bodies gp; with tide_only, gp(r) - gp(r_ref) and no residual
                let force = (tide + Vec3::of(&point_mass_residual) + perturbation) * group.masses();
                Ok(WrenchLanes { force, torque: Vec3::zero() })
            },
        )
    }
}
