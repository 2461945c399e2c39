//! The reduced model of a manipulator whose base nothing holds.

use super::data::{BodyData, Data};
use super::external::{FrameWrench, apply_external};
use super::jacobian::{classical, frame_drift, point_acceleration, write_column};
use super::kinematics::{
    FramePose, base_rotation, frame_offset, frame_origin_b, frame_pose, frame_rotation_b, frame_velocity,
    kinematics,
};
use super::rnea::{accelerations, net_force};
use super::subspace::{composite_force, joint_effort, subspace};
use super::walk::{inward, load};
use crate::model::{Model, Node};
use crate::spatial::{Force, InverseInertia, Mat3, Motion, Real, SpatialInertia, Vec3};

/// `M* q̈ + c* = τ + Q*` and `ẍ = Jg q̈ + d` for one frame; exact for any momentum and any wrench.
///
/// With `M = [[Mbb, Mbm], [Mbmᵀ, Mmm]]`, bias `[cb; cm]`, frame Jacobian `[Jb Jm]` and generalized
/// external forces `Q = [Qb; Qm]`; matrices row major, frame rows in W axes, linear first.
///
/// Source: Umetani and Yoshida, IEEE Trans. Robotics and Automation 5(3), 1989.
#[derive(Clone, Debug)]
pub struct FreeFloating<S> {
    /// `M* = Mmm − Mbmᵀ Mbb⁻¹ Mbm`, `(n, n)`.
    pub inertia: Vec<S>,
    /// `c* = cm − Mbmᵀ Mbb⁻¹ cb`, `(n,)`, N m.
    pub bias: Vec<S>,
    /// `Q* = Qm − Mbmᵀ Mbb⁻¹ Qb`, `(n,)`, N m: what the external wrenches do at the joints.
    pub external: Vec<S>,
    /// `Jg = Jm − Jb Mbb⁻¹ Mbm`, `(6, n)`.
    pub jacobian: Vec<S>,
    /// `d = J̇ v − Jb Mbb⁻¹ (cb − Qb)`, m/s² and rad/s².
    pub drift: Motion<S>,
    /// Pose of the frame.
    pub pose: FramePose<S>,
    /// Twist of the frame in W axes at its origin.
    pub velocity: Motion<S>,
    /// The robot's centre of mass `c` from the base's origin, m: about it `Mbb` falls into `m` and `I_c`.
    com_b: Vec3<S>,
    /// `Mbb⁻¹ (cb − Qb)`, about `c`.
    net: Motion<S>,
    /// Columns of `Mbm`, about `c`.
    coupling: Vec<Force<S>>,
    /// `−Mbb⁻¹ Mbm`, a twist of the base per unit joint rate, about `c`.
    recoil: Vec<Motion<S>>,
}

impl<S: Real> FreeFloating<S> {
    /// Space for `model`.
    pub fn new(model: &Model) -> Self {
        let (n, o) = (model.joint_count(), S::of(0.0));
        Self {
            inertia: vec![o; n * n],
            bias: vec![o; n],
            external: vec![o; n],
            jacobian: vec![o; 6 * n],
            drift: Motion::zero(),
            pose: FramePose { rot_wf: Mat3::identity(), pos_w: Vec3::zero() },
            velocity: Motion::zero(),
            com_b: Vec3::zero(),
            net: Motion::zero(),
            coupling: vec![Force::zero(); n],
            recoil: vec![Motion::zero(); n],
        }
    }
}

/// [`FreeFloating`] of a frame (index) at `q`: `(nq,)`, `v`: `(nv,)`.
pub fn free_floating<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    q: &[S],
    v: &[S],
    frame: usize,
    external: &[FrameWrench<S>],
    out: &mut FreeFloating<S>,
) {
    kinematics(model, data, q, v);
    apply_external(model, data, external);
    free_floating_recursion(model, data, q, v, frame, out);
}

/// [`free_floating`] after [`kinematics`], with the external wrenches in `data`.
pub fn free_floating_recursion<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    q: &[S],
    v: &[S],
    frame: usize,
    out: &mut FreeFloating<S>,
) {
    S::enter(
        #[inline(always)]
        || kernel(model, data, q, v, frame, out),
    );
}

/// Another frame of the same reduced model: pose, twist, `Jg` and `d` anew, after
/// [`free_floating_recursion`].
pub fn free_floating_frame<S: Real>(
    model: &Model,
    data: &Data<S>,
    q: &[S],
    v: &[S],
    frame: usize,
    out: &mut FreeFloating<S>,
) {
    out.drift = frame_drift(model, data, q, v, frame);
    S::enter(
        #[inline(always)]
        || {
            reduce_task(model, data, q, frame, out);
        },
    );
}

/// [`free_floating_frame`] as the base sees it: pose, twist, Jacobian and drift relative to B, in its
/// axes. The base's recoil does not show there, so `Jg` is the arm's own Jacobian.
///
/// `ẋ = J q̇`, `ẍ = J q̈ + d`, `d = J̇ q̇` with the bodies' twists less the base's.
pub fn base_relative_frame<S: Real>(
    model: &Model,
    data: &Data<S>,
    v: &[S],
    frame: usize,
    out: &mut FreeFloating<S>,
) {
    S::enter(
        #[inline(always)]
        || {
            let n = model.joint_count();
            let frame = &model.frames()[frame];
            let (p, base) = (frame_offset(data, frame), data.bodies[0].velocity);
            let relative = |body: &BodyData<S>| body.velocity - base.referred_to(body.pos_b);
            out.pose =
                FramePose { rot_wf: frame_rotation_b(data, frame), pos_w: frame_origin_b(data, frame) };
            let twist = relative(&data.bodies[frame.body]);
            out.velocity = twist.referred_to(p);
            out.jacobian.fill(S::of(0.0));
            // Σ v_k × S q̇ along the path to the base, at the origin of the frame's body
            let (mut spatial, mut lever) = (Motion::zero(), Vec3::zero());
            let mut k = frame.body;
            while k > 0 {
                let (node, body) = (&model.nodes()[k], &data.bodies[k]);
                let unit = subspace(node, body.axis());
                write_column(&mut out.jacobian, n, k - 1, Mat3::identity(), unit.referred_to(lever + p));
                spatial += relative(body).cross(unit * v[k + 5]).referred_to(lever);
                (lever, k) = (lever + body.offset, node.parent);
            }
            out.drift = point_acceleration(spatial, twist, p);
        },
    );
}

#[inline(always)]
fn kernel<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    q: &[S],
    v: &[S],
    frame: usize,
    out: &mut FreeFloating<S>,
) {
    let (nodes, n) = (model.nodes(), model.joint_count());
    let bodies = &mut data.bodies[..=n];
    accelerations(nodes, bodies, v, None);
    let load = inward(
        nodes,
        bodies,
        #[inline(always)]
        |k, node, body, load| {
            let (composite, (bias, Outside(outside))) = with_own(body, load);
            // I^c S, cm − Qm, Qm
            out.bias[k - 1] = joint_effort(node, body.axis(), bias);
            out.external[k - 1] = joint_effort(node, body.axis(), outside);
            body.force = composite_force(node, body.axis(), &composite);
            let r = body.offset;
            (composite.from_point(r), (bias.from_point_late(r), Outside(outside.from_point_late(r))))
        },
    );
    let (composite, (bias, Outside(outside))) = with_own(&bodies[0], load);
    bodies[0].composite = composite;
    let inverse = composite.inverse();
    out.com_b = inverse.com;

    mobility(nodes, bodies, &inverse, out);

    // Mbb⁻¹ (cb − Qb), Mbb⁻¹ Qb
    let from_com = -inverse.com;
    out.net = inverse.at_com(bias.from_point(from_com));
    let outside = inverse.at_com(outside.from_point(from_com));
    for (k, coupling) in out.coupling.iter().enumerate() {
        // Q* = Qm − Mbmᵀ Mbb⁻¹ Qb,  c* = (cm − Qm) − Mbmᵀ Mbb⁻¹ (cb − Qb) + Q*
        out.external[k] -= outside.dot(*coupling);
        out.bias[k] = out.bias[k] - out.net.dot(*coupling) + out.external[k];
    }
    out.drift = classical(model, data, q, frame, data.bodies[model.frames()[frame].body].acceleration);
    reduce_task(model, data, q, frame, out);
}

/// `M* = Mmm − Mbmᵀ Mbb⁻¹ Mbm`, `Mbm` and the base's recoil from the forces `I^c S` of all joints.
///
/// `Mmm` has `S_jᵀ I^c S_k`, the force moved to the origin of each ancestor `j` of `k`.
#[inline(always)]
fn mobility<S: Real>(
    nodes: &[Node],
    bodies: &[BodyData<S>],
    inverse: &InverseInertia<S>,
    out: &mut FreeFloating<S>,
) {
    let n = nodes.len() - 1;
    for (k, body) in bodies[1..].iter().enumerate() {
        let force = body.force.from_point(body.pos_b - inverse.com);
        (out.coupling[k], out.recoil[k]) = (force, -inverse.at_com(force));
    }
    let (nodes, bodies, recoil) = (&nodes[1..], &bodies[1..=n], &out.recoil[..n]);
    for k in 0..n {
        let (mut force, coupling, mut ancestor) = (bodies[k].force, out.coupling[k], k + 1);
        for j in (0..=k).rev() {
            let mut entry = recoil[j].dot(coupling);
            if j + 1 == ancestor {
                let (node, body) = (&nodes[j], &bodies[j]);
                entry += joint_effort(node, body.axis(), force);
                ancestor = node.parent;
                // the base has no joint that needs it
                if ancestor > 0 {
                    force = force.from_point(body.offset);
                }
            }
            out.inertia[k * n + j] = entry;
            out.inertia[j * n + k] = entry;
        }
        out.inertia[k * n + k] += S::of(nodes[k].rotor_inertia);
    }
}

/// Wrenches from outside on a subtree.
#[derive(Clone, Copy)]
struct Outside<S>(Force<S>);
impl<S: Real> std::ops::Add for Outside<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}
load!(Outside<S>, Self(Force::zero()), |body| Self(body.outside), |this, body| body.outside = this.0);
/// A body's own inertia, bias and wrench beside those of what it carries.
#[inline(always)]
fn with_own<S: Real>(
    body: &BodyData<S>,
    (composite, (bias, outside)): (SpatialInertia<S>, (Force<S>, Outside<S>)),
) -> (SpatialInertia<S>, (Force<S>, Outside<S>)) {
    (composite + body.inertia.about_origin(), (bias + net_force(body), Outside(outside.0 + body.external)))
}

/// Pose, twist, `Jg` and `d`, the last from `J̇ v`: what the frame does when the base gives way.
#[inline(always)]
fn reduce_task<S: Real>(model: &Model, data: &Data<S>, q: &[S], frame: usize, out: &mut FreeFloating<S>) {
    out.pose = frame_pose(model, data, q, frame);
    out.velocity = frame_velocity(model, data, q, frame);
    let n = model.joint_count();
    let frame = &model.frames()[frame];
    let (rot_wb, p) = (base_rotation(q), frame_origin_b(data, frame));
    let (from_com, mut ancestor, mut lever) = (p - out.com_b, frame.body, frame_offset(data, frame));
    for k in (1..=n).rev() {
        // Jg = Jm − Jb Mbb⁻¹ Mbm
        let mut twist = out.recoil[k - 1].referred_to(from_com);
        if k == ancestor {
            let (node, body) = (&model.nodes()[k], &data.bodies[k]);
            twist += subspace(node, body.axis()).referred_to(lever);
            (lever, ancestor) = (lever + body.offset, node.parent);
        }
        write_column(&mut out.jacobian, n, k - 1, rot_wb, twist);
    }
    // d = J̇ v − Jb Mbb⁻¹ (cb − Qb)
    out.drift -= Motion::new(rot_wb * out.net.at(from_com), rot_wb * out.net.angular);
}
