//! Products with the motion subspace `S` of a joint, at the body origin in base axes.
//!
//! The origin lies on the joint axis `z`, so `S = (0, z)` for a revolute joint and `(z, 0)` for a prismatic
//! one. Products with `S` therefore need only half of the other factor.

use super::data::BodyData;
use crate::model::{Axis, Node};
use crate::spatial::{ArticulatedInertia, Force, Motion, Real, SpatialInertia, Vec3};

/// Returns the motion subspace `S`, which is `(0, z)` for a revolute joint and `(z, 0)` for a prismatic one.
#[inline(always)]
pub(super) fn subspace<S: Real>(node: &Node, z: Vec3<S>) -> Motion<S> {
    match node.axis {
        Axis::Revolute => Motion::new(Vec3::zero(), z),
        Axis::Prismatic => Motion::new(z, Vec3::zero()),
    }
}

/// Returns `m + S s`, the motion `m` plus a joint motion with the rate or acceleration `s`.
#[inline(always)]
pub(super) fn add_joint_motion<S: Real>(node: &Node, z: Vec3<S>, s: S, m: Motion<S>) -> Motion<S> {
    match node.axis {
        Axis::Revolute => Motion::new(m.linear, z.scale_add(s, m.angular)),
        Axis::Prismatic => Motion::new(z.scale_add(s, m.linear), m.angular),
    }
}

/// Returns `Sᵀ f`, the component of the force `f` along the joint.
#[inline(always)]
pub(super) fn joint_effort<S: Real>(node: &Node, z: Vec3<S>, f: Force<S>) -> S {
    match node.axis {
        Axis::Revolute => z.dot(f.angular),
        Axis::Prismatic => z.dot(f.linear),
    }
}

/// Returns `v × S q̇`, the velocity-product acceleration of a joint, where `v` is the twist of its body.
#[inline(always)]
pub(super) fn velocity_product<S: Real>(node: &Node, body: &BodyData<S>, rate: S) -> Motion<S> {
    let (v, joint_velocity) = (&body.velocity, body.axis() * rate);
    match node.axis {
        Axis::Revolute => Motion::new(v.linear.cross(joint_velocity), v.angular.cross(joint_velocity)),
        Axis::Prismatic => Motion::new(v.angular.cross(joint_velocity), Vec3::zero()),
    }
}

/// Returns `U = IA S`, the force of an articulated body per unit joint acceleration.
#[inline(always)]
pub(super) fn articulated_force<S: Real>(node: &Node, z: Vec3<S>, i: &ArticulatedInertia<S>) -> Force<S> {
    match node.axis {
        Axis::Revolute => Force::new(i.coupling * z, i.angular * z),
        Axis::Prismatic => Force::new(i.linear * z, i.coupling.transpose_mul(z)),
    }
}

/// Returns `I S`, the force of a rigid (composite) inertia per unit joint acceleration.
#[inline(always)]
pub(super) fn composite_force<S: Real>(node: &Node, z: Vec3<S>, i: &SpatialInertia<S>) -> Force<S> {
    match node.axis {
        Axis::Revolute => Force::new(z.cross(i.moment), i.about_origin * z),
        Axis::Prismatic => Force::new(z * i.mass, i.moment.cross(z)),
    }
}
