//! Hybrid dynamics: the accelerations of some joints are given or follow from tasks; the efforts of the
//! others are given.

use super::control_law::JointCommand;
use super::pseudo_inverse::{PseudoInverse, ROWS};
use crate::spatial::{cholesky_factor, cholesky_solve, dot};

/// Solver for the torques with which the joints `A` have their commanded accelerations while the efforts of
/// the joints `E` are given.
///
/// The reduced model is `M* q̈ + l = τ` with `l = c* − Q* + f`, where `f` is the sum of the damping and
/// friction torques and of the feedforward of joint laws, minus the torques of springs; the other symbols are
/// those of [`ComputedTorque`](super::ComputedTorque). A subscript selects the rows or columns of a set of
/// joints. The joints `E` react like a second base, `q̈_E = y − G q̈_A` with `G = M*_EE⁻¹ M*_EA` and
/// `y = M*_EE⁻¹ (τ_E − l_E)`, so that a task `ẍ = J q̈ + d` with the Jacobian `J` depends only on `A`:
/// `ẍ = J' q̈_A + d + J_E y` with `J' = J_A − J_E G`. The set `A` consists of the joints `C`, whose
/// accelerations are commanded by joint laws, and the joints `T`, which the tasks drive. A single damped
/// pseudo-inverse of all task rows gives `q̈_T = J'_T⁺ (p̈r − d − J_E y − J'_C q̈_C) − N k q̇_T − κ D q̇_T`,
/// so that each task accounts for the reactions to all others. Joints held by friction belong to neither set;
/// their acceleration is zero. For a single task on all joints the solution equals that of
/// [`computed_torque`](super::computed_torque).
///
/// Source of the method: Featherstone, Rigid Body Dynamics Algorithms, 2008, section 9.2 (hybrid dynamics).
#[derive(Debug)]
pub(super) struct HybridDynamics {
    n: usize,
    /// Reduced inertia matrix `M*`, row major `(n, n)`.
    pub(super) inertia: Vec<f64>,
    /// Load `l` of the joints, `(n,)`, N m (N).
    pub(super) load: Vec<f64>,
    /// Joint accelerations `q̈`, `(n,)`, rad/s² (m/s²); the caller sets the accelerations of the joints `C`.
    pub(super) acceleration: Vec<f64>,
    /// Damping `k` in the null space and damping `κ` of suppressed rates, 1/s, `(n,)`; only the entries of
    /// the joints `T` are used.
    pub(super) null_damping: Vec<[f64; 2]>,
    tasks: Vec<usize>,
    fixed: Vec<usize>,
    given: Vec<usize>,
    factor: Vec<f64>,
    /// Transpose of `G`: row `j` belongs to joint `j` of `A` and begins with one number per joint of `E`.
    gain: Vec<f64>,
    y: Vec<f64>,
    jacobian: Vec<f64>,
    /// Accelerations `p̈r − d − J_E y − J'_C q̈_C`, for all tasks, that the joints `T` must produce, m/s² and
    /// rad/s².
    task_accelerations: Vec<f64>,
    damping: Vec<f64>,
    inverse: PseudoInverse<f64>,
    work: [Vec<f64>; 4],
}

impl HybridDynamics {
    /// Allocates the workspace for `n` joints and up to `tasks` tasks.
    pub(super) fn new(n: usize, tasks: usize) -> Self {
        let (zeros, indices) = (|k: usize| vec![0.0; k], || Vec::with_capacity(n));
        Self {
            n,
            inertia: zeros(n * n),
            load: zeros(n),
            acceleration: zeros(n),
            null_damping: vec![[0.0; 2]; n],
            tasks: indices(),
            fixed: indices(),
            given: indices(),
            factor: zeros(n * n),
            gain: zeros(n * n),
            y: zeros(n),
            jacobian: Vec::with_capacity(ROWS * tasks * n),
            task_accelerations: Vec::with_capacity(ROWS * tasks),
            damping: Vec::with_capacity(tasks),
            inverse: PseudoInverse::new(tasks),
            work: [zeros(n), zeros(n), zeros(n), zeros(n)],
        }
    }

    /// Sets the number of joints, which must not exceed that of [`HybridDynamics::new`].
    pub(super) fn set_count(&mut self, n: usize) {
        self.n = n;
    }

    /// Eliminates the joints with given efforts `tau`, and clears the tasks. `commands` and `tau` are `(n,)`;
    /// inertia and load must be set.
    pub(super) fn eliminate(&mut self, commands: &[JointCommand], tau: &[f64]) {
        let Self { n, inertia, load, tasks, fixed, given, factor, gain, y, acceleration, .. } = self;
        for (list, command) in
            [(tasks, JointCommand::Task), (fixed, JointCommand::Acceleration), (given, JointCommand::Effort)]
        {
            list.clear();
            list.extend((0..*n).filter(|&j| commands[j] == command));
        }
        (0..*n).filter(|&j| commands[j] == JointCommand::Held).for_each(|j| acceleration[j] = 0.0);
        [&mut self.jacobian, &mut self.task_accelerations, &mut self.damping]
            .into_iter()
            .for_each(Vec::clear);
        let e = self.given.len();
        for (row, &i) in self.given.iter().enumerate() {
            y[row] = tau[i] - load[i];
            for (column, &j) in self.given.iter().enumerate() {
                factor[row * e + column] = inertia[i * *n + j];
            }
        }
        cholesky_factor(&mut factor[..e * e], e);
        cholesky_solve(&factor[..e * e], e, &mut y[..e]);
        for &a in self.tasks.iter().chain(&self.fixed) {
            let column = &mut gain[a * *n..a * *n + e];
            column.iter_mut().zip(&self.given).for_each(|(g, &i)| *g = inertia[i * *n + a]);
            cholesky_solve(&factor[..e * e], e, column);
        }
    }

    /// Adds a task with the row-major Jacobian `(6, n)`, the acceleration `p̈r − d`, m/s² and rad/s², and the
    /// damping threshold `λ₀`.
    pub(super) fn add_task(&mut self, jacobian: &[f64], acceleration: [f64; ROWS], damping: f64) {
        let (n, given) = (self.n, &self.given);
        let [of_given, ..] = &mut self.work;
        for (row, acceleration) in jacobian.chunks_exact(n).zip(acceleration) {
            let of_given = &mut of_given[..given.len()];
            of_given.iter_mut().zip(given).for_each(|(x, &i)| *x = row[i]);
            // J' = J_A − J_E G
            let entry = |a: usize| row[a] - dot(of_given, &self.gain[a * n..]);
            // p̈r − d − J_E y − J'_C q̈_C
            let fixed: f64 = self.fixed.iter().map(|&a| entry(a) * self.acceleration[a]).sum();
            self.task_accelerations.push(acceleration - dot(of_given, &self.y) - fixed);
            self.jacobian.extend(self.tasks.iter().map(|&a| entry(a)));
        }
        self.damping.push(damping);
    }

    /// Returns the friction torque, N m (N), that holds joint `j` at rest while its drive exerts `tau`.
    /// Requires the accelerations of all joints.
    pub(super) fn holding_torque(&self, j: usize, tau: f64) -> f64 {
        dot(&self.inertia[j * self.n..(j + 1) * self.n], &self.acceleration) + self.load[j] - tau
    }

    /// Computes the accelerations of all joints at the joint rates `rates`, `(n,)`, rad/s (m/s), and writes
    /// the torques of the joints `A` to `tau`, `(n,)`, N m (N).
    pub(super) fn solve(&mut self, rates: &[f64], tau: &mut [f64]) {
        let Self { n, tasks, fixed, given, acceleration, null_damping, .. } = self;
        let [a, x, free, suppressed] = &mut self.work;
        let k = tasks.len();
        let (a, x, free, suppressed) = (&mut a[..k], &mut x[..k], &mut free[..k], &mut suppressed[..k]);
        if !self.damping.is_empty() {
            // q̈_T = J_T⁺ r − N k q̇ − κ D q̇
            self.inverse.factor(&self.jacobian, k, &self.damping);
            self.inverse.apply(&self.jacobian, &self.task_accelerations, a);
            tasks.iter().enumerate().for_each(|(i, &j)| x[i] = null_damping[j][0] * rates[j]);
            self.inverse.free(&self.jacobian, x, free);
            (0..k).for_each(|i| a[i] -= free[i]);
            tasks.iter().enumerate().for_each(|(i, &j)| x[i] = rates[j]);
            self.inverse.suppressed(&self.jacobian, x, free, suppressed);
            for (i, &j) in tasks.iter().enumerate() {
                acceleration[j] = a[i] - null_damping[j][1] * suppressed[i];
            }
        }
        // q̈_E = y − G q̈_A
        for (row, &i) in given.iter().enumerate() {
            let along: f64 =
                tasks.iter().chain(&*fixed).map(|&j| self.gain[j * *n + row] * acceleration[j]).sum();
            acceleration[i] = self.y[row] - along;
        }
        // τ_A = M* q̈ + l
        for &i in tasks.iter().chain(&*fixed) {
            tau[i] = dot(&self.inertia[i * *n..(i + 1) * *n], acceleration) + self.load[i];
        }
    }
}
