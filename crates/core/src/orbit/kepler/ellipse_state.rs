//! State on an ellipse computed directly from its elements, for batches on SIMD lanes.

use super::conic::{Ellipse, wrap};
use crate::spatial::{Real, Vec3};
use std::f64::consts::TAU;

/// Returns the position (m, from the planet's centre) and velocity (m/s), in the inertial axes of the
/// elements, `t` s after the instant to which the mean anomaly refers.
///
/// `elements`: semi-major axis (m), eccentricity in [0, 1), inclination, node, argument of periapsis and mean
/// anomaly (rad); `mu`: m³/s². For large `t`, the phase has the rounding error of `n t`, where `n` is the
/// mean motion; [`Kepler`](super::Kepler) avoids this error.
#[inline(always)]
pub(crate) fn ellipse_state<S: Real>(elements: [S; 6], mu: S, t: S) -> (Vec3<S>, Vec3<S>) {
    let ([a, e, inclination, raan, argument, anomaly], one) = (elements, S::of(1.0));
    let one_minus_e = one - e;
    // n = √(μ/a³), b = a √(1 - e²), p = b²/a
    let velocity_scale = (mu * a).sqrt();
    let ratio = (one_minus_e * (one + e)).sqrt();
    let n = velocity_scale / (a * a);
    let (b, velocity_scale) = (a * ratio, [velocity_scale, velocity_scale * ratio]);
    let s = Ellipse { e, one_minus_e, periapsis: a * one_minus_e, a, b, velocity_scale }
        .at(subtract_turns_lanes(anomaly + n * t));
    // P and Q: unit vectors towards the periapsis and along the velocity there
    let ((si, ci), (so, co), (sw, cw)) = (inclination.sin_cos(), raan.sin_cos(), argument.sin_cos());
    let p = Vec3::new(co * cw - so * sw * ci, so * cw + co * sw * ci, sw * si);
    let q = Vec3::new(-co * sw - so * cw * ci, -so * sw + co * cw * ci, cw * si);
    (p * s.x + q * s.y, p * s.vx + q * s.vy)
}

/// Subtracts whole turns from an angle, rad; the result is in [-π, π].
#[inline(always)]
fn subtract_turns_lanes<S: Real>(angle: S) -> S {
    const ROUND: f64 = 6_755_399_441_055_744.0; // adding 1.5 × 2⁵² rounds to an integer
    const HEAD: f64 = f64::from_bits(TAU.to_bits() & !((1 << 27) - 1));
    const TAIL: f64 = TAU - HEAD;
    const REST: f64 = 2.449_293_598_294_706_4e-16; // 2π less its value as f64
    let k = (angle * S::of(1.0 / TAU) + S::of(ROUND)) - S::of(ROUND);
    wrap(((angle - k * S::of(HEAD)) - k * S::of(TAIL)) - k * S::of(REST))
}
