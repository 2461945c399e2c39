//! Damped pseudo-inverse of a task Jacobian, and the projector on its null space.

use crate::spatial::{Real, cholesky_factor, cholesky_solve, dot};

/// Task rows: three of position, three of attitude.
const ROWS: usize = 6;

/// `J⁺ = Jᵀ (J Jᵀ + λ²)⁻¹`, undamped where the Jacobian is well conditioned.
///
/// `σ² = 1/tr (J Jᵀ)⁻¹` is at most the square of the smallest singular value, and at least a sixth of
/// it. Where it falls below `λ₀²` the damping makes up for what is missing, `λ² = λ₀² − σ²`. The
/// null-space projector is always built from the undamped inverse: a damped one leaks into the
/// task.
///
/// Source: Nakamura and Hanafusa, J. Dyn. Sys. Meas. Control 108(3), 1986, with another measure of
/// the distance from singularity.
#[derive(Clone, Debug)]
pub struct PseudoInverse<S> {
    gram: [S; ROWS * ROWS],
    damped: [S; ROWS * ROWS],
    undamped: [S; ROWS * ROWS],
    is_damped: bool,
}

impl<S: Real> PseudoInverse<S> {
    /// Space for a factor.
    pub fn new() -> Self {
        let empty = [S::of(0.0); ROWS * ROWS];
        Self { gram: empty, damped: empty, undamped: empty, is_damped: false }
    }

    /// Factors `J Jᵀ` of a row-major `(6, n)` Jacobian; `damping` is `λ₀`.
    #[inline(always)]
    pub fn factor(&mut self, jacobian: &[S], n: usize, damping: S) {
        let mut trace = S::of(0.0);
        for i in 0..ROWS {
            for j in 0..=i {
                let (a, b) = (&jacobian[i * n..(i + 1) * n], &jacobian[j * n..(j + 1) * n]);
                self.gram[i * ROWS + j] = dot(a, b);
            }
            trace += self.gram[i * ROWS + i];
        }
        // the floor keeps the factor of a singular Jacobian finite; it is rounding otherwise
        self.undamped = self.gram;
        let floor = trace * S::of(1e-14) + S::of(f64::MIN_POSITIVE);
        add_diagonal(&mut self.undamped, floor);
        cholesky_factor(&mut self.undamped, ROWS);

        // λ² = max(λ₀² − σ², 0)
        let missing = damping * damping - S::of(1.0) / inverse_trace(&self.undamped);
        let is_short = S::less(S::of(0.0), missing);
        self.is_damped = S::any(is_short);
        if self.is_damped {
            self.damped = self.gram;
            add_diagonal(&mut self.damped, S::select(is_short, missing, S::of(0.0)) + floor);
            cholesky_factor(&mut self.damped, ROWS);
        }
    }

    /// `out = J⁺ x`, damped; `x` is `(6,)`, `out` `(n,)`.
    #[inline(always)]
    pub fn apply(&self, jacobian: &[S], x: [S; ROWS], out: &mut [S]) {
        let factor = if self.is_damped { &self.damped } else { &self.undamped };
        transpose_apply(factor, jacobian, x, out);
    }

    /// Splits joint rates `y`, `(n,)`: what the task does not feel, `(1 − J⁺ J) y` undamped, into
    /// `free`, and what it feels but gives up for the damping, into `lost` (zero where undamped).
    #[inline(always)]
    pub fn split(&self, jacobian: &[S], y: &[S], free: &mut [S], lost: &mut [S]) {
        let n = y.len();
        let mut felt = [S::of(0.0); ROWS];
        for (i, felt) in felt.iter_mut().enumerate() {
            *felt = dot(&jacobian[i * n..(i + 1) * n], y);
        }
        transpose_apply(&self.undamped, jacobian, felt, free);
        lost.copy_from_slice(free);
        if self.is_damped {
            transpose_apply(&self.damped, jacobian, felt, lost);
        }
        for j in 0..n {
            lost[j] = free[j] - lost[j];
            free[j] = y[j] - free[j];
        }
    }
}

impl<S: Real> Default for PseudoInverse<S> {
    fn default() -> Self {
        Self::new()
    }
}

#[inline(always)]
fn add_diagonal<S: Real>(a: &mut [S; ROWS * ROWS], x: S) {
    for i in 0..ROWS {
        a[i * ROWS + i] += x;
    }
}

/// `out = Jᵀ A⁻¹ x` with the factor of `A`.
#[inline(always)]
fn transpose_apply<S: Real>(factor: &[S], jacobian: &[S], mut x: [S; ROWS], out: &mut [S]) {
    let n = out.len();
    cholesky_solve(factor, ROWS, &mut x);
    for (j, out) in out.iter_mut().enumerate() {
        *out = S::of(0.0);
        for i in 0..ROWS {
            *out = jacobian[i * n + j].mul_add(x[i], *out);
        }
    }
}

/// `tr A⁻¹ = Σ (L⁻¹)²` with the factor of `A`.
#[inline(always)]
fn inverse_trace<S: Real>(factor: &[S; ROWS * ROWS]) -> S {
    let mut trace = S::of(0.0);
    for j in 0..ROWS {
        // column j of L⁻¹ by forward substitution; the factor's diagonal holds 1/L_ii
        let mut column = [S::of(0.0); ROWS];
        column[j] = factor[j * ROWS + j];
        trace = column[j].mul_add(column[j], trace);
        for i in j + 1..ROWS {
            let sum = dot(&factor[i * ROWS + j..i * ROWS + i], &column[j..i]);
            column[i] = -sum * factor[i * ROWS + i];
            trace = column[i].mul_add(column[i], trace);
        }
    }
    trace
}
