//! Torques of controls on robots with closed loops.

use super::control_law::JointCommand;
use super::driven_torques::DrivenTorques;
use super::hybrid_dynamics::HybridDynamics;
use super::internal_force::InternalForce;
use super::pseudo_inverse::ROWS;
use crate::dynamics::{ClosedLoops, Data, FreeFloating, IndependentJoints, add_leaders, length_joints};
use crate::model::{Closure, Model};
use crate::spatial::{Scalar, cholesky_factor, cholesky_solve, dot};

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
/// joints that tasks drive, the columns of `G` of these joints are orthonormal, so that the accelerations of
/// least norm do not depend on the choice of independent joints.
///
/// Several driven joints may share one coordinate. The torques of the driven joints `A` are those of least
/// norm with the required efforts `u = G_Aᵀ τ_A` of the coordinates: `τ_A = G_A (G_Aᵀ G_A)⁻¹ u`. Joints
/// without a motor have no torque. Torques with `G_Aᵀ t = 0` change only the constraint forces `λ`, and no
/// motion. If internal forces are commanded, the smallest such `t` that produces them is added.
///
/// Source: Featherstone, Rigid Body Dynamics Algorithms, 2008, section 8.12 (inverse dynamics with closed loops).
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
    /// For each row and for each joint, true if its unit is m.
    is_length: [Vec<bool>; 2],
    /// `M*` of the tree, row major `(n, n)`.
    inertia: Vec<f64>,
    /// `c* − Q*` of the tree, `(n,)`, N m (N).
    model_load: Vec<f64>,
    /// `K`, with `n` columns; the first `m` rows are those of the loops, the other rows those of joints held by
    /// friction.
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
            self.commanded.extend(force.rows(closure).into_iter().map(|(row, value)| (start + row, value)));
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

    /// Chooses independent joints, preferably those with commanded accelerations, then those of tasks.
    fn choose_joints(&mut self) {
        let Self { n, m, jacobian, right, is_length, commands, leader, joints, .. } = self;
        jacobian.truncate(*m * *n);
        right.truncate(*m);
        let [rows, columns] = is_length;
        rows.truncate(*m);
        for j in (0..*n).filter(|&j| commands[j] == JointCommand::Held) {
            // q̈_j = 0
            jacobian.extend((0..*n).map(|k| if k == j { 1.0 } else { 0.0 }));
            right.push(0.0);
            rows.push(columns[j]);
        }
        let class = |(command, leader): (&JointCommand, &u8)| {
            let class = match command {
                JointCommand::Held => 0,
                JointCommand::Effort => 1,
                JointCommand::Task => 2,
                JointCommand::Acceleration => 3,
            };
            2 * class + leader
        };
        let class: Vec<u8> = commands.iter().zip(&*leader).map(class).collect();
        joints.solve((jacobian, right), &class, [rows, columns]);
        self.orthonormalize();
    }

    /// Makes the columns of `G` that belong to tasks orthonormal in the rows of the joints that tasks drive, by the
    /// modified Gram-Schmidt process.
    fn orthonormalize(&mut self) {
        let f = self.joints.count();
        let is_task = |j: usize| self.commands[j] == JointCommand::Task;
        let columns: Vec<usize> = (0..f).filter(|&c| is_task(self.joints.independent[c])).collect();
        let rows: Vec<usize> = (0..self.n).filter(|&j| is_task(j)).collect();
        if rows.len() == columns.len() {
            return; // no dependent joints
        }
        let map = &mut self.joints.map;
        for (place, &c) in columns.iter().enumerate() {
            let size = rows.iter().map(|&j| map[j * f + c] * map[j * f + c]).sum::<f64>().sqrt();
            (0..self.n).for_each(|j| map[j * f + c] /= size);
            for &other in &columns[place + 1..] {
                let share: f64 = rows.iter().map(|&j| map[j * f + c] * map[j * f + other]).sum();
                (0..self.n).for_each(|j| map[j * f + other] -= share * map[j * f + c]);
            }
        }
    }

    /// Computes the reduced equations, and eliminates the coordinates with given efforts.
    fn reduce(&mut self) {
        let Self { n, joints, hybrid, inertia, load, tau, commands, null_damping, .. } = self;
        let f = joints.count();
        hybrid.set_count(f);
        joints.reduce_matrix(inertia, &mut hybrid.inertia);
        // Gᵀ (l + M* g − τ), where τ are the given efforts
        let loads: Vec<f64> =
            (0..*n).map(|j| load[j] + dot(&inertia[j * *n..(j + 1) * *n], &joints.drift) - tau[j]).collect();
        for c in 0..f {
            hybrid.load[c] = joints.reduced_effort(c, |j| loads[j]);
            hybrid.null_damping[c] = [0.0; 2];
            for j in (0..*n).filter(|&j| commands[j] == JointCommand::Task) {
                let square = joints.map[j * f + c] * joints.map[j * f + c];
                (0..2).for_each(|k| hybrid.null_damping[c][k] += square * null_damping[j][k]);
            }
        }
        self.command_accelerations();
        let commands: Vec<JointCommand> = self.joints.independent.iter().map(|&j| self.commands[j]).collect();
        self.hybrid.eliminate(&commands, &vec![0.0; f]);
    }

    /// Sets the accelerations of the coordinates with commanded accelerations. If the loops do not permit all
    /// commanded accelerations, the permitted ones that are nearest in the metric of `M*` are used (Gauss's
    /// principle).
    fn command_accelerations(&mut self) {
        let Self { n, joints, hybrid, inertia, commands, acceleration, .. } = self;
        let is_commanded = |j: &usize| commands[*j] == JointCommand::Acceleration;
        let f = joints.count();
        let rows: Vec<usize> = (0..*n).filter(is_commanded).collect();
        let columns: Vec<usize> = (0..f).filter(|&c| is_commanded(&joints.independent[c])).collect();
        if rows.len() == columns.len() {
            columns.iter().for_each(|&c| hybrid.acceleration[c] = acceleration[joints.independent[c]]);
            return;
        }
        // Gᵀ M G y = Gᵀ M (q̈ − g) on the commanded joints
        let (k, mut matrix, mut y) = (columns.len(), Vec::new(), Vec::new());
        let weighted = |a: usize| -> Vec<f64> {
            let product =
                |&i: &usize| rows.iter().map(|&j| inertia[i * *n + j] * joints.map[j * f + a]).sum();
            rows.iter().map(product).collect()
        };
        for &a in &columns {
            let weighted = weighted(a);
            let sum = |x: &dyn Fn(usize) -> f64| -> f64 {
                rows.iter().zip(&weighted).map(|(&j, w)| w * x(j)).sum()
            };
            matrix.extend(columns.iter().map(|&b| sum(&|j| joints.map[j * f + b])));
            y.push(sum(&|j| acceleration[j] - joints.drift[j]));
        }
        cholesky_factor(&mut matrix, k);
        cholesky_solve(&matrix, k, &mut y);
        columns.iter().zip(y).for_each(|(&c, y)| hybrid.acceleration[c] = y);
    }

    /// Adds a task of a frame with the acceleration `p̈r − d`, m/s² and rad/s², and the damping threshold
    /// `λ₀`. The row-major Jacobian has six rows, and one column per joint of the tree or, if it is relative
    /// to the base, per joint of the robot.
    pub(super) fn add_task(&mut self, jacobian: &[f64], mut acceleration: [f64; ROWS], damping: f64) {
        let (n, own) = (self.n, &self.own);
        let mut all = vec![0.0; ROWS * n];
        if jacobian.len() == ROWS * n {
            all.copy_from_slice(jacobian);
        } else {
            for (to, from) in all.chunks_exact_mut(n).zip(jacobian.chunks_exact(own.len())) {
                own.iter().zip(from).for_each(|(&j, x)| to[j] = *x);
            }
        }
        // ẍ = J G z + J g + d
        for (acceleration, row) in acceleration.iter_mut().zip(all.chunks_exact(n)) {
            *acceleration -= dot(row, &self.joints.drift);
        }
        let mut reduced = vec![0.0; ROWS * self.joints.count()];
        self.joints.reduce_rows(&all, &mut reduced);
        self.hybrid.add_task(&reduced, acceleration, damping);
    }

    /// Computes the accelerations of the robot's joints, rad/s² (m/s²), and the torques of its driven joints,
    /// N m (N). `rates` contains the rates of the joints of the tree, rad/s (m/s).
    pub(super) fn solve(&mut self, rates: &[f64], acceleration: &mut [f64], tau: &mut [f64]) {
        let (f, is_task) = (self.joints.count(), |j: usize| self.commands[j] == JointCommand::Task);
        let along = |c: usize| {
            (0..self.n).filter(|&j| is_task(j)).map(|j| self.joints.map[j * f + c] * rates[j]).sum()
        };
        let coordinate_rates: Vec<f64> = (0..f).map(along).collect();
        let mut efforts = vec![0.0; f];
        self.hybrid.solve(&coordinate_rates, &mut efforts);
        self.joints.accelerations(&self.hybrid.acceleration, &mut self.acceleration);
        self.distribute(&efforts);
        for (i, &j) in self.own.iter().enumerate() {
            (acceleration[i], tau[i]) = (self.acceleration[j], self.tau[j]);
        }
    }

    /// Returns the friction torque, N m (N), that holds a joint (index in the robot) at rest, or zero if the
    /// joint is not held. If the holding torques of several joints are redundant, some of them are zero.
    pub(super) fn holding_torque(&self, joint: usize) -> f64 {
        let is_held = |&j: &usize| self.commands[j] == JointCommand::Held;
        let row = (0..self.n).filter(is_held).position(|j| j == self.own[joint]);
        row.map_or(0.0, |row| self.force[self.m + row])
    }

    /// Computes the torques `τ_A` of the driven joints from the efforts `u` of the coordinates, and the constraint
    /// forces.
    fn distribute(&mut self, efforts: &[f64]) {
        let f = self.joints.count();
        let is_driven =
            |j: &usize| matches!(self.commands[*j], JointCommand::Task | JointCommand::Acceleration);
        let driven: Vec<usize> = (0..self.n).filter(is_driven).collect();
        let columns: Vec<usize> = (0..f).filter(|&c| is_driven(&self.joints.independent[c])).collect();
        let torques = DrivenTorques::new(&self.joints, driven, columns);
        let mut least: Vec<f64> = torques.columns.iter().map(|&c| efforts[c]).collect();
        torques.apply(&mut least, |place, tau| self.tau[torques.driven[place]] = tau);
        self.update_forces();
        if !self.commanded.is_empty() {
            let added = torques.internal(&self.joints, &self.commanded, &self.force);
            torques.driven.iter().zip(added).for_each(|(&j, added)| self.tau[j] += added);
            self.update_forces();
        }
    }

    /// Computes the constraint forces from `Kᵀ λ = M* q̈ + l − τ`.
    fn update_forces(&mut self) {
        let Self { n, inertia, acceleration, load, tau, right, force, joints, .. } = self;
        force.resize(right.len(), 0.0);
        let residual = |j: usize| dot(&inertia[j * *n..(j + 1) * *n], acceleration) + load[j] - tau[j];
        joints.constraint_forces(residual, force);
    }
}
