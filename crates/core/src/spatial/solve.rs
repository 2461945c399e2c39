//! Small dense solvers on slices, row major.

use super::scalar::Real;

/// Scalar product of two rows.
#[inline(always)]
pub fn dot<S: Real>(a: &[S], b: &[S]) -> S {
    // a loop, not a fold: what the library leaves out of line loses the instruction set
    let mut sum = S::of(0.0);
    for i in 0..a.len().min(b.len()) {
        sum = a[i].mul_add(b[i], sum);
    }
    sum
}

/// Cholesky's factors without roots, `A = L D Lᵀ`, of a positive definite `n × n` matrix, in place.
///
/// Reads the lower triangle and replaces it by `L`, whose diagonal of ones gives way to the *inverse* pivots `1/D_ii`
/// (what the solves multiply by). The upper triangle is used up.
#[inline(always)]
pub fn cholesky_factor<S: Real>(a: &mut [S], n: usize) {
    for j in 0..n {
        for i in j..n {
            // D_j L_ij = A_ij − Σ L_ik (D_k L_jk), what is in brackets from the upper triangle
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

/// `x ← A⁻¹ x` with the factors of [`cholesky_factor`].
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
