//! The robot as the integrator sees it: from a state and torques to its rate of change.

use super::contacts::Contacts;
use super::error::SimulationError;
use super::state::{Rate, State};
use crate::dynamics::{
    Data, Momentum, base_rotation, base_twist, center_of_mass_b, forward_dynamics_recursion, kinematics,
    locked_dynamics_recursion,
};
use crate::model::Model;
use crate::spatial::{Force, Motion, Real, Vec3};

/// What acts on the bodies from outside.
pub(crate) trait World<S> {
    /// Puts the wrenches of all effects on the bodies. Needs `kinematics`, relative to a frame that
    /// moves at `carried` (W axes).
    fn apply(
        &mut self,
        data: &mut Data<S>,
        q: &[S],
        carried: Vec3<S>,
        t: f64,
        interval: (f64, f64),
    ) -> Result<(), SimulationError>;

    /// Whether anything acts at all: where nothing does, the wrenches on the bodies stay zero.
    fn acts(&self) -> bool;
}

/// Empty space: nothing acts.
pub(crate) struct Nothing;

impl<S> World<S> for Nothing {
    fn apply(
        &mut self,
        _: &mut Data<S>,
        _: &[S],
        _: Vec3<S>,
        _: f64,
        _: (f64, f64),
    ) -> Result<(), SimulationError> {
        Ok(())
    }

    fn acts(&self) -> bool {
        false
    }
}

/// A robot in its surroundings, with the torques held at its joints.
pub(crate) struct Plant<'a, S, W> {
    pub(crate) model: &'a Model,
    pub(crate) data: Data<S>,
    pub(crate) surroundings: W,
    /// Commanded joint torques, `(n,)`, N m; drives add what compensates Coulomb friction.
    pub(crate) command: Vec<S>,
    /// All generalized forces of a stage, `(nv,)`: command, damping and friction.
    pub(super) forces: Vec<S>,
    /// Accelerations or changes of velocity in passing, `(nv,)`.
    pub(super) scratch: Vec<S>,
    /// Velocity, W axes, of the frame in which `data` has its velocities: W's own outside a step, that
    /// of the base's origin at the start of the step within it.
    carried: Vec3<S>,
    mass: S,
    /// Joints that stick or stand at a stop.
    pub(crate) contacts: Contacts,
    /// Whether joints lose energy while they move.
    is_lossy: bool,
}

impl<'a, S: Real, W: World<S>> Plant<'a, S, W> {
    /// `stops`: the restitution of the joints' limits, where they are to be kept.
    pub(crate) fn new(model: &'a Model, surroundings: W, stops: Option<f64>) -> Self {
        let (n, zero) = (model.joint_count(), S::of(0.0));
        Self {
            model,
            data: Data::new(model),
            surroundings,
            command: vec![zero; n],
            forces: vec![zero; model.nv()],
            scratch: vec![zero; model.nv()],
            carried: Vec3::zero(),
            mass: S::of(model.mass()),
            contacts: Contacts::new(model, stops),
            is_lossy: model.joints().iter().any(|joint| joint.damping > 0.0 || joint.friction > 0.0),
        }
    }

    /// Kinematics at the start of a step, the base twist put right by the momentum.
    ///
    /// The momentum was integrated from the wrenches alone, so that it is kept to rounding where
    /// none act; the twist of the integrator differs by its truncation error.
    pub(crate) fn settle(&mut self, state: &mut State<S>) {
        // in the frame of the base's origin: a robot that W sees pass at km/s keeps all its digits
        let passing = Motion::new(Vec3::from_slice(&state.v), Vec3::zero());
        Vec3::zero().write(&mut state.v);
        self.carried = Vec3::zero();
        kinematics(self.model, &mut self.data, &state.q, &state.v);
        let (mass, data) = (self.mass, &mut self.data);
        S::enter(
            #[inline(always)]
            || {
                let mut target = state.momentum();
                target.linear -= base_rotation(&state.q) * passing.linear * mass;
                let twist = base_twist(data, &state.q, &state.v, target);
                let correction = twist - Motion::from_slice(&state.v) + passing;
                (twist + passing).write(&mut state.v);
                data.bodies.iter_mut().for_each(|body| body.velocity += correction.referred_to(body.pos_b));
            },
        );
    }

    /// Kinematics at a state that stays as it is.
    pub(crate) fn look(&mut self, state: &State<S>) {
        self.carried = Vec3::zero();
        kinematics(self.model, &mut self.data, &state.q, &state.v);
    }

    /// Goes over to the frame that moves with the base's origin as it does now; `v` and the
    /// velocities in `data` follow.
    ///
    /// The equations of motion are the same there, and what is integrated stays robot-sized: in base
    /// axes even a straight flight is a velocity that turns, at the cost of digits and of order.
    pub(crate) fn ride(&mut self, q: &[S], v: &mut [S]) {
        let passing = Vec3::from_slice(v);
        let Self { data, carried, .. } = self;
        S::enter(
            #[inline(always)]
            || {
                *carried = base_rotation(q) * passing;
                Vec3::zero().write(v);
                for body in &mut data.bodies {
                    body.velocity.linear -= passing;
                }
            },
        );
    }

    /// Velocity of the frame of the step, W axes, m/s.
    pub(crate) fn carried(&self) -> Vec3<S> {
        self.carried
    }

    /// External wrenches at the state whose kinematics are in `data`.
    pub(crate) fn surround(&mut self, t: f64, interval: (f64, f64), q: &[S]) -> Result<(), SimulationError> {
        self.surroundings.apply(&mut self.data, q, self.carried, t, interval)
    }

    /// Rates at a state whose kinematics and wrenches are in `data`.
    pub(crate) fn accelerate(&mut self, q: &[S], v: &[S], rate: &mut Rate<S>) {
        self.drive(v);
        let Self { model, data, forces, contacts, carried, is_lossy, surroundings, .. } = self;
        let pushed = if surroundings.acts() { model.nodes().len() } else { 0 };
        match contacts.locked() {
            Some(locked) => locked_dynamics_recursion(model, data, v, forces, locked, &mut rate.a),
            None => forward_dynamics_recursion(model, data, v, forces, &mut rate.a),
        }
        rate.v.copy_from_slice(v);
        S::enter(
            #[inline(always)]
            || balance(data, pushed, q, v, *carried, forces, rate),
        );
        if *is_lossy {
            rate.loss = S::enter(
                #[inline(always)]
                || contacts.loss(model, v),
            );
        }
    }

    /// What the drive of a joint adds to its command to compensate Coulomb friction, N m (N).
    pub(crate) fn compensation(&self, j: usize) -> f64 {
        self.contacts.compensation(j).unwrap_or(0.0)
    }

    /// Torque of the drive of a joint: the command, and what compensates Coulomb friction, N m (N).
    pub(crate) fn torque(&self, j: usize) -> S {
        match self.contacts.compensation(j) {
            Some(compensation) => self.command[j] + S::of(compensation),
            None => self.command[j],
        }
    }

    /// Torques at the joints: `τ − b q̇ − f s` with `s` the direction of slip; `f s` is left out where it is
    /// compensated.
    pub(super) fn drive(&mut self, v: &[S]) {
        let Self { model, contacts, command, forces, is_lossy, .. } = self;
        forces[6..].copy_from_slice(command);
        if !*is_lossy {
            return;
        }
        S::enter(
            #[inline(always)]
            || {
                for (j, joint) in model.joints().iter().enumerate() {
                    forces[j + 6] -= v[j + 6] * S::of(joint.damping) + S::of(contacts.remaining_drag(j));
                }
            },
        );
    }

    /// Kinematics, wrenches and rates of a later stage.
    pub(crate) fn evaluate(
        &mut self,
        t: f64,
        interval: (f64, f64),
        state: &State<S>,
        rate: &mut Rate<S>,
    ) -> Result<(), SimulationError> {
        kinematics(self.model, &mut self.data, &state.q, &state.v);
        self.surround(t, interval, &state.q)?;
        self.accelerate(&state.q, &state.v, rate);
        Ok(())
    }
}

/// Velocity and acceleration of the base, sum of the wrenches on the first `pushed` bodies and the power of all forces, in W;
/// `v` and the velocities in `data` are relative to a frame that moves at `carried`.
#[inline(always)]
fn balance<S: Real>(
    data: &Data<S>,
    pushed: usize,
    q: &[S],
    v: &[S],
    carried: Vec3<S>,
    forces: &[S],
    rate: &mut Rate<S>,
) {
    let rot_wb = base_rotation(q);
    rate.origin = rot_wb * Vec3::from_slice(v) + carried;
    rate.turn = Vec3::from_slice(&v[3..]);
    rate.bend = rot_wb * (Vec3::from_slice(&rate.a) + rate.turn.cross(Vec3::from_slice(v)));
    let (mut total, mut power) = (Force::zero(), S::of(0.0));
    for body in &data.bodies[..pushed] {
        total += body.external.from_point(body.pos_b);
        power += body.velocity.dot(body.external);
    }
    for (tau, rate) in forces[6..].iter().zip(&v[6..]) {
        power = tau.mul_add(*rate, power);
    }
    if pushed > 0 {
        total.angular -= center_of_mass_b(data).cross(total.linear);
    }
    rate.wrench = Momentum { linear: rot_wb * total.linear, angular: rot_wb * total.angular };
    rate.power = power + rate.wrench.linear.dot(carried);
}
