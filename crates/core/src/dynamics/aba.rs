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

/// Computes the acceleration `a = M⁻¹ (τ − c + Σ Jᵀ F)`.
///
/// `q`: `(nq,)`; `v`, `tau`, `a` (out): `(nv,)`; `tau[..6]` is a wrench on the base in base axes.
///
/// The bias accelerations for `q̈ = 0` are computed first, as in inverse dynamics; the recursion then solves for the
/// difference from these and multiplies each articulated inertia only once. If a light body supports heavy ones, the
/// mass matrix is used instead (`dense.rs`).
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

/// Computes [`forward_dynamics`] after [`kinematics`], with the external wrenches in `data`.
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

/// Computes [`forward_dynamics_recursion`] with some joints locked (`locked`, `(n,)`): their acceleration is exactly
/// zero, or that of `given`, `(n,)`, unless `given` is empty. `holding_torque` of their bodies receives the constraint
/// torque, N m (N).
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
        // in addition to the recursion: the stick margin of a locked joint needs its `U`
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

    // bias accelerations for q̈ = 0, or the given q̈; the recursion below solves for the difference from these
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
                body.force = force; // only locked joints need it, and storing lanes is expensive
            }
            // 1/D, D = Sᵀ U + rotor; 1/D = 0 makes a locked joint rigid: its parent then supports the whole of IA
            body.d_inverse = match is_locked(k) {
                true => S::of(0.0),
                false => S::of(1.0) / (joint_effort(node, body.axis(), u_force) + S::of(node.rotor_inertia)),
            };
            // u = τ − Sᵀ pA
            body.joint_bias = tau[k + 5] - joint_effort(node, body.axis(), force);
            // Ia = IA − U Uᵀ/D,  pa = pA + U u/D, about the parent's origin
            // IA is shifted before the subtraction, so that the shift overlaps with the division by D
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

/// Returns `IA` and `pA` of a body: `I` and `I a + v ×* I v − F` of the body itself plus the sums over its children.
#[inline(always)]
fn add_body<S: Real>(
    body: &BodyData<S>,
    (mut articulated, force): (ArticulatedInertia<S>, Force<S>),
) -> (ArticulatedInertia<S>, Force<S>) {
    articulated.add_rigid(&body.inertia.about_origin());
    (articulated, force + net_force(body))
}
