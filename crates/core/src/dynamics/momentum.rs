//! Momentum, centre of mass and kinetic energy.

use super::data::Data;
use super::kinematics::base_rotation;
use crate::model::Model;
use crate::spatial::{Force, Mat3, Motion, Real, SpatialInertia, Vec3};
use serde::{Deserialize, Serialize};

/// Momentum of the robot in W axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Momentum<S> {
    /// Linear momentum, kg m/s.
    pub linear: Vec3<S>,
    /// Angular momentum about the centre of mass of the robot, kg m²/s.
    pub angular: Vec3<S>,
}

/// Returns the composite inertia of the robot and its momentum `Σ I v`, both about the base origin in base
/// axes. Requires up-to-date kinematics ([`kinematics`](super::kinematics)) in `data`.
#[inline(always)]
pub fn composite_momentum<S: Real>(data: &Data<S>) -> (SpatialInertia<S>, Force<S>) {
    let mut inertia = SpatialInertia::zero();
    let mut momentum = Force::zero();
    for body in &data.bodies {
        inertia += body.inertia_b();
        momentum += body.inertia.momentum(body.velocity).from_point(body.pos_b);
    }
    (inertia, momentum)
}

/// Returns the momentum in W axes, the angular part about the centre of mass of the robot.
/// Requires up-to-date kinematics ([`kinematics`](super::kinematics)) in `data`.
pub fn momentum<S: Real>(data: &Data<S>, q: &[S]) -> Momentum<S> {
    S::enter(
        #[inline(always)]
        || {
            let (inertia, h) = composite_momentum(data);
            about_com(h, inertia.com(), &base_rotation(q))
        },
    )
}

/// Converts a momentum about the base origin in base axes to one about the centre of mass in W axes; `com` is
/// in B, m.
#[inline(always)]
fn about_com<S: Real>(h: Force<S>, com: Vec3<S>, rot_wb: &Mat3<S>) -> Momentum<S> {
    // L_com = L − r_c × p, with the centre of mass r_c
    let angular = h.angular - com.cross(h.linear);
    Momentum { linear: *rot_wb * h.linear, angular: *rot_wb * angular }
}

/// Returns the centre of mass in W, m. Requires up-to-date poses ([`positions`](super::positions)) in `data`.
pub fn center_of_mass<S: Real>(data: &Data<S>, q: &[S]) -> Vec3<S> {
    S::enter(
        #[inline(always)]
        || base_rotation(q) * center_of_mass_b(data) + Vec3::from_slice(q),
    )
}

/// Returns the centre of mass in B, m. Requires up-to-date poses ([`positions`](super::positions)) in `data`.
#[inline(always)]
pub(crate) fn center_of_mass_b<S: Real>(data: &Data<S>) -> Vec3<S> {
    let (mut mass, mut moment) = (S::of(0.0), Vec3::zero());
    for body in &data.bodies {
        mass += body.inertia.mass;
        moment = body.com_b().scale_add(body.inertia.mass, moment);
    }
    moment * (S::of(1.0) / mass)
}

/// Returns the kinetic energy `½ Σ vᵀ I v + ½ Σ I_r q̇²`, J, of the motion in W, with the rotor inertias
/// `I_r` of the joints. Requires up-to-date kinematics ([`kinematics`](super::kinematics)) in `data`.
pub fn kinetic_energy<S: Real>(model: &Model, data: &Data<S>, v: &[S]) -> S {
    S::enter(
        #[inline(always)]
        || inertia_momentum_energy(model, data, v).2,
    )
}

/// Returns [`momentum`], [`kinetic_energy`] and [`center_of_mass`], all computed in one pass over the bodies.
#[inline(always)]
pub(crate) fn momentum_energy_com<S: Real>(
    model: &Model,
    data: &Data<S>,
    q: &[S],
    v: &[S],
) -> (Momentum<S>, S, Vec3<S>) {
    let (inertia, h, energy) = inertia_momentum_energy(model, data, v);
    let (rot_wb, com) = (base_rotation(q), inertia.com());
    (about_com(h, com, &rot_wb), energy, rot_wb * com + Vec3::from_slice(q))
}

/// Returns the composite inertia and the momentum of the robot, both in B about the base origin, and its
/// kinetic energy, J.
#[inline(always)]
fn inertia_momentum_energy<S: Real>(
    model: &Model,
    data: &Data<S>,
    v: &[S],
) -> (SpatialInertia<S>, Force<S>, S) {
    let (mut inertia, mut momentum, mut twice_energy) = (SpatialInertia::zero(), Force::zero(), S::of(0.0));
    for body in &data.bodies {
        let body_momentum = body.inertia.momentum(body.velocity);
        inertia += body.inertia_b();
        momentum += body_momentum.from_point(body.pos_b);
        twice_energy += body.velocity.dot(body_momentum);
    }
    for (node, rate) in model.nodes()[1..].iter().zip(&v[6..]) {
        twice_energy = (*rate * *rate).mul_add(S::of(node.rotor_inertia), twice_energy);
    }
    (inertia, momentum, twice_energy * S::of(0.5))
}

/// Returns the base twist `v_b = Mbb⁻¹ (h − Mbm q̇)`, m/s and rad/s in base axes, with which the robot has a
/// given momentum.
///
/// `h` is the momentum `target` converted to B axes about the base origin. `target` is in W axes, with the
/// angular part about the centre of mass. Requires up-to-date [`kinematics`](super::kinematics) in `data`.
pub fn projected_base_twist<S: Real>(data: &Data<S>, q: &[S], v: &[S], target: Momentum<S>) -> Motion<S> {
    S::enter(
        #[inline(always)]
        || {
            let (inertia, present) = composite_momentum(data);
            let rot_wb = base_rotation(q);
            let linear = rot_wb.transpose_mul(target.linear);
            let angular = rot_wb.transpose_mul(target.angular) + inertia.com().cross(linear);
            // v_b ← v_b + Mbb⁻¹ (h − Σ I v), equal to Mbb⁻¹ (h − Mbm q̇)
            let h = Force::new(linear, angular);
            Motion::from_slice(v) + inertia.inverse().apply(h - present)
        },
    )
}
