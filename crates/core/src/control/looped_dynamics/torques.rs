//! Torques of the driven joints of a robot with closed loops.

use super::LoopedDynamics;
use crate::control::control_law::JointCommand;
use crate::control::pseudo_inverse::ROWS;
use crate::spatial::{Scalar, dot};

impl LoopedDynamics {
    /// Adds a task of a frame with the acceleration `p̈r − d`, m/s² and rad/s², and the damping threshold
    /// `λ₀`. The row-major Jacobian has six rows, and one column per joint of the tree or, if it is relative
    /// to the base, per joint of the robot.
    pub(in crate::control) fn add_task(
        &mut self,
        jacobian: &[f64],
        mut acceleration: [f64; ROWS],
        damping: f64,
    ) {
        self.set_jacobian(jacobian);
        let Self { n, joints, hybrid, work, .. } = self;
        let [all, reduced] = &mut work.jacobians;
        // ẍ = J G z + J g + d
        for (acceleration, row) in acceleration.iter_mut().zip(all.chunks_exact(*n)) {
            *acceleration -= dot(row, &joints.drift);
        }
        reduced.clear();
        reduced.resize(ROWS * joints.count(), 0.0);
        joints.reduce_rows(all, reduced);
        hybrid.add_task(reduced, acceleration, damping);
    }

    /// Sets the Jacobian of a frame with respect to all joints of the tree. The row-major `jacobian` has six
    /// rows, and one column per joint of the tree or per joint of the robot.
    pub(super) fn set_jacobian<S: Scalar>(&mut self, jacobian: &[S]) {
        let Self { n, own, work, .. } = self;
        let [all, _] = &mut work.jacobians;
        all.clear();
        if jacobian.len() == ROWS * *n {
            all.extend(jacobian.iter().map(|x| x.value()));
            return;
        }
        all.resize(ROWS * *n, 0.0);
        for (to, from) in all.chunks_exact_mut(*n).zip(jacobian.chunks_exact(own.len())) {
            own.iter().zip(from).for_each(|(&j, x)| to[j] = x.value());
        }
    }

    /// Computes the accelerations of the robot's joints, rad/s² (m/s²), and the torques of its driven joints,
    /// N m (N). `rates` contains the rates of the joints of the tree, rad/s (m/s).
    pub(in crate::control) fn solve(&mut self, rates: &[f64], acceleration: &mut [f64], tau: &mut [f64]) {
        let Self { n, joints, hybrid, commands, work, acceleration: own_acceleration, .. } = self;
        let (f, is_task) = (joints.count(), |j: usize| commands[j] == JointCommand::Task);
        let along = |c: usize| -> f64 {
            (0..*n).filter(|&j| is_task(j)).map(|j| joints.map[j * f + c] * rates[j]).sum()
        };
        work.loads.clear();
        work.loads.extend((0..f).map(along));
        work.efforts.clear();
        work.efforts.resize(f, 0.0);
        hybrid.solve(&work.loads, &mut work.efforts);
        joints.accelerations(&hybrid.acceleration, own_acceleration);
        self.distribute();
        for (i, &j) in self.own.iter().enumerate() {
            (acceleration[i], tau[i]) = (self.acceleration[j], self.tau[j]);
        }
    }

    /// Computes the torques `τ_A` of the driven joints from the efforts `u` of the coordinates, and the
    /// constraint forces.
    fn distribute(&mut self) {
        let Self { n, commands, joints, torques, work, tau, .. } = self;
        let is_driven = |j: usize| matches!(commands[j], JointCommand::Task | JointCommand::Acceleration);
        torques.set(joints, (0..*n).filter(|&j| is_driven(j)), is_driven);
        let least = &mut work.loads;
        least.clear();
        least.extend(torques.columns.iter().map(|&c| work.efforts[c]));
        torques.apply(least, |place, torque| tau[torques.driven[place]] = torque);
        self.update_forces();
        if !self.commanded.is_empty() {
            let Self { joints, torques, commanded, force, tau, .. } = self;
            torques.internal(joints, commanded, force, |j, added| tau[j] += added);
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
