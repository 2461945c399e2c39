//! The Earth before the Sun.

use nalgebra::Vector3;
use std::f64::consts::PI;

/// Radius of the Sun, m. Source: IAU 2015 Resolution B3, nominal solar radius.
const SUN_RADIUS: f64 = 6.957e8;

/// Share of the Sun's disc, 0 to 1, that a ball of `radius` about the origin leaves free, as seen from `r`.
///
/// `r` and `sun` are positions from the Earth's centre, m. With the apparent radii `a` of the Sun and `b` of the Earth
/// and their distance `c` in the sky: all of it where `c ≥ a + b`, none where `c ≤ b - a`, all but `b²/a²` where
/// `c ≤ a - b` (annular), else all but the overlap of two discs (flat ones: within 2e-3 of
/// what rays to a ball give). An observer inside the ball sees nothing.
///
/// Source: Montenbruck and Gill, Satellite Orbits, Springer 2000, section 3.4.2.
pub fn sunlit(r: &Vector3<f64>, sun: &Vector3<f64>, radius: f64) -> f64 {
    let to_sun = sun - r;
    let (distance, height) = (to_sun.norm(), r.norm());
    if height <= radius {
        return 0.0;
    }
    // clear of the cone that touches both (its slope is (R☉ + R)/|sun|), by a margin: no need of angles
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

/// Area that two discs have in common whose rims cross; radii `a` and `b`, centres `c` apart.
fn overlap(a: f64, b: f64, c: f64) -> f64 {
    // A = a² acos(x/a) + b² acos((c - x)/b) - c y,  x = (c² + a² - b²)/2c,  y = √(a² - x²)
    let x = (c * c + a * a - b * b) / (2.0 * c);
    let y = ((a - x) * (a + x)).max(0.0).sqrt();
    a * a * y.atan2(x) + b * b * y.atan2(c - x) - c * y
}
