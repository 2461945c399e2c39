//! Momentum, centre of mass, energy.

use super::data::Data;
use super::kinematics::base_rotation;
use crate::model::Model;
use crate::spatial::{Force, Mat3, Motion, Real, SpatialInertia, Vec3};

/// Momentum of the whole robot in W axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Momentum<S> {
    /// Linear, kg m/s.
    pub linear: Vec3<S>,
    /// Angular about the system's centre of mass, kg m²/s.
    pub angular: Vec3<S>,
}

/// Inertia of the whole robot and its momentum `Σ I v`, both in B about the base's origin.
/// Needs [`kinematics`](super::kinematics).
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

/// Momentum in W axes, angular about the system's centre of mass.
/// Needs [`kinematics`](super::kinematics).
pub fn momentum<S: Real>(data: &Data<S>, q: &[S]) -> Momentum<S> {
    S::enter(
        #[inline(always)]
        || {
            let (inertia, h) = composite_momentum(data);
            about_com(h, inertia.com(), &base_rotation(q))
        },
    )
}

/// A momentum in B about the base's origin, in W axes about the centre of mass: `L_com = L − c × p`.
#[inline(always)]
fn about_com<S: Real>(h: Force<S>, com: Vec3<S>, rot_wb: &Mat3<S>) -> Momentum<S> {
    let angular = h.angular - com.cross(h.linear);
    Momentum { linear: *rot_wb * h.linear, angular: *rot_wb * angular }
}

/// Centre of mass in W, m. Needs [`positions`](super::positions).
pub fn center_of_mass<S: Real>(data: &Data<S>, q: &[S]) -> Vec3<S> {
    S::enter(
        #[inline(always)]
        || base_rotation(q) * center_of_mass_b(data) + Vec3::from_slice(q),
    )
}

/// Centre of mass in B, m. Needs [`positions`](super::positions).
#[inline(always)]
pub(crate) fn center_of_mass_b<S: Real>(data: &Data<S>) -> Vec3<S> {
    let (mut mass, mut moment) = (S::of(0.0), Vec3::zero());
    for body in &data.bodies {
        mass += body.inertia.mass;
        moment = body.com_b().scale_add(body.inertia.mass, moment);
    }
    moment * (S::of(1.0) / mass)
}

/// Kinetic energy `½ Σ vᵀ I v + ½ Σ rotor q̇²` in W, J. Needs [`kinematics`](super::kinematics).
pub fn kinetic_energy<S: Real>(model: &Model, data: &Data<S>, v: &[S]) -> S {
    S::enter(
        #[inline(always)]
        || sums(model, data, v).2,
    )
}

/// [`momentum`], [`kinetic_energy`] and [`center_of_mass`] in one walk.
#[inline(always)]
pub(crate) fn motion_of_whole<S: Real>(
    model: &Model,
    data: &Data<S>,
    q: &[S],
    v: &[S],
) -> (Momentum<S>, S, Vec3<S>) {
    let (inertia, h, energy) = sums(model, data, v);
    let (rot_wb, com) = (base_rotation(q), inertia.com());
    (about_com(h, com, &rot_wb), energy, rot_wb * com + Vec3::from_slice(q))
}

/// Inertia, momentum (both in B about the base's origin) and kinetic energy of the whole robot.
#[inline(always)]
fn sums<S: Real>(model: &Model, data: &Data<S>, v: &[S]) -> (SpatialInertia<S>, Force<S>, S) {
    let (mut inertia, mut momentum, mut twice) = (SpatialInertia::zero(), Force::zero(), S::of(0.0));
    for body in &data.bodies {
        let own = body.inertia.momentum(body.velocity);
        inertia += body.inertia_b();
        momentum += own.from_point(body.pos_b);
        twice += body.velocity.dot(own);
    }
    for (node, rate) in model.nodes()[1..].iter().zip(&v[6..]) {
        twice = (*rate * *rate).mul_add(S::of(node.rotor_inertia), twice);
    }
    (inertia, momentum, twice * S::of(0.5))
}

/// The base twist that goes with a momentum and joint rates: `v_b = Mbb⁻¹ (h − Mbm q̇)`.
///
/// `target` is in W axes, angular about the centre of mass. Needs [`kinematics`](super::kinematics)
/// at `q`, `v`; returned in base axes, linear first.
pub fn base_twist<S: Real>(data: &Data<S>, q: &[S], v: &[S], target: Momentum<S>) -> Motion<S> {
    S::enter(
        #[inline(always)]
        || {
            let (inertia, h) = composite_momentum(data);
            let rot_wb = base_rotation(q);
            let linear = rot_wb.transpose_mul(target.linear);
            let angular = rot_wb.transpose_mul(target.angular) + inertia.com().cross(linear);
            // what the momentum misses, the base makes up for
            Motion::from_slice(v) + inertia.inverse().apply(Force::new(linear, angular) - h)
        },
    )
}
