//! Frame Jacobians and drift accelerations.

use super::data::Data;
use super::kinematics::{base_rotation, frame_offset};
use super::subspace::{subspace, velocity_product};
use crate::model::Model;
use crate::spatial::{Mat3, Motion, Real, Vec3};

/// Computes the Jacobian `J` of a frame (index): `J v` is the twist at the frame origin in W axes.
///
/// `out`: row major `(6, nv)`, linear rows first. Requires up-to-date poses ([`positions`](super::positions))
/// in `data`.
pub fn frame_jacobian<S: Real>(model: &Model, data: &Data<S>, q: &[S], frame: usize, out: &mut [S]) {
    S::enter(
        #[inline(always)]
        || {
            let (nv, frame) = (model.nv(), &model.frames()[frame]);
            let (rot_wb, mut lever) = (base_rotation(q), frame_offset(data, frame));
            out.fill(S::of(0.0));
            let mut k = frame.body;
            while k > 0 {
                // column of joint k: S_k, referred to the frame origin
                let (node, body) = (&model.nodes()[k], &data.bodies[k]);
                write_column(out, nv, k + 5, rot_wb, subspace(node, body.axis()).referred_to(lever));
                (lever, k) = (lever + body.offset, node.parent);
            }
            // columns of the base: (e_j, 0) and (e_j × r, e_j)
            for (j, axis) in unit_axes().into_iter().enumerate() {
                write_column(out, nv, j, rot_wb, Motion::new(axis, Vec3::zero()));
                write_column(out, nv, j + 3, rot_wb, Motion::new(axis.cross(lever), axis));
            }
        },
    );
}

/// Writes `twist`, which is in base axes, to column `j` of a Jacobian with `width` columns, rotated to W
/// axes.
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

/// Returns the unit vectors x, y, z.
#[inline(always)]
pub(super) fn unit_axes<S: Real>() -> [Vec3<S>; 3] {
    let (o, l) = (S::of(0.0), S::of(1.0));
    [Vec3::new(l, o, o), Vec3::new(o, l, o), Vec3::new(o, o, l)]
}

/// Returns the drift `J̇ v` of a frame (index): the classical acceleration of its origin, m/s², and its
/// angular acceleration, rad/s², in W axes at constant `v`. Requires up-to-date kinematics
/// ([`kinematics`](super::kinematics)) in `data`.
pub fn frame_drift<S: Real>(model: &Model, data: &Data<S>, q: &[S], v: &[S], frame: usize) -> Motion<S> {
    S::enter(
        #[inline(always)]
        || {
            let index = &model.frames()[frame];
            // Σ v_k × S q̇ along the path to the base, at the origin of the body of the frame
            let (mut spatial, mut lever) = (Motion::zero(), Vec3::zero());
            let mut k = index.body;
            while k > 0 {
                let (node, body) = (&model.nodes()[k], &data.bodies[k]);
                spatial += velocity_product(node, body, v[k + 5]).referred_to(lever);
                (lever, k) = (lever + body.offset, node.parent);
            }
            classical_acceleration(model, data, q, frame, spatial)
        },
    )
}

/// Returns the classical acceleration of the origin of a frame (index), m/s², and the angular acceleration of
/// the frame, rad/s², in W axes. Requires the accelerations of the bodies in `data`, which the recursions of
/// forward and inverse dynamics store.
pub fn frame_acceleration<S: Real>(model: &Model, data: &Data<S>, q: &[S], frame: usize) -> Motion<S> {
    let spatial = data.bodies[model.frames()[frame].body].acceleration;
    classical_acceleration(model, data, q, frame, spatial)
}

/// Converts the spatial acceleration of a body, in base axes, to the classical acceleration of the origin of
/// a frame (index) on this body, in W axes.
///
/// A spatial acceleration is the rate of change of the velocity field at a fixed point. The classical
/// acceleration follows the material point ([`point_acceleration`]).
#[inline(always)]
pub(super) fn classical_acceleration<S: Real>(
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

/// Returns the classical acceleration `a + α × p + ω × (v + ω × p)` of the point of a body at `p`, m, and the
/// angular acceleration `α`, where `spatial = (a, α)` and `velocity = (v, ω)`.
#[inline(always)]
pub(super) fn point_acceleration<S: Real>(spatial: Motion<S>, velocity: Motion<S>, p: Vec3<S>) -> Motion<S> {
    // a + α × p + ω × (v + ω × p)
    Motion::new(spatial.at(p) + velocity.angular.cross(velocity.at(p)), spatial.angular)
}
