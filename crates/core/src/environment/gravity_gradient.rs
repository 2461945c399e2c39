//! Torque of the field on each extended body.

use nalgebra::{Matrix3, Vector3};

use super::error::Place;
use super::scene::BodyState;
use super::{Effect, EnvironmentError, Scene, Wrench};
use crate::spatial::{Mat3, Sym3, Vec3};

/// Gravity-gradient torque of each body about its own centre of mass, at its own position.
///
/// `T_i = -ε_ijk (I G)_jk`, `G` the gradient of the full field there and `I` the inertia about the centre of
/// mass, kg m²; for a point mass `T = (3μ/r³) r̂ × I r̂`, `r` running from its centre to the body's
/// centre of mass. All in `W` axes. The force that goes with the body's
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
    /// [`EnvironmentError::NoPlanet`], [`EnvironmentError::InsidePlanet`] and [`EnvironmentError::Gravity`].
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut [Wrench]) -> Result<(), EnvironmentError> {
        let planet = scene.planet(NAME)?;
        for (k, (body, wrench)) in scene.paired(wrenches)?.enumerate() {
            let r = planet.reference.position + body.com;
            let distance = planet.outside(Place::Body(k), r.norm())?;
            wrench.torque += towards(planet.mu, body, &r, distance);
        }
        if let Some(field) = scene.nearby(&planet, planet.falls_freely)? {
            for (body, wrench) in scene.paired(wrenches)? {
                wrench.torque += torque(&field.gradient(&body.com)?, body);
            }
        }
        Ok(())
    }
}

/// The torque of a point mass, `r` and `distance` from it: `(3μ/r³) R (r̂_k × I r̂_k)`, with `r̂_k = Rᵀ r̂` in body axes,
/// where `I` is constant.
#[inline]
fn towards(mu: f64, body: &BodyState, r: &Vector3<f64>, distance: f64) -> Vector3<f64> {
    let inverse = 1.0 / distance;
    let (rot_wk, inertia) = (Mat3::from(body.rot_wk), Sym3::from(body.inertia));
    let up_k = rot_wk.transpose_mul(Vec3::from(*r)) * inverse;
    let torque_k = up_k.cross(inertia * up_k) * (3.0 * mu * inverse * inverse * inverse);
    (rot_wk * torque_k).to_nalgebra()
}

/// The torque of a field with gradient `G`, `W` axes, on a body about its centre of mass, N m, `W` axes.
///
/// `T_i = ∫ ε_ijk x_j G_kl x_l dm = -ε_ijk (I G)_jk`, since `∫ x xᵀ dm = ½ tr(I) 1 - I` and `G` is symmetric.
pub(super) fn torque(gradient: &Matrix3<f64>, body: &BodyState) -> Vector3<f64> {
    // in body axes, where I is constant
    let product = body.inertia * (body.rot_wk.tr_mul(gradient) * body.rot_wk);
    let axial = |j: usize, k: usize| product[(k, j)] - product[(j, k)];
    body.rot_wk * Vector3::new(axial(1, 2), axial(2, 0), axial(0, 1))
}
