//! Positions of the Sun and the Moon from trigonometric series.

use nalgebra::Vector3;

use super::precession::{ARC_SECOND, arguments, precession};
use super::rotation::{r1, r3};
use super::{moon_table, sun_table};

/// Returns the fundamental arguments `l, l', F, D, Ω` and the mean longitudes of Venus, Mars and Jupiter,
/// rad, at `t`, Julian centuries of TT from J2000.0.
///
/// Source: IERS Conventions (2010), eq. 5.43 and 5.44.
fn all_arguments(t: f64) -> [f64; 8] {
    let [l, l_sun, f, d, omega] = arguments(t);
    let venus = 3.176_146_697 + 1_021.328_554_621_1 * t;
    let mars = 6.203_480_913 + 334.061_242_67 * t;
    let jupiter = 0.599_546_497 + 52.969_096_264_1 * t;
    [l, l_sun, f, d, omega, venus, mars, jupiter]
}

/// Returns the geometric position of the Sun from the Earth's centre, GCRF axes, m, without correction for
/// light time or aberration.
///
/// `t` is in Julian centuries of TT from J2000.0.
pub(super) fn sun(t: f64) -> Vector3<f64> {
    let x = all_arguments(t);
    let [longitude, latitude, distance] =
        [&sun_table::LONGITUDE, &sun_table::LATITUDE, &sun_table::DISTANCE].map(|series| series.sum(t, &x));
    from_ecliptic(t, x[2] - x[3] + x[4] + longitude * ARC_SECOND, latitude * ARC_SECOND, distance * 1e3)
}

/// Returns the geometric position of the Moon from the Earth's centre, GCRF axes, m, without correction
/// for light time or aberration, at `t`, Julian centuries of TT from J2000.0.
pub(super) fn moon(t: f64) -> Vector3<f64> {
    let x = all_arguments(t);
    let [longitude, latitude, distance] =
        [&moon_table::LONGITUDE, &moon_table::LATITUDE, &moon_table::DISTANCE]
            .map(|series| series.sum(t, &x));
    from_ecliptic(t, x[2] + x[4] + longitude * ARC_SECOND, latitude * ARC_SECOND, distance * 1e3)
}

/// Converts a position given in the mean ecliptic and equinox of date to GCRF axes, m; angles are in rad, the
/// distance is in m. The date is `t`, Julian centuries of TT from J2000.0.
fn from_ecliptic(t: f64, longitude: f64, latitude: f64, distance: f64) -> Vector3<f64> {
    let [gamma, phi, psi, _] = precession(t);
    let (s, c) = longitude.sin_cos();
    let (z, p) = latitude.sin_cos();
    r3(-gamma) * r1(-phi) * r3(psi) * Vector3::new(c * p, s * p, z) * distance
}
