//! Computation of the osculating state from mean elements: long-period terms of J₃, Kepler's equation, and
//! short-period terms of J₂.
//!
//! Source: Spacetrack Report #3, section 6.

use super::constants::{Earth, Mean, wrap_angle};
use crate::spatial::{Real, Vec3};

/// Smallest value used for `1 + cos i`, which is a divisor in the report and vanishes at `i = π`.
const MIN_ONE_PLUS_COS: f64 = 1.5e-12;
/// Parameters of the solver of Kepler's equation: tolerance, rad, largest number of iterations, and largest
/// step, rad.
const KEPLER: (f64, usize, f64) = (1e-12, 10, 0.95);

/// Position and velocity of the satellite in TEME axes.
pub(super) struct OsculatingState<S> {
    /// Semi-latus rectum, Earth radii. If it is negative, the other values have no meaning.
    pub(super) p: S,
    /// Distance from the Earth's centre, Earth radii.
    pub(super) distance: S,
    /// Position, km.
    pub(super) position: Vec3<S>,
    /// Velocity, km/s.
    pub(super) velocity: Vec3<S>,
}

/// Returns the osculating state for the mean elements `mean`, the semi-major axis `a`, Earth radii, and the
/// sine and cosine of the inclination.
#[inline(always)]
pub(super) fn osculating_state<S: Real>(
    mean: &Mean<S>,
    a: S,
    inclination_sin_cos: (S, S),
    earth: &Earth,
) -> OsculatingState<S> {
    let (Mean { n, e, node, perigee, anomaly, .. }, of, one) = (*mean, S::of, S::of(1.0));
    let ((sin_i, cos_i), (sin_w, cos_w)) = (inclination_sin_cos, perigee.sin_cos());
    // long-period terms: axN = e cos ω,  ayN = e sin ω - J₃ sin i/(2 J₂ p),
    // Lᴛ = L - J₃ sin i (3 + 5θ)/(4 J₂ p (1 + θ)) axN
    let up = cos_i + one;
    let up = S::select(S::less(of(MIN_ONE_PLUS_COS), up.abs()), up, of(MIN_ONE_PLUS_COS));
    let pinv = one / (a * (one - e * e));
    let ax = e * cos_w;
    let ay = e * sin_w + pinv * (of(-0.5 * earth.j3_j2) * sin_i);
    let l = anomaly
        + perigee
        + node
        + pinv * (of(-0.25 * earth.j3_j2) * sin_i * (of(3.0) + of(5.0) * cos_i) / up) * ax;

    let (sin_eo, cos_eo) = kepler(wrap_angle(l - node), ax, ay);
    let (e_cos, e_sin) = (ax * cos_eo + ay * sin_eo, ax * sin_eo - ay * cos_eo);
    let el2 = ax * ax + ay * ay;
    let p = a * (one - el2);
    let r = a * (one - e_cos);
    let (r_dot, rf_dot) = (a.sqrt() * e_sin / r, p.sqrt() / r); // both divided by kₑ
    let beta = (one - el2).sqrt();
    let q = e_sin / (one + beta);
    let (sin_u, cos_u) = (a / r * (sin_eo - ay - ax * q), a / r * (cos_eo - ax + ay * q));
    let (sin_2u, cos_2u) = ((cos_u + cos_u) * sin_u, one - of(2.0) * sin_u * sin_u);

    // short-period terms
    let k1 = of(0.5 * earth.j2) / p;
    let k2 = k1 / p;
    let c2 = cos_i * cos_i;
    let (x3, x1, x7) = (of(3.0) * c2 - one, one - c2, of(7.0) * c2 - one);
    let rk = r * (one - of(1.5) * k2 * beta * x3) + of(0.5) * k1 * x1 * cos_2u;
    let du = of(-0.25) * k2 * x7 * sin_2u;
    let node_k = node + of(1.5) * k2 * cos_i * sin_2u;
    let di = of(1.5) * k2 * cos_i * sin_i * cos_2u;
    let rk_dot = r_dot - n * k1 * x1 * sin_2u / of(earth.ke);
    let rf_dot_k = rf_dot + n * k1 * (x1 * cos_2u + of(1.5) * x3) / of(earth.ke);

    // radial and transverse unit vectors
    let ((su, cu), (si, ci)) = (turned((sin_u, cos_u), du), turned(inclination_sin_cos, di));
    let (sn, cn) = node_k.sin_cos();
    let m = Vec3::new(-sn * ci, cn * ci, si);
    let k = Vec3::new(cn, sn, of(0.0));
    let (out, along) = (m * su + k * cu, m * cu - k * su);
    OsculatingState {
        p,
        distance: rk,
        position: out * (rk * of(earth.radius_km)),
        velocity: (out * rk_dot + along * rf_dot_k) * of(earth.radius_km * earth.ke / 60.0),
    }
}

/// Returns the sine and cosine of `α + d`, rad, given those of `α`.
#[inline(always)]
fn turned<S: Real>((sin, cos): (S, S), d: S) -> (S, S) {
    let (sin_d, cos_d) = d.sin_cos();
    (sin * cos_d + cos * sin_d, cos * cos_d - sin * sin_d)
}

/// Returns the sine and cosine of `E + ω`, the solution of `u = E + ω - axN sin(E + ω) + ayN cos(E + ω)` by
/// Newton's method, with `axN` and `ayN` given as `ax` and `ay`.
#[inline(always)]
fn kepler<S: Real>(u: S, ax: S, ay: S) -> (S, S) {
    let (enough, steps, longest) = KEPLER;
    let mut eo = u;
    let mut sin_cos = eo.sin_cos();
    for left in (0..steps).rev() {
        let (sin, cos) = sin_cos;
        let step = (u - ay * cos + ax * sin - eo) / (S::of(1.0) - cos * ax - sin * ay);
        let (low, high) = (S::of(-longest), S::of(longest));
        let step = S::select(S::less(step, low), low, S::select(S::less(high, step), high, step));
        // lanes that have converged keep their bits
        let is_iterating = S::less(S::of(enough), step.abs());
        if left == 0 || !S::any(is_iterating) {
            break;
        }
        eo += S::select(is_iterating, step, S::of(0.0));
        sin_cos = eo.sin_cos();
    }
    sin_cos
}
