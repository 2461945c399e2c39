//! Grip-force law: closes a gripper and then grips the object with a given force.

use super::control_law::{ControlLaw, EffortInput, EffortWork};
use super::error::ControlError;
use super::fingers::{Finger, FingerForce, fingers_of, mean_force};
use super::gains::{PerJoint, check_numbers};
use super::grip_memory::GripMemory;
use crate::model::{Axis, BASE_NQ, Model};

/// Law that closes the fingers of a gripper at a given rate until they touch an object, and then grips it
/// with a given force.
///
/// A finger is moved by a joint of the group, or by a joint that mimics such a joint. `N` is the mean of the
/// normal forces of all fingers, computed from the contact forces of the simulation. Until all fingers touch,
/// each joint moves at its closing rate `r`: `τ = d (r − q̇)`. Then the desired force `F` increases from the
/// present normal force to `force` at the rate `force/ramp`, and
///
/// `τ = λ (F + ∫ i (F − N) dt) − d q̇ − p Δ`
///
/// with the lever `λ` of the joint: the effort that balances a normal force of 1 N at each of its fingers.
/// The lever follows from the points and normals of the contacts and, in a robot with closed loops, from the
/// motion of the finger that the loops impose. `Δ` is the displacement of the joint since all fingers
/// touched, without its component along the closing motion; the stiffness `p` thus keeps independent joints
/// from moving sideways together with the object. If a finger loses contact, the joints move at their
/// closing rates again.
#[derive(Clone, Debug)]
pub struct GripForce {
    /// Desired mean of the normal forces of all fingers, N.
    pub force: f64,
    /// Rates of the joints until all fingers touch, rad/s (m/s); their signs are those of the closing motion.
    pub closing_rate: PerJoint,
    /// Time in which the desired force would increase from zero to `force`, s; 0 for an immediate increase.
    pub ramp: f64,
    /// Gain `i` of the integral of the force error, 1/s.
    pub integral: f64,
    /// Damping `d`, N m s/rad (N s/m).
    pub damping: PerJoint,
    /// Stiffness `p` against joint motions of the fingers together with the object, N m/rad (N/m).
    pub stiffness: PerJoint,
    /// Largest effort, N m (N); infinity for no limit.
    pub effort_limit: PerJoint,
}

impl GripForce {
    /// Creates a law with a desired force, N, a closing rate, rad/s (m/s), and a damping, N m s/rad (N s/m).
    /// It has a ramp of 0.5 s and an integral gain of 5 1/s, but neither stiffness nor effort limits.
    pub fn new(force: f64, closing_rate: f64, damping: f64) -> Self {
        Self {
            force,
            closing_rate: closing_rate.into(),
            ramp: 0.5,
            integral: 5.0,
            damping: damping.into(),
            stiffness: 0.0.into(),
            effort_limit: f64::INFINITY.into(),
        }
    }

    /// Checks the parameters for a group of `count` joints.
    ///
    /// # Errors
    /// [`ControlError`] if the number of values is neither 1 nor `count`, if the force or a damping is not
    /// positive, if a closing rate is zero, if the ramp, the integral gain, a stiffness or an effort limit is
    /// negative, or if a value is too large or not finite. Effort limits may be infinite.
    pub fn check(&self, count: usize) -> Result<(), ControlError> {
        for (name, value) in [("force", self.force), ("ramp", self.ramp), ("integral", self.integral)] {
            check_numbers(name, &[value])?;
        }
        if self.force == 0.0 {
            return Err(ControlError::NotPositive { name: "force" });
        }
        self.damping.check("damping", count)?;
        if !self.damping.is_positive() {
            return Err(ControlError::NotPositive { name: "damping" });
        }
        self.closing_rate.check_signed("closing_rate", count)?;
        self.stiffness.check("stiffness", count)?;
        self.effort_limit.check_limit("effort_limit", count)
    }

    /// Checks that the effort limits of the prismatic joints of the group permit the force, assuming that the
    /// contact normals are parallel to the joint axes. The levers of revolute joints and of joints in closed
    /// loops are not known before the contact.
    fn check_efforts(&self, control: &str, joints: &[usize], model: &Model) -> Result<(), ControlError> {
        let fingers = fingers_of(joints, model);
        for (place, &j) in joints.iter().enumerate() {
            let is_prismatic = |joint: usize| model.nodes()[joint + 1].axis == Axis::Prismatic;
            let own = fingers.iter().filter(|finger| finger.place == place && is_prismatic(finger.joint));
            let is_known = is_prismatic(j) && !own.clone().any(|finger| finger.is_in_loop(model));
            let levers: f64 = own.map(|finger| finger.ratio.abs()).sum();
            let (joint, effort) = (&model.joints()[j], self.force * levers);
            let limit = self.effort_limit.at(place).min(joint.limits.effort.unwrap_or(f64::INFINITY));
            if is_known && effort > limit {
                let (control, joint, force) = (control.to_owned(), joint.name.clone(), self.force);
                return Err(ControlError::GripEffort { control, joint, force, effort, limit });
            }
        }
        Ok(())
    }

    /// Updates the desired force and the integral `dt` seconds after the last control tick, and writes the
    /// efforts of the group to `tau`, N m (N), which initially holds the efforts of damping and stiffness.
    /// `levers` contains the lever of each joint, m (1), and `normal` is the mean normal force, N.
    fn squeeze(&self, memory: &mut GripMemory, (normal, dt): (f64, f64), levers: &[f64], tau: &mut [f64]) {
        let rise = if self.ramp > dt { self.force * dt / self.ramp } else { self.force };
        memory.reference = (memory.reference + rise).min(self.force);
        let change = self.integral * (memory.reference - normal) * dt;
        let command = memory.reference + memory.integral;
        let limits = |place: usize| self.effort_limit.at(place);
        // the integral stops growing when the effort of a joint reaches its limit; the sum of desired force
        // and integral is never negative
        let room = |place: usize| {
            let (before, growth) = (tau[place] + levers[place] * command, levers[place] * change);
            let effort = before + growth;
            let is_beyond = effort.abs() > limits(place) && effort * growth > 0.0;
            if is_beyond { (limits(place).copysign(effort) - before) / growth } else { 1.0 }
        };
        let fraction = (0..tau.len()).map(room).fold(1.0, f64::min).max(0.0);
        memory.integral = (memory.integral + fraction * change).max(-memory.reference);
        // τ = λ (F + ∫ i (F − N) dt) − d q̇ − p Δ
        for (place, tau) in tau.iter_mut().enumerate() {
            let effort = *tau + levers[place] * (memory.reference + memory.integral);
            *tau = effort.clamp(-limits(place), limits(place));
        }
    }

    /// Returns the component of a joint displacement `δ` along the closing motion, `(r · δ)/(r · r)`, s:
    /// multiplied by the closing rates `r`, it is the projection of `δ` onto the closing motion.
    /// `displacement` returns `δ` for each of the `joints` joints, rad (m).
    fn along_closing(&self, displacement: impl Fn(usize) -> f64, joints: usize) -> f64 {
        let rate = |place: usize| self.closing_rate.at(place);
        let sum = |of: &dyn Fn(usize) -> f64| (0..joints).map(of).sum::<f64>();
        sum(&|place| rate(place) * displacement(place)) / sum(&|place| rate(place) * rate(place))
    }
}

impl ControlLaw for GripForce {
    fn check_group(&self, control: &str, joints: &[usize], model: &Model) -> Result<(), ControlError> {
        self.check(joints.len()).map_err(|error| error.of_control(control))?;
        self.check_efforts(control, joints, model)
    }

    fn efforts(
        &mut self,
        input: &EffortInput<'_>,
        work: EffortWork<'_>,
        tau: &mut [f64],
    ) -> Result<(), ControlError> {
        let (Some(memory), (fingers, forces)) = (work.grip, input.fingers) else { return Ok(()) };
        let q = |place: usize| input.observation.q[BASE_NQ + input.observation.joints[place]];
        if !forces.iter().all(|force| force.normal > 0.0) {
            memory.release();
            for (place, tau) in tau.iter_mut().enumerate() {
                let (rate, limit) = (self.closing_rate.at(place), self.effort_limit.at(place));
                // τ = d (r − q̇)
                *tau = (self.damping.at(place) * (rate - input.rates[place])).clamp(-limit, limit);
            }
            return Ok(());
        }
        let normal = mean_force(forces);
        if !memory.is_closed {
            (memory.is_closed, memory.reference) = (true, normal.min(self.force));
            memory.held.iter_mut().enumerate().for_each(|(place, held)| *held = q(place));
        }
        let moved = |place: usize| q(place) - memory.held[place];
        let closed = self.along_closing(moved, tau.len());
        for (place, tau) in tau.iter_mut().enumerate() {
            let across = moved(place) - closed * self.closing_rate.at(place);
            *tau = -self.damping.at(place) * input.rates[place] - self.stiffness.at(place) * across;
        }
        let levers = &mut work.scratch[..tau.len()];
        write_levers(fingers, forces, levers);
        self.squeeze(memory, (normal, input.elapsed), levers, tau);
        Ok(())
    }
}

/// Writes, for each joint of the group, the effort that balances a normal force of 1 N at each of its
/// fingers, m (1): `λ = −Σ e/N` with the normal force `N` of a finger and its effort `e` on the joint.
fn write_levers(fingers: &[Finger], forces: &[FingerForce], levers: &mut [f64]) {
    levers.fill(0.0);
    for (finger, force) in fingers.iter().zip(forces) {
        levers[finger.place] -= force.effort / force.normal;
    }
}
