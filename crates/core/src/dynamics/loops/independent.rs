//! Independent joints of a robot with closed loops.

use super::rows::{self, JointRows};
use super::{ClosedLoops, dense_response};
use crate::dynamics::data::Data;
use crate::model::{BASE_NV, Model};
use crate::spatial::{Scalar, dot};

/// Pivot, relative to the sizes of its row and its column, below which a constraint counts as dependent on
/// those before it.
const DEPENDENT: f64 = 1e-7;
/// Smallest lever arm, m, for the comparison of metres and radians; a shorter one may be a rounding error.
const SHORTEST: f64 = 1e-3;

impl<S: Scalar> ClosedLoops<S> {
    /// Returns the number of scalar constraints.
    pub fn count(&self) -> usize {
        self.rows.len()
    }

    /// Computes the constraints on the joint accelerations, `K q̈ = k` with `k = −K̇ q̇`: `K` is written to
    /// `jacobian`, `(m, n)`, and `k` to `right`, `(m,)`. Constraints inside a robot do not depend on the
    /// motion of the base, because the two forces of a row are opposite and act along the same line.
    ///
    /// Requires in `data` the kinematics, and the accelerations that the bodies have while no joint
    /// accelerates; [`free_floating_recursion`](crate::dynamics::free_floating_recursion) computes these
    /// accelerations.
    pub fn joint_constraints(
        &mut self,
        model: &Model,
        data: &Data<S>,
        jacobian: &mut [f64],
        right: &mut [f64],
    ) {
        self.joint_jacobian(model, data, jacobian);
        let mut joint_rows = std::mem::take(&mut self.joint_rows);
        let JointRows { at_rest, drift, .. } = &mut joint_rows;
        at_rest.resize(model.nv(), S::of(0.0));
        drift.resize(self.rows.len(), S::of(0.0));
        drift.iter_mut().zip(&self.rows).for_each(|(drift, row)| *drift = row.acceleration(data, at_rest));
        for closure in 0..self.closures.len() {
            let range = self.range_of(closure);
            rows::add_drift(&self.closures[closure], data, &self.rows[range.clone()], &mut drift[range]);
        }
        right.iter_mut().zip(&*drift).for_each(|(right, drift)| *right = -drift.value());
        self.joint_rows = joint_rows;
    }

    /// Computes the Jacobian `K`, `(m, n)`, of the constraints on the joint rates, `K q̇ = 0`, as
    /// [`Self::joint_constraints`] does. Requires up-to-date poses in `data`.
    pub(crate) fn joint_jacobian(&mut self, model: &Model, data: &Data<S>, jacobian: &mut [f64]) {
        let (n, nv) = (model.joint_count(), model.nv());
        self.update_rows(data);
        let mut joint_rows = std::mem::take(&mut self.joint_rows);
        let all = &mut joint_rows.jacobian;
        all.resize(self.rows.len() * nv, S::of(0.0));
        dense_response::jacobian(model, data, &self.rows, all);
        for (to, from) in jacobian.chunks_exact_mut(n).zip(all.chunks_exact(nv)) {
            to.iter_mut().zip(&from[BASE_NV..]).for_each(|(to, from)| *to = from.value());
        }
        self.joint_rows = joint_rows;
    }
}

/// Solution of the joint constraints `K q̇ = 0`, `K q̈ = k` in terms of independent joints: `q̇ = G ẏ`,
/// `q̈ = G ÿ + g`.
///
/// `K` is brought to reduced row echelon form by Gaussian elimination. Each pivot determines the acceleration
/// of one dependent joint; rows without a pivot are redundant.
///
/// Source: Featherstone, Rigid Body Dynamics Algorithms, 2008, section 8.8.
#[derive(Clone, Debug, Default)]
pub struct IndependentJoints {
    /// Number of joints, `n`.
    n: usize,
    /// Number of rows of `K`, `m`.
    m: usize,
    /// Reduced rows `R K`, then `R k` and `R`: `(m, n + 1 + m)`.
    table: Vec<f64>,
    /// Independent joints, `(f,)`, in ascending order of their class and of their index.
    pub independent: Vec<usize>,
    /// Dependent joints, each with the row of its pivot.
    pub dependent: Vec<(usize, usize)>,
    /// `G`, `(n, f)`.
    pub map: Vec<f64>,
    /// `g`, `(n,)`, rad/s² (m/s²).
    pub drift: Vec<f64>,
    row_size: Vec<f64>,
    column_size: Vec<f64>,
    /// Buffer for a row of the table, or for the product of a matrix and `G`.
    product: Vec<f64>,
}

impl IndependentJoints {
    /// Returns the number of independent joints, `f`.
    pub fn count(&self) -> usize {
        self.independent.len()
    }

    /// Chooses the independent joints and computes `G` and `g`. `jacobian` is `K`, `(m, n)`, and `right` is
    /// `k`, `(m,)`. `class` is `(n,)`: joints of a lower class become dependent before those of a higher one,
    /// so that dependent joints of a class depend only on independent joints of the same and of higher
    /// classes. `is_length` contains, for each row, `(m,)`, whether its constraint error is a length, m, and,
    /// for each joint, `(n,)`, whether its position is one.
    pub fn solve(&mut self, (jacobian, right): (&[f64], &[f64]), class: &[u8], is_length: [&[bool]; 2]) {
        (self.n, self.m) = (class.len(), right.len());
        self.fill(jacobian, right);
        self.set_sizes(is_length);
        self.dependent.clear();
        let classes = class.iter().copied().max().map_or(0..0, |last| 0..last + 1);
        for chosen in classes {
            while let Some((row, joint)) = self.largest(|joint| class[joint] == chosen) {
                self.eliminate(row, joint);
                self.dependent.push((joint, row));
            }
        }
        let is_independent = |joint: &usize| !self.dependent.iter().any(|(dependent, _)| dependent == joint);
        self.independent.clear();
        self.independent.extend((0..self.n).filter(is_independent));
        self.independent.sort_unstable_by_key(|&joint| (class[joint], joint));
        self.write_map();
    }

    /// Sets the sizes of the rows and of the columns. Metres and radians are compared by means of the longest
    /// lever arm, which is the largest displacement per angle in `K`.
    fn set_sizes(&mut self, [rows, columns]: [&[bool]; 2]) {
        let (n, width) = (self.n, self.width());
        let mut lever = 0.0_f64;
        for row in
            self.table.chunks_exact(width).zip(rows).filter_map(|(row, is_length)| is_length.then_some(row))
        {
            let turning = row[..n].iter().zip(columns).filter(|(_, is_length)| !**is_length);
            lever = turning.fold(lever, |lever, (x, _)| lever.max(x.abs()));
        }
        let lever = lever.max(SHORTEST);
        let size = |is_length: &bool| if *is_length { lever } else { 1.0 };
        self.row_size.clear();
        self.row_size.extend(rows.iter().map(size));
        self.column_size.clear();
        self.column_size.extend(columns.iter().map(size));
    }

    /// Returns the row and the joint of the largest entry in rows and columns without a pivot, among the
    /// joints that `is_candidate` selects; `None` if no entry exceeds rounding errors.
    fn largest(&self, is_candidate: impl Fn(usize) -> bool) -> Option<(usize, usize)> {
        let (width, mut most, mut found) = (self.width(), DEPENDENT, None);
        for i in (0..self.m).filter(|i| !self.dependent.iter().any(|(_, row)| row == i)) {
            for j in (0..self.n).filter(|&j| is_candidate(j)) {
                // the columns of dependent joints are zero in these rows
                let x = (self.table[i * width + j] * self.column_size[j] / self.row_size[i]).abs();
                if x > most {
                    (most, found) = (x, Some((i, j)));
                }
            }
        }
        found
    }

    /// Writes `Gᵀ A G`, row major `(f, f)`, for a matrix `A`, `(n, n)`, to `out`.
    pub fn reduce_matrix(&mut self, a: &[f64], out: &mut Vec<f64>) {
        let (n, f) = (self.n, self.count());
        let mut product = std::mem::take(&mut self.product);
        product.resize(n * f, 0.0);
        self.reduce_rows(a, &mut product);
        out.clear();
        out.resize(f * f, 0.0);
        for (j, product) in product.chunks_exact(f.max(1)).enumerate() {
            for (row, g) in out.chunks_exact_mut(f.max(1)).zip(&self.map[j * f..]) {
                row.iter_mut().zip(product).for_each(|(out, x)| *out = g.mul_add(*x, *out));
            }
        }
        self.product = product;
    }

    /// Computes `J G`, `(r, f)`, for rows `J`, `(r, n)`.
    pub fn reduce_rows(&self, rows: &[f64], out: &mut [f64]) {
        let (n, f) = (self.n, self.count());
        for (row, out) in rows.chunks_exact(n.max(1)).zip(out.chunks_exact_mut(f.max(1))) {
            out.fill(0.0);
            for (x, map) in row.iter().zip(self.map.chunks_exact(f.max(1))) {
                out.iter_mut().zip(map).for_each(|(out, g)| *out = x.mul_add(*g, *out));
            }
        }
    }

    /// Returns entry `column` of `Gᵀ x`, the effort at that independent joint; `x` returns the effort of a
    /// joint.
    pub fn reduced_effort(&self, column: usize, x: impl Fn(usize) -> f64) -> f64 {
        (0..self.n).map(|j| self.map[j * self.count() + column] * x(j)).sum()
    }

    /// Computes the joint accelerations `q̈ = G ÿ + g`, `(n,)`, rad/s² (m/s²), from those of the independent
    /// joints, `y`, `(f,)`.
    pub fn accelerations(&self, y: &[f64], out: &mut [f64]) {
        for (j, out) in out.iter_mut().enumerate() {
            *out = dot(&self.map[j * self.count()..], &y[..self.count()]) + self.drift[j];
        }
    }

    /// Computes the constraint forces `lambda`, `(m,)`, with `Kᵀ λ = f` from the entries of `f` at the
    /// dependent joints; the forces of redundant rows are zero. `force` returns the entry of `f` for a joint.
    pub fn constraint_forces(&self, force: impl Fn(usize) -> f64, lambda: &mut [f64]) {
        lambda.fill(0.0);
        for &(joint, row) in &self.dependent {
            let f = force(joint);
            lambda.iter_mut().enumerate().for_each(|(i, lambda)| *lambda += self.share(row, i) * f);
        }
    }

    /// Returns the change of the constraint force of row `i` per unit of `f` ([`Self::constraint_forces`]) at
    /// the dependent joint whose pivot is in row `row`.
    pub fn share(&self, row: usize, i: usize) -> f64 {
        self.table[row * self.width() + self.n + 1 + i]
    }

    fn width(&self) -> usize {
        self.n + 1 + self.m
    }

    /// Sets the table to `[K | k | 1]`.
    fn fill(&mut self, jacobian: &[f64], right: &[f64]) {
        let (n, width) = (self.n, self.width());
        self.table.clear();
        self.table.resize(self.m * width, 0.0);
        for (i, row) in self.table.chunks_exact_mut(width).enumerate() {
            row[..n].copy_from_slice(&jacobian[i * n..(i + 1) * n]);
            (row[n], row[n + 1 + i]) = (right[i], 1.0);
        }
    }

    /// Scales a row so that its entry in column `joint` is one, and sets this column to zero in all other
    /// rows.
    fn eliminate(&mut self, row: usize, joint: usize) {
        let width = self.width();
        let pivot = self.table[row * width + joint];
        let scaled = &mut self.product;
        scaled.clear();
        scaled.extend(self.table[row * width..(row + 1) * width].iter().map(|x| x / pivot));
        for (i, other) in self.table.chunks_exact_mut(width).enumerate() {
            if i == row {
                other.copy_from_slice(scaled);
            } else {
                let factor = other[joint];
                other.iter_mut().zip(&*scaled).for_each(|(x, y)| *x = (-factor).mul_add(*y, *x));
                other[joint] = 0.0;
            }
        }
    }

    /// Computes `G` and `g` from the reduced rows.
    fn write_map(&mut self) {
        let (n, f, width) = (self.n, self.count(), self.width());
        self.map.clear();
        self.map.resize(n * f, 0.0);
        self.drift.clear();
        self.drift.resize(n, 0.0);
        for (column, &j) in self.independent.iter().enumerate() {
            self.map[j * f + column] = 1.0;
        }
        for &(joint, row) in &self.dependent {
            let row = &self.table[row * width..];
            for (column, &j) in self.independent.iter().enumerate() {
                self.map[joint * f + column] = -row[j];
            }
            self.drift[joint] = row[n];
        }
    }
}
