//! Frame Jacobians and their drift.

use super::data::Data;
use super::kinematics::{base_rotation, frame_offset};
use super::subspace::{subspace, velocity_product};
use crate::model::Model;
use crate::spatial::{Mat3, Motion, Real, Vec3};

/// Jacobian of a frame (index): its twist at its origin in W axes is `J v`.
///
/// `out`: row major `(6, nv)`, linear rows first. Needs [`positions`](super::positions).
pub fn frame_jacobian<S: Real>(model: &Model, data: &Data<S>, q: &[S], frame: usize, out: &mut [S]) {
    S::enter(
        #[inline(always)]
        || {
            let (nv, frame) = (model.nv(), &model.frames()[frame]);
            let (rot_wb, mut lever) = (base_rotation(q), frame_offset(data, frame));
            out.fill(S::of(0.0));
            let mut k = frame.body;
            while k > 0 {
                let (node, body) = (&model.nodes()[k], &data.bodies[k]);
                write_column(out, nv, k + 5, rot_wb, subspace(node, body.axis()).referred_to(lever));
                (lever, k) = (lever + body.offset, node.parent);
            }
            for (j, axis) in unit_axes().into_iter().enumerate() {
                write_column(out, nv, j, rot_wb, Motion::new(axis, Vec3::zero()));
                write_column(out, nv, j + 3, rot_wb, Motion::new(axis.cross(lever), axis));
            }
        },
    );
}

/// Column `j` of a Jacobian `width` wide: the twist of the frame's origin, turned to W.
#[inline(always)]
pub(super) fn write_column<S: Real>(
    out: &mut [S],
    width: usize,
    j: usize,
    rot_wb: Mat3<S>,
    twist: Motion<S>,
) {
    let (linear, angular) = (rot_wb * twist.linear, rot_wb * twist.angular);
    let entries = [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z];
    for (row, entry) in out.chunks_exact_mut(width).zip(entries) {
        row[j] = entry;
    }
}

/// The axes of the frame at hand.
#[inline(always)]
pub(super) fn unit_axes<S: Real>() -> [Vec3<S>; 3] {
    let (o, l) = (S::of(0.0), S::of(1.0));
    [Vec3::new(l, o, o), Vec3::new(o, l, o), Vec3::new(o, o, l)]
}

/// Drift `J̇ v` of a frame (index): its classical acceleration, m/s² and rad/s², at its origin in W
/// axes while `v` does not change. Needs [`kinematics`](super::kinematics).
pub fn frame_drift<S: Real>(model: &Model, data: &Data<S>, q: &[S], v: &[S], frame: usize) -> Motion<S> {
    S::enter(
        #[inline(always)]
        || {
            let index = &model.frames()[frame];
            // Σ v_k × S q̇ along the path to the base, at the origin of the frame's body
            let (mut spatial, mut lever) = (Motion::zero(), Vec3::zero());
            let mut k = index.body;
            while k > 0 {
                let (node, body) = (&model.nodes()[k], &data.bodies[k]);
                spatial += velocity_product(node, body, v[k + 5]).referred_to(lever);
                (lever, k) = (lever + body.offset, node.parent);
            }
            classical(model, data, q, frame, spatial)
        },
    )
}

/// Acceleration of a frame's origin, m/s², and its angular acceleration, rad/s², in W axes, after
/// a recursion that left the bodies' accelerations in `data`.
pub fn frame_acceleration<S: Real>(model: &Model, data: &Data<S>, q: &[S], frame: usize) -> Motion<S> {
    let spatial = data.bodies[model.frames()[frame].body].acceleration;
    classical(model, data, q, frame, spatial)
}

/// A body's spatial acceleration at its origin as that of a frame's origin, [`point_acceleration`], in W axes.
///
/// A spatial acceleration is the rate of the velocity field at a fixed point; the last term
/// follows the material point instead.
#[inline(always)]
pub(super) fn classical<S: Real>(
    model: &Model,
    data: &Data<S>,
    q: &[S],
    frame: usize,
    spatial: Motion<S>,
) -> Motion<S> {
    let frame = &model.frames()[frame];
    let (rot_wb, p) = (base_rotation(q), frame_offset(data, frame));
    let velocity = data.bodies[frame.body].velocity;
    let acceleration = point_acceleration(spatial, velocity, p);
    Motion::new(rot_wb * acceleration.linear, rot_wb * acceleration.angular)
}

/// `a + α × p + ω × (v + ω × p)`, and `α`: of the point at `p` of a body with this spatial acceleration and velocity.
#[inline(always)]
pub(super) fn point_acceleration<S: Real>(spatial: Motion<S>, velocity: Motion<S>, p: Vec3<S>) -> Motion<S> {
    Motion::new(spatial.at(p) + velocity.angular.cross(velocity.at(p)), spatial.angular)
}
