//! What evolves, and how fast.

use crate::dynamics::{Data, Momentum, kinematics, momentum};
use crate::model::Model;
use crate::spatial::{Quat, Real, Vec3, exp_so3};

/// Everything that is integrated.
#[derive(Clone, Debug)]
pub(crate) struct State<S> {
    /// Configuration, `(nq,)`.
    pub(crate) q: Vec<S>,
    /// Velocity, `(nv,)`.
    pub(crate) v: Vec<S>,
    /// Momentum at the start of the run.
    pub(crate) start: Momentum<S>,
    /// Integral of the external wrenches: forces, and moments about the centre of mass.
    pub(crate) impulse: Momentum<S>,
    /// Work done on the robot so far, J.
    pub(crate) work: S,
    /// Energy that damping, friction and stops of the joints took so far, J.
    pub(crate) dissipated: S,
}

/// Time derivatives at one stage.
#[derive(Clone, Debug)]
pub(crate) struct Rate<S> {
    /// Velocity of the base's origin in W axes, m/s.
    pub(crate) origin: Vec3<S>,
    /// Acceleration of the base's origin in W axes, m/s².
    pub(crate) bend: Vec3<S>,
    /// Rate of the rotation vector since the start of the step, rad/s.
    pub(crate) turn: Vec3<S>,
    /// Joint rates in `[6..]`: the stage's velocity.
    pub(crate) v: Vec<S>,
    /// Acceleration, `(nv,)`.
    pub(crate) a: Vec<S>,
    /// Rate of momentum: all external forces and their moments about the centre of mass.
    pub(crate) wrench: Momentum<S>,
    /// Power of joint torques and external wrenches, W.
    pub(crate) power: S,
    /// What damping and friction take of it, W.
    pub(crate) loss: S,
}

impl<S: Real> Rate<S> {
    pub(crate) fn new(model: &Model) -> Self {
        let zeros = vec![S::of(0.0); model.nv()];
        Self {
            origin: Vec3::zero(),
            bend: Vec3::zero(),
            turn: Vec3::zero(),
            v: zeros.clone(),
            a: zeros,
            wrench: Momentum::default(),
            power: S::of(0.0),
            loss: S::of(0.0),
        }
    }

    /// `self += s · other`, for weighted sums of stages.
    #[inline(always)]
    pub(crate) fn accumulate(&mut self, other: &Self, s: S) {
        self.origin = other.origin.scale_add(s, self.origin);
        self.turn = other.turn.scale_add(s, self.turn);
        self.wrench.linear = other.wrench.linear.scale_add(s, self.wrench.linear);
        self.wrench.angular = other.wrench.angular.scale_add(s, self.wrench.angular);
        self.power = other.power.mul_add(s, self.power);
        self.loss = other.loss.mul_add(s, self.loss);
        for i in 0..self.v.len() {
            self.v[i] = other.v[i].mul_add(s, self.v[i]);
            self.a[i] = other.a[i].mul_add(s, self.a[i]);
        }
    }

    /// Copies without allocating.
    pub(crate) fn copy_from(&mut self, from: &Self) {
        let Self { origin, bend, turn, wrench, power, loss, .. } = *from;
        (self.origin, self.bend, self.turn) = (origin, bend, turn);
        (self.wrench, self.power, self.loss) = (wrench, power, loss);
        self.v.copy_from_slice(&from.v);
        self.a.copy_from_slice(&from.a);
    }

    /// Forgets everything.
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        (self.origin, self.turn, self.wrench) = (Vec3::zero(), Vec3::zero(), Momentum::default());
        (self.power, self.loss) = (S::of(0.0), S::of(0.0));
        self.v.fill(S::of(0.0));
        self.a.fill(S::of(0.0));
    }
}

impl<S: Real> State<S> {
    /// At `q`, its quaternion normalised, and `v`, with the momentum that goes with them; leaves the
    /// kinematics in `data`.
    pub(crate) fn at(model: &Model, data: &mut Data<S>, mut q: Vec<S>, v: Vec<S>) -> Self {
        Quat::from_xyzw(&q[3..]).normalized().write_xyzw(&mut q[3..]);
        kinematics(model, data, &q, &v);
        let start = momentum(data, &q);
        Self { q, v, start, impulse: Momentum::default(), work: S::of(0.0), dissipated: S::of(0.0) }
    }

    /// Whether every number of the state is one.
    pub(crate) fn is_finite(&self) -> bool {
        self.q.iter().chain(&self.v).all(|x| (0..S::LANES).all(|lane| x.lane(lane).is_finite()))
    }

    /// Momentum the state must have: that of the start and what the wrenches added.
    pub(crate) fn momentum(&self) -> Momentum<S> {
        let (a, b) = (&self.start, &self.impulse);
        Momentum { linear: a.linear + b.linear, angular: a.angular + b.angular }
    }

    /// Copies without allocating.
    pub(crate) fn copy_from(&mut self, from: &Self) {
        self.q.copy_from_slice(&from.q);
        self.v.copy_from_slice(&from.v);
        (self.start, self.impulse) = (from.start, from.impulse);
        (self.work, self.dissipated) = (from.work, from.dissipated);
    }

    /// `self = from` moved by `h` at `rate`: positions add, the attitude turns on the group.
    #[inline(always)]
    pub(crate) fn move_from(&mut self, from: &Self, rate: &Rate<S>, h: S) {
        rate.origin.scale_add(h, Vec3::from_slice(&from.q)).write(&mut self.q);
        let attitude = Quat::from_xyzw(&from.q[3..]).product(exp_so3(rate.turn * h));
        attitude.renormalized().write_xyzw(&mut self.q[3..]);
        for j in 7..self.q.len() {
            self.q[j] = rate.v[j - 1].mul_add(h, from.q[j]);
        }
        for i in 0..self.v.len() {
            self.v[i] = rate.a[i].mul_add(h, from.v[i]);
        }
        self.start = from.start;
        self.impulse.linear = rate.wrench.linear.scale_add(h, from.impulse.linear);
        self.impulse.angular = rate.wrench.angular.scale_add(h, from.impulse.angular);
        self.work = rate.power.mul_add(h, from.work);
        self.dissipated = rate.loss.mul_add(h, from.dissipated);
    }
}
