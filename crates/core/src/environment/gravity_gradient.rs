//! Torque of the field on each extended body.

use super::eight::on_lanes;
use super::wrenches::Push;
use super::{Effect, EnvironmentError, Scene, Wrenches};
use crate::spatial::{Real, Sym3, Vec3};

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

    fn counts_once_on(&self, _body: usize) -> bool {
        true
    }

    /// # Errors
    /// [`EnvironmentError::NoPlanet`], [`EnvironmentError::InsidePlanet`] and [`EnvironmentError::Gravity`].
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        on_lanes!(scene.bodies.len(), S => self.add::<S>(scene, wrenches))
    }
}

impl GravityGradient {
    fn add<S: Real>(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        let planet = scene.planet(NAME)?;
        let field = scene.nearby(&planet, planet.falls_freely)?;
        let origin = Vec3::from(planet.reference.position);
        scene.push::<S>(
            wrenches,
            #[inline(always)]
            |group| {
                let com = group.coms();
                let r = Vec3::<S>::of(&origin) + com;
                let square = r.dot(r);
                let distance = square.sqrt();
                planet.all_outside(group, distance)?;
                // G = (3μ/r³) r̂ r̂ᵀ + Gp;  what is left out, -(μ/r³) 1, turns nothing;  T = (3μ/r³) r̂ × I r̂ of the first
                let inverse = distance * (S::of(1.0) / square); // root and quotient at the same time
                let up = r * inverse;
                let rate = S::of(3.0 * planet.mu) * inverse * inverse * inverse;
                let (rot_wk, inertia) = (group.rot_wk(), group.inertias());
                let torque_k = match field {
                    Some(field) => {
                        let g = field.gradient(com)?.add_outer(up, rate);
                        torque(&g.rotate(&rot_wk.transpose()), &inertia)
                    }
                    None => {
                        let up_k = rot_wk.transpose_mul(up);
                        up_k.cross(inertia * up_k) * rate
                    }
                };
                Ok(Push { force: Vec3::zero(), torque: rot_wk * torque_k })
            },
        )
    }
}

/// Torque of a field with gradient `G` about the centre of mass, N m; gradient, inertia and torque in the same axes.
///
/// `T_i = ∫ ε_ijk x_j G_kl x_l dm = -ε_ijk (I G)_jk`, since `∫ x xᵀ dm = ½ tr(I) 1 - I` and `G` is symmetric:
/// `T = Σ e_k × I G e_k`.
#[inline(always)]
fn torque<S: Real>(g: &Sym3<S>, inertia: &Sym3<S>) -> Vec3<S> {
    let x = *inertia * Vec3::new(g.xx, g.xy, g.xz);
    let y = *inertia * Vec3::new(g.xy, g.yy, g.yz);
    let z = *inertia * Vec3::new(g.xz, g.yz, g.zz);
    Vec3::new(y.z - z.y, z.x - x.z, x.y - y.x)
}
