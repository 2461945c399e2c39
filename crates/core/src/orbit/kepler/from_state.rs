//! Kepler orbit from a position and a velocity.

use nalgebra::Vector3;

use super::conic::{Conic, Shape};
use super::double::Double;
use super::{Kepler, anomaly};
use crate::orbit::OrbitError;
use crate::orbit::error::{finite, positive};

/// Sine of the angle between position and velocity up to which the orbital plane is treated as undefined. On
/// ellipses with `1 - e` above 1e-16 the sine always exceeds this limit, because its minimum is `√(1 - e²)`.
/// On a hyperbola the sine reaches the limit at a distance of 1e10 semi-minor axes.
const SMALLEST_SINE: f64 = 1e-10;

impl Kepler {
    /// Creates the orbit with position `r` (m, from the planet's centre) and velocity `v` (m/s) at time zero,
    /// axes of `I`, around a planet with the gravitational parameter `mu` (m³/s²).
    ///
    /// Circular and equatorial orbits are not singular.
    ///
    /// # Errors
    /// [`OrbitError::NotFinite`], [`OrbitError::TooLarge`] and [`OrbitError::NotPositive`] for invalid
    /// numbers and for sizes beyond the range of `f64`; [`OrbitError::Rectilinear`] if `r` or `v` is zero or
    /// if the two are parallel within 1e-10 rad.
    ///
    /// Source: Battin, An Introduction to the Mathematics and Methods of Astrodynamics, AIAA 1999, chapter 3.
    pub fn from_state(r: Vector3<f64>, v: Vector3<f64>, mu: f64) -> Result<Self, OrbitError> {
        positive("mu", mu)?;
        for (name, x) in [("position", &r), ("velocity", &v)] {
            x.iter().try_for_each(|&c| finite(name, c).map(drop))?;
        }
        let (rr, vv, rv) = (Double::dot(&r, &r), Double::dot(&v, &v), Double::dot(&r, &v));
        let (radius, mu_d, one) = (rr.sqrt(), Double::from(mu), Double::from(1.0));
        // h² = r² v² - (r·v)²
        let hh = rr * vv - rv * rv;
        let sine = (hh.hi.max(0.0) / (rr.hi * vv.hi)).sqrt();
        finite("squared length of the position", rr.hi)?;
        finite("squared length of the velocity", vv.hi)?;
        if sine.is_nan() || sine <= SMALLEST_SINE {
            let (radius, speed) = (rr.hi.sqrt(), vv.hi.sqrt());
            return Err(OrbitError::Rectilinear { radius, speed, sine, limit: SMALLEST_SINE });
        }
        // p = h²/μ, 1/a = 2/r - v²/μ, e cos ν = p/r - 1, e sin ν = (r·v) √(p/μ)/r
        let p = hh / mu_d;
        let inverse_axis = Double::from(2.0) / radius - vv / mu_d;
        let e_cos = (p / radius - one).hi;
        let e_sin = (rv * (p / mu_d).sqrt() / radius).hi;
        let e = e_cos.hypot(e_sin);
        // 1 - e = (p/a)/(1 + e)
        let one_minus_e = (p * inverse_axis).hi / (1.0 + e);
        let shape = Shape { e, one_minus_e, periapsis: p.hi / (1.0 + e), inverse_axis };
        let conic = Conic::new(&shape, mu)?;

        // perifocal axes: the radial and transverse axes rotated by -ν within the orbital plane
        let (cos, sin) = if e > 0.0 { (e_cos / e, e_sin / e) } else { (1.0, 0.0) };
        let x = r / radius.hi;
        let y = accurate_cross(&r, &v).normalize().cross(&x);
        let (p_i, q_i) = (x * cos - y * sin, x * sin + y * cos);

        // (sin, cos) of ν/2 up to a common factor, without cancellation
        let half = if e_cos >= 0.0 { (e_sin, e + e_cos) } else { (e - e_cos, e_sin) };
        let half = if e > 0.0 { half } else { (0.0, 1.0) };
        let phase = if let Conic::Hyperbola { n, .. } = conic {
            // e sinh H = (r·v) √(1/(μ|a|)), which is also accurate near the asymptotes
            let e_sinh = (rv * (-inverse_axis / mu_d).sqrt()).hi;
            anomaly::mean_from_hyperbolic(e, -one_minus_e, (e_sinh / e).asinh()) / n
        } else {
            phase_from_half_anomaly(&shape, &conic, half)
        };
        Ok(Self { mu, epoch: 0.0, phase, shape, conic, p_i, q_i })
    }
}

/// Returns the phase on a conic from `half`, the sine and cosine of half the true anomaly up to a common
/// factor.
///
/// The phase is the mean anomaly in [-π, π] on an ellipse, otherwise the time since periapsis, s.
pub(super) fn phase_from_half_anomaly(shape: &Shape, conic: &Conic, half: (f64, f64)) -> f64 {
    let (sin, cos) = if half.1 < 0.0 { (-half.0, -half.1) } else { half };
    let (e, one_minus_e) = (shape.e, shape.one_minus_e);
    match *conic {
        Conic::Ellipse { .. } => {
            // tan(E/2) = √((1 - e)/(1 + e)) tan(ν/2)
            let eccentric = 2.0 * (one_minus_e.sqrt() * sin).atan2((1.0 + e).sqrt() * cos);
            anomaly::mean_from_eccentric(e, one_minus_e, eccentric)
        }
        Conic::Hyperbola { n, .. } => {
            // tanh(H/2) = √((e - 1)/(e + 1)) tan(ν/2)
            let ratio = (-one_minus_e / (1.0 + e)).sqrt() * sin / cos;
            anomaly::mean_from_hyperbolic(e, -one_minus_e, 2.0 * ratio.atanh()) / n
        }
        Conic::Parabola { n, .. } => {
            // t - t_p = (D + D³/3)/√(μ/(2 q³))
            let d = sin / cos;
            d * (1.0 + d * d / 3.0) / n
        }
    }
}

/// Computes `a × b` with one rounding error per component (Kahan's difference of products).
fn accurate_cross(a: &Vector3<f64>, b: &Vector3<f64>) -> Vector3<f64> {
    let det = |a: f64, b: f64, c: f64, d: f64| {
        let cd = c * d;
        a.mul_add(b, -cd) + (-c).mul_add(d, cd)
    };
    Vector3::new(det(a.y, b.z, a.z, b.y), det(a.z, b.x, a.x, b.z), det(a.x, b.y, a.y, b.x))
}
