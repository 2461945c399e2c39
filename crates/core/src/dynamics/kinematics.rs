//! Where the bodies are and how they move.

use super::data::{BodyData, Data};
use crate::model::{Axis, Frame, Model, Node};
use crate::spatial::{Mat3, Motion, Quat, Real, SpatialInertia, Sym3, Vec3};

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
    walk(model, data, q, |_, _, _, _| {});
}

#[inline(always)]
pub(crate) fn kinematics_kernel<S: Real>(model: &Model, data: &mut Data<S>, q: &[S], v: &[S]) {
    data.bodies[0].velocity = Motion::from_slice(v);
    let rates = &v[5..];
    // v_k = v_p + S q̇
    walk(
        model,
        data,
        q,
        #[inline(always)]
        |k, parent, body, _| {
            body.velocity = body.subspace.scale_add(rates[k], parent.velocity);
        },
    );
}

/// Outward over the tree: places each body, then hands it to `visit` with its parent.
#[inline(always)]
fn walk<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    q: &[S],
    mut visit: impl FnMut(usize, &BodyData<S>, &mut BodyData<S>, &Node),
) {
    let nodes = model.nodes();
    let bodies = &mut data.bodies[..nodes.len()];
    place_inertia(&nodes[0], &mut bodies[0]);
    for k in 1..nodes.len() {
        let (done, rest) = bodies.split_at_mut(k);
        let (node, body) = (&nodes[k], &mut rest[0]);
        let parent = &done[node.parent];
        place(node, parent, body, q[k + 6]);
        place_inertia(node, body);
        visit(k, parent, body, node);
    }
}

/// Pose of a body from its parent's: `R_bk = R_bp R_pk Rz(q)`, and its motion subspace.
#[inline(always)]
fn place<S: Real>(node: &Node, parent: &BodyData<S>, body: &mut BodyData<S>, q: S) {
    let tree = parent.rot_bk * Mat3::of(&node.rot_pk);
    let pos = parent.rot_bk * Vec3::of(&node.pos_pk) + parent.pos_b;
    match node.axis {
        Axis::Revolute => {
            let (s, c) = q.sin_cos();
            let x = tree.x.scale_add(c, tree.y * s);
            let y = tree.y.scale_add(c, -(tree.x * s));
            body.rot_bk = Mat3::from_columns(x, y, tree.z);
            body.pos_b = pos;
            body.subspace = Motion::new(pos.cross(tree.z), tree.z); // v = −ω × p = p × ω
        }
        Axis::Prismatic => {
            body.rot_bk = tree;
            body.pos_b = tree.z.scale_add(q, pos);
            body.subspace = Motion::new(tree.z, Vec3::zero());
        }
    }
}

#[inline(always)]
fn place_inertia<S: Real>(node: &Node, body: &mut BodyData<S>) {
    let mass = S::of(node.mass);
    body.com_b = body.rot_bk * Vec3::of(&node.com) + body.pos_b;
    body.inertia = SpatialInertia::at_com(mass, body.com_b, Sym3::of(&node.about_com).rotate(&body.rot_bk));
}

/// Origin of a frame in B, m. Needs [`positions`].
#[inline(always)]
pub(crate) fn frame_origin_b<S: Real>(data: &Data<S>, frame: &Frame) -> Vec3<S> {
    let body = &data.bodies[frame.body];
    body.rot_bk * Vec3::of(&frame.pos_kf) + body.pos_b
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
    Motion::new(rot_wb * velocity.at(frame_origin_b(data, frame)), rot_wb * velocity.angular)
}
