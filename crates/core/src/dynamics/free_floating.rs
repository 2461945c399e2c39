//! The reduced model of a manipulator whose base nothing holds.

use super::crba::{composites, coupling};
use super::data::Data;
use super::external::{FrameWrench, apply_external};
use super::jacobian::{frame_drift, write_column};
use super::kinematics::{
    FramePose, base_rotation, frame_origin_b, frame_pose, frame_rotation_b, frame_velocity, kinematics,
};
use super::rnea::inverse_dynamics_recursion;
use crate::model::{Model, Node};
use crate::spatial::{Force, InverseInertia, Mat3, Motion, Real, Vec3};

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
    /// `[cb − Qb; cm − Qm]`, `(nv,)`.
    net_bias: Vec<S>,
    /// `Mbb⁻¹ Mbm`, a base twist per joint: how the base recoils from a unit joint rate.
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
            net_bias: vec![o; model.nv()],
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
    inverse_dynamics_recursion(model, data, v, None, &mut out.net_bias);
    out.drift = frame_drift(model, data, q, v, frame);
    S::enter(
        #[inline(always)]
        || kernel(model, data, q, frame, out),
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
            out.pose = frame_pose(model, data, q, frame);
            out.velocity = frame_velocity(model, data, q, frame);
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
            // the point's acceleration: a + α × p + ω × (v + ω × p)
            let linear = spatial.at(p) + twist.angular.cross(twist.at(p));
            out.drift = Motion::new(linear, spatial.angular);
        },
    );
}

#[inline(always)]
fn kernel<S: Real>(model: &Model, data: &mut Data<S>, q: &[S], frame: usize, out: &mut FreeFloating<S>) {
    let (nodes, n) = (model.nodes(), model.joint_count());
    out.pose = frame_pose(model, data, q, frame);
    out.velocity = frame_velocity(model, data, q, frame);
    composites(nodes, &mut data.bodies);
    let inverse = data.bodies[0].composite.inverse();

    for k in 1..=n {
        // column of Mbb⁻¹ Mbm
        out.recoil[k - 1] = inverse.apply(coupling(&data.bodies, k));
    }
    out.inertia.fill(S::of(0.0));
    for k in (1..=n).rev() {
        let force = coupling(&data.bodies, k);
        let mut j = k;
        while j > 0 {
            out.inertia[(k - 1) * n + j - 1] = data.bodies[j].subspace.dot(force);
            j = nodes[j].parent;
        }
        out.inertia[(k - 1) * n + k - 1] += S::of(nodes[k].rotor_inertia);
        for j in 1..=k {
            // M* = Mmm − Mbmᵀ (Mbb⁻¹ Mbm)
            let entry = out.inertia[(k - 1) * n + j - 1] - out.recoil[j - 1].dot(force);
            out.inertia[(k - 1) * n + j - 1] = entry;
            out.inertia[(j - 1) * n + k - 1] = entry;
        }
    }

    reduce_forces(nodes, data, &inverse, out);
    reduce_task(model, data, q, frame, &inverse, out);
}

/// `c*` and `Q*`: what is left at the joints when the base gives way.
#[inline(always)]
fn reduce_forces<S: Real>(
    nodes: &[Node],
    data: &mut Data<S>,
    inverse: &InverseInertia<S>,
    out: &mut FreeFloating<S>,
) {
    let bodies = &mut data.bodies[..nodes.len()];
    bodies.iter_mut().for_each(|body| body.outside = body.external);
    for k in (1..nodes.len()).rev() {
        let outside = bodies[k].outside;
        bodies[nodes[k].parent].outside += outside;
    }
    let net = inverse.apply(Force::from_slice(&out.net_bias)); // Mbb⁻¹ (cb − Qb)
    let outside = inverse.apply(bodies[0].outside); // Mbb⁻¹ Qb
    for k in 1..nodes.len() {
        let column = coupling(bodies, k);
        // Q* = Qm − Mbmᵀ Mbb⁻¹ Qb,  c* = (cm − Qm) − Mbmᵀ Mbb⁻¹ (cb − Qb) + Q*
        let reduced = bodies[k].subspace.dot(bodies[k].outside) - outside.dot(column);
        out.external[k - 1] = reduced;
        out.bias[k - 1] = out.net_bias[k + 5] - net.dot(column) + reduced;
    }
}

/// `Jg` and `d`: what the frame does when the base gives way.
#[inline(always)]
fn reduce_task<S: Real>(
    model: &Model,
    data: &Data<S>,
    q: &[S],
    frame: usize,
    inverse: &InverseInertia<S>,
    out: &mut FreeFloating<S>,
) {
    let n = model.joint_count();
    let frame = &model.frames()[frame];
    let (rot_wb, p) = (base_rotation(q), frame_origin_b(data, frame));
    for k in 0..n {
        // Jg = Jm − Jb Mbb⁻¹ Mbm; Jm follows below
        write_column(&mut out.jacobian, n, k, rot_wb, p, -out.recoil[k]);
    }
    let mut k = frame.body;
    while k > 0 {
        let unit = data.bodies[k].subspace - out.recoil[k - 1];
        write_column(&mut out.jacobian, n, k - 1, rot_wb, p, unit);
        k = model.nodes()[k].parent;
    }
    // d = J̇ v − Jb Mbb⁻¹ (cb − Qb)
    let net = inverse.apply(Force::from_slice(&out.net_bias));
    out.drift -= Motion::new(rot_wb * net.at(p), rot_wb * net.angular);
}
