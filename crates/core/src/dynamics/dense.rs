//! Forward dynamics of robots in which a light body carries heavy ones, by the mass matrix.
//!
//! The articulated inertia of such a body is a small difference of large ones, which cancels the digits that these have in
//! common. The entries of `M` are accurate relative to their own size, and the residual of `M = L D Lᵀ` is small relative to
//! the terms of each row.

use super::crba;
use super::data::Data;
use super::rnea::inverse_dynamics_recursion;
use crate::model::Model;
use crate::spatial::Real;

/// Solves `M a = τ − c`. Leaves the accelerations of all bodies and the torques that hold locked joints in `data`, as the
/// recursion does.
///
/// Source: Higham, Accuracy and Stability of Numerical Algorithms, 2002, chapter 10.
pub(super) fn solve<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    v: &[S],
    tau: &[S],
    a: &mut [S],
    is_locked: impl Fn(usize) -> bool,
) {
    let nv = model.nv();
    let (mut factors, mut efforts) = (std::mem::take(&mut data.factors), std::mem::take(&mut data.efforts));
    inverse_dynamics_recursion(model, data, v, None, &mut efforts);
    S::enter(
        #[inline(always)]
        || {
            crba::kernel(model, data, &mut factors);
            for i in 0..nv {
                a[i] = tau[i] - efforts[i];
            }
            for i in (6..nv).filter(|i| is_locked(i - 5)) {
                hold(&mut factors, nv, i);
                a[i] = S::of(0.0);
            }
            factorize(&mut factors, nv);
            substitute(&factors, nv, a);
        },
    );
    inverse_dynamics_recursion(model, data, v, Some(a), &mut efforts);
    for k in (1..=model.joint_count()).filter(|k| is_locked(*k)) {
        data.bodies[k].drive = efforts[k + 5] - tau[k + 5];
    }
    (data.factors, data.efforts) = (factors, efforts);
}

/// `M⁻¹` from the factors that [`solve`] left, row major `(nv, nv)`.
#[inline(always)]
pub(super) fn inverse_mass<S: Real>(data: &Data<S>, nv: usize, out: &mut [S]) {
    for (j, row) in out.chunks_exact_mut(nv).enumerate() {
        row.fill(S::of(0.0));
        row[j] = S::of(1.0);
        substitute(&data.factors, nv, row); // a row of a symmetric matrix is a column
    }
}

/// Takes joint `i` out of the equations: its row and column become those of the identity.
#[inline(always)]
fn hold<S: Real>(m: &mut [S], nv: usize, i: usize) {
    for j in 0..nv {
        (m[i * nv + j], m[j * nv + i]) = (S::of(0.0), S::of(0.0));
    }
    m[i * nv + i] = S::of(1.0);
}

/// `M = L D Lᵀ`, `L` below the diagonal and `D⁻¹` on it.
#[inline(always)]
fn factorize<S: Real>(m: &mut [S], nv: usize) {
    for i in 0..nv {
        let least = m[i * nv + i] * S::of(f64::EPSILON);
        for j in 0..i {
            // L_ij d_j = M_ij − Σ_k L_ik d_k L_jk
            let mut entry = m[i * nv + j];
            for k in 0..j {
                entry -= m[i * nv + k] * m[j * nv + k];
            }
            m[i * nv + j] = entry;
        }
        // d_i = M_ii − Σ_j (L_ij d_j)²/d_j
        let mut pivot = m[i * nv + i];
        for j in 0..i {
            let scaled = m[i * nv + j];
            m[i * nv + j] = scaled * m[j * nv + j];
            pivot -= scaled * m[i * nv + j];
        }
        let pivot = S::select(pivot.less(least), least, pivot); // rounding alone takes it below that
        m[i * nv + i] = S::of(1.0) / pivot;
    }
}

/// `L D Lᵀ x = b`, `b` being replaced by `x`.
#[inline(always)]
fn substitute<S: Real>(m: &[S], nv: usize, x: &mut [S]) {
    for i in 0..nv {
        for j in 0..i {
            x[i] -= m[i * nv + j] * x[j];
        }
    }
    for i in (0..nv).rev() {
        x[i] *= m[i * nv + i];
        for j in i + 1..nv {
            x[i] -= m[j * nv + i] * x[j];
        }
    }
}
