//! Gravity-gradient torque on each extended body.

use super::body_index::BodyIndex;
use super::effect::Effect;
use super::error::EnvironmentError;
use super::scene::Scene;
use super::soa::on_lanes;
use super::wrenches::{WrenchLanes, Wrenches};
use crate::spatial::{Real, Sym3, Vec3};

/// Effect that applies the gravity-gradient torque to each body, about its centre of mass.
///
/// `T_i = -ε_ijk (I G)_jk`, with the permutation symbol `ε_ijk`, the gradient `G` of the full field at the
/// body, 1/s², and the inertia `I` about the centre of mass, kg m². In the field of a point mass with the
/// gravitational parameter `μ`, the torque is `T = (3μ/r³) r̂ × I r̂`, with `r` from the planet's centre to
/// the centre of mass of the body. All quantities are in `W` axes. The motion of an articulated robot also
/// requires the force on each body, which [`super::DifferentialGravity`] computes.
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

    fn counts_once_on(&self, _body: BodyIndex) -> bool {
        true
    }

    /// Adds the gravity-gradient torque of every body.
    ///
    /// # Errors
    /// [`EnvironmentError::NoPlanet`] without a planet, [`EnvironmentError::InsidePlanet`] if the reference
    /// or a body is below ground, [`EnvironmentError::Gravity`] if the field cannot be evaluated, and
    /// [`EnvironmentError::OtherBodies`] if `wrenches` belongs to different bodies.
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        on_lanes!(scene.bodies.len(), S => self.add::<S>(scene, wrenches))
    }
}

impl GravityGradient {
    fn add<S: Real>(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        let planet = scene.planet(NAME)?;
        let field = scene.local_field(&planet, planet.in_free_fall)?;
        let r_ref = Vec3::from(planet.reference.position);
        scene.add_lanes::<S>(
            wrenches,
            #[inline(always)]
            |group| {
                let com = group.coms();
                let r = Vec3::<S>::of(&r_ref) + com;
                let square = r.dot(r);
                let distance = square.sqrt();
                planet.check_group_above_ground(group, distance)?;
                let inverse = distance * (S::of(1.0) / square); // 1/r; root and quotient are independent
                let up = r * inverse;
                let three_mu_over_r3 = S::of(3.0 * planet.mu) * inverse * inverse * inverse;
                let (rot_wk, inertia) = (group.rot_wk(), group.inertias());
                let torque_k = match field {
                    Some(field) => {
                        // G = (3μ/r³) r̂ r̂ᵀ + Gp; the term -(μ/r³) 1 causes no torque and is omitted
                        let g = field.gradient(com)?.add_outer(up, three_mu_over_r3);
                        torque(&g.rotate(&rot_wk.transpose()), &inertia)
                    }
                    None => {
                        let up_k = rot_wk.transpose_mul(up);
                        // T = (3μ/r³) r̂ × I r̂
                        up_k.cross(inertia * up_k) * three_mu_over_r3
                    }
                };
                Ok(WrenchLanes { force: Vec3::zero(), torque: rot_wk * torque_k })
            },
        )
    }
}

/// Returns the torque, N m, about the centre of mass in a field with the gradient `g`, `G`, on a body with
/// the given `inertia`, `I`; all quantities are in the same axes.
///
/// `T_i = ∫ ε_ijk x_j G_kl x_l dm = -ε_ijk (I G)_jk` with the position `x` from the centre of mass, since
/// `∫ x xᵀ dm = ½ tr(I) 1 - I` with the unit matrix `1`, and `G` is symmetric. In vectors, with the unit
/// vectors `e_k`: `T = Σ e_k × I G e_k`.
#[inline(always)]
fn torque<S: Real>(g: &Sym3<S>, inertia: &Sym3<S>) -> Vec3<S> {
    let x = *inertia * Vec3::new(g.xx, g.xy, g.xz);
    let y = *inertia * Vec3::new(g.xy, g.yy, g.yz);
    let z = *inertia * Vec3::new(g.xz, g.yz, g.zz);
    Vec3::new(y.z - z.y, z.x - x.z, x.y - y.x)
}
