//! Forward dynamics: the motion behind forces, in O(n) (articulated bodies, floating base).

use super::data::Data;
use super::external::{FrameWrench, apply_external};
use super::kinematics::kinematics;
use crate::model::Model;
use crate::spatial::{ArticulatedInertia, Force, Motion, Real};

/// Acceleration `a = M⁻¹ (τ − c + Σ Jᵀ F)`.
///
/// `q`: `(nq,)`; `v`, `tau`, `a` (out): `(nv,)`; `tau[..6]` is a wrench on the base in its axes.
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

    for (k, body) in bodies.iter_mut().enumerate() {
        // ζ_k = v_k × S q̇,  pA_k = v ×* I v − F
        if k > 0 {
            body.acceleration = body.velocity.cross(body.subspace * v[k + 5]);
        }
        body.articulated = ArticulatedInertia::rigid(&body.inertia);
        body.force = body.velocity.cross_force(body.inertia.momentum(body.velocity)) - body.external;
    }

    for k in (1..nodes.len()).rev() {
        let (before, rest) = bodies.split_at_mut(k);
        let (node, body) = (&nodes[k], &mut rest[0]);
        let parent = &mut before[node.parent];
        // U = IA S,  D = Sᵀ U + rotor,  u = τ − Sᵀ pA
        body.reach = body.articulated.apply(body.subspace);
        // a locked joint hands on all of IA: as if nothing could move it, 1/D = 0
        body.inverse_pivot = match is_locked(k) {
            true => S::of(0.0),
            false => S::of(1.0) / (body.subspace.dot(body.reach) + S::of(node.rotor_inertia)),
        };
        body.drive = tau[k + 5] - body.subspace.dot(body.force);
        // Ia = IA − U Uᵀ/D,  pa = pA + IA ζ + U (u − Uᵀ ζ)/D
        let share = (body.drive - body.acceleration.dot(body.reach)) * body.inverse_pivot;
        let bias = body.reach.scale_add(share, body.force + body.articulated.apply(body.acceleration));
        parent.articulated.accumulate(&body.articulated.add_outer(body.reach, -body.inverse_pivot));
        parent.force += bias;
    }

    // a_0 = IA⁻¹ (τ_b − pA)
    let base = &mut bodies[0];
    base.acceleration = base.articulated.solve(Force::from_slice(tau) - base.force);
    base.acceleration.write(a);

    for k in 1..nodes.len() {
        let (done, rest) = bodies.split_at_mut(k);
        let (parent, body) = (&done[nodes[k].parent], &mut rest[0]);
        // a' = a_p + ζ,  q̈ = (u − Uᵀ a')/D,  a = a' + S q̈
        let carried: Motion<S> = parent.acceleration + body.acceleration;
        let missing = body.drive - carried.dot(body.reach);
        let acceleration = missing * body.inverse_pivot;
        if is_locked(k) {
            body.drive = -missing; // λ = Uᵀ a' − u
        }
        body.acceleration = body.subspace.scale_add(acceleration, carried);
        a[k + 5] = acceleration;
    }
}
