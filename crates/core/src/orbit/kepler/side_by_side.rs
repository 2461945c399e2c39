//! An ellipse from its elements, without preparation: many at once in lanes.

use super::conic::{Ellipse, wrap};
use crate::spatial::{Real, Vec3};
use std::f64::consts::TAU;

/// Position (m) and velocity (m/s) `t` s after the mean anomaly held.
///
/// `elements`: semi-major axis (m), eccentricity in [0, 1), inclination, node, argument of periapsis, mean
/// anomaly (rad). Far from time zero the phase has the rounding of `n t`, which [`Kepler`](super::Kepler) has not.
#[inline(always)]
pub(crate) fn ellipse_state<S: Real>(elements: [S; 6], mu: S, t: S) -> (Vec3<S>, Vec3<S>) {
    let ([a, e, inclination, raan, argument, anomaly], one) = (elements, S::of(1.0));
    let one_minus_e = one - e;
    // n = √(μ/a³), b = a √(1 - e²), p = b²/a
    let flow = (mu * a).sqrt();
    let ratio = (one_minus_e * (one + e)).sqrt();
    let n = flow / (a * a);
    let (b, flow) = (a * ratio, [flow, flow * ratio]);
    let s = Ellipse { e, one_minus_e, periapsis: a * one_minus_e, a, b, flow }.at(turns_off(anomaly + n * t));
    // P, Q: periapsis direction and the one along the velocity there
    let ((si, ci), (so, co), (sw, cw)) = (inclination.sin_cos(), raan.sin_cos(), argument.sin_cos());
    let p = Vec3::new(co * cw - so * sw * ci, so * cw + co * sw * ci, sw * si);
    let q = Vec3::new(-co * sw - so * cw * ci, -so * sw + co * cw * ci, cw * si);
    (p * s.x + q * s.y, p * s.vx + q * s.vy)
}

/// `angle` less whole turns, within [-π, π].
#[inline(always)]
fn turns_off<S: Real>(angle: S) -> S {
    const ROUND: f64 = 6_755_399_441_055_744.0; // adding 1.5 × 2⁵² rounds to a whole number
    const HEAD: f64 = f64::from_bits(TAU.to_bits() & !((1 << 27) - 1));
    const TAIL: f64 = TAU - HEAD;
    const REST: f64 = 2.449_293_598_294_706_4e-16; // 2π beyond its f64
    let k = (angle * S::of(1.0 / TAU) + S::of(ROUND)) - S::of(ROUND);
    wrap(((angle - k * S::of(HEAD)) - k * S::of(TAIL)) - k * S::of(REST))
}
