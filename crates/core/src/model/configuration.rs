//! Operations on configurations: integration `q ⊕ δ` and difference `q₂ ⊖ q₁`.

use super::tree::Model;
use crate::spatial::{Quat, Real, Vec3, exp_so3, log_so3};

/// Returns the configuration, `(nq,)`, with the base at the origin of W, unrotated, and all joints at zero.
pub fn neutral(model: &Model) -> Vec<f64> {
    let mut q = vec![0.0; model.nq()];
    q[6] = 1.0;
    q
}

/// Computes `q ⊕ δ`: the base moves with the constant body twist `δ[..6]` for unit time, and the joint
/// positions change by `δ[6..]`.
///
/// `p' = p + R V(θ) ρ`, `R' = R exp(θ)` for the position `p` and rotation `R` of the base, with `ρ = δ[..3]`,
/// `θ = δ[3..6]`, `φ = |θ|` and `V = 1 + (1−cos φ)/φ² θ× + (φ−sin φ)/φ³ θ×²`. `q`, `out`: `(nq,)`; `delta`:
/// `(nv,)`, m and rad, linear first.
#[inline(always)]
pub fn integrate<S: Real>(q: &[S], delta: &[S], out: &mut [S]) {
    let attitude = Quat::from_xyzw(&q[3..]);
    let (rho, theta) = (Vec3::from_slice(delta), Vec3::from_slice(&delta[3..]));
    let (a, b) = left_coefficients(theta);
    let cross = theta.cross(rho);
    let step = rho + cross * a + theta.cross(cross) * b;
    (attitude.matrix() * step + Vec3::from_slice(q)).write(out);
    attitude.product(exp_so3(theta)).normalized().write_xyzw(&mut out[3..]);
    for j in 7..q.len() {
        out[j] = q[j] + delta[j - 1];
    }
}

/// Computes `q₂ ⊖ q₁`, the `δ` for which `q₁ ⊕ δ = q₂`; of the two possible rotations of the base, the
/// smaller is returned.
///
/// `q1`, `q2`: `(nq,)`; `out`: `(nv,)`, m and rad, linear first.
#[inline(always)]
pub fn difference<S: Real>(q1: &[S], q2: &[S], out: &mut [S]) {
    let (r1, r2) = (Quat::from_xyzw(&q1[3..]), Quat::from_xyzw(&q2[3..]));
    let theta = log_so3(r1.conjugate().product(r2));
    let step = r1.matrix().transpose_mul(Vec3::from_slice(q2) - Vec3::from_slice(q1));
    // ρ = V⁻¹ step,  V⁻¹ = 1 − θ×/2 + c θ×²
    let c = inverse_coefficient(theta);
    let cross = theta.cross(step);
    (step - cross * S::of(0.5) + theta.cross(cross) * c).write(out);
    theta.write(&mut out[3..]);
    for j in 6..out.len() {
        out[j] = q2[j + 1] - q1[j + 1];
    }
}

/// Returns `((1 − cos φ)/φ², (φ − sin φ)/φ³)` with `φ = |θ|`; below 0.1 rad, both are computed from their
/// series.
#[inline(always)]
fn left_coefficients<S: Real>(theta: Vec3<S>) -> (S, S) {
    let squared = theta.dot(theta);
    let is_small = S::less(squared, S::of(1e-2));
    let safe = S::select(is_small, S::of(1.0), squared);
    let angle = safe.sqrt();
    // 1 − cos φ = 2 sin²(φ/2) avoids cancellation
    let (half, _) = (angle * S::of(0.5)).sin_cos();
    let (s, _) = angle.sin_cos();
    let a = S::of(2.0) * half * half / safe;
    let b = (angle - s) / (safe * angle);
    let series = |c: [f64; 5]| {
        c.iter().rev().fold(S::of(0.0), |sum, &coefficient| sum.mul_add(squared, S::of(coefficient)))
    };
    (
        S::select(is_small, series([0.5, -1.0 / 24.0, 1.0 / 720.0, -1.0 / 40_320.0, 1.0 / 3_628_800.0]), a),
        S::select(
            is_small,
            series([1.0 / 6.0, -1.0 / 120.0, 1.0 / 5040.0, -1.0 / 362_880.0, 1.0 / 39_916_800.0]),
            b,
        ),
    )
}

/// Returns `c = 1/φ² − cot(φ/2)/(2φ)` in `V⁻¹ = 1 − θ×/2 + c θ×²`, by a series below `φ = |θ| = 0.1` rad.
#[inline(always)]
fn inverse_coefficient<S: Real>(theta: Vec3<S>) -> S {
    let squared = theta.dot(theta);
    let is_small = S::less(squared, S::of(1e-2));
    let safe = S::select(is_small, S::of(1.0), squared);
    let angle = safe.sqrt();
    let (s, c) = (angle * S::of(0.5)).sin_cos();
    let closed = S::of(1.0) / safe - c / (S::of(2.0) * angle * s);
    let series = [1.0 / 12.0, 1.0 / 720.0, 1.0 / 30_240.0, 1.0 / 1_209_600.0]
        .iter()
        .rev()
        .fold(S::of(0.0), |sum, &coefficient| sum.mul_add(squared, S::of(coefficient)));
    S::select(is_small, series, closed)
}
