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
    walk(model, data, q, |_| Motion::zero(), |_, _, _| Motion::zero());
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
        |body| body.velocity,
        #[inline(always)]
        |k, velocity, body| {
            body.velocity = body.subspace.scale_add(rates[k], velocity);
            body.velocity
        },
    );
}

/// What a body must know of the one that carries it.
#[derive(Clone, Copy)]
struct Carrier<S> {
    rot_bk: Mat3<S>,
    pos_b: Vec3<S>,
    velocity: Motion<S>,
}

/// Outward over the tree: places each body, then hands it to `visit` with its parent's velocity.
///
/// Most bodies hang on the one before them, whose pose is then passed on without a way through memory.
#[inline(always)]
fn walk<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    q: &[S],
    velocity: impl Fn(&BodyData<S>) -> Motion<S>,
    mut visit: impl FnMut(usize, Motion<S>, &mut BodyData<S>) -> Motion<S>,
) {
    let nodes = model.nodes();
    let Data { bodies, turns } = data;
    let bodies = &mut bodies[..nodes.len()];
    let (turns, q) = (&mut turns[..nodes.len()], &q[6..nodes.len() + 6]);
    S::sin_cos_each(&q[1..], &mut turns[1..]);
    place_inertia(&nodes[0], &mut bodies[0]);
    let look = |body: &BodyData<S>| Carrier { rot_bk: body.rot_bk, pos_b: body.pos_b, velocity: velocity(body) };
    let mut previous = look(&bodies[0]);
    for k in 1..nodes.len() {
        let (done, rest) = bodies.split_at_mut(k);
        let (node, body) = (&nodes[k], &mut rest[0]);
        let parent = if node.parent + 1 == k { previous } else { look(&done[node.parent]) };
        place(node, &parent, body, q[k], turns[k]);
        place_inertia(node, body);
        let velocity = visit(k, parent.velocity, body);
        previous = Carrier { rot_bk: body.rot_bk, pos_b: body.pos_b, velocity };
    }
}

/// Pose of a body from its parent's: `R_bk = R_bp R_pk Rz(q)`, and its motion subspace.
#[inline(always)]
fn place<S: Real>(node: &Node, parent: &Carrier<S>, body: &mut BodyData<S>, q: S, (s, c): (S, S)) {
    let tree = parent.rot_bk * Mat3::of(&node.rot_pk);
    let pos = parent.rot_bk * Vec3::of(&node.pos_pk) + parent.pos_b;
    match node.axis {
        Axis::Revolute => {
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
