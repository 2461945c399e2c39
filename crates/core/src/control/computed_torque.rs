//! Task-space computed torque for an arm on a free-floating base: Eq. (6)-(8) of the OnOrbitROS paper (cited
//! in full in `docs/concepts/control.md`).
//!
//! [`computed_torque`] is used for laws on all joints and in rollouts. For groups of joints,
//! `controller_set/torques.rs` evaluates the same law with `hybrid_dynamics.rs`.

use super::control_law::{ControlLaw, JointCommand, TaskDamping};
use super::error::ControlError;
use super::gains::{check_matrix, check_numbers};
use super::pseudo_inverse::PseudoInverse;
use crate::dynamics::{Data, FreeFloating, base_relative_frame, free_floating_recursion};
use crate::model::{BASE_NQ, BASE_NV, Frame, Model};
use crate::reference::TaskSample;
use crate::spatial::{Mat3, Motion, Real, Vec3, dot, log_rotation};

/// Task-space computed torque with its gains and options:
///
/// `τ = M* [Jg⁺ (p̈r − d) − k N q̇ − κ D q̇] + c* − Q* + f`,
/// `p̈r = p̈d + Kd (ṗd − ṗ) + Kp (pd − p)`,
///
/// with the reduced model `M*`, `c*`, `Jg`, the exact drift `d` and the joint torques `Q*` of the external
/// wrenches ([`FreeFloating`]), the joint rates `q̇`, the actual pose `p` of the frame and the desired pose
/// `pd`. Poses and their derivatives are in W axes, or in base axes if the reference is relative to the base;
/// the attitude error is the logarithm on SO(3). The term `f = −τ_s` compensates the torques `τ_s` of the
/// springs at the joints ([`JointSpring`](crate::model::JointSpring)). If friction is compensated as well,
/// `f = b q̇ − τ_s` with the damping coefficients `b` of the joints.
///
/// `Jg⁺` is the damped and `J₀⁺` the undamped pseudo-inverse of `Jg`; `N = 1 − J₀⁺ Jg` projects onto the null
/// space. Near a singularity `Jg⁺` reproduces some directions only partly. The suppressed part of the joint
/// rates is `D q̇` with `D = (J₀⁺ − Jg⁺) Jg`; it is damped by `κ`, the mean of the diagonal of `Kd`. The
/// joint drives compensate Coulomb friction on the basis of the desired acceleration `q̈`
/// ([`ComputedTorqueWork::desired_accelerations`]).
#[derive(Clone, Debug)]
pub struct ComputedTorque {
    /// Index of the tracked frame.
    pub frame: usize,
    /// Gain `Kp` of the pose error, row major `(6, 6)`, 1/s².
    pub kp: [f64; 36],
    /// Gain `Kd` of the velocity error, row major `(6, 6)`, 1/s.
    pub kd: [f64; 36],
    /// Threshold `λ₀`, SI units: the pseudo-inverse of `Jg` is damped while `tr[(Jg Jgᵀ)⁻¹]^(-1/2)`, a lower
    /// bound of the smallest singular value, is below `λ₀`.
    pub damping: f64,
    /// Damping `k` of joint motion that does not move the frame, 1/s.
    pub null_space_damping: f64,
    /// True if the law compensates the external wrenches.
    pub compensate_environment: bool,
    /// True if damping and Coulomb friction of the joints are compensated: damping at control ticks, Coulomb
    /// friction by the joint drives at every instant.
    pub compensate_friction: bool,
}

impl ComputedTorque {
    /// Creates a law for the frame with index `frame`. `kp` (1/s²) and `kd` (1/s) apply to all six
    /// components, `λ₀` is 0.05, and the null-space damping is zero. The law compensates the environment and
    /// friction.
    pub fn new(frame: usize, kp: f64, kd: f64) -> Self {
        Self {
            frame,
            kp: Self::diagonal([kp; 6]),
            kd: Self::diagonal([kd; 6]),
            damping: 0.05,
            null_space_damping: 0.0,
            compensate_environment: true,
            compensate_friction: true,
        }
    }

    /// Returns the row-major `(6, 6)` gain with these diagonal entries, linear part first, and zeros
    /// elsewhere.
    pub fn diagonal(entries: [f64; 6]) -> [f64; 36] {
        let mut out = [0.0; 36];
        entries.iter().enumerate().for_each(|(i, x)| out[7 * i] = *x);
        out
    }

    /// Returns the damping `κ` of suppressed joint rates, the mean of the diagonal of `Kd`, 1/s.
    pub(super) fn damping_rate(&self) -> f64 {
        (0..6).map(|i| self.kd[7 * i]).sum::<f64>() / 6.0
    }

    /// Returns the smallest positive diagonal entry of `Kp`, 1/s², or 0 if there is none.
    pub(super) fn least_stiffness(&self) -> f64 {
        let least = (0..6).map(|i| self.kp[7 * i]).filter(|kp| *kp > 0.0).fold(f64::INFINITY, f64::min);
        if least.is_finite() { least } else { 0.0 }
    }

    /// Returns the commanded acceleration `p̈r = p̈d + Kd (ṗd − ṗ) + Kp (pd − p)` of the frame, m/s² and
    /// rad/s², from its pose error `pd − p`, its velocity error and the desired acceleration.
    #[inline(always)]
    pub(super) fn reference_acceleration<S: Real>(
        &self,
        error: Motion<S>,
        velocity_error: Motion<S>,
        desired: Motion<S>,
    ) -> Motion<S> {
        desired + gain(&self.kd, velocity_error) + gain(&self.kp, error)
    }

    /// Checks that the law applies to a robot.
    ///
    /// # Errors
    /// [`ControlError`] if a gain or damping is not finite or exceeds 1e20 in magnitude, if a diagonal entry
    /// of `kp` or `kd` or a damping is negative, if the frame does not exist, or if fewer than six joints
    /// move it.
    pub fn check(&self, model: &Model) -> Result<(), ControlError> {
        check_matrix("kp", &self.kp)?;
        check_matrix("kd", &self.kd)?;
        check_numbers("damping", &[self.damping])?;
        check_numbers("null_space_damping", &[self.null_space_damping])?;
        let frame = check_frame(model, self.frame)?;
        let joints = joints_between(model, self.frame).count();
        if joints < 6 {
            return Err(ControlError::TooFewJoints { frame: frame.name.clone(), joints });
        }
        Ok(())
    }
}

impl ControlLaw for ComputedTorque {
    fn check_group(&self, control: &str, joints: &[usize], model: &Model) -> Result<(), ControlError> {
        self.check(model)?;
        let moving = joints_between(model, self.frame).filter(|j| joints.contains(j)).count();
        if moving < 6 {
            let (control, frame) = (control.to_owned(), model.frames()[self.frame].name.clone());
            return Err(ControlError::TooFewInGroup { control, frame, joints: moving });
        }
        Ok(())
    }

    fn joint_command(&self) -> JointCommand {
        JointCommand::Task
    }

    fn compensates_environment(&self) -> Option<bool> {
        Some(self.compensate_environment)
    }

    fn compensates_friction(&self) -> bool {
        self.compensate_friction
    }

    fn task_acceleration(
        &self,
        error: Motion<f64>,
        velocity_error: Motion<f64>,
        desired: Motion<f64>,
    ) -> Motion<f64> {
        self.reference_acceleration(error, velocity_error, desired)
    }

    fn task_damping(&self) -> TaskDamping {
        TaskDamping {
            pseudo_inverse: self.damping,
            null_space: self.null_space_damping,
            suppressed: self.damping_rate(),
        }
    }

    fn desired_acceleration(&self, _: usize, acceleration: f64) -> f64 {
        zero_within_goal_error(acceleration, self.least_stiffness())
    }
}

/// Position error, rad (m), below which a joint at rest is not moved. A joint drive that responded to smaller
/// errors would chatter at the goal.
const AT_GOAL: f64 = 2e-8;

/// Returns `acceleration`, rad/s² (m/s²), or zero if its magnitude is at most the gain `kp`, 1/s², of the law
/// times [`AT_GOAL`].
pub(super) fn zero_within_goal_error(acceleration: f64, kp: f64) -> f64 {
    if acceleration.abs() <= kp * AT_GOAL { 0.0 } else { acceleration }
}

/// Returns the frame with this index, or an error if there is none.
pub(super) fn check_frame(model: &Model, frame: usize) -> Result<&Frame, ControlError> {
    let count = model.frames().len();
    model.frames().get(frame).ok_or(ControlError::NoSuchFrame { frame, count })
}

/// Returns the indices of the joints on the path from a frame to the base, starting at the frame.
pub(super) fn joints_between(model: &Model, frame: usize) -> impl Iterator<Item = usize> {
    let body = model.frames()[frame].body;
    let path = std::iter::successors(Some(body), |&k| (k > 0).then(|| model.nodes()[k].parent));
    path.filter(|&k| k > 0).map(|k| k - 1)
}

/// Workspace of [`computed_torque`], allocated once.
#[derive(Clone, Debug)]
pub struct ComputedTorqueWork<S> {
    /// Reduced model computed in the last call.
    pub reduced: FreeFloating<S>,
    inverse: PseudoInverse<S>,
    acceleration: Vec<S>,
    achieved: Vec<S>,
    suppressed: Vec<S>,
}

impl<S: Real> ComputedTorqueWork<S> {
    /// Allocates the workspace for `model`.
    pub fn new(model: &Model) -> Self {
        let n = model.joint_count();
        Self {
            reduced: FreeFloating::new(model),
            inverse: PseudoInverse::new(1),
            acceleration: vec![S::of(0.0); n],
            achieved: vec![S::of(0.0); n],
            suppressed: vec![S::of(0.0); n],
        }
    }

    /// Writes the joint accelerations that the last call of [`computed_torque`] commanded to `asked`, `(n,)`,
    /// rad/s² (m/s²), for the first SIMD lane. The compensation of Coulomb friction uses them. An entry is
    /// zero if its joint may stay at rest; all are `None` if `law` does not compensate friction.
    pub fn desired_accelerations(&self, law: &ComputedTorque, asked: &mut [Option<f64>]) {
        let stiffness = law.least_stiffness();
        for (to, from) in asked.iter_mut().zip(&self.acceleration) {
            *to = law.compensate_friction.then(|| zero_within_goal_error(from.lane(0), stiffness));
        }
    }
}

/// Returns the pose error of a frame, desired less actual, in W axes: the difference of the positions, m, and
/// the rotation vector of `rot_wd rot_wfᵀ`, rad.
#[inline(always)]
pub fn task_error<S: Real>(rot_wf: &Mat3<S>, pos_w: Vec3<S>, desired: &TaskSample<S>) -> Motion<S> {
    Motion::new(desired.pos_w - pos_w, log_rotation(&(desired.rot_wd * rot_wf.transpose())))
}

/// Computes the joint torques `tau`, `(n,)`, N m (N), with which the frame tracks the `desired` pose and
/// motion at the configuration `q`, `(nq,)`, and velocity `v`, `(nv,)`. They do not include the compensation
/// of Coulomb friction.
///
/// Requires up-to-date kinematics ([`kinematics`](crate::dynamics::kinematics)) and, in `data`, the external
/// wrenches that are to be compensated. `desired` is relative to the base, in base axes, if `is_relative` is
/// true; otherwise it is in W.
pub fn computed_torque<S: Real>(
    law: &ComputedTorque,
    model: &Model,
    data: &mut Data<S>,
    q: &[S],
    v: &[S],
    desired: &TaskSample<S>,
    is_relative: bool,
    work: &mut ComputedTorqueWork<S>,
    tau: &mut [S],
) {
    free_floating_recursion(model, data, q, v, law.frame, &mut work.reduced);
    if is_relative {
        base_relative_frame(model, data, v, law.frame, &mut work.reduced);
    }
    S::enter(
        #[inline(always)]
        || kernel(law, model, (q, v), desired, work, tau),
    );
}

#[inline(always)]
fn kernel<S: Real>(
    law: &ComputedTorque,
    model: &Model,
    (q, v): (&[S], &[S]),
    desired: &TaskSample<S>,
    work: &mut ComputedTorqueWork<S>,
    tau: &mut [S],
) {
    let n = tau.len();
    let reduced = &work.reduced;
    // p̈r − d,  p̈r = p̈d + Kd (ṗd − ṗ) + Kp (pd − p)
    let error = task_error(&reduced.pose.rot_wf, reduced.pose.pos_w, desired);
    let velocity_error = desired.velocity - reduced.velocity;
    let task_acceleration =
        law.reference_acceleration(error, velocity_error, desired.acceleration) - reduced.drift;

    // q̈ = Jg⁺ (p̈r − d) − k N q̇ − κ D q̇, written as Jg⁺ (p̈r − d + k Jg q̇) − k q̇ + (k − κ) D q̇
    let (jacobian, rates, k) = (&reduced.jacobian, &v[BASE_NV..], S::of(law.null_space_damping));
    work.inverse.factor(jacobian, n, &[law.damping]);
    let mut task = [S::of(0.0); 6];
    task_acceleration.write(&mut task);
    for (row, task) in jacobian.chunks_exact(n).zip(&mut task) {
        *task = dot(row, rates).mul_add(k, *task);
    }
    work.inverse.apply(jacobian, &task, &mut work.acceleration);
    for (a, rate) in work.acceleration.iter_mut().zip(rates) {
        *a = (-k).mul_add(*rate, *a);
    }
    if work.inverse.is_damped() {
        work.inverse.suppressed(jacobian, rates, &mut work.achieved, &mut work.suppressed);
        for (a, suppressed) in work.acceleration.iter_mut().zip(&work.suppressed) {
            *a = (k - S::of(law.damping_rate())).mul_add(*suppressed, *a);
        }
    }

    // τ = M* q̈ + c* − Q* + f,  f = b q̇ − τ_s
    for (i, tau) in tau.iter_mut().enumerate() {
        let inertial = dot(&reduced.inertia[i * n..(i + 1) * n], &work.acceleration);
        *tau = inertial + reduced.bias[i] - reduced.external[i];
        if law.compensate_friction {
            *tau += v[BASE_NV + i] * S::of(model.joints()[i].damping);
        }
    }
    for (joint, spring) in model.springs() {
        tau[joint] -= spring.torque(q[BASE_NQ + joint]);
    }
}

/// Returns `K x` for a row-major `(6, 6)` gain.
#[inline(always)]
pub(super) fn gain<S: Real>(k: &[f64; 36], x: Motion<S>) -> Motion<S> {
    let (mut from, mut to) = ([S::of(0.0); 6], [S::of(0.0); 6]);
    x.write(&mut from);
    for (i, to) in to.iter_mut().enumerate() {
        for j in 0..6 {
            *to = S::of(k[6 * i + j]).mul_add(from[j], *to);
        }
    }
    Motion::from_slice(&to)
}
