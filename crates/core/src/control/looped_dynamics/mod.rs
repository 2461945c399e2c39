//! Joint torques of the controls of robots with closed loops.

mod coordinates;
mod driven_jacobian;
mod torques;

use super::control_law::JointCommand;
use super::driven_torques::DrivenTorques;
use super::hybrid_dynamics::HybridDynamics;
use super::internal_force::InternalForce;
use crate::dynamics::{ClosedLoops, Data, FreeFloating, IndependentJoints, add_leaders, length_joints};
use crate::model::{Closure, Model};
use crate::spatial::Scalar;

/// Constraints of the closed loops of a tree, and the solver for the torques of its controls.
#[derive(Debug)]
pub(super) struct Looped<S> {
    loops: ClosedLoops<S>,
    pub(super) dynamics: LoopedDynamics,
}

impl<S: Scalar> Looped<S> {
    /// Allocates the solver for a tree with closed loops and up to `tasks` tasks. `own` has the index in the
    /// tree of each joint of the robot. `names` has the name by which an [`InternalForce`] refers to each
    /// closure of the tree, or `None` for a closure without such a name. Returns `None` if the tree has no
    /// loops.
    pub(super) fn new(
        model: &Model,
        own: Vec<usize>,
        names: Vec<Option<String>>,
        tasks: usize,
    ) -> Option<Self> {
        let loops = ClosedLoops::new(model, model.closures());
        let dynamics = LoopedDynamics::new(model, &loops, own, names, tasks);
        (!loops.is_empty()).then_some(Self { loops, dynamics })
    }

    /// Allocates the solver for a single robot and up to `tasks` tasks; returns `None` if it has no loops.
    pub(super) fn of_robot(model: &Model, tasks: usize) -> Option<Self> {
        let names = model.closures().iter().map(|closure| Some(closure.name.clone())).collect();
        Self::new(model, (0..model.joint_count()).collect(), names, tasks)
    }

    /// Sets the reduced model of the tree and its constraints. Requires in `data` the results of
    /// [`free_floating_recursion`](crate::dynamics::free_floating_recursion), which computed `reduced`.
    pub(super) fn update(&mut self, model: &Model, data: &Data<S>, reduced: &FreeFloating<S>) {
        let LoopedDynamics { n, m, inertia, model_load, jacobian, right, .. } = &mut self.dynamics;
        inertia.iter_mut().zip(&reduced.inertia).for_each(|(to, from)| *to = from.value());
        for (j, load) in model_load.iter_mut().enumerate() {
            *load = (reduced.bias[j] - reduced.external[j]).value();
        }
        jacobian.resize(*m * *n, 0.0);
        right.resize(*m, 0.0);
        self.loops.joint_constraints(model, data, jacobian, right);
    }
}

/// Solver for the torques of controls on a robot with closed loops.
///
/// The constraints on the joints are `K q̈ = k`. They are satisfied by the joint accelerations `q̈ = G z + g`
/// with the accelerations `z` of independent coordinates ([`IndependentJoints`]). The independent joints are
/// chosen among the driven joints as far as possible. With `M* q̈ + l = τ + Kᵀ λ` and `K G = 0`, the reduced
/// equations are `Gᵀ M* G z + Gᵀ (l + M* g) = Gᵀ τ`, to which [`HybridDynamics`] applies. In the rows of the
/// joints that tasks drive, the columns of `G` of these joints are orthonormal, and `g` is orthogonal to
/// them, so that the accelerations of least norm do not depend on the choice of independent joints.
///
/// Several driven joints may share one coordinate. The torques of the driven joints `A` are those of least
/// norm with the required efforts `u = G_Aᵀ τ_A` of the coordinates: `τ_A = G_A (G_Aᵀ G_A)⁻¹ u`. Joints
/// without a motor have no torque. Torques with `G_Aᵀ t = 0` change only the constraint forces `λ`, and no
/// motion. If internal forces are commanded, the smallest such `t` that produces them is added.
///
/// Source: Featherstone, Rigid Body Dynamics Algorithms, 2008, section 8.12 (inverse dynamics with closed
/// loops).
#[derive(Debug)]
pub(super) struct LoopedDynamics {
    /// Number of joints of the tree.
    n: usize,
    /// Number of constraints of the loops.
    m: usize,
    /// Index in the tree of each joint of the robot.
    own: Vec<usize>,
    /// Closures of the tree, each with the index of its first row and the name by which an [`InternalForce`]
    /// refers to it.
    closures: Vec<(Closure, usize, Option<String>)>,
    /// Preference of each joint of the tree as an independent joint, `(n,)`: 0 for mimic joints, 1 for all
    /// others.
    leader: Vec<u8>,
    /// For each constraint row, true if its error is a length, m; and for each joint, true if its position is
    /// a length, m.
    is_length: [Vec<bool>; 2],
    /// `M*` of the tree, row major `(n, n)`.
    inertia: Vec<f64>,
    /// `c* − Q*` of the tree, `(n,)`, N m (N).
    model_load: Vec<f64>,
    /// `K`, with `n` columns; the first `m` rows are those of the loops, the other rows those of joints held
    /// by friction.
    jacobian: Vec<f64>,
    /// `k`, with one entry per row of `K`.
    right: Vec<f64>,
    joints: IndependentJoints,
    hybrid: HybridDynamics,
    commands: Vec<JointCommand>,
    /// Loads `l` of the joints of the tree, `(n,)`, N m (N).
    load: Vec<f64>,
    /// Torques `τ` of the joints of the tree, `(n,)`, N m (N).
    tau: Vec<f64>,
    /// Accelerations `q̈` of the joints of the tree, `(n,)`, rad/s² (m/s²).
    acceleration: Vec<f64>,
    /// Damping in the null space and damping of suppressed rates of the joints of the tree, `(n,)`, 1/s.
    null_damping: Vec<[f64; 2]>,
    /// Indices of the rows with commanded constraint forces, and these forces, N or N m.
    commanded: Vec<(usize, f64)>,
    /// Constraint forces `λ`, N and N m.
    force: Vec<f64>,
    torques: DrivenTorques,
    work: Workspace,
}

/// Buffers of [`LoopedDynamics`], which keep their capacity between updates.
#[derive(Debug, Default)]
struct Workspace {
    /// Selected joints (indices in the tree).
    rows: Vec<usize>,
    /// Selected coordinates (columns of `G`).
    columns: Vec<usize>,
    class: Vec<u8>,
    commands: Vec<JointCommand>,
    /// Loads or rates of joints or coordinates.
    loads: Vec<f64>,
    efforts: Vec<f64>,
    /// Jacobian of a frame with respect to the joints of the tree, and to the coordinates.
    jacobians: [Vec<f64>; 2],
    matrix: Vec<f64>,
}

impl LoopedDynamics {
    fn new<S: Scalar>(
        model: &Model,
        loops: &ClosedLoops<S>,
        own: Vec<usize>,
        names: Vec<Option<String>>,
        tasks: usize,
    ) -> Self {
        let (n, m) = (model.joint_count(), loops.count());
        let zeros = |count: usize| vec![0.0; count];
        let mut leader = vec![0; n];
        add_leaders(model, &mut leader);
        let closures = model.closures().iter().zip(names).enumerate();
        Self {
            closures: closures
                .map(|(i, (closure, name))| (closure.clone(), loops.range_of(i).start, name))
                .collect(),
            leader,
            is_length: [loops.length_rows(), length_joints(model)],
            inertia: zeros(n * n),
            model_load: zeros(n),
            jacobian: zeros(m * n),
            right: zeros(m),
            joints: IndependentJoints::default(),
            hybrid: HybridDynamics::new(n, tasks),
            commands: vec![JointCommand::Effort; n],
            load: zeros(n),
            tau: zeros(n),
            acceleration: zeros(n),
            null_damping: vec![[0.0; 2]; n],
            commanded: Vec::new(),
            force: zeros(m),
            torques: DrivenTorques::default(),
            work: Workspace::default(),
            own,
            n,
            m,
        }
    }

    /// Removes the commanded internal forces.
    pub(super) fn clear_forces(&mut self) {
        self.commanded.clear();
    }

    /// Adds a commanded internal force. It has no effect while its loop is not closed.
    pub(super) fn add_force(&mut self, force: &InternalForce) {
        let closure = self.closures.iter().find(|(.., name)| name.as_ref() == Some(&force.closure));
        if let Some((closure, start, _)) = closure {
            self.commanded.extend(force.rows(closure).map(|(row, value)| (start + row, value)));
        }
    }

    /// Chooses the independent joints, eliminates those with given efforts `tau`, and clears the tasks.
    /// `joints`, `commands` and `tau` refer to the joints of the robot; `joints` has their commanded
    /// accelerations, their damping and those of their loads that the model does not include. Requires
    /// [`Looped::update`].
    pub(super) fn eliminate(&mut self, joints: &HybridDynamics, commands: &[JointCommand], tau: &[f64]) {
        self.commands.fill(JointCommand::Effort); // the joints of other robots have no motor torque
        self.tau.fill(0.0);
        self.load.copy_from_slice(&self.model_load);
        for (i, &j) in self.own.iter().enumerate() {
            (self.commands[j], self.null_damping[j]) = (commands[i], joints.null_damping[i]);
            self.load[j] += joints.load[i];
            match commands[i] {
                JointCommand::Effort | JointCommand::Held => self.tau[j] = tau[i],
                JointCommand::Acceleration => self.acceleration[j] = joints.acceleration[i],
                JointCommand::Task => {}
            }
        }
        self.choose_joints();
        self.reduce();
    }

    /// Returns the friction torque, N m (N), that holds a joint (index in the robot) at rest, or zero if the
    /// joint is not held. If the holding torques of several joints are redundant, some of them are zero.
    pub(super) fn holding_torque(&self, joint: usize) -> f64 {
        let is_held = |&j: &usize| self.commands[j] == JointCommand::Held;
        let row = (0..self.n).filter(is_held).position(|j| j == self.own[joint]);
        row.map_or(0.0, |row| self.force[self.m + row])
    }
}
