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

/// Cholesky factor `A = L Lᵀ` of a positive definite `n × n` matrix, in place.
///
/// Reads the lower triangle and replaces it by `L`, whose diagonal holds the *inverse* pivots
/// `1/L_ii` (what the solves multiply by). The upper triangle is left alone.
#[inline(always)]
pub fn cholesky_factor<S: Real>(a: &mut [S], n: usize) {
    for j in 0..n {
        for i in j..n {
            let mut sum = a[i * n + j];
            for k in 0..j {
                sum = (-a[i * n + k]).mul_add(a[j * n + k], sum);
            }
            a[i * n + j] = if i == j { S::of(1.0) / sum.sqrt() } else { sum * a[j * n + j] };
        }
    }
}

/// `x ← A⁻¹ x` with the factor of [`cholesky_factor`].
#[inline(always)]
pub fn cholesky_solve<S: Real>(l: &[S], n: usize, x: &mut [S]) {
    for i in 0..n {
        let mut sum = x[i];
        for k in 0..i {
            sum = (-l[i * n + k]).mul_add(x[k], sum);
        }
        x[i] = sum * l[i * n + i];
    }
    for i in (0..n).rev() {
        let mut sum = x[i];
        for k in i + 1..n {
            sum = (-l[k * n + i]).mul_add(x[k], sum);
        }
        x[i] = sum * l[i * n + i];
    }
}
