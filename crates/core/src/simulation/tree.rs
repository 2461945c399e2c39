//! Equations of motion of one tree, with which the time derivatives of its state are computed from the state,
//! the loads and the joint torques.

use super::body_states::LoadedSystem;
use super::modes::JointModes;
use super::singularity_watch::SingularityWatch;
use super::tree_state::{TreeRate, TreeState};
use crate::dynamics::{
    ClosedLoops, Data, Momentum, base_rotation, center_of_mass, center_of_mass_b, constrained_recursion,
    kinematics, kinetic_energy, momentum, project_configuration, project_velocity, projected_base_twist,
};
use crate::model::{BASE_NQ, BASE_NV, JointSpring, Model};
use crate::spatial::{Force, Motion, Real, Vec3};
use crate::world::Brake;
use std::borrow::Cow;

/// Equations of motion of one tree under constant joint torques and the external wrenches in `data`.
pub(crate) struct Tree<'a, S> {
    pub(crate) model: Cow<'a, Model>,
    pub(crate) data: Data<S>,
    /// Commanded joint torques, `(n,)`, N m or N, without the compensation of Coulomb friction.
    pub(crate) command: Vec<S>,
    /// Generalized forces of a stage, `(nv,)`, N m or N: the sum of the command and of the torques of
    /// springs, damping, friction and brakes; zero at the base.
    pub(super) forces: Vec<S>,
    /// Buffer for accelerations or changes of velocity, `(nv,)`.
    pub(super) scratch: Vec<S>,
    /// Velocity of the frame to which the velocities in `data` are relative, W axes, m/s. During a step, this
    /// is the velocity that the base's origin had at the start of the step; otherwise it is zero.
    frame_velocity: Vec3<S>,
    mass: S,
    /// Modes of the joints: whether each of them moves, sticks or rests at a stop.
    pub(crate) modes: JointModes,
    /// Constraints of the tree; empty without closed loops and mimic joints.
    pub(super) loops: ClosedLoops<S>,
    pub(super) singularities: SingularityWatch,
    /// True for each joint, `(n,)`, that the last projection onto the loops did not move; empty if there were
    /// no such joints.
    pub(super) kept: Vec<bool>,
    /// True if any joint has damping, friction or a brake.
    is_lossy: bool,
    /// Indices of the joints with springs, each with its spring.
    springs: Vec<(usize, JointSpring)>,
    /// Indices of the joints of each member; empty if the tree has a single member.
    pub(super) shares: Vec<Vec<usize>>,
}

impl<'a, S: Real> Tree<'a, S> {
    /// Creates the equations of motion of `model`. `restitution` is the coefficient of restitution of the
    /// stops at the position limits of joints, from 0 to 1; `None` means no stops.
    pub(crate) fn new(model: Cow<'a, Model>, restitution: Option<f64>) -> Self {
        let modes = JointModes::new(&model, restitution);
        Self::with_modes(model, modes)
    }

    /// Creates the equations of motion of `model`, with the given modes of its joints.
    pub(super) fn with_modes(model: Cow<'a, Model>, modes: JointModes) -> Self {
        let (n, zero) = (model.joint_count(), S::of(0.0));
        Self {
            data: Data::new(&model),
            command: vec![zero; n],
            forces: vec![zero; model.nv()],
            scratch: vec![zero; model.nv()],
            frame_velocity: Vec3::zero(),
            mass: S::of(model.mass()),
            loops: ClosedLoops::new(&model, model.closures()),
            singularities: SingularityWatch::default(),
            kept: Vec::new(),
            shares: Vec::new(),
            springs: model.springs().map(|(joint, spring)| (joint, *spring)).collect(),
            is_lossy: model.joints().iter().any(|joint| joint.damping > 0.0 || joint.friction > 0.0)
                || modes.has_brakes(),
            modes,
            model,
        }
    }

    /// Adds brakes to the joints of the tree and engages those that are initially engaged.
    pub(super) fn with_brakes(mut self, brakes: &[Brake]) -> Self {
        if brakes.is_empty() {
            return self;
        }
        self.modes.allow_brakes();
        self.is_lossy = true;
        for brake in brakes.iter().filter(|brake| brake.is_engaged) {
            self.modes.set_brake(brake.joint, brake.slip_torque);
        }
        self
    }

    /// Computes the kinematics of `state` and projects its base twist `v_b` onto its momentum:
    /// `v_b = Mbb⁻¹ (h − Mbm q̇)`, with the blocks `Mbb` of the base and `Mbm` between base and joints of the
    /// mass matrix.
    ///
    /// The momentum `h` is integrated from the external wrenches alone. Without such wrenches it is therefore
    /// conserved up to rounding errors, whereas the integrated base twist has a truncation error. In a run
    /// with several trees, the base is also shifted so that the centre of mass is the integral of its
    /// velocity `P/m`, linear momentum over mass. Stages within a step are not projected.
    ///
    /// If the tree has closed loops, the configuration is first projected onto them; after the base twist has
    /// been projected, so is the velocity.
    pub(crate) fn project_momentum(&mut self, state: &mut TreeState<S>) {
        if self.loops.is_empty() {
            self.project_twist(state);
        } else {
            self.project_onto_loops(state);
        }
        if let Some(center) = state.center {
            let shift = center - center_of_mass(&self.data, &state.q);
            (Vec3::from_slice(&state.q) + shift).write(&mut state.q);
        }
    }

    /// Projects the configuration onto the closed loops, the base twist onto the momentum, and the velocity
    /// onto the closed loops.
    #[inline(never)]
    fn project_onto_loops(&mut self, state: &mut TreeState<S>) {
        self.move_given(state);
        let Self { model, data, loops, modes, kept, .. } = self;
        modes.find_kept_at_rest(&state.q, &state.v, kept);
        project_configuration(model, data, loops, &mut state.q, locked(kept));
        self.project_twist(state);
        self.close_velocity(state);
    }

    fn project_twist(&mut self, state: &mut TreeState<S>) {
        self.move_given(state);
        // velocities are taken relative to the base's origin, so that a speed of km/s in W costs no precision
        let frame_velocity = Motion::new(Vec3::from_slice(&state.v), Vec3::zero());
        Vec3::zero().write(&mut state.v);
        self.update_kinematics(state);
        let (mass, data) = (self.mass, &mut self.data);
        S::enter(
            #[inline(always)]
            || {
                let mut target = state.momentum();
                target.linear -= base_rotation(&state.q) * frame_velocity.linear * mass;
                let twist = projected_base_twist(data, &state.q, &state.v, target);
                let correction = twist - Motion::from_slice(&state.v) + frame_velocity;
                (twist + frame_velocity).write(&mut state.v);
                data.bodies.iter_mut().for_each(|body| body.velocity += correction.referred_to(body.pos_b));
            },
        );
    }

    /// Projects the velocity of `state` onto the closed loops, which changes neither the momentum nor the
    /// rates of the joints in `kept`. Computes the kinematics. Requires the articulated-body inertias of
    /// [`project_configuration`].
    fn close_velocity(&mut self, state: &mut TreeState<S>) {
        // relative to the base's origin, as in `project_twist`
        let frame_velocity = Vec3::from_slice(&state.v);
        Vec3::zero().write(&mut state.v);
        self.update_kinematics(state);
        let Self { model, data, loops, kept, .. } = self;
        project_velocity(model, data, loops, (&state.q, &mut state.v), locked(kept));
        (Vec3::from_slice(&state.v) + frame_velocity).write(&mut state.v);
        self.update_kinematics(state);
    }

    /// Computes the accelerations `a`, `(nv,)`, at the velocity `v` under the generalized forces in `forces`,
    /// with the present modes of the joints and the constraints of closed loops.
    #[inline]
    pub(super) fn accelerate(&mut self, v: &[S], a: &mut [S]) {
        let Self { model, data, loops, forces, modes, .. } = self;
        let locked = modes.locked().map(|locked| (locked, modes.accelerations()));
        constrained_recursion(model, data, loops, (v, forces), locked, a);
    }

    /// Writes the positions and rates of the joints with prescribed motion to `state`.
    fn move_given(&self, state: &mut TreeState<S>) {
        if let Some(clock) = state.clock {
            self.modes.move_given(clock.lane(0), &mut state.q, &mut state.v);
        }
    }

    /// Adds `change`, `(nv,)`, to the velocity of `state`, and the resulting changes of momentum and kinetic
    /// energy to its impulse and work. Computes the new kinematics. Requires the kinematics before the
    /// change.
    pub(super) fn jump(&mut self, state: &mut TreeState<S>, change: &[f64]) {
        let energy = |tree: &Self, state: &TreeState<S>| kinetic_energy(&tree.model, &tree.data, &state.v);
        let before = energy(self, state);
        state.v.iter_mut().zip(change).for_each(|(v, change)| *v += S::of(*change));
        self.update_kinematics(state);
        state.work += energy(self, state) - before;
        let h = momentum(&self.data, &state.q);
        let start = &state.initial_momentum;
        state.impulse = Momentum { linear: h.linear - start.linear, angular: h.angular - start.angular };
    }

    /// Computes the kinematics of `state` in W.
    pub(crate) fn update_kinematics(&mut self, state: &TreeState<S>) {
        self.frame_velocity = Vec3::zero();
        kinematics(&self.model, &mut self.data, &state.q, &state.v);
    }

    /// Computes the kinematics of a stage after the first, whose velocity is relative to the moving frame of
    /// the step.
    pub(super) fn update_stage_kinematics(&mut self, stage: &mut TreeState<S>) {
        self.move_given(stage);
        kinematics(&self.model, &mut self.data, &stage.q, &stage.v);
    }

    /// Restores the kinematics and loads at the start of a step after a trial step has overwritten them.
    pub(super) fn restore(&mut self, start: &Data<S>) {
        self.data.copy_from(start);
        self.frame_velocity = Vec3::zero();
    }

    /// Changes to the moving frame of the step, whose velocity is the current velocity of the base's origin.
    /// Afterwards, `v` and the velocities in `data` are relative to this frame.
    ///
    /// The equations of motion are the same in this frame, and the integrated velocities stay small. In base
    /// axes, even a velocity that is constant in W rotates with the base, which would reduce the precision
    /// and the order of convergence.
    pub(crate) fn enter_step_frame(&mut self, q: &[S], v: &mut [S]) {
        let frame_velocity_b = Vec3::from_slice(v);
        let Self { data, frame_velocity, .. } = self;
        S::enter(
            #[inline(always)]
            || {
                *frame_velocity = base_rotation(q) * frame_velocity_b;
                Vec3::zero().write(v);
                for body in &mut data.bodies {
                    body.velocity.linear -= frame_velocity_b;
                }
            },
        );
    }

    /// Returns the velocity of the moving frame of the step, W axes, m/s; zero outside a step.
    pub(crate) fn frame_velocity(&self) -> Vec3<S> {
        self.frame_velocity
    }

    /// Sets the velocity of the frame to which the velocities in `data` are relative, W axes, m/s.
    pub(super) fn follow_frame(&mut self, velocity: Vec3<S>) {
        self.frame_velocity = velocity;
    }

    /// Returns those parts of the tree that loads read and write; `q` is the configuration whose kinematics
    /// are in `data`.
    pub(super) fn loaded<'s>(&'s mut self, q: &'s [S]) -> LoadedSystem<'s, S> {
        LoadedSystem { q, frame_velocity: self.frame_velocity, data: &mut self.data }
    }

    /// Computes the time derivatives of a state whose kinematics and loads are in `data`, and writes them to
    /// `rate`; `is_loaded` is true if there are external loads.
    pub(crate) fn rates(&mut self, state: &TreeState<S>, is_loaded: bool, rate: &mut TreeRate<S>) {
        let (q, v) = (&state.q[..], &state.v[..]);
        if let Some(clock) = state.clock {
            self.modes.accelerate_given(clock.lane(0));
        }
        self.update_joint_forces(q, v);
        self.accelerate(v, &mut rate.a);
        let Self { model, data, forces, modes, frame_velocity, is_lossy, mass, .. } = self;
        let loaded = if is_loaded { model.nodes().len() } else { 0 };
        for joint in modes.given().iter().map(|given| given.joint) {
            forces[BASE_NV + joint] = data.bodies[joint + 1].holding_torque; // its power is work
        }
        rate.joint_rates.copy_from_slice(&v[BASE_NV..]);
        if state.center.is_some() {
            rate.center_velocity = Some(state.momentum().linear * (S::of(1.0) / *mass));
        }
        S::enter(
            #[inline(always)]
            || base_rates(data, loaded, q, v, *frame_velocity, forces, rate),
        );
        if *is_lossy {
            self.losses(v, rate);
        }
    }

    /// Writes the power that damping, friction and brakes dissipate in the joints at the velocity `v` to
    /// `rate`.
    #[inline(never)]
    fn losses(&self, v: &[S], rate: &mut TreeRate<S>) {
        let Self { model, modes, shares, .. } = self;
        rate.loss = S::enter(
            #[inline(always)]
            || modes.loss(model, v),
        );
        for (share, joints) in rate.shares.iter_mut().zip(shares) {
            *share = modes.loss_of(model, v, joints.iter().copied());
        }
    }

    /// Returns the torques of the motors, N m or N: the commands plus the compensation of Coulomb friction.
    pub(crate) fn torques(&self) -> impl Iterator<Item = S> {
        let joints = self.command.iter().zip(self.modes.compensations());
        joints.map(|(command, torque)| torque.map_or(*command, |torque| *command + S::of(torque)))
    }

    /// Returns the elastic energy of the springs at the configuration `q`, `(nq,)`, J; `None` if no joint has
    /// a spring.
    pub(crate) fn spring_energy(&self, q: &[S]) -> Option<S> {
        let energies = self.springs.iter().map(|(joint, spring)| spring.energy(q[BASE_NQ + joint]));
        energies.reduce(|sum, energy| sum + energy)
    }

    /// Computes the generalized forces at the joints, N m or N, `τ − k d − k₃ d³ − b q̇ − f s`, with the
    /// commanded torque `τ`, the stiffnesses `k` and `k₃` and the deflection `d` of the spring, the damping
    /// `b`, the Coulomb friction `f` of the joint and of an engaged brake, and the direction of slip `s`, and
    /// writes them to `forces`. For joints whose motors compensate friction, `f` is that of the brake alone.
    #[inline]
    pub(super) fn update_joint_forces(&mut self, q: &[S], v: &[S]) {
        let Self { model, modes, command, forces, is_lossy, springs, .. } = self;
        forces[BASE_NV..].copy_from_slice(command);
        for (joint, spring) in springs {
            forces[BASE_NV + *joint] += spring.torque(q[BASE_NQ + *joint]);
        }
        if !*is_lossy {
            return;
        }
        S::enter(
            #[inline(always)]
            || {
                for (j, joint) in model.joints().iter().enumerate() {
                    forces[BASE_NV + j] -=
                        v[BASE_NV + j] * S::of(joint.damping) + S::of(modes.remaining_drag(j));
                }
            },
        );
    }
}

/// Returns the argument with which the projections keep the joints in `kept` from moving; `kept` is empty if
/// there are no such joints.
fn locked(kept: &[bool]) -> Option<(&[bool], &'static [f64])> {
    (!kept.is_empty()).then_some((kept, &[][..]))
}

/// Computes the velocity and acceleration of the base in W, the sum of the wrenches on the first `loaded`
/// bodies about the centre of mass in W axes, and the power of all forces, and writes them to `rate`. `v` and
/// the velocities in `data` are relative to a frame that moves with `frame_velocity`, W axes, m/s.
#[inline(always)]
fn base_rates<S: Real>(
    data: &Data<S>,
    loaded: usize,
    q: &[S],
    v: &[S],
    frame_velocity: Vec3<S>,
    forces: &[S],
    rate: &mut TreeRate<S>,
) {
    let rot_wb = base_rotation(q);
    rate.base_velocity = rot_wb * Vec3::from_slice(v) + frame_velocity;
    rate.rotation_rate = Vec3::from_slice(&v[3..]);
    // p̈ = R (a + ω × v)
    rate.base_acceleration =
        rot_wb * (Vec3::from_slice(&rate.a) + rate.rotation_rate.cross(Vec3::from_slice(v)));
    let (mut total, mut power) = (Force::zero(), S::of(0.0));
    for body in &data.bodies[..loaded] {
        total += body.external.from_point(body.pos_b);
        power += body.velocity.dot(body.external);
    }
    for (tau, rate) in forces[BASE_NV..].iter().zip(&v[BASE_NV..]) {
        power = tau.mul_add(*rate, power);
    }
    if loaded > 0 {
        total.angular -= center_of_mass_b(data).cross(total.linear);
    }
    rate.wrench = Momentum { linear: rot_wb * total.linear, angular: rot_wb * total.angular };
    rate.power = power + rate.wrench.linear.dot(frame_velocity);
}
