//! Derivatives of inverse dynamics.

use super::terms::{Derivatives, components};
use crate::dynamics::crba::mass_matrix;
use crate::dynamics::data::Data;
use crate::dynamics::external::{FrameWrench, apply_external};
use crate::dynamics::kinematics::kinematics;
use crate::dynamics::rnea::inverse_dynamics_recursion;
use crate::model::Model;
use crate::spatial::{Motion, Real};

/// Computes the derivatives `dq`, `dv` and `da` of [`inverse_dynamics`](crate::dynamics::inverse_dynamics)
/// with respect to `q`, `v` and `a`.
///
/// Each matrix is row major `(nv, nv)`, with the derivatives of `τ_i` in row `i`; the derivative with respect
/// to `a` is the mass matrix. The tangent space of `q` and the quantities held constant are defined in
/// [`derivatives`](super).
pub fn inverse_dynamics_derivatives<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    work: &mut Derivatives<S>,
    q: &[S],
    v: &[S],
    a: &[S],
    external: &[FrameWrench<S>],
    [dq, dv, da]: [&mut [S]; 3],
) {
    mass_matrix(model, data, q, da);
    kinematics(model, data, q, v);
    apply_external(model, data, external);
    inverse_dynamics_recursion(model, data, v, Some(a), &mut work.force);
    S::enter(
        #[inline(always)]
        || kernel(model, data, work, dq, dv),
    );
}

#[inline(always)]
fn kernel<S: Real>(model: &Model, data: &Data<S>, work: &mut Derivatives<S>, dq: &mut [S], dv: &mut [S]) {
    let (nodes, nv) = (model.nodes(), model.nv());
    work.compute_bodies(nodes, data);
    dq.fill(S::of(0.0));
    dv.fill(S::of(0.0));
    for j in (1..nodes.len()).rev() {
        for row in work.joint_columns(nodes, &data.bodies, j) {
            dq[row.index * nv + j + 5] = row.values[0];
            dv[row.index * nv + j + 5] = row.values[1];
        }
    }
    for row in work.base_columns() {
        dv[row.index * nv + 3..row.index * nv + 6].copy_from_slice(&row.values);
    }
    // ∂τ/∂v_b = 2B + M (v_b × e_m)
    let velocity = data.bodies[0].velocity;
    for j in 0..6 {
        let mut unit = [S::of(0.0); 6];
        unit[j] = S::of(1.0);
        let base_rate = velocity.cross(Motion::from_slice(&unit)); // v_b × e_m
        let force = components(work.bodies[0].inertia.momentum(base_rate));
        for i in 0..6 {
            dv[i * nv + j] += force[i];
        }
        for k in 1..nodes.len() {
            dv[(k + 5) * nv + j] += base_rate.dot(work.bodies[k].composite_force);
        }
    }
}
