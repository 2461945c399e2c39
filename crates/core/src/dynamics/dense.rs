//! Forward dynamics with the dense mass matrix, for robots in which a light body supports heavy ones.
//!
//! The articulated inertia of such a body is a small difference of large numbers, so ABA loses digits to
//! cancellation. The entries of `M`, by contrast, have small relative errors, and the residual of the
//! factorization `M = L D Lᵀ` is small relative to the terms of each row.

use super::crba;
use super::data::Data;
use super::rnea::inverse_dynamics_recursion;
use crate::model::{BASE_NV, Model};
use crate::spatial::Real;

/// Solves `M a = τ − c + Σ Jᵀ F` for `a` with the external wrenches `F` in `data`. Requires up-to-date
/// kinematics in `data`. A joint is locked if `is_locked` returns true for the index of its body; locked
/// joints have the accelerations `given`, `(n,)`, or zero if `given` is empty. Stores the accelerations of
/// all bodies and the holding torques of locked joints in `data`, as the ABA recursion does.
///
/// Source: Higham, Accuracy and Stability of Numerical Algorithms, 2002, chapter 10.
pub(super) fn solve<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    v: &[S],
    tau: &[S],
    given: &[f64],
    a: &mut [S],
    is_locked: impl Fn(usize) -> bool,
) {
    let nv = model.nv();
    let (mut factors, mut forces) = (std::mem::take(&mut data.factors), std::mem::take(&mut data.forces));
    a.fill(S::of(0.0));
    a[BASE_NV..].iter_mut().zip(given).for_each(|(a, given)| *a = S::of(*given));
    inverse_dynamics_recursion(model, data, v, (!given.is_empty()).then_some(&*a), &mut forces);
    S::enter(
        #[inline(always)]
        || {
            crba::kernel(model, data, &mut factors);
            for i in 0..nv {
                a[i] = tau[i] - forces[i];
            }
            for i in (6..nv).filter(|i| is_locked(i - 5)) {
                remove_joint(&mut factors, nv, i);
                a[i] = S::of(0.0);
            }
            factorize(&mut factors, nv);
            substitute(&factors, nv, a);
        },
    );
    a[BASE_NV..].iter_mut().zip(given).for_each(|(a, given)| *a += S::of(*given));
    inverse_dynamics_recursion(model, data, v, Some(a), &mut forces);
    for k in (1..=model.joint_count()).filter(|k| is_locked(*k)) {
        data.bodies[k].holding_torque = forces[k + 5] - tau[k + 5];
    }
    (data.factors, data.forces) = (factors, forces);
}

/// Computes `x ← M⁻¹ x` with the factors stored by [`solve`].
#[inline(always)]
pub(super) fn solve_factored<S: Real>(data: &Data<S>, nv: usize, x: &mut [S]) {
    substitute(&data.factors, nv, x);
}

/// Computes `M⁻¹`, row major `(nv, nv)`, from the factors stored by [`solve`].
#[inline(always)]
pub(super) fn inverse_mass<S: Real>(data: &Data<S>, nv: usize, out: &mut [S]) {
    for (j, row) in out.chunks_exact_mut(nv).enumerate() {
        row.fill(S::of(0.0));
        row[j] = S::of(1.0);
        substitute(&data.factors, nv, row); // rows and columns of a symmetric matrix are equal
    }
}

/// Removes component `i` of the velocity from the equations: its row and column become those of the identity.
#[inline(always)]
fn remove_joint<S: Real>(m: &mut [S], nv: usize, i: usize) {
    for j in 0..nv {
        (m[i * nv + j], m[j * nv + i]) = (S::of(0.0), S::of(0.0));
    }
    m[i * nv + i] = S::of(1.0);
}

/// Factorizes `M = L D Lᵀ` in place, with `L` below the diagonal and `D⁻¹` on the diagonal. A pivot that is
/// smaller than the rounding error of its diagonal entry is replaced by that rounding error.
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
        let pivot = S::select(pivot.less(least), least, pivot); // a smaller pivot is a rounding error
        m[i * nv + i] = S::of(1.0) / pivot;
    }
}

/// Solves `L D Lᵀ x = b` with the factors in `m`; on entry `x` contains `b`.
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
