//! Solvers of Kepler's equation for the ellipse and the hyperbola, and of Barker's equation for the parabola.
//!
//! `e` is the eccentricity, `E` the eccentric anomaly, `H` its hyperbolic counterpart and `M` the mean
//! anomaly. `|1 - e|` is a separate input and `E - sin E` is computed without cancellation, which keeps the
//! relative accuracy for `e → 1`, `M → 0`.

use crate::spatial::Real;
use std::f64::consts::PI;

/// Sine and cosine of half the eccentric anomaly; for a hyperbola, hyperbolic sine and cosine.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfAnomaly<S = f64> {
    pub(super) sin: S,
    pub(super) cos: S,
}

/// Returns `Σ (-s)ᵏ x²ᵏ⁺³/(2k+3)!` for `|x| < 1`, where `s` is `sign`: `x - sin x` for 1, `sinh x - x` for
/// -1.
#[inline(always)]
fn cubic_tail<S: Real>(x: S, sign: f64) -> S {
    // each factor is 1 - y/d times the next factor
    let fold = |y: S, d: f64, tail: S| S::of(1.0) - y * S::of(1.0 / d) * tail;
    let y = S::of(sign) * x * x;
    let tail = fold(y, 210.0, fold(y, 272.0, S::of(1.0)));
    let tail = fold(y, 72.0, fold(y, 110.0, fold(y, 156.0, tail)));
    x * x * x * S::of(1.0 / 6.0) * fold(y, 20.0, fold(y, 42.0, tail))
}

/// Returns `x - sin x` without cancellation, given `sin x`.
#[inline(always)]
fn x_minus_sin<S: Real>(x: S, sin: S) -> S {
    S::select(S::less(x.abs(), S::of(1.0)), cubic_tail(x, 1.0), x - sin)
}

/// Returns `∛x` with a relative error of 1e-9 for `x > 0`, by Newton steps for `1/∛x`, which need no
/// division. The initial value is obtained by dividing the exponent by three.
#[inline(always)]
fn cube_root<S: Real>(x: S) -> S {
    const HIGH: u64 = 0x553e_f0ff; // 4/3 of the exponent bias, with the error balanced over three octaves
    let mut inverse = S::from_lanes(
        #[inline(always)]
        |lane| {
            let third = ((x.lane(lane).to_bits() >> 32) * 0x5555_5556) >> 32; // of the upper 32 bits
            f64::from_bits((HIGH - third) << 32)
        },
    );
    for _ in 0..3 {
        // y ← y (4 - x y³)/3: the relative error falls from 3 % to 2e-3, 1e-5 and 2e-10
        let cube = inverse * inverse * inverse;
        inverse *= S::of(4.0 / 3.0) - x * cube * S::of(1.0 / 3.0);
    }
    x * inverse * inverse
}

/// Returns `sinh x - x` without cancellation, given `sinh x`.
fn sinh_minus_x(x: f64, sinh: f64) -> f64 {
    if x.abs() < 1.0 { cubic_tail(x, -1.0) } else { sinh - x }
}

/// Returns the mean anomaly `M = (1 - e) E + e (E - sin E)` of an ellipse, rad.
pub(super) fn mean_from_eccentric(e: f64, one_minus_e: f64, eccentric: f64) -> f64 {
    one_minus_e * eccentric + e * x_minus_sin(eccentric, eccentric.sin())
}

/// Returns the mean anomaly `M = (e - 1) H + e (sinh H - H)` of a hyperbola, rad.
pub(super) fn mean_from_hyperbolic(e: f64, e_minus_one: f64, hyperbolic: f64) -> f64 {
    e_minus_one * hyperbolic + e * sinh_minus_x(hyperbolic, hyperbolic.sinh())
}

/// Eccentricity below which [`solve_ellipse`] uses [`solve_nearly_circular`]; for higher eccentricities, it
/// uses [`solve_any_ellipse`].
const NEARLY_CIRCULAR: f64 = 0.1;

/// Solves Kepler's equation `M = E - e sin E`, given `M` (`mean`), rad, in [-π, π] and `0 ≤ e < 1`, and
/// returns the sine and cosine of `E/2`.
#[inline(always)]
pub(super) fn solve_ellipse<S: Real>(e: S, one_minus_e: S, mean: S) -> HalfAnomaly<S> {
    let is_nearly_circular = S::less(e, S::of(NEARLY_CIRCULAR));
    let is_elongated = S::less(S::of(NEARLY_CIRCULAR.next_down()), e);
    if !S::any(is_elongated) {
        return solve_nearly_circular(e, mean);
    }
    let elongated = solve_any_ellipse(e, one_minus_e, mean);
    if !S::any(is_nearly_circular) {
        return elongated;
    }
    let nearly_circular = solve_nearly_circular(e, mean);
    HalfAnomaly {
        sin: S::select(is_nearly_circular, nearly_circular.sin, elongated.sin),
        cos: S::select(is_nearly_circular, nearly_circular.cos, elongated.cos),
    }
}

/// Solves Kepler's equation of a nearly circular orbit, in half the time of [`solve_any_ellipse`], and
/// returns the sine and cosine of `E/2`.
///
/// The unknown is `δ = E - M`. Two steps use the reverted series of `f = δ - e sin(M + δ)`. The first step
/// starts at `δ = 0`; its result `δ = x - x³/2` with `x = e sin M/(1 - e cos M)` is of second order and has
/// an error below 1e-5 rad. The second step is of third order and reduces the error to rounding.
///
/// Source of the series: Abramowitz and Stegun, Handbook of Mathematical Functions, 1964, eq. 3.6.25.
#[inline(always)]
fn solve_nearly_circular<S: Real>(e: S, mean: S) -> HalfAnomaly<S> {
    let (of, one, half) = (S::of, S::of(1.0), S::of(0.5));
    let (s, c) = (half * mean).sin_cos();
    let (sin_m, cos_m) = (of(2.0) * s * c, one - of(2.0) * s * s);
    let x = e * sin_m / (one - e * cos_m);
    let start = x - half * x * x * x;
    let (sin_e, cos_e) = turned((sin_m, cos_m), start);
    let over_f1 = one / (one - e * cos_e);
    // f₂/f₁, f₃/f₁ and Newton's step
    let (f2, f3) = (e * sin_e * over_f1, e * cos_e * over_f1);
    let d = (e * sin_e - start) * over_f1;
    let d = d * (one + d * (d * (half * f2 * f2 - of(1.0 / 6.0) * f3) - half * f2));
    let (sin, cos) = turned((s, c), half * (start + d));
    HalfAnomaly { sin, cos }
}

/// Returns the sine and cosine of `α + x`, given those of `α` as `(s, c)`, for `|x| < 1/8` rad.
#[inline(always)]
fn turned<S: Real>((s, c): (S, S), x: S) -> (S, S) {
    // nested series of sin x/x and cos x: each factor is 1 - z/a times the next factor
    let fold = |z: S, a: f64, tail: S| (-z * tail).mul_add(S::of(1.0 / a), S::of(1.0));
    let (z, one) = (x * x, S::of(1.0));
    let sin = x * fold(z, 6.0, fold(z, 20.0, fold(z, 42.0, fold(z, 72.0, one))));
    let cos = fold(z, 2.0, fold(z, 12.0, fold(z, 30.0, fold(z, 56.0, fold(z, 90.0, one)))));
    (s * cos + c * sin, c * cos - s * sin)
}

/// Solves Kepler's equation of any ellipse, with the inputs of [`solve_ellipse`].
///
/// The solution of a cubic equation, with an error below 1e-3 rad, is refined by one correction of fifth
/// order.
///
/// Source: Markley, Celestial Mechanics and Dynamical Astronomy 63, 1995, eqs. (5)-(24).
#[inline(always)]
fn solve_any_ellipse<S: Real>(e: S, one_minus_e: S, mean: S) -> HalfAnomaly<S> {
    let (of, one, m) = (S::of, S::of(1.0), mean.abs());
    // Eqs. (20), (5), (9), (10), (14), (15): the cubic equation follows from a Padé approximant of sin E
    let alpha = (of(3.0 * PI * PI) + of(1.6 * PI) * (of(PI) - m) / (one + e)) * of(1.0 / (PI * PI - 6.0));
    let d = of(3.0) * one_minus_e + alpha * e;
    let q = of(2.0) * alpha * d * one_minus_e - m * m;
    let r = (of(3.0) * alpha * d * (d - one_minus_e) + m * m) * m;
    let root = cube_root(r + (q * q * q + r * r).sqrt());
    let w = root * root;
    let below = w * w + w * q + q * q;
    let start = (of(2.0) * r * w + m * below) / (below * d);
    // Eqs. (21)-(24): f and its derivatives
    let (sin, cos) = (of(0.5) * start).sin_cos();
    let sin_e = of(2.0) * sin * cos;
    let f = one_minus_e * start + e * x_minus_sin(start, sin_e) - m;
    let f1 = one_minus_e + of(2.0) * e * sin * sin;
    let f2 = e * sin_e;
    let f3 = e * (one - of(2.0) * sin * sin);
    let (half, sixth) = (of(0.5), of(1.0 / 6.0));
    let d3 = -f * f1 / (f1 * f1 - half * f * f2);
    let d4 = -f / (f1 + d3 * (half * f2 + d3 * f3 * sixth));
    let d5 = -f / (f1 + d4 * (half * f2 + d4 * (f3 * sixth - d4 * f2 * of(1.0 / 24.0))));
    // sin and cos of (start + d5)/2, where d5 is small
    let h = half * d5;
    let h2 = h * h;
    let sin_h = h * (one - h2 * sixth * (one - h2 * of(0.05)));
    let cos_h = one - half * h2 * (one - h2 * of(1.0 / 12.0));
    let up = sin * cos_h + cos * sin_h;
    HalfAnomaly { sin: S::select(S::less(mean, of(0.0)), -up, up), cos: cos * cos_h - sin * sin_h }
}

/// Solves Kepler's equation `M = e sinh H - H`, given any `M` (`mean`) and `e > 1`, and returns the
/// hyperbolic sine and cosine of `H/2`.
///
/// Newton's method for `|M|` starts above the solution. From there the iterates decrease monotonically,
/// because `e sinh H - H` is convex for `H > 0`.
pub(super) fn solve_hyperbola(e: f64, e_minus_one: f64, mean: f64) -> HalfAnomaly {
    let m = mean.abs();
    // upper bounds of H: from (e - 1) H + e H³/6 ≤ M, and from sinh H = (M + H)/e with the first bound
    // inserted
    let p = 2.0 * (2.0 * e_minus_one / e).sqrt();
    let cubic = p * ((3.0 * m / (e_minus_one * p)).asinh() / 3.0).sinh();
    let mut h = cubic.min(((m + cubic) / e).asinh());
    // at most four steps for e - 1 from 1e-16 to 1e6 and M from 1e-40 to 1e20
    for _ in 0..20 {
        let sin = (0.5 * h).sinh();
        let f = e_minus_one * h + e * sinh_minus_x(h, 2.0 * sin * (1.0 + sin * sin).sqrt()) - m;
        let step = f / (e_minus_one + 2.0 * e * sin * sin);
        h -= step;
        if step.abs() <= 1e-9 * h {
            break; // the remaining error is the square of the step
        }
    }
    let sin = (0.5 * h).sinh();
    HalfAnomaly { sin: sin.copysign(mean), cos: (1.0 + sin * sin).sqrt() }
}

/// Solves Barker's equation `B = D + D³/3` for `D = tan(ν/2)` with the true anomaly `ν`. `B` is proportional
/// to the time since periapsis.
pub(super) fn solve_parabola(b: f64) -> f64 {
    2.0 * ((1.5 * b).asinh() / 3.0).sinh()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the residual of Kepler's equation as a multiple of the effect of the rounding errors of `M`
    /// and `E`; values up to 8 are accepted.
    fn residual_in_roundings(e: f64, one_minus_e: f64, m: f64) -> f64 {
        let half = solve_ellipse(e, one_minus_e, m);
        let eccentric = 2.0 * half.sin.atan2(half.cos);
        let slope = one_minus_e + 2.0 * e * half.sin * half.sin;
        let back = mean_from_eccentric(e, one_minus_e, eccentric);
        (back - m).abs() / (f64::EPSILON * (m.abs() + slope * eccentric.abs()))
    }

    #[test]
    fn ellipse_is_solved_to_rounding_for_every_eccentricity() {
        let mut worst: f64 = 0.0;
        for i in 0..=320 {
            // 1 - e from 1 to 1e-16
            let one_minus_e = 10f64.powf(-f64::from(i) / 20.0);
            let e = 1.0 - one_minus_e;
            for j in 0..=400 {
                worst = worst.max(residual_in_roundings(e, one_minus_e, PI * f64::from(j) / 400.0));
                worst =
                    worst.max(residual_in_roundings(e, one_minus_e, 3.0 * 10f64.powf(-f64::from(j) / 10.0)));
            }
        }
        assert!(worst < 8.0, "{worst} roundings");
        for i in 0..=40 {
            // eccentricities on both sides of the limit between the two solvers
            let e = 0.105 * f64::from(i) / 40.0;
            for j in -400..=400 {
                worst = worst.max(residual_in_roundings(e, 1.0 - e, PI * f64::from(j) / 400.0));
            }
        }
        assert!(worst < 8.0, "{worst} roundings");
    }

    #[test]
    fn hyperbola_is_solved_to_rounding_for_every_eccentricity() {
        for i in -320..=120 {
            let eme = 10f64.powf(f64::from(i) / 20.0);
            let e = 1.0 + eme;
            for j in -400..=200 {
                let m = 10f64.powf(f64::from(j) / 10.0);
                let half = solve_hyperbola(e, eme, m);
                let h = 2.0 * half.sin.asinh();
                let back = mean_from_hyperbolic(e, eme, h);
                // a rounding error of H changes M by e cosh H · H, which is up to 50 rounding errors of M
                let scale = m + (eme + 2.0 * e * half.sin * half.sin) * h;
                assert!((back - m).abs() < 8.0 * f64::EPSILON * scale, "e-1={eme} M={m}: {back}");
            }
        }
    }

    #[test]
    fn odd_in_the_mean_anomaly() {
        let (a, b) = (solve_ellipse(0.7, 0.3, 1.1), solve_ellipse(0.7, 0.3, -1.1));
        assert_eq!((a.sin, a.cos), (-b.sin, b.cos));
    }
}
