//! State of one tree and its time derivatives.

use crate::dynamics::{Data, Momentum, kinematics, momentum};
use crate::model::{BASE_NQ, BASE_NV, Model};
use crate::spatial::{Quat, Real, Scalar, Vec3, exp_so3};
use serde::{Deserialize, Serialize};

/// Integrated quantities of one tree, such as configuration, velocity, impulse and work.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct TreeState<S> {
    /// Configuration, `(nq,)`, m and rad.
    pub(crate) q: Vec<S>,
    /// Velocity, `(nv,)`, m/s and rad/s.
    pub(crate) v: Vec<S>,
    /// Momentum at the start of the run or, in a tree with several members, at the assembly of the tree, W
    /// axes, N s and N m s. During a run, only a change of the reference orbit changes this value.
    pub(crate) initial_momentum: Momentum<S>,
    /// Time integral of the external forces and of their moments about the centre of mass, W axes, N s and
    /// N m s. In a group with contacts, the moments of a step are about the common centre of mass until the
    /// step ends.
    pub(crate) impulse: Momentum<S>,
    /// Work done by motors, springs and external wrenches less the energy dissipated in the joints, J, since
    /// the start of the run or, in a tree with several members, since its assembly.
    pub(crate) work: S,
    /// Energy dissipated by the damping, friction, brakes and stops of the joints, J, over the same time as
    /// `work`.
    pub(crate) dissipated: S,
    /// Position of the centre of mass in W, m, integrated from its velocity; `None` in a run with a single
    /// tree. Once per step the base is shifted so that the centre of mass of the tree is at this position;
    /// the angular momentum of several trees about a common point is then exact.
    pub(crate) center: Option<Vec3<S>>,
    /// Parts of `dissipated` that belong to the joints of each member, J; empty for a tree with a single
    /// member.
    pub(crate) shares: Vec<S>,
    /// Time, s, at which the prescribed motion of joints is evaluated; `None` without such joints.
    pub(crate) clock: Option<S>,
}

/// Time derivatives of a tree at one stage.
#[derive(Clone, Debug)]
pub(crate) struct TreeRate<S> {
    /// Velocity of the base's origin in W axes, m/s.
    pub(crate) base_velocity: Vec3<S>,
    /// Acceleration of the base's origin in W axes, m/s².
    pub(crate) base_acceleration: Vec3<S>,
    /// Rate of the rotation vector since the start of the step, base axes, rad/s.
    pub(crate) rotation_rate: Vec3<S>,
    /// Joint rates at the stage, `(n,)`, rad/s and m/s.
    pub(crate) joint_rates: Vec<S>,
    /// Acceleration, `(nv,)`, m/s² and rad/s².
    pub(crate) a: Vec<S>,
    /// Time derivative of the momentum: the sum of the external forces, and of their moments about the centre
    /// of mass, W axes, N and N m; in a group with contacts, about the common centre of mass.
    pub(crate) wrench: Momentum<S>,
    /// Power of the motors, springs and external wrenches less the power dissipated in the joints, W.
    pub(crate) power: S,
    /// Power dissipated by the damping, friction and brakes of the joints, W.
    pub(crate) loss: S,
    /// Velocity of the centre of mass, linear momentum over mass, W axes, m/s; `None` in a run with a single
    /// tree.
    pub(crate) center_velocity: Option<Vec3<S>>,
    /// Parts of `loss` that belong to the joints of each member, W; empty for a tree with a single member.
    pub(crate) shares: Vec<S>,
    /// Time derivative of the clock, which is 1; `None` without a clock.
    pub(crate) clock: Option<S>,
}

impl<S: Real> TreeRate<S> {
    pub(crate) fn of(state: &TreeState<S>) -> Self {
        let zeros = vec![S::of(0.0); state.v.len()];
        Self {
            base_velocity: Vec3::zero(),
            base_acceleration: Vec3::zero(),
            rotation_rate: Vec3::zero(),
            joint_rates: zeros[BASE_NV..].to_vec(),
            a: zeros,
            wrench: Momentum::default(),
            power: S::of(0.0),
            loss: S::of(0.0),
            center_velocity: state.center.map(|_| Vec3::zero()),
            shares: vec![S::of(0.0); state.shares.len()],
            clock: state.clock.map(|_| S::of(1.0)),
        }
    }

    /// Adds `s · other` to these rates, for weighted sums of stages.
    #[inline(always)]
    pub(crate) fn accumulate(&mut self, other: &Self, s: S) {
        self.base_velocity = other.base_velocity.scale_add(s, self.base_velocity);
        self.rotation_rate = other.rotation_rate.scale_add(s, self.rotation_rate);
        self.wrench.linear = other.wrench.linear.scale_add(s, self.wrench.linear);
        self.wrench.angular = other.wrench.angular.scale_add(s, self.wrench.angular);
        self.power = other.power.mul_add(s, self.power);
        self.loss = other.loss.mul_add(s, self.loss);
        for (to, from) in [(&mut self.joint_rates, &other.joint_rates), (&mut self.a, &other.a)] {
            for (to, from) in to.iter_mut().zip(from) {
                *to = from.mul_add(s, *to);
            }
        }
        if let (Some(sum), Some(other)) = (&mut self.center_velocity, &other.center_velocity) {
            *sum = other.scale_add(s, *sum);
        }
        for (to, from) in self.shares.iter_mut().zip(&other.shares) {
            *to = from.mul_add(s, *to);
        }
        if let (Some(sum), Some(other)) = (&mut self.clock, &other.clock) {
            *sum = other.mul_add(s, *sum);
        }
    }

    /// Copies `from` without allocating.
    pub(crate) fn copy_from(&mut self, from: &Self) {
        let Self { base_velocity, base_acceleration, rotation_rate, wrench, power, loss, .. } = *from;
        (self.base_velocity, self.base_acceleration, self.rotation_rate) =
            (base_velocity, base_acceleration, rotation_rate);
        (self.wrench, self.power, self.loss) = (wrench, power, loss);
        self.joint_rates.copy_from_slice(&from.joint_rates);
        self.a.copy_from_slice(&from.a);
        self.center_velocity.clone_from(&from.center_velocity);
        self.shares.copy_from_slice(&from.shares);
        self.clock = from.clock;
    }

    /// Sets to zero the rates to which [`TreeRate::accumulate`] adds.
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        (self.base_velocity, self.rotation_rate, self.wrench) =
            (Vec3::zero(), Vec3::zero(), Momentum::default());
        (self.power, self.loss) = (S::of(0.0), S::of(0.0));
        self.joint_rates.fill(S::of(0.0));
        self.a.fill(S::of(0.0));
        self.center_velocity = self.center_velocity.map(|_| Vec3::zero());
        self.shares.fill(S::of(0.0));
        self.clock = self.clock.map(|_| S::of(0.0));
    }
}

impl<S: Real> TreeState<S> {
    /// Creates the state with configuration `q`, whose quaternion is normalised, velocity `v` and the
    /// corresponding momentum. Writes the kinematics to `data`.
    pub(crate) fn at(model: &Model, data: &mut Data<S>, mut q: Vec<S>, v: Vec<S>) -> Self {
        Quat::from_xyzw(&q[3..]).normalized().write_xyzw(&mut q[3..]);
        kinematics(model, data, &q, &v);
        let initial_momentum = momentum(data, &q);
        Self {
            q,
            v,
            initial_momentum,
            impulse: Momentum::default(),
            work: S::of(0.0),
            dissipated: S::of(0.0),
            center: None,
            shares: Vec::new(),
            clock: None,
        }
    }

    /// Returns true if configuration and velocity are finite in every lane.
    pub(crate) fn is_finite(&self) -> bool {
        S::enter(
            #[inline(always)]
            || all_finite(&self.q) & all_finite(&self.v),
        )
    }

    /// Returns the momentum, W axes, N s and N m s: the initial momentum plus the integral of the external
    /// wrenches.
    pub(crate) fn momentum(&self) -> Momentum<S> {
        let (a, b) = (&self.initial_momentum, &self.impulse);
        Momentum { linear: a.linear + b.linear, angular: a.angular + b.angular }
    }

    /// Returns the state with `f` applied to every number.
    pub(crate) fn map<T>(&self, f: impl Fn(&S) -> T) -> TreeState<T> {
        let momentum = |h: &Momentum<S>| Momentum { linear: h.linear.map(&f), angular: h.angular.map(&f) };
        TreeState {
            q: self.q.iter().map(&f).collect(),
            v: self.v.iter().map(&f).collect(),
            initial_momentum: momentum(&self.initial_momentum),
            impulse: momentum(&self.impulse),
            work: f(&self.work),
            dissipated: f(&self.dissipated),
            center: self.center.map(|center| center.map(&f)),
            shares: self.shares.iter().map(&f).collect(),
            clock: self.clock.as_ref().map(&f),
        }
    }

    /// Copies `from` without allocating.
    pub(crate) fn copy_from(&mut self, from: &Self) {
        self.q.copy_from_slice(&from.q);
        self.v.copy_from_slice(&from.v);
        (self.initial_momentum, self.impulse) = (from.initial_momentum, from.impulse);
        (self.work, self.dissipated) = (from.work, from.dissipated);
        if from.center.is_some() {
            self.center = from.center;
        }
        self.shares.copy_from_slice(&from.shares);
        if from.clock.is_some() {
            self.clock = from.clock;
        }
    }

    /// Stores `from ⊕ h rate` with the step `h`, s: increments are added to positions and velocities, and the
    /// attitude is multiplied by `exp(h θ̇)` with the rate `θ̇` of the rotation vector.
    #[inline(always)]
    pub(crate) fn move_from(&mut self, from: &Self, rate: &TreeRate<S>, h: S) {
        rate.base_velocity.scale_add(h, Vec3::from_slice(&from.q)).write(&mut self.q);
        let attitude = Quat::from_xyzw(&from.q[3..]).product(exp_so3(rate.rotation_rate * h));
        attitude.renormalized().write_xyzw(&mut self.q[3..]);
        let joints = (&mut self.q[BASE_NQ..], &from.q[BASE_NQ..], &rate.joint_rates[..]);
        for (to, from, rate) in [joints, (&mut self.v[..], &from.v[..], &rate.a[..])] {
            for ((to, from), rate) in to.iter_mut().zip(from).zip(rate) {
                *to = rate.mul_add(h, *from);
            }
        }
        self.initial_momentum = from.initial_momentum;
        self.impulse.linear = rate.wrench.linear.scale_add(h, from.impulse.linear);
        self.impulse.angular = rate.wrench.angular.scale_add(h, from.impulse.angular);
        self.work = rate.power.mul_add(h, from.work);
        self.dissipated = rate.loss.mul_add(h, from.dissipated);
        if let (Some(center), Some(velocity)) = (from.center, rate.center_velocity) {
            self.center = Some(velocity.scale_add(h, center));
        }
        for ((to, from), rate) in self.shares.iter_mut().zip(&from.shares).zip(&rate.shares) {
            *to = rate.mul_add(h, *from);
        }
        if let (Some(clock), Some(rate)) = (from.clock, rate.clock) {
            self.clock = Some(rate.mul_add(h, clock));
        }
    }
}

impl<S: Scalar> TreeState<S> {
    /// Returns the configuration and the velocity as `f64`.
    pub(super) fn values(&self) -> [Vec<f64>; 2] {
        [&self.q, &self.v].map(|x| x.iter().map(|x| x.value()).collect())
    }
}

/// Returns true if all numbers are finite in every lane. The loop does not end early, so that it is
/// vectorised.
#[inline(always)]
fn all_finite<S: Real>(numbers: &[S]) -> bool {
    let mut is_finite = true;
    for x in numbers {
        for lane in 0..S::LANES {
            is_finite &= x.lane(lane).is_finite();
        }
    }
    is_finite
}
