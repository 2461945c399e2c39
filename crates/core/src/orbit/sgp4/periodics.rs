//! From mean elements to position and velocity: long-period terms of J₃, Kepler's equation, short-period terms of J₂.
//!
//! Source: Spacetrack Report #3, section 6, from the long-period terms on.

use super::constants::{Earth, Mean};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Least `1 + cos i`: at `i = π` the report's quotient has no value.
const RETROGRADE: f64 = 1.5e-12;
/// Kepler's equation is solved to this, rad, in at most so many steps, none longer than that.
const KEPLER: (f64, usize, f64) = (1e-12, 10, 0.95);

/// Where the satellite is.
pub(super) struct Flight {
    /// Distance from the Earth's centre, Earth radii.
    pub(super) distance: f64,
    /// km.
    pub(super) position: Vector3<f64>,
    /// km/s.
    pub(super) velocity: Vector3<f64>,
}

/// Position and velocity of `mean` with semi-major axis `a` (Earth radii), else the negative semi-latus
/// rectum, Earth radii.
pub(super) fn flight(mean: &Mean, a: f64, earth: &Earth) -> Result<Flight, f64> {
    let Mean { n, e, i, node, perigee, anomaly } = *mean;
    let ((sin_i, cos_i), (sin_w, cos_w)) = (i.sin_cos(), perigee.sin_cos());
    // long periods: axN = e cos ω,  ayN = e sin ω - J₃ sin i/(2 J₂ p),  Lᴛ = L - J₃ sin i (3 + 5θ)/(4 J₂ p (1 + θ)) axN
    let up = if (cos_i + 1.0).abs() > RETROGRADE { 1.0 + cos_i } else { RETROGRADE };
    let pinv = 1.0 / (a * (1.0 - e * e));
    let ax = e * cos_w;
    let ay = e * sin_w + pinv * (-0.5 * earth.j3_j2 * sin_i);
    let l = anomaly + perigee + node + pinv * (-0.25 * earth.j3_j2 * sin_i * (3.0 + 5.0 * cos_i) / up) * ax;

    let (sin_eo, cos_eo) = kepler((l - node) % TAU, ax, ay);
    let (e_cos, e_sin) = (ax * cos_eo + ay * sin_eo, ax * sin_eo - ay * cos_eo);
    let el2 = ax * ax + ay * ay;
    let p = a * (1.0 - el2);
    if p.is_nan() || p < 0.0 {
        return Err(p);
    }
    let r = a * (1.0 - e_cos);
    let (r_dot, rf_dot) = (a.sqrt() * e_sin / r, p.sqrt() / r); // over kₑ
    let beta = (1.0 - el2).sqrt();
    let q = e_sin / (1.0 + beta);
    let (sin_u, cos_u) = (a / r * (sin_eo - ay - ax * q), a / r * (cos_eo - ax + ay * q));
    let u = sin_u.atan2(cos_u);
    let (sin_2u, cos_2u) = ((cos_u + cos_u) * sin_u, 1.0 - 2.0 * sin_u * sin_u);

    // short periods
    let k1 = 0.5 * earth.j2 / p;
    let k2 = k1 / p;
    let c2 = cos_i * cos_i;
    let (x3, x1, x7) = (3.0 * c2 - 1.0, 1.0 - c2, 7.0 * c2 - 1.0);
    let rk = r * (1.0 - 1.5 * k2 * beta * x3) + 0.5 * k1 * x1 * cos_2u;
    let uk = u - 0.25 * k2 * x7 * sin_2u;
    let node_k = node + 1.5 * k2 * cos_i * sin_2u;
    let ik = i + 1.5 * k2 * cos_i * sin_i * cos_2u;
    let rk_dot = r_dot - n * k1 * x1 * sin_2u / earth.ke;
    let rf_dot_k = rf_dot + n * k1 * (x1 * cos_2u + 1.5 * x3) / earth.ke;

    // axes along the radius and across it
    let ((su, cu), (sn, cn), (si, ci)) = (uk.sin_cos(), node_k.sin_cos(), ik.sin_cos());
    let m = Vector3::new(-sn * ci, cn * ci, si);
    let k = Vector3::new(cn, sn, 0.0);
    let (out, along) = (m * su + k * cu, m * cu - k * su);
    Ok(Flight {
        distance: rk,
        position: out * (rk * earth.radius_km),
        velocity: (out * rk_dot + along * rf_dot_k) * (earth.radius_km * earth.ke / 60.0),
    })
}

/// Sine and cosine of `E + ω`, where `u = E + ω - axN sin(E + ω) + ayN cos(E + ω)`, by Newton's steps.
fn kepler(u: f64, ax: f64, ay: f64) -> (f64, f64) {
    let (enough, steps, longest) = KEPLER;
    let mut eo = u;
    let mut sin_cos = eo.sin_cos();
    for _ in 0..steps {
        sin_cos = eo.sin_cos();
        let (sin, cos) = sin_cos;
        let step = (u - ay * cos + ax * sin - eo) / (1.0 - cos * ax - sin * ay);
        eo += step.clamp(-longest, longest);
        if step.abs() < enough {
            break;
        }
    }
    sin_cos
}
