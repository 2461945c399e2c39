//! Shadow of the Earth with penumbra.

use nalgebra::Vector3;
use std::f64::consts::PI;

/// Radius of the Sun, m. Source: IAU 2015 Resolution B3, nominal solar radius.
const SUN_RADIUS: f64 = 6.957e8;

/// Returns the fraction `ν` of the solar disc, from 0 to 1, that the Earth does not occult as seen from `r`.
///
/// `r` and `sun` are positions from the Earth's centre, m, and `radius` is the radius of the Earth, m. With
/// the apparent radii `a` of the Sun and `b` of the Earth and their angular separation `c`: `ν = 1` if
/// `c ≥ a + b`, `ν = 0` if `c ≤ b - a` (umbra), `ν = 1 - b²/a²` if `c ≤ a - b` (annular eclipse), otherwise
/// `ν = 1 - A/(π a²)` with the overlap `A` of two flat discs. The result is within 2e-3 of ray tracing to a
/// sphere. Inside the Earth, `ν = 0`.
///
/// Source: Montenbruck and Gill, Satellite Orbits, Springer 2000, section 3.4.2.
pub fn sunlit(r: &Vector3<f64>, sun: &Vector3<f64>, radius: f64) -> f64 {
    let to_sun = sun - r;
    let (distance, height) = (to_sun.norm(), r.norm());
    if height <= radius {
        return 0.0;
    }
    // Far enough outside the penumbral cone (slope (R☉ + R)/|sun|), no angles have to be computed.
    let behind = -r.dot(&to_sun) / distance;
    let cone = 1.001 * radius + 1.01 * (SUN_RADIUS + radius) / (distance - behind) * behind.max(0.0);
    if behind < -0.1 * height || height * height - behind * behind > cone * cone {
        return 1.0;
    }
    let a = (SUN_RADIUS / distance).min(1.0).asin();
    let b = (radius / height).asin();
    let c = r.cross(&to_sun).norm().atan2(-r.dot(&to_sun));
    if c >= a + b {
        1.0
    } else if c <= b - a {
        0.0
    } else if c <= a - b {
        1.0 - (b / a) * (b / a)
    } else {
        1.0 - overlap(a, b, c) / (PI * a * a)
    }
}

/// Returns the common area of two discs of radii `a` and `b` whose rims intersect; `c` is the distance
/// between their centres.
fn overlap(a: f64, b: f64, c: f64) -> f64 {
    // A = a² acos(x/a) + b² acos((c - x)/b) - c y,  x = (c² + a² - b²)/2c,  y = √(a² - x²)
    let x = (c * c + a * a - b * b) / (2.0 * c);
    let y = ((a - x) * (a + x)).max(0.0).sqrt();
    a * a * y.atan2(x) + b * b * y.atan2(c - x) - c * y
}
