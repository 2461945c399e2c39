//! Inverse dynamics: the forces behind a motion (recursive Newton-Euler).

use super::data::{BodyData, Data};
use super::external::{FrameWrench, apply_external};
use super::kinematics::kinematics;
use super::subspace::{along, joint_effort, velocity_product};
use super::walk::{inward, outward};
use crate::model::{Model, Node};
use crate::spatial::{Force, Motion, Real};

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
            Some(a) => kernel(model, data, v, Some(a), tau), // each its own code
            None => kernel(model, data, v, None, tau),
        },
    );
}

#[inline(always)]
fn kernel<S: Real>(model: &Model, data: &mut Data<S>, v: &[S], a: Option<&[S]>, tau: &mut [S]) {
    let nodes = model.nodes();
    let bodies = &mut data.bodies[..nodes.len()];
    let tau = &mut tau[..nodes.len() + 5];
    accelerations(nodes, bodies, v, a);
    let carried = inward(
        nodes,
        bodies,
        #[inline(always)]
        |k, node, body, carried: Force<S>| {
            // f_k = I a + v ×* I v − F + Σ f of what it carries,  τ_k = Sᵀ f_k + rotor q̈
            body.force = carried + net_force(body);
            tau[k + 5] = joint_effort(node, body.axis(), body.force);
            if let Some(a) = a {
                tau[k + 5] = a[k + 5].mul_add(S::of(node.rotor_inertia), tau[k + 5]);
            }
            body.force.from_point_late(body.offset)
        },
    );
    bodies[0].force = carried + net_force(&bodies[0]);
    bodies[0].force.write(tau);
}

/// Outward: `a_k = a_p + v_k × S q̇ + S q̈` of all bodies; no `a` is zero.
#[inline(always)]
pub(super) fn accelerations<S: Real>(nodes: &[Node], bodies: &mut [BodyData<S>], v: &[S], a: Option<&[S]>) {
    let v = &v[..nodes.len() + 5];
    bodies[0].acceleration = a.map_or_else(Motion::zero, Motion::from_slice);
    outward(
        nodes,
        bodies,
        #[inline(always)]
        |body| body.acceleration,
        #[inline(always)]
        |k, node, body, carrier: Motion<S>| {
            let own = velocity_product(node, body, v[k + 5]);
            body.acceleration = Motion::new(
                carrier.linear + carrier.angular.cross_add(body.offset, own.linear),
                carrier.angular + own.angular,
            );
            if let Some(a) = a {
                body.acceleration = along(node, body.axis(), a[k + 5], body.acceleration);
            }
            body.acceleration
        },
    );
}

/// What moves a body as it does, less what acts on it from outside: `I a + v ×* I v − F`.
#[inline(always)]
pub(super) fn net_force<S: Real>(body: &BodyData<S>) -> Force<S> {
    body.inertia.inertial_force(body.velocity, body.acceleration) - body.external
}
