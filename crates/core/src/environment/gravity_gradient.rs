//! Torque of the field on each extended body.

use nalgebra::{Matrix3, Vector3};

use super::error::Place;
use super::{Effect, EnvironmentError, Scene, Wrench};
use crate::spatial::{Fused, InstructionSet, Mat3, Scalar, Sym3, Vec3};

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
        match InstructionSet::current() {
            InstructionSet::Baseline => add::<f64>(scene, wrenches),
            InstructionSet::Fused | InstructionSet::Wide => add::<Fused>(scene, wrenches),
        }
    }
}

/// [`GravityGradient::add_wrenches`] in the arithmetic of `S`.
fn add<S: Scalar>(scene: &Scene<'_>, wrenches: &mut [Wrench]) -> Result<(), EnvironmentError> {
    let planet = scene.planet(NAME)?;
    let field = scene.nearby(&planet, planet.falls_freely)?;
    S::enter(
        #[inline(always)]
        || {
            for (k, (body, wrench)) in scene.paired(wrenches)?.enumerate() {
                let r = planet.reference.position + body.com;
                let distance = planet.outside(Place::Body(k), r.norm())?;
                let rot_wk = Mat3::<S>::of(&Mat3::from(body.rot_wk));
                let inertia = Sym3::<S>::of(&Sym3::from(body.inertia));
                let mut torque_k = towards(planet.mu, &inertia, &rot_wk, &r, distance);
                if let Some(field) = &field {
                    torque_k += of_field(&field.gradient(&body.com)?, &inertia, &rot_wk);
                }
                wrench.torque += (rot_wk * torque_k).to_nalgebra();
            }
            Ok(())
        },
    )
}

/// The torque of a point mass, `r` and `distance` from it: `(3μ/r³) r̂_k × I r̂_k`, with `r̂_k = Rᵀ r̂` in body axes,
/// where `I` is constant.
#[inline(always)]
fn towards<S: Scalar>(
    mu: f64,
    inertia: &Sym3<S>,
    rot_wk: &Mat3<S>,
    r: &Vector3<f64>,
    distance: f64,
) -> Vec3<S> {
    let inverse = 1.0 / distance;
    let up_k = rot_wk.transpose_mul(Vec3::of(&Vec3::from(*r))) * S::of(inverse);
    up_k.cross(*inertia * up_k) * S::of(3.0 * mu * inverse * inverse * inverse)
}

/// The torque of a field with gradient `G`, `W` axes, about the centre of mass, N m, body axes.
///
/// `T_i = ∫ ε_ijk x_j G_kl x_l dm = -ε_ijk (I G)_jk`, since `∫ x xᵀ dm = ½ tr(I) 1 - I` and `G` is symmetric:
/// `T = Σ e_k × I G e_k`.
#[inline(always)]
fn of_field<S: Scalar>(gradient: &Matrix3<f64>, inertia: &Sym3<S>, rot_wk: &Mat3<S>) -> Vec3<S> {
    let g = Sym3::<S>::of(&Sym3::from(*gradient)).rotate(&rot_wk.transpose());
    let x = *inertia * Vec3::new(g.xx, g.xy, g.xz);
    let y = *inertia * Vec3::new(g.xy, g.yy, g.yz);
    let z = *inertia * Vec3::new(g.xz, g.yz, g.zz);
    Vec3::new(y.z - z.y, z.x - x.z, x.y - y.x)
}
