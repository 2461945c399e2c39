//! Solution of `A λ = b` for the constraint forces.

use crate::spatial::{Real, cholesky_solve};

/// Pivot of the scaled matrix below which a row counts as dependent on the rows before it.
const DEPENDENT: f64 = 1e-10;

/// Solves `A λ = b` for a positive semidefinite matrix `A`, `(m, m)`, given by its lower triangle, which its
/// factors replace. `x` contains `b` before and `λ` after the call. Returns the rank of `A`.
///
/// The rows have different units, so the matrix is first scaled to `D^(−1/2) A D^(−1/2)` with
/// `D = diag(A) + C`. `compliance` contains the diagonal `C`: for each row, the acceleration that its force
/// would give to the base if it acted on only one of its two bodies. `C` prevents the scaling from magnifying
/// a diagonal entry that is only a rounding error. A row whose pivot then vanishes depends on the rows before
/// it, as happens with redundant closures and in singular configurations. Its constraint force is set to
/// zero, since the other rows already imply its equation. For consistent equations the result is a solution.
///
/// Source: Higham, Accuracy and Stability of Numerical Algorithms, 2002, section 10.3.
#[inline(always)]
pub(crate) fn solve<S: Real>(a: &mut [S], compliance: &[S], scale: &mut [S], x: &mut [S]) -> S {
    let m = x.len();
    for i in 0..m {
        let size = a[i * m + i] + compliance[i];
        let is_movable = S::less(S::of(0.0), size);
        let root = S::select(is_movable, size, S::of(1.0)).sqrt();
        scale[i] = S::select(is_movable, S::of(1.0) / root, S::of(0.0));
    }
    for i in 0..m {
        for j in 0..=i {
            a[i * m + j] *= scale[i] * scale[j];
        }
        x[i] *= scale[i];
    }
    let rank = factor(a, m);
    cholesky_solve(a, m, x);
    for i in 0..m {
        x[i] *= scale[i];
    }
    rank
}

/// Computes the factors `A = L D Lᵀ` in place, in the form that [`cholesky_solve`] expects, with `1/D_ii = 0`
/// for dependent rows. Returns the number of independent rows.
#[inline(always)]
fn factor<S: Real>(a: &mut [S], m: usize) -> S {
    let mut rank = S::of(0.0);
    for j in 0..m {
        for i in j..m {
            // D_j L_ij = A_ij − Σ L_ik (D_k L_jk); the products in brackets are in the upper triangle
            let mut sum = a[i * m + j];
            for k in 0..j {
                sum = (-a[i * m + k]).mul_add(a[k * m + j], sum);
            }
            if i == j {
                let is_independent = S::less(S::of(DEPENDENT), sum);
                let pivot = S::select(is_independent, sum, S::of(1.0));
                a[j * m + j] = S::select(is_independent, S::of(1.0) / pivot, S::of(0.0));
                rank += S::select(is_independent, S::of(1.0), S::of(0.0));
            } else {
                a[j * m + i] = sum;
                a[i * m + j] = sum * a[j * m + j];
            }
        }
    }
    rank
}
