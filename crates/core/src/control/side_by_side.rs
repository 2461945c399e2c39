//! Laws of accelerations and laws of efforts on one robot at once, exactly.

use super::pseudo_inverse::{PseudoInverse, ROWS};
use crate::spatial::{cholesky_factor, cholesky_solve, dot};

/// Torques that give joints `A` the accelerations their laws want, while the efforts of all other
/// joints `E` are known.
///
/// The reduced model `M* q̈ + l = τ`, `l = c* − Q* + f`, in the two groups: `E` gives way like a second base,
/// `q̈_E = y − G q̈_A` with `G = M_EE⁻¹ M_EA` and `y = M_EE⁻¹ (τ_E − l_E)`, and a task
/// `ẍ = J q̈ + d` is one of `A` alone, `ẍ = (J_A − J_E G) q̈_A + d + J_E y`. Of `A`, joint laws fix
/// their `q̈_J`; the tasks share the rest: all their rows stacked in one damped pseudo-inverse,
/// `q̈_T = J_T⁺ (p̈r − d − J_E y − J_J q̈_J) − N k q̇ − κ D q̇`, so that one arm counts on the recoil of the
/// other. Joints that friction holds are no part of either group: `q̈ = 0`. With a single task on all joints this is [`computed_torque`](super::computed_torque).
pub(super) struct SideBySide {
    n: usize,
    /// `M*`, `(n, n)`.
    pub(super) inertia: Vec<f64>,
    /// `l`, `(n,)`.
    pub(super) load: Vec<f64>,
    /// `q̈`, `(n,)`; those of `J` are given.
    pub(super) acceleration: Vec<f64>,
    /// `k` and `κ` of each joint of `T`, 1/s.
    pub(super) calming: Vec<[f64; 2]>,
    tasks: Vec<usize>,
    fixed: Vec<usize>,
    given: Vec<usize>,
    factor: Vec<f64>,
    /// `G`, a row of `E`'s length per joint of `A`, at the joint's index.
    gain: Vec<f64>,
    y: Vec<f64>,
    jacobian: Vec<f64>,
    command: Vec<f64>,
    damping: Vec<f64>,
    inverse: PseudoInverse<f64>,
    room: [Vec<f64>; 4],
}

/// How a joint is driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Drive {
    /// Its effort is known.
    Effort,
    /// Its friction holds it at rest.
    Held,
    /// Its acceleration is given.
    Acceleration,
    /// It works for the tasks.
    Task,
}

impl SideBySide {
    /// Room for `n` joints and up to `tasks` tasks.
    pub(super) fn new(n: usize, tasks: usize) -> Self {
        let (zeros, indices) = (|k: usize| vec![0.0; k], || Vec::with_capacity(n));
        Self {
            n,
            inertia: zeros(n * n),
            load: zeros(n),
            acceleration: zeros(n),
            calming: vec![[0.0; 2]; n],
            tasks: indices(),
            fixed: indices(),
            given: indices(),
            factor: zeros(n * n),
            gain: zeros(n * n),
            y: zeros(n),
            jacobian: Vec::with_capacity(ROWS * tasks * n),
            command: Vec::with_capacity(ROWS * tasks),
            damping: Vec::with_capacity(tasks),
            inverse: PseudoInverse::new(tasks),
            room: [zeros(n), zeros(n), zeros(n), zeros(n)],
        }
    }

    /// Eliminates the joints whose efforts are known, `tau`; starts a new list of tasks.
    pub(super) fn eliminate(&mut self, drives: &[Drive], tau: &[f64]) {
        let Self { n, inertia, load, tasks, fixed, given, factor, gain, y, acceleration, .. } = self;
        for (list, drive) in [(tasks, Drive::Task), (fixed, Drive::Acceleration), (given, Drive::Effort)] {
            list.clear();
            list.extend((0..*n).filter(|&j| drives[j] == drive));
        }
        (0..*n).filter(|&j| drives[j] == Drive::Held).for_each(|j| acceleration[j] = 0.0);
        [&mut self.jacobian, &mut self.command, &mut self.damping].into_iter().for_each(Vec::clear);
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

    /// Adds a task with the Jacobian `(6, n)`, the command `p̈r − d` and `λ₀`.
    pub(super) fn add_task(&mut self, jacobian: &[f64], command: [f64; ROWS], damping: f64) {
        let (n, given) = (self.n, &self.given);
        let [of_given, ..] = &mut self.room;
        for (row, command) in jacobian.chunks_exact(n).zip(command) {
            let of_given = &mut of_given[..given.len()];
            of_given.iter_mut().zip(given).for_each(|(x, &i)| *x = row[i]);
            // J_A − J_E G
            let entry = |a: usize| row[a] - dot(of_given, &self.gain[a * n..]);
            // p̈r − d − J_E y − J_J q̈_J
            let fixed: f64 = self.fixed.iter().map(|&a| entry(a) * self.acceleration[a]).sum();
            self.command.push(command - dot(of_given, &self.y) - fixed);
            self.jacobian.extend(self.tasks.iter().map(|&a| entry(a)));
        }
        self.damping.push(damping);
    }

    /// Torque that friction gives to hold a joint whose own is `tau`, N m (N). Needs all accelerations.
    pub(super) fn holding(&self, j: usize, tau: f64) -> f64 {
        dot(&self.inertia[j * self.n..(j + 1) * self.n], &self.acceleration) + self.load[j] - tau
    }

    /// All accelerations, and the torques of `A` into `tau`.
    pub(super) fn solve(&mut self, rates: &[f64], tau: &mut [f64]) {
        let Self { n, tasks, fixed, given, acceleration, calming, .. } = self;
        let [a, x, free, lost] = &mut self.room;
        let k = tasks.len();
        let (a, x, free, lost) = (&mut a[..k], &mut x[..k], &mut free[..k], &mut lost[..k]);
        if !self.damping.is_empty() {
            // q̈_T = J_T⁺ r − N k q̇ − κ D q̇
            self.inverse.factor(&self.jacobian, k, &self.damping);
            self.inverse.apply(&self.jacobian, &self.command, a);
            tasks.iter().enumerate().for_each(|(i, &j)| x[i] = calming[j][0] * rates[j]);
            self.inverse.free(&self.jacobian, x, free);
            (0..k).for_each(|i| a[i] -= free[i]);
            tasks.iter().enumerate().for_each(|(i, &j)| x[i] = rates[j]);
            self.inverse.lost(&self.jacobian, x, free, lost);
            for (i, &j) in tasks.iter().enumerate() {
                acceleration[j] = a[i] - calming[j][1] * lost[i];
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
