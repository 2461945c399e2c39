//! Damped pseudo-inverse of stacked task Jacobians, and the projector on their null space.

use crate::spatial::{Real, cholesky_factor, cholesky_solve, dot};

/// Number of rows of one task: three of position, three of attitude.
pub(super) const ROWS: usize = 6;

/// Damped pseudo-inverse `J⁺ = Jᵀ (J Jᵀ + Λ²)⁻¹` for `k` tasks of six rows. Well-conditioned tasks are not
/// damped.
///
/// For each task, `1/σ²` is the sum of the six diagonal entries of `(J Jᵀ)⁻¹` in the rows of the task. `σ²`
/// is at most the square of the smallest singular value of the task's own six rows of `J`; for a single task
/// it is at least a sixth of that square. If `σ²` is below the task's `λ₀²`, the rows of that task are damped
/// by the difference, `λ² = λ₀² − σ²`; the diagonal matrix `Λ²` has `λ²` in these rows and zeros in the
/// others. The null-space projector always uses the undamped inverse, because a projector from the damped
/// inverse would disturb the task.
///
/// Source: Nakamura and Hanafusa, J. Dyn. Sys. Meas. Control 108(3), 1986, with another measure of
/// the distance from singularity.
#[derive(Clone, Debug)]
pub(super) struct PseudoInverse<S> {
    rows: usize,
    gram: Vec<S>,
    damped: Vec<S>,
    undamped: Vec<S>,
    x: Vec<S>,
    is_damped: bool,
}

impl<S: Real> PseudoInverse<S> {
    /// Allocates the workspace for up to `tasks` tasks.
    pub(super) fn new(tasks: usize) -> Self {
        let (rows, zero) = (ROWS * tasks, S::of(0.0));
        let square = vec![zero; rows * rows];
        Self {
            rows,
            gram: square.clone(),
            damped: square.clone(),
            undamped: square,
            x: vec![zero; rows],
            is_damped: false,
        }
    }

    /// Factorizes `J Jᵀ` of a row-major `(6 k, n)` Jacobian; `damping` contains the threshold `λ₀` of each of
    /// the `k` tasks.
    #[inline(always)]
    pub(super) fn factor(&mut self, jacobian: &[S], n: usize, damping: &[f64]) {
        self.rows = ROWS * damping.len();
        match damping.len() {
            1 => self.factor_rows(ROWS, jacobian, n, damping), // compiled separately, with unrolled loops
            k => self.factor_rows(ROWS * k, jacobian, n, damping),
        }
    }

    #[inline(always)]
    fn factor_rows(&mut self, rows: usize, jacobian: &[S], n: usize, damping: &[f64]) {
        let [gram, damped, undamped] =
            [&mut self.gram, &mut self.damped, &mut self.undamped].map(|a| &mut a[..rows * rows]);
        let mut trace = S::of(0.0);
        for i in 0..rows {
            for j in 0..=i {
                let (a, b) = (&jacobian[i * n..(i + 1) * n], &jacobian[j * n..(j + 1) * n]);
                gram[i * rows + j] = dot(a, b);
            }
            trace += gram[i * rows + i];
        }
        // the floor keeps the factor of a singular Jacobian finite; for other Jacobians it is below rounding
        undamped.copy_from_slice(gram);
        let floor = trace * S::of(1e-14) + S::of(f64::MIN_POSITIVE);
        add_diagonal(undamped, rows, 0..rows, floor);
        cholesky_factor(undamped, rows);

        self.is_damped = false;
        for (task, damping) in damping.iter().enumerate() {
            // λ² = max(λ₀² − σ², 0)
            let block = ROWS * task..ROWS * (task + 1);
            let sigma2 = S::of(1.0) / inverse_trace(undamped, rows, block.clone(), &mut self.x[..rows]);
            let missing = S::of(damping * damping) - sigma2;
            let is_short = S::less(S::of(0.0), missing);
            if S::any(is_short) {
                if !self.is_damped {
                    damped.copy_from_slice(gram);
                    add_diagonal(damped, rows, 0..rows, floor);
                }
                self.is_damped = true;
                add_diagonal(damped, rows, block, S::select(is_short, missing, S::of(0.0)));
            }
        }
        if self.is_damped {
            cholesky_factor(damped, rows);
        }
    }

    /// Computes `out = J⁺ x` with the damped pseudo-inverse; `x` is `(6 k,)` and `out` is `(n,)`.
    #[inline(always)]
    pub(super) fn apply(&mut self, jacobian: &[S], x: &[S], out: &mut [S]) {
        self.x[..self.rows].copy_from_slice(&x[..self.rows]);
        let factor = if self.is_damped { &self.damped } else { &self.undamped };
        transpose_apply(self.rows, factor, jacobian, &mut self.x, out);
    }

    /// Returns true if any task is damped.
    #[inline(always)]
    pub(super) fn is_damped(&self) -> bool {
        self.is_damped
    }

    /// Computes the projection `(1 − J⁺ J) y` of joint rates `y`, `(n,)`, onto the null space of `J`, without
    /// damping.
    #[inline(always)]
    pub(super) fn free(&mut self, jacobian: &[S], y: &[S], free: &mut [S]) {
        multiply(self.rows, jacobian, y, &mut self.x);
        transpose_apply(self.rows, &self.undamped, jacobian, &mut self.x, free);
        free.iter_mut().zip(y).for_each(|(free, y)| *free = *y - *free);
    }

    /// Computes `D y = (J₀⁺ − J⁺) J y` for joint rates `y`, `(n,)`, with the undamped inverse `J₀⁺`. This is
    /// the part of `y` that the damping suppresses, and zero without damping. With damping, `achieved`
    /// receives `J⁺ J y`; otherwise `achieved` is not written.
    #[inline(always)]
    pub(super) fn suppressed(&mut self, jacobian: &[S], y: &[S], achieved: &mut [S], suppressed: &mut [S]) {
        if !self.is_damped {
            return suppressed.fill(S::of(0.0));
        }
        for (factor, out) in [(&self.undamped, &mut *suppressed), (&self.damped, &mut *achieved)] {
            multiply(self.rows, jacobian, y, &mut self.x);
            transpose_apply(self.rows, factor, jacobian, &mut self.x, out);
        }
        suppressed.iter_mut().zip(achieved).for_each(|(suppressed, achieved)| *suppressed -= *achieved);
    }
}

/// Computes the product `x = J y`, where `J` has `rows` rows.
#[inline(always)]
fn multiply<S: Real>(rows: usize, jacobian: &[S], y: &[S], x: &mut [S]) {
    for i in 0..rows {
        x[i] = dot(&jacobian[i * y.len()..(i + 1) * y.len()], y);
    }
}

#[inline(always)]
fn add_diagonal<S: Real>(a: &mut [S], rows: usize, at: std::ops::Range<usize>, x: S) {
    for i in at {
        a[i * rows + i] += x;
    }
}

/// Computes `out = Jᵀ A⁻¹ x` with the factor of `A`, and overwrites `x`.
#[inline(always)]
fn transpose_apply<S: Real>(rows: usize, factor: &[S], jacobian: &[S], x: &mut [S], out: &mut [S]) {
    match rows {
        ROWS => transpose_apply_rows(ROWS, factor, jacobian, x, out),
        rows => transpose_apply_rows(rows, factor, jacobian, x, out),
    }
}

#[inline(always)]
fn transpose_apply_rows<S: Real>(rows: usize, factor: &[S], jacobian: &[S], x: &mut [S], out: &mut [S]) {
    let (n, x) = (out.len(), &mut x[..rows]);
    cholesky_solve(&factor[..rows * rows], rows, x);
    for (j, out) in out.iter_mut().enumerate() {
        *out = S::of(0.0);
        for i in 0..rows {
            *out = jacobian[i * n + j].mul_add(x[i], *out);
        }
    }
}

/// Returns `Σ (A⁻¹)_jj = Σ (L⁻¹)_ij²/D_i` over the given columns `j`, with the factors of `A = L D Lᵀ`;
/// `column` is workspace.
#[inline(always)]
fn inverse_trace<S: Real>(factor: &[S], rows: usize, columns: std::ops::Range<usize>, column: &mut [S]) -> S {
    let mut trace = S::of(0.0);
    for j in columns {
        // column j of L⁻¹ by forward substitution; the factor's diagonal holds 1/D_i
        column[j] = S::of(1.0);
        trace += factor[j * rows + j];
        for i in j + 1..rows {
            column[i] = -dot(&factor[i * rows + j..i * rows + i], &column[j..i]);
            trace = (column[i] * column[i]).mul_add(factor[i * rows + i], trace);
        }
    }
    trace
}
