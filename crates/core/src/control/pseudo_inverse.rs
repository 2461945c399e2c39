//! Damped pseudo-inverse of stacked task Jacobians, and the projector on their null space.

use crate::spatial::{Real, cholesky_factor, cholesky_solve, dot};

/// Rows of one task: three of position, three of attitude.
pub(super) const ROWS: usize = 6;

/// `J⁺ = Jᵀ (J Jᵀ + Λ²)⁻¹` for `k` tasks of six rows, undamped where a task is well conditioned.
///
/// `σ² = 1/tr [(J Jᵀ)⁻¹]` over the six rows of a task is at most the square of the smallest singular
/// value, and for one task at least a sixth of it. Where it falls below the task's `λ₀²` the damping makes
/// up for what is missing, `λ² = λ₀² − σ²`, in the rows of that task alone. The null-space projector is
/// always built from the undamped inverse: a damped one leaks into the task.
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
    /// Space for the factors of up to `tasks` tasks.
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

    /// Factors `J Jᵀ` of a row-major `(6 k, n)` Jacobian; `damping` has the `k` numbers `λ₀`.
    #[inline(always)]
    pub(super) fn factor(&mut self, jacobian: &[S], n: usize, damping: &[f64]) {
        self.rows = ROWS * damping.len();
        match damping.len() {
            1 => self.factor_rows(ROWS, jacobian, n, damping), // its own code, loops unrolled
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
        // the floor keeps the factor of a singular Jacobian finite; it is rounding otherwise
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

    /// `out = J⁺ x`, damped; `x` is `(6 k,)`, `out` `(n,)`.
    #[inline(always)]
    pub(super) fn apply(&mut self, jacobian: &[S], x: &[S], out: &mut [S]) {
        self.x[..self.rows].copy_from_slice(&x[..self.rows]);
        let factor = if self.is_damped { &self.damped } else { &self.undamped };
        transpose_apply(self.rows, factor, jacobian, &mut self.x, out);
    }

    /// Whether some task is damped.
    #[inline(always)]
    pub(super) fn is_damped(&self) -> bool {
        self.is_damped
    }

    /// Of joint rates `y`, `(n,)`, what the tasks do not feel: `(1 − J⁺ J) y`, undamped.
    #[inline(always)]
    pub(super) fn free(&mut self, jacobian: &[S], y: &[S], free: &mut [S]) {
        feel(self.rows, jacobian, y, &mut self.x);
        transpose_apply(self.rows, &self.undamped, jacobian, &mut self.x, free);
        free.iter_mut().zip(y).for_each(|(free, y)| *free = *y - *free);
    }

    /// Of joint rates `y`, `(n,)`, what the tasks feel but give up for the damping, zero where there is none; `kept` is what
    /// they do not give up.
    #[inline(always)]
    pub(super) fn lost(&mut self, jacobian: &[S], y: &[S], kept: &mut [S], lost: &mut [S]) {
        if !self.is_damped {
            return lost.fill(S::of(0.0));
        }
        for (factor, out) in [(&self.undamped, &mut *lost), (&self.damped, &mut *kept)] {
            feel(self.rows, jacobian, y, &mut self.x);
            transpose_apply(self.rows, factor, jacobian, &mut self.x, out);
        }
        lost.iter_mut().zip(kept).for_each(|(lost, kept)| *lost -= *kept);
    }
}

/// `x = J y`.
#[inline(always)]
fn feel<S: Real>(rows: usize, jacobian: &[S], y: &[S], x: &mut [S]) {
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

/// `out = Jᵀ A⁻¹ x` with the factor of `A`; `x` is used up.
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

/// `Σ (A⁻¹)_jj = Σ (L⁻¹)_ij²/D_i` over some columns `j`, with the factors of `A`; `column` is room for one.
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
