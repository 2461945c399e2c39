//! Damped pseudo-inverse of a task Jacobian, and the projector on its null space.

use crate::spatial::{Real, cholesky_factor, cholesky_solve, dot};

/// Task rows: three of position, three of attitude.
const ROWS: usize = 6;

/// `Jᵀ (J Jᵀ + λ²)⁻¹`, undamped where the Jacobian is well conditioned.
///
/// The smallest Cholesky pivot of `J Jᵀ` over its trace, `ρ`, bounds the distance from
/// singularity; below `ρ₀ = 1e-6` the damping grows, `λ² = λ₀² (1 − ρ/ρ₀)²`. The null-space
/// projector is always built from the undamped inverse: a damped one leaks into the task.
///
/// Source: Nakamura and Hanafusa, J. Dyn. Sys. Meas. Control 108(3), 1986.
#[derive(Clone, Debug)]
pub struct PseudoInverse<S> {
    gram: [S; ROWS * ROWS],
    damped: [S; ROWS * ROWS],
    undamped: [S; ROWS * ROWS],
}

const CONDITION_LIMIT: f64 = 1e-6;

impl<S: Real> PseudoInverse<S> {
    /// Space for a factor.
    pub fn new() -> Self {
        let empty = [S::of(0.0); ROWS * ROWS];
        Self { gram: empty, damped: empty, undamped: empty }
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
        add_diagonal(&mut self.undamped, trace * S::of(1e-14) + S::of(f64::MIN_POSITIVE));
        cholesky_factor(&mut self.undamped, ROWS);

        let mut largest = S::of(0.0); // of the inverse pivots
        for i in 0..ROWS {
            let pivot = self.undamped[i * ROWS + i];
            largest = S::select(S::less(largest, pivot), pivot, largest);
        }
        let condition = S::of(1.0) / (largest * largest * trace);
        let short = S::of(1.0) - condition * S::of(1.0 / CONDITION_LIMIT);
        let short = S::select(S::less(short, S::of(0.0)), S::of(0.0), short);
        self.damped = self.gram;
        add_diagonal(&mut self.damped, damping * damping * short * short + trace * S::of(1e-14));
        cholesky_factor(&mut self.damped, ROWS);
    }

    /// `out = J⁺ x`, damped; `x` is `(6,)`, `out` `(n,)`.
    #[inline(always)]
    pub fn apply(&self, jacobian: &[S], x: [S; ROWS], out: &mut [S]) {
        transpose_apply(&self.damped, jacobian, x, out);
    }

    /// `out = (1 − J⁺ J) y`: the part of `y`, `(n,)`, that the task does not feel.
    #[inline(always)]
    pub fn project(&self, jacobian: &[S], y: &[S], out: &mut [S]) {
        let n = y.len();
        let mut felt = [S::of(0.0); ROWS];
        for (i, felt) in felt.iter_mut().enumerate() {
            *felt = dot(&jacobian[i * n..(i + 1) * n], y);
        }
        transpose_apply(&self.undamped, jacobian, felt, out);
        out.iter_mut().zip(y).for_each(|(out, y)| *out = *y - *out);
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
