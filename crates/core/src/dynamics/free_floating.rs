//! The reduced model of a manipulator whose base nothing holds.

use super::data::{BodyData, Data};
use super::external::{FrameWrench, apply_external};
use super::jacobian::{classical, frame_drift, point_acceleration, write_column};
use super::kinematics::{
    FramePose, base_rotation, frame_origin_b, frame_pose, frame_rotation_b, frame_velocity, kinematics,
};
use super::rnea::{accelerations, net_force};
use super::walk::{inward, load};
use crate::model::Model;
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
    /// `cb − Qb`.
    base_bias: Force<S>,
    /// `−Mbb⁻¹ Mbm`, a twist per joint: how the base, and all that the joint does not move, recoils from its unit rate.
    recoil: Vec<Motion<S>>,
    /// `S − Mbb⁻¹ Mbm`: how what the joint moves does.
    stroke: Vec<Motion<S>>,
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
            base_bias: Force::zero(),
            recoil: vec![Motion::zero(); n],
            stroke: vec![Motion::zero(); n],
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
            reduce_task(model, data, q, frame, &data.bodies[0].composite.inverse(), out);
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
            let (p, base) = (frame_origin_b(data, frame), data.bodies[0].velocity);
            out.pose = FramePose { rot_wf: frame_rotation_b(data, frame), pos_w: p };
            let twist = data.bodies[frame.body].velocity - base;
            out.velocity = Motion::new(twist.at(p), twist.angular);
            out.jacobian.fill(S::of(0.0));
            let mut spatial = Motion::zero();
            let mut k = frame.body;
            while k > 0 {
                let body = &data.bodies[k];
                write_column(&mut out.jacobian, n, k - 1, Mat3::identity(), p, body.subspace);
                spatial += (body.velocity - base).cross(body.subspace * v[k + 5]);
                k = model.nodes()[k].parent;
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
        |k, _, body, load| {
            let load = with_own(body, load);
            let (composite, (bias, Outside(outside))) = load;
            // column of Mbm, cm − Qm, Qm
            body.force = composite.momentum(body.subspace);
            out.bias[k - 1] = body.subspace.dot(bias);
            out.external[k - 1] = body.subspace.dot(outside);
            load
        },
    );
    let (composite, (bias, Outside(outside))) = with_own(&bodies[0], load);
    (bodies[0].composite, out.base_bias) = (composite, bias);
    let inverse = composite.inverse();

    for (k, body) in bodies[1..].iter().enumerate() {
        out.recoil[k] = -inverse.apply(body.force);
        out.stroke[k] = out.recoil[k] + body.subspace;
    }
    for (k, row) in (1..).zip(out.inertia.chunks_exact_mut(n.max(1))) {
        let (force, mut ancestor) = (bodies[k].force, k);
        let (row, recoil, stroke) = (&mut row[..k], &out.recoil[..k], &out.stroke[..k]);
        for j in (0..k).rev() {
            // M* = Mmm − Mbmᵀ (Mbb⁻¹ Mbm)
            let mut twist = recoil[j];
            if j + 1 == ancestor {
                twist = stroke[j];
                ancestor = nodes[j + 1].parent;
            }
            row[j] = twist.dot(force);
        }
        row[k - 1] += S::of(nodes[k].rotor_inertia);
    }
    for k in 0..n {
        for j in 0..k {
            out.inertia[j * n + k] = out.inertia[k * n + j];
        }
    }

    let (net, outside) = (inverse.apply(bias), inverse.apply(outside)); // Mbb⁻¹ (cb − Qb), Mbb⁻¹ Qb
    for (k, body) in bodies[1..].iter().enumerate() {
        // Q* = Qm − Mbmᵀ Mbb⁻¹ Qb,  c* = (cm − Qm) − Mbmᵀ Mbb⁻¹ (cb − Qb) + Q*
        out.external[k] -= outside.dot(body.force);
        out.bias[k] = out.bias[k] - net.dot(body.force) + out.external[k];
    }
    out.drift = classical(model, data, q, frame, data.bodies[model.frames()[frame].body].acceleration);
    reduce_task(model, data, q, frame, &inverse, out);
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
    (composite + body.inertia, (bias + net_force(body), Outside(outside.0 + body.external)))
}

/// Pose, twist, `Jg` and `d`, the last from `J̇ v`: what the frame does when the base gives way.
#[inline(always)]
fn reduce_task<S: Real>(
    model: &Model,
    data: &Data<S>,
    q: &[S],
    frame: usize,
    inverse: &InverseInertia<S>,
    out: &mut FreeFloating<S>,
) {
    out.pose = frame_pose(model, data, q, frame);
    out.velocity = frame_velocity(model, data, q, frame);
    let n = model.joint_count();
    let frame = &model.frames()[frame];
    let (rot_wb, p) = (base_rotation(q), frame_origin_b(data, frame));
    let mut ancestor = frame.body;
    for k in (1..=n).rev() {
        // Jg = Jm − Jb Mbb⁻¹ Mbm
        let mut twist = out.recoil[k - 1];
        if k == ancestor {
            twist = out.stroke[k - 1];
            ancestor = model.nodes()[k].parent;
        }
        write_column(&mut out.jacobian, n, k - 1, rot_wb, p, twist);
    }
    // d = J̇ v − Jb Mbb⁻¹ (cb − Qb)
    let net = inverse.apply(out.base_bias);
    out.drift -= Motion::new(rot_wb * net.at(p), rot_wb * net.angular);
}
