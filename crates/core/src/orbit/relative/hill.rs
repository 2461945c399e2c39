//! Linear relative motion near a circular orbit (Hill, Clohessy-Wiltshire).

use crate::orbit::OrbitError;
use crate::orbit::error::{finite, positive};
use nalgebra::{Matrix3, Matrix6, Vector3};

/// Returns the transition matrix of relative position and velocity over `t` s, for a circular orbit with mean
/// motion `n`, rad/s.
///
/// `ẍ = 3n² x + 2n ẏ`, `ÿ = -2n ẋ`, `z̈ = -n² z` in Hill axes `L` (x outward, y along track, z normal).
/// Velocities are relative to the rotating axes; rows and columns are ordered `(x, y, z, ẋ, ẏ, ż)`, in m and
/// m/s. The position error is about `3/2 ρ²/R` per radian of orbit, with the distance `ρ` from the origin and
/// the orbit radius `R`.
///
/// # Errors
/// [`OrbitError::NotFinite`] and [`OrbitError::TooLarge`] for `t` or `n`, and [`OrbitError::NotPositive`] for
/// `n`.
///
/// Source: Clohessy and Wiltshire, J. Aerospace Sciences 27(9), 1960.
pub fn hill_transition(n: f64, t: f64) -> Result<Matrix6<f64>, OrbitError> {
    positive("mean motion", n)?;
    let nt = finite("time", t)? * n;
    let (s, c) = nt.sin_cos();
    let half = (0.5 * nt).sin();
    let v = 2.0 * half * half; // 1 - cos nt without cancellation
    #[rustfmt::skip]
    let transition = Matrix6::new(
        4.0 - 3.0 * c,      0.0, 0.0,    s / n,              2.0 * v / n,                0.0,
        6.0 * (s - nt),     1.0, 0.0,    -2.0 * v / n,       (4.0 * s - 3.0 * nt) / n,   0.0,
        0.0,                0.0, c,      0.0,                0.0,                        s / n,
        3.0 * n * s,        0.0, 0.0,    c,                  2.0 * s,                    0.0,
        -6.0 * n * v,       0.0, 0.0,    -2.0 * s,           4.0 * c - 3.0,              0.0,
        0.0,                0.0, -n * s, 0.0,                0.0,                        c,
    );
    Ok(transition)
}

/// Computes [`hill_transition`] for each of `times` (T,), s; `out` is (T, 6, 6), row-major.
///
/// # Errors
/// The errors of [`hill_transition`], and [`OrbitError::WrongLength`] if `out` has the wrong length.
pub fn hill_transitions(n: f64, times: &[f64], out: &mut [f64]) -> Result<(), OrbitError> {
    super::check(&[("transitions", 36 * times.len(), out.len())])?;
    for (&t, to) in times.iter().zip(out.chunks_exact_mut(36)) {
        to.copy_from_slice(hill_transition(n, t)?.transpose().as_slice()); // nalgebra is column-major
    }
    Ok(())
}

/// Magnitude of the determinant of `n Φ_rv` ([`intercept_velocity`]) up to which the matrix counts as
/// singular, so that no impulse leads to the origin in the given time.
const SINGULAR: f64 = 1e-9;

/// Returns the velocity, m/s in rotating axes `L`, with which a satellite at `r` (m, axes `L`) reaches the
/// origin in `t` s, near a circular orbit with mean motion `n`, rad/s. The change to this velocity is the
/// first impulse of a two-impulse rendezvous.
///
/// `v = -Φ_rv⁻¹ Φ_rr r`, where the blocks `Φ_rr` and `Φ_rv` of the transition matrix give the final position
/// due to the initial position and velocity. The second impulse cancels the final velocity, which
/// [`hill_transition`] gives.
///
/// # Errors
/// The errors of [`hill_transition`]; [`OrbitError::NotFinite`] and [`OrbitError::TooLarge`] for `r`;
/// [`OrbitError::NoIntercept`] at times when a component of the final position does not depend on the initial
/// velocity, such as z after half a period.
pub fn intercept_velocity(n: f64, r: &Vector3<f64>, t: f64) -> Result<Vector3<f64>, OrbitError> {
    r.iter().try_for_each(|&x| finite("position", x).map(drop))?;
    let transition = hill_transition(n, t)?;
    let from_r: Matrix3<f64> = transition.fixed_view::<3, 3>(0, 0).into();
    let from_v: Matrix3<f64> = transition.fixed_view::<3, 3>(0, 3).into_owned() * n;
    match from_v.try_inverse() {
        Some(inverse) if from_v.determinant().abs() > SINGULAR => Ok(inverse * (from_r * r) * -n),
        _ => Err(OrbitError::NoIntercept { time: t, mean_motion: n }),
    }
}
