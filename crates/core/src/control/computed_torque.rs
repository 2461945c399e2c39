//! Task-space computed torque for an arm on a free base: Eq. (6)-(8) of the OnOrbitROS paper.

use super::error::ControlError;
use super::gains::{check_matrix, check_numbers};
use super::pseudo_inverse::PseudoInverse;
use crate::dynamics::{Data, FreeFloating, base_relative_frame, free_floating_recursion};
use crate::model::{Frame, Model};
use crate::reference::TaskSample;
use crate::spatial::{Mat3, Motion, Real, Vec3, dot, log_rotation};

/// Gains and options of the law
///
/// `τ = M* [Jg⁺ (p̈r − d) − k N q̇ − κ D q̇] + c* − Q* + f`,
/// `p̈r = p̈d + Kd (ṗd − ṗ) + Kp (pd − p)`,
///
/// with the exact drift `d` of [`FreeFloating`], the attitude error by the logarithm on SO(3),
/// `N` the null-space projector of `Jg`, `Q*` what the known external wrenches do and `f` the damping
/// `b q̇` of the joints. Their Coulomb friction is compensated by the drives, which are told the
/// acceleration `q̈` ([`ComputedTorqueWork::ask`]). Near a singularity `Jg⁺` gives up directions for its damping;
/// `D` holds those, and `κ`, the mean of `Kd`'s diagonal, brakes them.
#[derive(Clone, Debug)]
pub struct ComputedTorque {
    /// Index of the frame that tracks.
    pub frame: usize,
    /// `Kp`, row major `(6, 6)`, 1/s².
    pub kp: [f64; 36],
    /// `Kd`, row major `(6, 6)`, 1/s.
    pub kd: [f64; 36],
    /// `λ₀`, the singular value of `Jg` below which the pseudo-inverse is damped.
    pub damping: f64,
    /// `k`, damping of self-motion, 1/s.
    pub null_space_damping: f64,
    /// Whether the wrenches of the environment are known to the law and compensated.
    pub compensate_environment: bool,
    /// Whether the joints' damping and Coulomb friction are known and compensated: the damping at control
    /// ticks, Coulomb friction by the drives at every instant.
    pub compensate_friction: bool,
}

impl ComputedTorque {
    /// A law with scalar gains `kp` (1/s²) and `kd` (1/s), `λ₀ = 0.05`, no null-space damping.
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

    /// A `(6, 6)` gain with this diagonal.
    pub fn diagonal(entries: [f64; 6]) -> [f64; 36] {
        let mut out = [0.0; 36];
        entries.iter().enumerate().for_each(|(i, x)| out[7 * i] = *x);
        out
    }

    /// `κ`, the mean of `Kd`'s diagonal, 1/s.
    pub(super) fn brake(&self) -> f64 {
        (0..6).map(|i| self.kd[7 * i]).sum::<f64>() / 6.0
    }

    /// The smallest positive entry of `Kp`'s diagonal, 1/s²; 0 if no direction has one.
    pub(super) fn softest(&self) -> f64 {
        let least = (0..6).map(|i| self.kp[7 * i]).filter(|kp| *kp > 0.0).fold(f64::INFINITY, f64::min);
        if least.is_finite() { least } else { 0.0 }
    }

    /// `p̈r = p̈d + Kd (ṗd − ṗ) + Kp (pd − p)`.
    #[inline(always)]
    pub(super) fn command<S: Real>(&self, error: Motion<S>, lag: Motion<S>, desired: Motion<S>) -> Motion<S> {
        desired + gain(&self.kd, lag) + gain(&self.kp, error)
    }

    /// Checks that the law can work on a robot.
    ///
    /// # Errors
    /// Gains that are not finite or have a negative diagonal, negative damping, a frame that
    /// fewer than six joints move.
    pub fn check(&self, model: &Model) -> Result<(), ControlError> {
        check_matrix("kp", &self.kp)?;
        check_matrix("kd", &self.kd)?;
        check_numbers("damping", &[self.damping])?;
        check_numbers("null_space_damping", &[self.null_space_damping])?;
        let frame = frame_of(model, self.frame)?;
        let joints = path_joints(model, self.frame).count();
        if joints < 6 {
            return Err(ControlError::TooFewJoints { frame: frame.name.clone(), joints });
        }
        Ok(())
    }
}

/// Position error that a law leaves to a joint at rest, rad (m): a drive that broke it away for less would
/// chatter at the goal.
const AT_GOAL: f64 = 2e-8;

/// The acceleration that a law with the gain `kp` (1/s²) asks a joint for, or zero where it is no more than an
/// error of [`AT_GOAL`] calls for.
pub(super) fn unless_at_goal(acceleration: f64, kp: f64) -> f64 {
    if acceleration.abs() <= kp * AT_GOAL { 0.0 } else { acceleration }
}

/// A frame that the robot has.
pub(super) fn frame_of(model: &Model, frame: usize) -> Result<&Frame, ControlError> {
    let count = model.frames().len();
    model.frames().get(frame).ok_or(ControlError::NoSuchFrame { frame, count })
}

/// Joints between a frame and the base, from the frame on.
pub(super) fn path_joints(model: &Model, frame: usize) -> impl Iterator<Item = usize> {
    let body = model.frames()[frame].body;
    let path = std::iter::successors(Some(body), |&k| (k > 0).then(|| model.nodes()[k].parent));
    path.filter(|&k| k > 0).map(|k| k - 1)
}

/// Workspace of [`computed_torque`], allocated once.
#[derive(Clone, Debug)]
pub struct ComputedTorqueWork<S> {
    /// The reduced model at the last call.
    pub reduced: FreeFloating<S>,
    inverse: PseudoInverse<S>,
    acceleration: Vec<S>,
    kept: Vec<S>,
    lost: Vec<S>,
}

impl<S: Real> ComputedTorqueWork<S> {
    /// Space for `model`.
    pub fn new(model: &Model) -> Self {
        let n = model.joint_count();
        Self {
            reduced: FreeFloating::new(model),
            inverse: PseudoInverse::new(1),
            acceleration: vec![S::of(0.0); n],
            kept: vec![S::of(0.0); n],
            lost: vec![S::of(0.0); n],
        }
    }

    /// Writes which accelerations the last call asked the joints for, rad/s² (m/s²), where `law` compensates
    /// their Coulomb friction; zero for those that may stay at rest.
    pub fn ask(&self, law: &ComputedTorque, asked: &mut [Option<f64>]) {
        for (to, from) in asked.iter_mut().zip(&self.acceleration) {
            *to = law.compensate_friction.then(|| unless_at_goal(from.lane(0), law.softest()));
        }
    }
}

/// Error of a frame against its reference in W axes: `pd − p`, m, and `log(Rd Rᵀ)`, rad.
#[inline(always)]
pub fn task_error<S: Real>(rot_wf: &Mat3<S>, pos_w: Vec3<S>, desired: &TaskSample<S>) -> Motion<S> {
    Motion::new(desired.pos_w - pos_w, log_rotation(&(desired.rot_wd * rot_wf.transpose())))
}

/// Joint torques, `(n,)`, N m, towards the `desired` pose and motion, without what compensates Coulomb
/// friction.
///
/// Needs [`kinematics`](crate::dynamics::kinematics) at `q`, `v`, and in `data` the external
/// wrenches to compensate. With `is_relative`, `desired` is relative to the base and the tool is
/// tracked as the base sees it.
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
        || kernel(law, model, v, desired, work, tau),
    );
}

#[inline(always)]
fn kernel<S: Real>(
    law: &ComputedTorque,
    model: &Model,
    v: &[S],
    desired: &TaskSample<S>,
    work: &mut ComputedTorqueWork<S>,
    tau: &mut [S],
) {
    let n = tau.len();
    let reduced = &work.reduced;
    // p̈r − d,  p̈r = p̈d + Kd (ṗd − ṗ) + Kp (pd − p)
    let error = task_error(&reduced.pose.rot_wf, reduced.pose.pos_w, desired);
    let lag = desired.velocity - reduced.velocity;
    let command = law.command(error, lag, desired.acceleration) - reduced.drift;

    // q̈ = Jg⁺ (p̈r − d) − k N q̇ − κ D q̇, written as Jg⁺ (p̈r − d + k Jg q̇) − k q̇ + (k − κ) D q̇
    let (jacobian, rates, k) = (&reduced.jacobian, &v[6..], S::of(law.null_space_damping));
    work.inverse.factor(jacobian, n, &[law.damping]);
    let mut task = [S::of(0.0); 6];
    command.write(&mut task);
    for (row, task) in jacobian.chunks_exact(n).zip(&mut task) {
        *task = dot(row, rates).mul_add(k, *task);
    }
    work.inverse.apply(jacobian, &task, &mut work.acceleration);
    for (a, rate) in work.acceleration.iter_mut().zip(rates) {
        *a = (-k).mul_add(*rate, *a);
    }
    if work.inverse.is_damped() {
        work.inverse.lost(jacobian, rates, &mut work.kept, &mut work.lost);
        for (a, lost) in work.acceleration.iter_mut().zip(&work.lost) {
            *a = (k - S::of(law.brake())).mul_add(*lost, *a);
        }
    }

    // τ = M* q̈ + c* − Q* + f
    for (i, tau) in tau.iter_mut().enumerate() {
        let inertial = dot(&reduced.inertia[i * n..(i + 1) * n], &work.acceleration);
        *tau = inertial + reduced.bias[i] - reduced.external[i];
        if law.compensate_friction {
            *tau += v[i + 6] * S::of(model.joints()[i].damping);
        }
    }
}

/// `K x` for a row-major `(6, 6)` gain.
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
