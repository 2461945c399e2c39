//! Forward kinematics: poses and twists of bodies and frames.

use super::data::{BodyData, Data};
use super::passes::root_to_leaf;
use super::subspace::add_joint_motion;
use crate::model::{Axis, Frame, Model, Node};
use crate::spatial::{Mat3, Motion, Quat, Real, Vec3};

/// Pose of a frame in W.
#[derive(Clone, Copy, Debug)]
pub struct FramePose<S> {
    /// Rotation from frame axes to W.
    pub rot_wf: Mat3<S>,
    /// Frame origin in W, m.
    pub pos_w: Vec3<S>,
}

/// Computes poses, joint axes and inertias of all bodies in base axes from the joint positions in `q`,
/// `(nq,)`, rad (m).
pub fn positions<S: Real>(model: &Model, data: &mut Data<S>, q: &[S]) {
    S::enter(
        #[inline(always)]
        || positions_kernel(model, data, q),
    );
}

/// Computes the results of [`positions`], and the twists of all bodies in base axes, from `q`, `(nq,)`, and
/// `v`, `(nv,)`.
pub fn kinematics<S: Real>(model: &Model, data: &mut Data<S>, q: &[S], v: &[S]) {
    S::enter(
        #[inline(always)]
        || kinematics_kernel(model, data, q, v),
    );
}

#[inline(always)]
pub(super) fn positions_kernel<S: Real>(model: &Model, data: &mut Data<S>, q: &[S]) {
    let Data { bodies, joint_sin_cos, .. } = data;
    let q = joint_positions(model, q, joint_sin_cos);
    root_to_leaf(
        model.nodes(),
        bodies,
        #[inline(always)]
        |body| (body.rot_bk, body.pos_b),
        #[inline(always)]
        |k, node, body, parent| {
            place_body(node, parent, body, q[k - 1], joint_sin_cos[k - 1]);
            (body.rot_bk, body.pos_b)
        },
    );
}

#[inline(always)]
pub(crate) fn kinematics_kernel<S: Real>(model: &Model, data: &mut Data<S>, q: &[S], v: &[S]) {
    let Data { bodies, joint_sin_cos, .. } = data;
    let (q, rates) = (joint_positions(model, q, joint_sin_cos), &v[6..model.nv()]);
    bodies[0].velocity = Motion::from_slice(v);
    root_to_leaf(
        model.nodes(),
        bodies,
        #[inline(always)]
        |body| (body.rot_bk, body.pos_b, body.velocity),
        #[inline(always)]
        |k, node, body, (rot_bp, pos_b, velocity)| {
            place_body(node, (rot_bp, pos_b), body, q[k - 1], joint_sin_cos[k - 1]);
            // v_k = v_p + S q̇
            body.velocity =
                add_joint_motion(node, body.axis(), rates[k - 1], velocity.referred_to(body.offset));
            (body.rot_bk, body.pos_b, body.velocity)
        },
    );
}

/// Returns the joint positions, `(n,)`, in `q`, `(nq,)`, and stores their sines and cosines.
#[inline(always)]
fn joint_positions<'q, S: Real>(model: &Model, q: &'q [S], joint_sin_cos: &mut [(S, S)]) -> &'q [S] {
    let q = &q[7..model.nq()];
    S::sin_cos_each(q, joint_sin_cos);
    q
}

/// Computes the pose of a body from the pose of its parent, and rotates the body's inertia to base axes.
#[inline(always)]
fn place_body<S: Real>(
    node: &Node,
    (rot_bp, pos_bp): (Mat3<S>, Vec3<S>),
    body: &mut BodyData<S>,
    q: S,
    (s, c): (S, S),
) {
    let tree = rot_bp * Mat3::of(&node.rot_pk);
    body.offset = rot_bp * Vec3::of(&node.pos_pk);
    match node.axis {
        Axis::Revolute => {
            // R_bk = R_bp R_pk Rz(q)
            let x = tree.x.scale_add(c, tree.y * s);
            let y = tree.y.scale_add(c, -(tree.x * s));
            body.rot_bk = Mat3::from_columns(x, y, tree.z);
        }
        Axis::Prismatic => {
            // R_bk = R_bp R_pk,  r = R_bp p_pk + z q
            body.rot_bk = tree;
            body.offset = tree.z.scale_add(q, body.offset);
        }
    }
    body.pos_b = pos_bp + body.offset;
    body.rotate_inertia(node);
}

/// Returns the origin of a frame relative to the origin of its body, in base axes, m. Requires up-to-date
/// poses ([`positions`]) in `data`.
#[inline(always)]
pub(super) fn frame_offset<S: Real>(data: &Data<S>, frame: &Frame) -> Vec3<S> {
    data.bodies[frame.body].rot_bk * Vec3::of(&frame.pos_kf)
}

/// Returns the origin of a frame in B, m. Requires up-to-date poses ([`positions`]) in `data`.
#[inline(always)]
pub(crate) fn frame_origin_b<S: Real>(data: &Data<S>, frame: &Frame) -> Vec3<S> {
    frame_offset(data, frame) + data.bodies[frame.body].pos_b
}

/// Returns the rotation from frame axes to B. Requires up-to-date poses ([`positions`]) in `data`.
#[inline(always)]
pub(crate) fn frame_rotation_b<S: Real>(data: &Data<S>, frame: &Frame) -> Mat3<S> {
    data.bodies[frame.body].rot_bk * Mat3::of(&frame.rot_kf)
}

/// Returns the rotation `R_wb` from base axes to W in `q`, `(nq,)`.
#[inline(always)]
pub(crate) fn base_rotation<S: Real>(q: &[S]) -> Mat3<S> {
    Quat::from_xyzw(&q[3..]).matrix()
}

/// Returns the pose of a frame (index) in W. Requires up-to-date poses ([`positions`]) in `data`.
#[inline(always)]
pub fn frame_pose<S: Real>(model: &Model, data: &Data<S>, q: &[S], frame: usize) -> FramePose<S> {
    let frame = &model.frames()[frame];
    let rot_wb = base_rotation(q);
    FramePose {
        rot_wf: rot_wb * frame_rotation_b(data, frame),
        pos_w: rot_wb * frame_origin_b(data, frame) + Vec3::from_slice(q),
    }
}

/// Returns the velocity of the origin of a frame (index), m/s, and the angular velocity of the frame, rad/s,
/// in W axes. Requires up-to-date kinematics ([`kinematics`]) in `data`.
#[inline(always)]
pub fn frame_velocity<S: Real>(model: &Model, data: &Data<S>, q: &[S], frame: usize) -> Motion<S> {
    let frame = &model.frames()[frame];
    let rot_wb = base_rotation(q);
    let velocity = data.bodies[frame.body].velocity;
    Motion::new(rot_wb * velocity.at(frame_offset(data, frame)), rot_wb * velocity.angular)
}
