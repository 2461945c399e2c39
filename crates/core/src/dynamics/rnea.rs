//! Inverse dynamics: the recursive Newton-Euler algorithm (RNEA).

use super::data::{BodyData, Data};
use super::external::{FrameWrench, apply_external};
use super::kinematics::kinematics;
use super::passes::{leaf_to_root, root_to_leaf};
use super::subspace::{add_joint_motion, joint_effort, velocity_product};
use crate::model::{Model, Node};
use crate::spatial::{Force, Motion, Real};

/// Computes the generalized forces `τ = M a + c − Σ Jᵀ F` for the acceleration `a` and external wrenches `F`.
///
/// `q`: `(nq,)`; `v`, `a`, `tau` (out): `(nv,)`; `tau[..6]` is the wrench on the base, about its origin in
/// base axes, N and N m.
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

/// Computes the bias forces `c − Σ Jᵀ F`: Coriolis and centrifugal forces `c(q, v)` minus the generalized
/// forces of the external wrenches.
///
/// The result, `(nv,)`, N and N m, is written to the argument `c` and equals inverse dynamics at `a = 0`.
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

/// Computes [`inverse_dynamics`] with the external wrenches stored in `data`; if `a` is `None`, it is zero.
/// Requires up-to-date [`kinematics`] in `data`.
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
            Some(a) => kernel(model, data, v, Some(a), tau), // compiled separately for `Some` and `None`
            None => kernel(model, data, v, None, tau),
        },
    );
}

#[inline(always)]
fn kernel<S: Real>(model: &Model, data: &mut Data<S>, v: &[S], a: Option<&[S]>, tau: &mut [S]) {
    let nodes = model.nodes();
    let bodies = &mut data.bodies[..nodes.len()];
    let tau = &mut tau[..nodes.len() + 5];
    body_accelerations(nodes, bodies, v, a);
    let children = leaf_to_root(
        nodes,
        bodies,
        #[inline(always)]
        |k, node, body, children: Force<S>| {
            // f_k = I a + v ×* I v − F + Σ f of the children
            body.force = children + net_force(body);
            // τ_k = Sᵀ f_k + rotor q̈
            tau[k + 5] = joint_effort(node, body.axis(), body.force);
            if let Some(a) = a {
                tau[k + 5] = a[k + 5].mul_add(S::of(node.rotor_inertia), tau[k + 5]);
            }
            body.force.from_point_late(body.offset)
        },
    );
    bodies[0].force = children + net_force(&bodies[0]);
    bodies[0].force.write(tau);
}

/// Computes the accelerations `a_k = a_p + v_k × S q̇ + S q̈` of all bodies from `v` and `a`, `(nv,)`. If `a`
/// is `None`, the accelerations of the base and the joints are zero.
#[inline(always)]
pub(super) fn body_accelerations<S: Real>(
    nodes: &[Node],
    bodies: &mut [BodyData<S>],
    v: &[S],
    a: Option<&[S]>,
) {
    let v = &v[..nodes.len() + 5];
    bodies[0].acceleration = a.map_or_else(Motion::zero, Motion::from_slice);
    root_to_leaf(
        nodes,
        bodies,
        #[inline(always)]
        |body| body.acceleration,
        #[inline(always)]
        |k, node, body, parent: Motion<S>| {
            // a_k = a_p + v_k × S q̇
            let product = velocity_product(node, body, v[k + 5]);
            body.acceleration = Motion::new(
                parent.linear + parent.angular.cross_add(body.offset, product.linear),
                parent.angular + product.angular,
            );
            if let Some(a) = a {
                // a_k += S q̈
                body.acceleration = add_joint_motion(node, body.axis(), a[k + 5], body.acceleration);
            }
            body.acceleration
        },
    );
}

/// Returns the inertial force minus the external wrench of a body, `I a + v ×* I v − F`.
#[inline(always)]
pub(super) fn net_force<S: Real>(body: &BodyData<S>) -> Force<S> {
    body.inertia.inertial_force(body.velocity, body.acceleration) - body.external
}
