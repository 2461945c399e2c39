//! Reduced model of a free-floating manipulator.

use super::data::{BodyData, Data};
use super::external::{FrameWrench, apply_external};
use super::jacobian::{classical_acceleration, frame_drift, point_acceleration, write_column};
use super::kinematics::{
    FramePose, base_rotation, frame_offset, frame_origin_b, frame_pose, frame_rotation_b, frame_velocity,
    kinematics,
};
use super::passes::{accumulated, leaf_to_root};
use super::rnea::{body_accelerations, net_force};
use super::subspace::{composite_force, joint_effort, subspace};
use crate::model::{Model, Node};
use crate::spatial::{Force, InverseInertia, Mat3, Motion, Real, SpatialInertia, Vec3};

/// Reduced equations `M* q̈ + c* = τ + Q*` and task acceleration `ẍ = Jg q̈ + d` of one frame.
///
/// The equations are exact for any momentum and any external wrench. After [`base_relative_frame`], the
/// results for the frame are relative to the base, in base axes, instead of in W.
///
/// Symbols: `M = [[Mbb, Mbm], [Mbmᵀ, Mmm]]`, bias `[c_b; c_m]`, frame Jacobian `[Jb Jm]` and generalized
/// external forces `Q = [Qb; Qm]`; matrices are row major; the rows of frame Jacobians are in W axes, linear
/// first.
///
/// Source: Umetani and Yoshida, IEEE Trans. Robotics and Automation 5(3), 1989.
#[derive(Clone, Debug)]
pub struct FreeFloating<S> {
    /// `M* = Mmm − Mbmᵀ Mbb⁻¹ Mbm`, `(n, n)`, in kg, kg m and kg m².
    pub inertia: Vec<S>,
    /// `c* = c_m − Mbmᵀ Mbb⁻¹ c_b`, `(n,)`, N m (N).
    pub bias: Vec<S>,
    /// `Q* = Qm − Mbmᵀ Mbb⁻¹ Qb`, `(n,)`, N m (N): generalized external forces at the joints.
    pub external: Vec<S>,
    /// `Jg = Jm − Jb Mbb⁻¹ Mbm`, `(6, n)`.
    pub jacobian: Vec<S>,
    /// `d = J̇ v − Jb Mbb⁻¹ (c_b − Qb)`, m/s² and rad/s², in W axes.
    pub drift: Motion<S>,
    /// Pose of the frame in W.
    pub pose: FramePose<S>,
    /// Twist of the frame at its origin, in W axes, m/s and rad/s.
    pub velocity: Motion<S>,
    /// Centre of mass `r_c` of the robot relative to the base origin, base axes, m. About `r_c`, `Mbb` is
    /// block diagonal with the blocks `m 1` and `I_c`.
    com_b: Vec3<S>,
    /// `Mbb⁻¹ (c_b − Qb)` at `r_c`, base axes, m/s² and rad/s².
    base_bias: Motion<S>,
    /// Columns of `Mbm`, about `r_c`, base axes.
    coupling: Vec<Force<S>>,
    /// Columns of `−Mbb⁻¹ Mbm`: base twist at `r_c` per unit joint rate, base axes.
    base_response: Vec<Motion<S>>,
}

impl<S: Real> FreeFloating<S> {
    /// Allocates the reduced model of `model`.
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
            base_bias: Motion::zero(),
            coupling: vec![Force::zero(); n],
            base_response: vec![Motion::zero(); n],
        }
    }
}

/// Computes the reduced model [`FreeFloating`] with one frame (index) as the task, at `q`, `(nq,)`, and `v`,
/// `(nv,)`.
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

/// Computes [`free_floating`] with the external wrenches stored in `data`. Requires up-to-date [`kinematics`]
/// in `data`.
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

/// Replaces the pose, twist, `Jg` and `d` in `out` by those of another frame (index). Requires the results of
/// [`free_floating_recursion`] in `out`.
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

/// Replaces the pose, twist, Jacobian and drift in `out` by those of a frame (index) relative to the base B,
/// in base axes.
///
/// `ẋ = J q̇`, `ẍ = J q̈ + d`, `d = J̇ q̇`, with twists relative to the base. Because the motion of the base
/// cancels, `J` is the Jacobian of the arm alone. Requires up-to-date [`kinematics`] in `data`.
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
            // Σ v_k × S q̇ along the path to the base, at the origin of the body of the frame
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
    body_accelerations(nodes, bodies, v, None);
    let children = leaf_to_root(
        nodes,
        bodies,
        #[inline(always)]
        |k, node, body, children| {
            let (composite, (bias, SubtreeWrench(external))) = add_body(body, children);
            // c_m − Qm = Sᵀ f
            out.bias[k - 1] = joint_effort(node, body.axis(), bias);
            // Qm = Sᵀ F, with F the sum of the external wrenches on the subtree
            out.external[k - 1] = joint_effort(node, body.axis(), external);
            // f_S = I^c S
            body.force = composite_force(node, body.axis(), &composite);
            let r = body.offset;
            (composite.from_point(r), (bias.from_point_late(r), SubtreeWrench(external.from_point_late(r))))
        },
    );
    let (composite, (bias, SubtreeWrench(external))) = add_body(&bodies[0], children);
    bodies[0].composite = composite;
    let inverse = composite.inverse();
    out.com_b = inverse.com;

    reduced_inertia(nodes, bodies, &inverse, out);

    // Mbb⁻¹ (c_b − Qb)
    let from_com = -inverse.com;
    out.base_bias = inverse.at_com(bias.from_point(from_com));
    // Mbb⁻¹ Qb
    let external = inverse.at_com(external.from_point(from_com));
    for (k, coupling) in out.coupling.iter().enumerate() {
        // Q* = Qm − Mbmᵀ Mbb⁻¹ Qb
        out.external[k] -= external.dot(*coupling);
        // c* = (c_m − Qm) − Mbmᵀ Mbb⁻¹ (c_b − Qb) + Q*
        out.bias[k] = out.bias[k] - out.base_bias.dot(*coupling) + out.external[k];
    }
    // J̇ v
    let spatial = data.bodies[model.frames()[frame].body].acceleration;
    out.drift = classical_acceleration(model, data, q, frame, spatial);
    reduce_task(model, data, q, frame, out);
}

/// Computes `M* = Mmm − Mbmᵀ Mbb⁻¹ Mbm`, `Mbm` and the base response `−Mbb⁻¹ Mbm` from the forces `f_S = I^c
/// S` of all joints.
///
/// Entry `(j, k)` of `Mmm` is `S_jᵀ f_S`, where `f_S` of joint `k` is shifted to the origin of its ancestor
/// `j`.
#[inline(always)]
fn reduced_inertia<S: Real>(
    nodes: &[Node],
    bodies: &[BodyData<S>],
    inverse: &InverseInertia<S>,
    out: &mut FreeFloating<S>,
) {
    let n = nodes.len() - 1;
    for (k, body) in bodies[1..].iter().enumerate() {
        let force = body.force.from_point(body.pos_b - inverse.com);
        (out.coupling[k], out.base_response[k]) = (force, -inverse.at_com(force));
    }
    let (nodes, bodies, base_response) = (&nodes[1..], &bodies[1..=n], &out.base_response[..n]);
    let (inertia, couplings) = (&mut out.inertia[..n * n], &out.coupling[..n]);
    for k in 0..n {
        let (mut force, coupling, mut ancestor) = (bodies[k].force, couplings[k], k + 1);
        let before = nodes[..=k].iter().zip(&bodies[..=k]).zip(&base_response[..=k]);
        for (j, ((node, body), response)) in before.enumerate().rev() {
            // −(Mbmᵀ Mbb⁻¹ Mbm)_jk
            let mut entry = response.dot(coupling);
            if j + 1 == ancestor {
                // + S_jᵀ f_S
                entry += joint_effort(node, body.axis(), force);
                ancestor = node.parent;
                // not needed at the base, which has no joint
                if ancestor > 0 {
                    force = force.from_point(body.offset);
                }
            }
            inertia[k * n + j] = entry;
            inertia[j * n + k] = entry;
        }
        inertia[k * n + k] += S::of(nodes[k].rotor_inertia);
    }
}

/// Sum of the external wrenches on a subtree.
#[derive(Clone, Copy)]
struct SubtreeWrench<S>(Force<S>);
impl<S: Real> std::ops::Add for SubtreeWrench<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}
accumulated!(SubtreeWrench<S>, Self(Force::zero()), |body| Self(body.subtree_external), |this, body| body
    .subtree_external =
    this.0);

/// Returns the inertia, the bias force and the external wrench of a subtree: those of its root plus the sums
/// over the children.
#[inline(always)]
fn add_body<S: Real>(
    body: &BodyData<S>,
    (composite, (bias, external)): (SpatialInertia<S>, (Force<S>, SubtreeWrench<S>)),
) -> (SpatialInertia<S>, (Force<S>, SubtreeWrench<S>)) {
    let external = SubtreeWrench(external.0 + body.external);
    (composite + body.inertia.about_origin(), (bias + net_force(body), external))
}

/// Computes the pose, the twist and `Jg` of a frame, and completes its drift `d`, to which the caller has
/// assigned `J̇ v`.
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
        let mut twist = out.base_response[k - 1].referred_to(from_com);
        if k == ancestor {
            let (node, body) = (&model.nodes()[k], &data.bodies[k]);
            twist += subspace(node, body.axis()).referred_to(lever);
            (lever, ancestor) = (lever + body.offset, node.parent);
        }
        write_column(&mut out.jacobian, n, k - 1, rot_wb, twist);
    }
    // d = J̇ v − Jb Mbb⁻¹ (c_b − Qb)
    out.drift -= Motion::new(rot_wb * out.base_bias.at(from_com), rot_wb * out.base_bias.angular);
}
