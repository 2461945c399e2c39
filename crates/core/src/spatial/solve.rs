//! Small dense solvers for row-major matrices.

use super::scalar::Real;

/// Returns the scalar product of two rows; extra elements of the longer row are ignored.
#[inline(always)]
pub fn dot<S: Real>(a: &[S], b: &[S]) -> S {
    // a loop, because a fold would not be inlined and would be compiled for the baseline
    let mut sum = S::of(0.0);
    for i in 0..a.len().min(b.len()) {
        sum = a[i].mul_add(b[i], sum);
    }
    sum
}

/// Replaces `a`, a positive definite matrix `A` (n, n), row-major, by its square-root-free Cholesky factors
/// `A = L D Lᵀ`.
///
/// Only the lower triangle of `A` is read; it is replaced by `L`. The diagonal receives the inverse pivots
/// `1/D_ii`, by which [`cholesky_solve`] multiplies, instead of the unit diagonal of `L`. The upper triangle
/// is used as workspace.
#[inline(always)]
pub fn cholesky_factor<S: Real>(a: &mut [S], n: usize) {
    for j in 0..n {
        for i in j..n {
            // D_j L_ij = A_ij − Σ L_ik (D_k L_jk); the products in brackets are in the upper triangle
            let mut sum = a[i * n + j];
            for k in 0..j {
                sum = (-a[i * n + k]).mul_add(a[k * n + j], sum);
            }
            if i == j {
                a[j * n + j] = S::of(1.0) / sum;
            } else {
                a[j * n + i] = sum;
                a[i * n + j] = sum * a[j * n + j];
            }
        }
    }
}

/// Replaces `x` (n,) by `A⁻¹ x`, where `l` holds the factors of `A` computed by [`cholesky_factor`].
#[inline(always)]
pub fn cholesky_solve<S: Real>(l: &[S], n: usize, x: &mut [S]) {
    for i in 1..n {
        for k in 0..i {
            x[i] = (-l[i * n + k]).mul_add(x[k], x[i]);
        }
    }
    for i in (0..n).rev() {
        x[i] *= l[i * n + i];
        for k in i + 1..n {
            x[i] = (-l[k * n + i]).mul_add(x[k], x[i]);
        }
    }
}
