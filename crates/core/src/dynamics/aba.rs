//! Forward dynamics: the motion behind forces, in O(n) (articulated bodies, floating base).

use super::data::{BodyData, Data};
use super::dense;
use super::external::{FrameWrench, apply_external};
use super::kinematics::kinematics;
use super::rnea::{accelerations, net_force};
use super::subspace::{along, articulated_force, joint_effort};
use super::walk::{inward, outward};
use crate::model::Model;
use crate::spatial::{ArticulatedInertia, Force, Motion, Real};

/// Acceleration `a = M⁻¹ (τ − c + Σ Jᵀ F)`.
///
/// `q`: `(nq,)`; `v`, `tau`, `a` (out): `(nv,)`; `tau[..6]` is a wrench on the base in its axes.
///
/// The velocity products are dealt with first, as in inverse dynamics with `q̈ = 0`: what the joints add is counted from
/// there, and the recursion of the articulated inertias has but one product with each. Where light bodies carry heavy
/// ones the mass matrix gives the accelerations (`dense.rs`).
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

/// [`forward_dynamics`] after [`kinematics`], with the external wrenches in `data`.
pub fn forward_dynamics_recursion<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    v: &[S],
    tau: &[S],
    a: &mut [S],
) {
    if model.is_heavy_on_light() {
        return dense::solve(model, data, v, tau, a, |_| false);
    }
    S::enter(
        #[inline(always)]
        || kernel(model, data, v, tau, a, |_| false),
    );
}

/// [`forward_dynamics_recursion`] with some joints (`locked`, `(n,)`) held as they are: they accelerate
/// by exactly zero, and the torque that it takes is left in `drive` of their bodies, N m (N).
pub(crate) fn locked_dynamics_recursion<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    v: &[S],
    tau: &[S],
    locked: &[bool],
    a: &mut [S],
) {
    S::enter(
        #[inline(always)]
        || kernel(model, data, v, tau, a, |k| locked[k - 1]),
    );
    if model.is_heavy_on_light() {
        // after the recursion, whose `U` the margin of a held joint is measured by
        dense::solve(model, data, v, tau, a, |k| locked[k - 1]);
    }
}

#[inline(always)]
fn kernel<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    v: &[S],
    tau: &[S],
    a: &mut [S],
    is_locked: impl Fn(usize) -> bool,
) {
    let nodes = model.nodes();
    let bodies = &mut data.bodies[..nodes.len()];
    let (v, tau, a) = (&v[..nodes.len() + 5], &tau[..nodes.len() + 5], &mut a[..nodes.len() + 5]);

    // what everything does if no joint accelerates; the rest is counted from there
    accelerations(nodes, bodies, v, None);
    let load = inward(
        nodes,
        bodies,
        #[inline(always)]
        |k, node, body, load| {
            let (articulated, force) = with_own(body, load);
            // U = IA S,  D = Sᵀ U + rotor,  u = τ − Sᵀ p
            let reach = articulated_force(node, body.axis(), &articulated);
            if is_locked(k) {
                body.force = force; // read for these alone, and a store of lanes is dear
            }
            // a locked joint hands on all of IA: as if nothing could move it, 1/D = 0
            body.inverse_pivot = match is_locked(k) {
                true => S::of(0.0),
                false => S::of(1.0) / (joint_effort(node, body.axis(), reach) + S::of(node.rotor_inertia)),
            };
            body.drive = tau[k + 5] - joint_effort(node, body.axis(), force);
            // Ia = IA − U Uᵀ/D,  pa = p + U u/D, about the parent's origin; shifting IA overlaps with the division by D
            body.reach = reach.from_point(body.offset);
            let yielding = body.reach * -body.inverse_pivot;
            (
                articulated.from_point(body.offset).add_parallel(body.reach, yielding),
                yielding.scale_add(-body.drive, force.from_point_late(body.offset)),
            )
        },
    );

    // a_0 = IA⁻¹ (τ_b − p)
    let base = &mut bodies[0];
    (base.articulated, base.force) = with_own(base, load);
    base.acceleration = base.articulated.solve(Force::from_slice(tau) - base.force);
    base.response = base.acceleration;
    base.acceleration.write(a);

    outward(
        nodes,
        bodies,
        #[inline(always)]
        |body| body.response,
        #[inline(always)]
        |k, node, body, carried: Motion<S>| {
            // q̈ = (u − Uᵀ a_p)/D,  a = a_p + S q̈, beside that of no q̈
            let pull = body.reach * -body.inverse_pivot;
            let acceleration = carried.dot_add(pull, body.drive * body.inverse_pivot);
            if is_locked(k) {
                body.drive = carried.dot(body.reach) - body.drive; // λ = Uᵀ a_p − u
            }
            a[k + 5] = acceleration;
            let response = along(node, body.axis(), acceleration, carried.referred_to(body.offset));
            body.acceleration += response;
            if node.is_fork {
                body.response = response;
            }
            response
        },
    );
}

/// `IA` and `p` of a body: its own, `I` and `I a + v ×* I v − F`, and those of what it carries.
#[inline(always)]
fn with_own<S: Real>(
    body: &BodyData<S>,
    (mut articulated, force): (ArticulatedInertia<S>, Force<S>),
) -> (ArticulatedInertia<S>, Force<S>) {
    articulated.add_rigid(&body.inertia.about_origin());
    (articulated, force + net_force(body))
}
