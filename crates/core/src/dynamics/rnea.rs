//! Inverse dynamics: the forces behind a motion (recursive Newton-Euler).

use super::data::Data;
use super::external::{FrameWrench, apply_external};
use super::kinematics::kinematics;
use crate::model::Model;
use crate::spatial::{Motion, Real};

/// Generalized forces `M a + c − Σ Jᵀ F` that give the acceleration `a`.
///
/// `q`: `(nq,)`; `v`, `a`, `tau` (out): `(nv,)`; `tau[..6]` is the wrench on the base in its axes.
///
/// Source: Featherstone, Rigid Body Dynamics Algorithms, 2008, Table 5.1.
pub fn inverse_dynamics<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    q: &[S],
    v: &[S],
    a: &[S],
    external: &[FrameWrench<S>],
    tau: &mut [S],
) {
    kinematics(model, data, q, v);
    apply_external(model, data, external);
    inverse_dynamics_recursion(model, data, v, Some(a), tau);
}

/// Bias forces less external wrenches, `c − Σ Jᵀ F`, with `c(q, v)` Coriolis and centrifugal:
/// inverse dynamics at `a = 0`. `c` (out): `(nv,)`.
pub fn bias_forces<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    q: &[S],
    v: &[S],
    external: &[FrameWrench<S>],
    c: &mut [S],
) {
    kinematics(model, data, q, v);
    apply_external(model, data, external);
    inverse_dynamics_recursion(model, data, v, None, c);
}

/// [`inverse_dynamics`] after [`kinematics`], with the external wrenches in `data`; no `a` is zero.
pub fn inverse_dynamics_recursion<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    v: &[S],
    a: Option<&[S]>,
    tau: &mut [S],
) {
    S::enter(
        #[inline(always)]
        || match a {
            Some(a) => kernel(model, data, v, |k| a[k + 5], Motion::from_slice(a), tau),
            None => kernel(model, data, v, |_| S::of(0.0), Motion::zero(), tau),
        },
    );
}

#[inline(always)]
fn kernel<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    v: &[S],
    joint_acceleration: impl Fn(usize) -> S,
    base_acceleration: Motion<S>,
    tau: &mut [S],
) {
    let nodes = model.nodes();
    let bodies = &mut data.bodies[..nodes.len()];
    bodies[0].acceleration = base_acceleration;
    for k in 0..nodes.len() {
        let (done, rest) = bodies.split_at_mut(k);
        let body = &mut rest[0];
        if k > 0 {
            // a_k = a_p + v_k × S q̇ + S q̈
            let carried = done[nodes[k].parent].acceleration + body.velocity.cross(body.subspace * v[k + 5]);
            body.acceleration = body.subspace.scale_add(joint_acceleration(k), carried);
        }
        // f_k = I a + v ×* I v − F
        body.force = body.inertia.momentum(body.acceleration)
            + body.velocity.cross_force(body.inertia.momentum(body.velocity))
            - body.external;
    }
    for k in (1..nodes.len()).rev() {
        let node = &nodes[k];
        let force = bodies[k].force;
        // τ_k = Sᵀ f_k + rotor q̈
        tau[k + 5] = joint_acceleration(k).mul_add(S::of(node.rotor_inertia), bodies[k].subspace.dot(force));
        bodies[node.parent].force += force;
    }
    bodies[0].force.write(tau);
}
