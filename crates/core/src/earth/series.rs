//! Where Sun and Moon are, by short series of sines.

use nalgebra::Vector3;

use super::precession::{ARC_SECOND, arguments, polynomial, precession};
use super::rotation::{r1, r3};
use super::{moon_table, sun_table};

/// `Σ cᵢ Tⁱ + Σ a sin θ + b cos θ`, each `θ` a sum of multiples of `l, l', F, D, Ω` and the planets' longitudes.
pub(super) struct Series {
    pub(super) polynomial: &'static [f64],
    pub(super) terms: &'static [([i8; 8], [f64; 2])],
}

impl Series {
    fn sum(&self, t: f64, arguments: &[f64; 8]) -> f64 {
        // terms with l' fade as the eccentricity of the Earth's orbit does (Meeus, Astronomical Algorithms, ch. 47)
        let fading = 1.0 - 0.002_516 * t;
        let term = |(multiples, [a, b]): &([i8; 8], [f64; 2])| {
            let angle: f64 = multiples.iter().zip(arguments).map(|(k, x)| f64::from(*k) * x).sum();
            let (sine, cosine) = angle.sin_cos();
            (a * sine + b * cosine) * fading.powi(i32::from(multiples[1].abs()))
        };
        polynomial(self.polynomial, t) + self.terms.iter().map(term).sum::<f64>()
    }
}

/// Arguments of the Moon and the Sun, and the mean longitudes of Venus, Mars and Jupiter, rad.
///
/// Source: IERS Conventions (2010), eq. 5.43 and 5.44.
fn all_arguments(t: f64) -> [f64; 8] {
    let [l, l_sun, f, d, omega] = arguments(t);
    let venus = 3.176_146_697 + 1_021.328_554_621_1 * t;
    let mars = 6.203_480_913 + 334.061_242_67 * t;
    let jupiter = 0.599_546_497 + 52.969_096_264_1 * t;
    [l, l_sun, f, d, omega, venus, mars, jupiter]
}

/// Position of the Sun from the Earth's centre at `T` centuries of TT from J2000.0, GCRF axes, m: where it is, no
/// light time or aberration.
pub(super) fn sun(t: f64) -> Vector3<f64> {
    let x = all_arguments(t);
    let [longitude, latitude, distance] =
        [&sun_table::LONGITUDE, &sun_table::LATITUDE, &sun_table::DISTANCE].map(|series| series.sum(t, &x));
    from_ecliptic(t, x[2] - x[3] + x[4] + longitude * ARC_SECOND, latitude * ARC_SECOND, distance * 1e3)
}

/// Position of the Moon; as [`sun`].
pub(super) fn moon(t: f64) -> Vector3<f64> {
    let x = all_arguments(t);
    let [longitude, latitude, distance] =
        [&moon_table::LONGITUDE, &moon_table::LATITUDE, &moon_table::DISTANCE]
            .map(|series| series.sum(t, &x));
    from_ecliptic(t, x[2] + x[4] + longitude * ARC_SECOND, latitude * ARC_SECOND, distance * 1e3)
}

/// From the mean ecliptic and equinox of date to GCRF.
fn from_ecliptic(t: f64, longitude: f64, latitude: f64, distance: f64) -> Vector3<f64> {
    let [gamma, phi, psi, _] = precession(t);
    let (s, c) = longitude.sin_cos();
    let (z, p) = latitude.sin_cos();
    r3(-gamma) * r1(-phi) * r3(psi) * Vector3::new(c * p, s * p, z) * distance
}
