//! Forward dynamics: the motion behind forces, in O(n) (articulated bodies, floating base).

use super::data::{BodyData, Data};
use super::external::{FrameWrench, apply_external};
use super::kinematics::kinematics;
use crate::model::{Model, Node};
use crate::spatial::{ArticulatedInertia, Force, Real};

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

    // what hangs on a body: the next one hands itself on in passing, others by way of their parent's memory
    let nothing = (ArticulatedInertia::zero(), Force::zero());
    for (node, body) in nodes.iter().zip(&mut *bodies) {
        if node.is_fork {
            (body.articulated, body.force) = nothing;
        }
    }
    let mut hanging = nothing;

    for k in (1..nodes.len()).rev() {
        let (before, rest) = bodies.split_at_mut(k);
        let (node, body) = (&nodes[k], &mut rest[0]);
        // ζ = v × S q̇,  pA = v ×* I v − F,  p = pA + IA ζ
        body.acceleration = body.velocity.cross(body.subspace * v[k + 5]);
        let (articulated, biased) = gather(node, body, hanging);
        body.force = biased + articulated.apply(body.acceleration);
        // U = IA S,  D = Sᵀ U + rotor,  u = τ − Sᵀ p
        body.reach = articulated.apply(body.subspace);
        // a locked joint hands on all of IA: as if nothing could move it, 1/D = 0
        body.inverse_pivot = match is_locked(k) {
            true => S::of(0.0),
            false => S::of(1.0) / (body.subspace.dot(body.reach) + S::of(node.rotor_inertia)),
        };
        body.drive = tau[k + 5] - body.subspace.dot(body.force);
        // Ia = IA − U Uᵀ/D,  pa = p + U u/D
        let shed = body.reach * -body.inverse_pivot;
        let left = (articulated.add_outer(body.reach, shed), shed.scale_add(-body.drive, body.force));
        hanging = if node.parent + 1 == k {
            left
        } else {
            let parent = &mut before[node.parent];
            parent.articulated.accumulate(&left.0);
            parent.force += left.1;
            nothing
        };
    }

    // a_0 = IA⁻¹ (τ_b − pA)
    let base = &mut bodies[0];
    (base.articulated, base.force) = gather(&nodes[0], base, hanging);
    base.acceleration = base.articulated.solve(Force::from_slice(tau) - base.force);
    base.acceleration.write(a);

    let mut previous = base.acceleration;
    for k in 1..nodes.len() {
        let (done, rest) = bodies.split_at_mut(k);
        let (node, body) = (&nodes[k], &mut rest[0]);
        let carried = if node.parent + 1 == k { previous } else { done[node.parent].acceleration };
        // q̈ = (u − Uᵀ a_p)/D,  a = a_p + ζ + S q̈
        let held = carried.dot(body.reach);
        let acceleration = (body.drive - held) * body.inverse_pivot;
        if is_locked(k) {
            body.drive = held - body.drive; // λ = Uᵀ a_p − u
        }
        previous = body.subspace.scale_add(acceleration, carried + body.acceleration);
        body.acceleration = previous;
        a[k + 5] = acceleration;
    }
}

/// Articulated inertia of a body and the force that it takes to leave it alone: its own, `v ×* I v − F`, and of all
/// that hangs on it.
#[inline(always)]
fn gather<S: Real>(
    node: &Node,
    body: &BodyData<S>,
    hanging: (ArticulatedInertia<S>, Force<S>),
) -> (ArticulatedInertia<S>, Force<S>) {
    let (mut articulated, mut force) = hanging;
    articulated.add_rigid(&body.inertia);
    force += body.velocity.cross_force(body.inertia.momentum(body.velocity)) - body.external;
    if node.is_fork {
        articulated.accumulate(&body.articulated);
        force += body.force;
    }
    (articulated, force)
}
