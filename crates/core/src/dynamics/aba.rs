//! Forward dynamics in O(n): the articulated-body algorithm (ABA) with a floating base.

use super::data::{BodyData, Data};
use super::dense;
use super::external::{FrameWrench, apply_external};
use super::kinematics::kinematics;
use super::passes::{leaf_to_root, root_to_leaf};
use super::rnea::{body_accelerations, net_force};
use super::subspace::{add_joint_motion, articulated_force, joint_effort};
use crate::model::{BASE_NV, Model};
use crate::spatial::{ArticulatedInertia, Force, Motion, Real};

/// Computes the generalized acceleration `a = M⁻¹ (τ − c + Σ Jᵀ F)` under generalized forces `τ`, bias forces
/// `c` and external wrenches `F` on frames with the Jacobians `J`.
///
/// `q`: `(nq,)`; `v`, `tau`, `a` (out): `(nv,)`; `tau[..6]` is a wrench on the base, about its origin in base
/// axes, N and N m.
///
/// The bias accelerations for `q̈ = 0` are computed first, as in inverse dynamics. The recursion then solves
/// for the deviation from these accelerations, so that each articulated inertia is multiplied only once. If a
/// light body supports heavy ones, the equations are solved with the dense mass matrix instead (`dense.rs`).
///
/// Source: Featherstone, Rigid Body Dynamics Algorithms, 2008, Tables 7.1 and 9.4.
pub fn forward_dynamics<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    q: &[S],
    v: &[S],
    tau: &[S],
    external: &[FrameWrench<S>],
    a: &mut [S],
) {
    kinematics(model, data, q, v);
    apply_external(model, data, external);
    forward_dynamics_recursion(model, data, v, tau, a);
}

/// Computes [`forward_dynamics`] with the external wrenches stored in `data`. Requires up-to-date
/// [`kinematics`] in `data`.
#[inline]
pub fn forward_dynamics_recursion<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    v: &[S],
    tau: &[S],
    a: &mut [S],
) {
    if model.is_heavy_on_light() {
        return dense::solve(model, data, v, tau, &[], a, |_| false);
    }
    S::enter(
        #[inline(always)]
        || kernel(model, data, v, tau, &[], a, |_| false),
    );
}

/// Computes [`forward_dynamics_recursion`] with locked joints: those whose entry in `locked`, `(n,)`, is
/// true. A locked joint has exactly the acceleration in `given`, `(n,)`, rad/s² (m/s²), or zero if `given` is
/// empty. The torque, N m, or force, N, that holds it is stored in `holding_torque` of its body.
pub(crate) fn locked_dynamics_recursion<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    v: &[S],
    tau: &[S],
    locked: &[bool],
    given: &[f64],
    a: &mut [S],
) {
    S::enter(
        #[inline(always)]
        || kernel(model, data, v, tau, given, a, |k| locked[k - 1]),
    );
    if model.is_heavy_on_light() {
        // the recursion above runs as well, because the stick margin of a locked joint needs `U`
        dense::solve(model, data, v, tau, given, a, |k| locked[k - 1]);
    }
}

#[inline(always)]
fn kernel<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    v: &[S],
    tau: &[S],
    given: &[f64],
    a: &mut [S],
    is_locked: impl Fn(usize) -> bool,
) {
    let nodes = model.nodes();
    let bodies = &mut data.bodies[..nodes.len()];
    let (v, tau, a) = (&v[..nodes.len() + 5], &tau[..nodes.len() + 5], &mut a[..nodes.len() + 5]);

    // bias accelerations for q̈ = 0 or for the given q̈; the recursion below solves for the deviation from
    // them
    if given.is_empty() {
        body_accelerations(nodes, bodies, v, None);
    } else {
        a[..BASE_NV].fill(S::of(0.0));
        a[BASE_NV..].iter_mut().zip(given).for_each(|(a, given)| *a = S::of(*given));
        body_accelerations(nodes, bodies, v, Some(a));
    }
    let children = leaf_to_root(
        nodes,
        bodies,
        #[inline(always)]
        |k, node, body, children| {
            let (articulated, force) = add_body(body, children);
            // U = IA S
            let u_force = articulated_force(node, body.axis(), &articulated);
            if is_locked(k) {
                body.force = force; // needed for locked joints only; storing SIMD lanes is expensive
            }
            // 1/D with D = Sᵀ U + rotor inertia; 1/D = 0 makes a locked joint rigid, so that its parent
            // supports all of IA
            body.d_inverse = match is_locked(k) {
                true => S::of(0.0),
                false => S::of(1.0) / (joint_effort(node, body.axis(), u_force) + S::of(node.rotor_inertia)),
            };
            // u = τ − Sᵀ pA
            body.joint_bias = tau[k + 5] - joint_effort(node, body.axis(), force);
            // Ia = IA − U Uᵀ/D,  pa = pA + U u/D, about the parent's origin
            // IA is shifted before the subtraction so that the shift can overlap with the division by D
            body.u_force = u_force.from_point(body.offset);
            let minus_u_force_over_d = body.u_force * -body.d_inverse;
            (
                articulated.from_point(body.offset).add_parallel(body.u_force, minus_u_force_over_d),
                minus_u_force_over_d.scale_add(-body.joint_bias, force.from_point_late(body.offset)),
            )
        },
    );

    // a_0 = IA⁻¹ (τ_b − pA)
    let base = &mut bodies[0];
    (base.articulated, base.force) = add_body(base, children);
    base.acceleration = base.articulated.solve(Force::from_slice(tau) - base.force);
    base.delta_acceleration = base.acceleration;
    base.acceleration.write(a);

    root_to_leaf(
        nodes,
        bodies,
        #[inline(always)]
        |body| body.delta_acceleration,
        #[inline(always)]
        |k, node, body, parent: Motion<S>| {
            // q̈ = (u − Uᵀ Δa_p)/D
            let minus_u_force_over_d = body.u_force * -body.d_inverse;
            let acceleration = parent.dot_add(minus_u_force_over_d, body.joint_bias * body.d_inverse);
            if is_locked(k) {
                // λ = Uᵀ Δa_p − u
                body.holding_torque = parent.dot(body.u_force) - body.joint_bias;
            }
            a[k + 5] = if given.is_empty() { acceleration } else { acceleration + S::of(given[k - 1]) };
            // Δa = Δa_p + S q̈,  a = a(q̈ = 0) + Δa
            let delta = add_joint_motion(node, body.axis(), acceleration, parent.referred_to(body.offset));
            body.acceleration += delta;
            if node.is_fork {
                body.delta_acceleration = delta;
            }
            delta
        },
    );
}

/// Returns `IA` and `pA` of a body: `I` and `I a + v ×* I v − F` of the body itself plus the sums over its
/// children, which the second argument contains.
#[inline(always)]
fn add_body<S: Real>(
    body: &BodyData<S>,
    (mut articulated, force): (ArticulatedInertia<S>, Force<S>),
) -> (ArticulatedInertia<S>, Force<S>) {
    articulated.add_rigid(&body.inertia.about_origin());
    (articulated, force + net_force(body))
}
