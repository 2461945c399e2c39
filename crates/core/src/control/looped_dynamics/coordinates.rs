//! Independent coordinates of a robot with closed loops, and its equations of motion in these coordinates.

use super::{LoopedDynamics, Workspace};
use crate::control::control_law::JointCommand;
use crate::dynamics::IndependentJoints;
use crate::spatial::{cholesky_factor, cholesky_solve, dot};

impl LoopedDynamics {
    /// Chooses independent joints, preferably those with commanded accelerations, then those of tasks.
    pub(super) fn choose_joints(&mut self) {
        let Self { n, m, jacobian, right, is_length, commands, leader, joints, work, .. } = self;
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
        work.class.clear();
        work.class.extend(commands.iter().zip(&*leader).map(class));
        joints.solve((jacobian, right), &work.class, [rows, columns]);
        self.orthonormalize();
    }

    /// Makes the columns of `G` that belong to tasks orthonormal in the rows of the joints that tasks drive,
    /// by the modified Gram-Schmidt process, and removes their part of `g` in these rows. The joint
    /// accelerations of least norm then do not depend on the choice of independent joints, which may change
    /// during a run.
    fn orthonormalize(&mut self) {
        let Self { n, joints, commands, work, .. } = self;
        let (n, f) = (*n, joints.count());
        let is_task = |j: usize| commands[j] == JointCommand::Task;
        let (rows, columns) = work.select(n, f, is_task, |c| is_task(joints.independent[c]));
        if rows.len() == columns.len() {
            return; // no dependent joints
        }
        let IndependentJoints { map, drift, .. } = joints;
        for (place, &c) in columns.iter().enumerate() {
            let size = rows.iter().map(|&j| map[j * f + c] * map[j * f + c]).sum::<f64>().sqrt();
            (0..n).for_each(|j| map[j * f + c] /= size);
            for &other in &columns[place + 1..] {
                let share: f64 = rows.iter().map(|&j| map[j * f + c] * map[j * f + other]).sum();
                (0..n).for_each(|j| map[j * f + other] -= share * map[j * f + c]);
            }
            let share: f64 = rows.iter().map(|&j| map[j * f + c] * drift[j]).sum();
            (0..n).for_each(|j| drift[j] -= share * map[j * f + c]);
        }
    }

    /// Computes the reduced equations of motion and eliminates the coordinates with given efforts.
    pub(super) fn reduce(&mut self) {
        let Self { n, joints, hybrid, inertia, load, tau, commands, null_damping, work, .. } = self;
        let f = joints.count();
        hybrid.set_count(f);
        joints.reduce_matrix(inertia, &mut hybrid.inertia);
        // Gᵀ (l + M* g − τ), where τ are the given efforts
        let loads = &mut work.loads;
        loads.clear();
        loads.extend((0..*n).map(|j| load[j] + dot(&inertia[j * *n..(j + 1) * *n], &joints.drift) - tau[j]));
        for c in 0..f {
            hybrid.load[c] = joints.reduced_effort(c, |j| loads[j]);
            hybrid.null_damping[c] = [0.0; 2];
            for j in (0..*n).filter(|&j| commands[j] == JointCommand::Task) {
                let square = joints.map[j * f + c] * joints.map[j * f + c];
                (0..2).for_each(|k| hybrid.null_damping[c][k] += square * null_damping[j][k]);
            }
        }
        self.command_accelerations();
        let Workspace { commands, efforts, .. } = &mut self.work;
        commands.clear();
        commands.extend(self.joints.independent.iter().map(|&j| self.commands[j]));
        efforts.clear();
        efforts.resize(f, 0.0);
        self.hybrid.eliminate(commands, efforts);
    }

    /// Sets the accelerations of the coordinates with commanded accelerations. If the loops do not permit all
    /// commanded accelerations, the permitted ones that are nearest in the metric of `M*` are used (Gauss's
    /// principle).
    fn command_accelerations(&mut self) {
        let Self { n, joints, hybrid, inertia, commands, acceleration, work, .. } = self;
        let is_commanded = |j: usize| commands[j] == JointCommand::Acceleration;
        let (n, f) = (*n, joints.count());
        work.select(n, f, is_commanded, |c| is_commanded(joints.independent[c]));
        let Workspace { rows, columns, matrix, efforts: y, loads: weighted, .. } = work;
        if rows.len() == columns.len() {
            columns.iter().for_each(|&c| hybrid.acceleration[c] = acceleration[joints.independent[c]]);
            return;
        }
        // Gᵀ M G y = Gᵀ M (q̈ − g) on the commanded joints
        matrix.clear();
        y.clear();
        for &a in &*columns {
            let product =
                |&i: &usize| rows.iter().map(|&j| inertia[i * n + j] * joints.map[j * f + a]).sum::<f64>();
            weighted.clear();
            weighted.extend(rows.iter().map(product));
            let sum = |x: &dyn Fn(usize) -> f64| -> f64 {
                rows.iter().zip(&*weighted).map(|(&j, w)| w * x(j)).sum()
            };
            matrix.extend(columns.iter().map(|&b| sum(&|j| joints.map[j * f + b])));
            y.push(sum(&|j| acceleration[j] - joints.drift[j]));
        }
        cholesky_factor(matrix, columns.len());
        cholesky_solve(matrix, columns.len(), y);
        columns.iter().zip(&*y).for_each(|(&c, y)| hybrid.acceleration[c] = *y);
    }
}

impl Workspace {
    /// Returns the indices of those of the `n` joints that `is_row` selects, and of those of the `f`
    /// coordinates that `is_column` selects.
    fn select(
        &mut self,
        n: usize,
        f: usize,
        is_row: impl Fn(usize) -> bool,
        is_column: impl Fn(usize) -> bool,
    ) -> (&[usize], &[usize]) {
        self.rows.clear();
        self.rows.extend((0..n).filter(|&j| is_row(j)));
        self.columns.clear();
        self.columns.extend((0..f).filter(|&c| is_column(c)));
        (&self.rows, &self.columns)
    }
}
