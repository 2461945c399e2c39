//! Torque of a spherical planet's field on each extended body.

use super::error::Place;
use super::{Effect, EnvironmentError, Scene, Wrench};
use crate::spatial::{Mat3, Sym3, Vec3};

/// Gravity-gradient torque of each body about its own centre of mass, at its own position.
///
/// `T = (3μ/r³) r̂ × I r̂`, all in `W` axes; `r` runs from the planet's centre to the body's centre
/// of mass and `I` is the inertia about that, in kg m². The force that goes with the body's
/// place is [`super::DifferentialGravity`]: an articulated robot needs both.
///
/// Source: Hughes, Spacecraft Attitude Dynamics, Wiley 1986, section 8.1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GravityGradient;

const NAME: &str = "gravity gradient";

impl Effect for GravityGradient {
    fn name(&self) -> &str {
        NAME
    }

    fn requires_orbit(&self) -> bool {
        true
    }

    fn reads_velocities(&self) -> bool {
        false
    }

    /// # Errors
    /// [`EnvironmentError::NoPlanet`] and [`EnvironmentError::InsidePlanet`].
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut [Wrench]) -> Result<(), EnvironmentError> {
        let planet = scene.planet(NAME)?;
        for (k, (body, wrench)) in scene.paired(wrenches)?.enumerate() {
            let r = planet.reference.position + body.com;
            let distance = planet.outside(Place::Body(k), r.norm())?;
            let inverse = 1.0 / distance;
            // T = (3μ/r³) R (r̂_k × I r̂_k), with r̂_k = Rᵀ r̂ in body axes, where I is constant
            let (rot_wk, inertia) = (Mat3::from(body.rot_wk), Sym3::from(body.inertia));
            let up_k = rot_wk.transpose_mul(Vec3::from(r)) * inverse;
            let torque_k = up_k.cross(inertia * up_k) * (3.0 * planet.mu * inverse * inverse * inverse);
            wrench.torque += (rot_wk * torque_k).to_nalgebra();
        }
        Ok(())
    }
}
