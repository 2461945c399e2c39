//! Where the bodies are and how they move.

use super::data::{BodyData, Data};
use super::subspace::along;
use super::walk::outward;
use crate::model::{Axis, Frame, Model, Node};
use crate::spatial::{Mat3, Motion, Quat, Real, Sym3, Vec3};

/// Pose of a frame in W.
#[derive(Clone, Copy, Debug)]
pub struct FramePose<S> {
    /// Takes frame components to W.
    pub rot_wf: Mat3<S>,
    /// Origin in W, m.
    pub pos_w: Vec3<S>,
}

/// Poses, joint axes and inertias of all bodies, from the joints of `q` (`(nq,)`, m and rad).
pub fn positions<S: Real>(model: &Model, data: &mut Data<S>, q: &[S]) {
    S::enter(
        #[inline(always)]
        || positions_kernel(model, data, q),
    );
}

/// [`positions`] and the twists of all bodies. `q`: `(nq,)`, `v`: `(nv,)`.
pub fn kinematics<S: Real>(model: &Model, data: &mut Data<S>, q: &[S], v: &[S]) {
    S::enter(
        #[inline(always)]
        || kinematics_kernel(model, data, q, v),
    );
}

#[inline(always)]
pub(super) fn positions_kernel<S: Real>(model: &Model, data: &mut Data<S>, q: &[S]) {
    let Data { bodies, turns, .. } = data;
    let q = turned(model, q, turns);
    outward(
        model.nodes(),
        bodies,
        #[inline(always)]
        |body| (body.rot_bk, body.pos_b),
        #[inline(always)]
        |k, node, body, parent| {
            place(node, parent, body, q[k - 1], turns[k - 1]);
            (body.rot_bk, body.pos_b)
        },
    );
}

#[inline(always)]
pub(crate) fn kinematics_kernel<S: Real>(model: &Model, data: &mut Data<S>, q: &[S], v: &[S]) {
    let Data { bodies, turns, .. } = data;
    let (q, rates) = (turned(model, q, turns), &v[6..model.nv()]);
    bodies[0].velocity = Motion::from_slice(v);
    outward(
        model.nodes(),
        bodies,
        #[inline(always)]
        |body| (body.rot_bk, body.pos_b, body.velocity),
        #[inline(always)]
        |k, node, body, (rot_bp, pos_b, velocity)| {
            place(node, (rot_bp, pos_b), body, q[k - 1], turns[k - 1]);
            // v_k = v_p + S q̇
            body.velocity = along(node, body.axis(), rates[k - 1], velocity.referred_to(body.offset));
            (body.rot_bk, body.pos_b, body.velocity)
        },
    );
}

/// The joints of `q`, after working out their sines and cosines.
#[inline(always)]
fn turned<'q, S: Real>(model: &Model, q: &'q [S], turns: &mut [(S, S)]) -> &'q [S] {
    let q = &q[7..model.nq()];
    S::sin_cos_each(q, turns);
    q
}

/// Pose of a body from its parent's, `R_bk = R_bp R_pk Rz(q)`, and its inertia.
#[inline(always)]
fn place<S: Real>(
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
            let x = tree.x.scale_add(c, tree.y * s);
            let y = tree.y.scale_add(c, -(tree.x * s));
            body.rot_bk = Mat3::from_columns(x, y, tree.z);
        }
        Axis::Prismatic => {
            body.rot_bk = tree;
            body.offset = tree.z.scale_add(q, body.offset);
        }
    }
    body.pos_b = pos_bp + body.offset;
    place_inertia(node, body);
}

/// Centre of mass and inertia of a body in base axes. The base's are constants.
#[inline(always)]
pub(super) fn place_inertia<S: Real>(node: &Node, body: &mut BodyData<S>) {
    body.inertia.com = body.rot_bk * Vec3::of(&node.com);
    body.inertia.about_com = Sym3::of(&node.about_com).rotate(&body.rot_bk);
}

/// Origin of a frame from that of its body, base axes, m. Needs [`positions`].
#[inline(always)]
pub(super) fn frame_offset<S: Real>(data: &Data<S>, frame: &Frame) -> Vec3<S> {
    data.bodies[frame.body].rot_bk * Vec3::of(&frame.pos_kf)
}

/// Origin of a frame in B, m. Needs [`positions`].
#[inline(always)]
pub(crate) fn frame_origin_b<S: Real>(data: &Data<S>, frame: &Frame) -> Vec3<S> {
    frame_offset(data, frame) + data.bodies[frame.body].pos_b
}

/// Rotation from a frame's axes to B. Needs [`positions`].
#[inline(always)]
pub(crate) fn frame_rotation_b<S: Real>(data: &Data<S>, frame: &Frame) -> Mat3<S> {
    data.bodies[frame.body].rot_bk * Mat3::of(&frame.rot_kf)
}

/// Rotation `R_wb` of the base.
#[inline(always)]
pub(crate) fn base_rotation<S: Real>(q: &[S]) -> Mat3<S> {
    Quat::from_xyzw(&q[3..]).matrix()
}

/// Pose of a frame (index) in W. Needs [`positions`].
#[inline(always)]
pub fn frame_pose<S: Real>(model: &Model, data: &Data<S>, q: &[S], frame: usize) -> FramePose<S> {
    let frame = &model.frames()[frame];
    let rot_wb = base_rotation(q);
    FramePose {
        rot_wf: rot_wb * frame_rotation_b(data, frame),
        pos_w: rot_wb * frame_origin_b(data, frame) + Vec3::from_slice(q),
    }
}

/// Velocity of a frame's origin, m/s, and its angular velocity, rad/s, in W axes.
/// Needs [`kinematics`].
#[inline(always)]
pub fn frame_velocity<S: Real>(model: &Model, data: &Data<S>, q: &[S], frame: usize) -> Motion<S> {
    let frame = &model.frames()[frame];
    let rot_wb = base_rotation(q);
    let velocity = data.bodies[frame.body].velocity;
    Motion::new(rot_wb * velocity.at(frame_offset(data, frame)), rot_wb * velocity.angular)
}
