//! Field of a point mass: acceleration, gradient, and difference between two positions (tide).

use crate::spatial::{Real, Vec3};
use nalgebra::{Matrix3, Vector3};

/// Returns the acceleration `g = -μ r / |r|³`, m/s², of a point mass with the gravitational parameter `μ`
/// (`mu`), m³/s², at position `r`, m, in the axes of `r`.
///
/// Orbits and effects both use this function, so that the residual acceleration of a reference in free fall
/// is exactly zero.
pub(crate) fn point_mass(mu: f64, r: &Vector3<f64>) -> Vector3<f64> {
    let r2 = r.norm_squared();
    // g = -μ r / |r|³
    r * (-mu / (r2 * r2.sqrt()))
}

/// Returns the gradient `∂g/∂r = μ/|r|³ (3 r̂ r̂ᵀ - 1)`, 1/s², of the field [`point_mass`] at position `r`,
/// m, with the unit matrix `1`.
pub(crate) fn point_mass_gradient(mu: f64, r: &Vector3<f64>) -> Matrix3<f64> {
    let r2 = r.norm_squared();
    (r * r.transpose() * (3.0 / r2) - Matrix3::identity()) * (mu / (r2 * r2.sqrt()))
}

/// Returns the tide `g(r_ref + ρ) - g(r_ref)` of a point mass, m/s², and the distance `r = |r_ref + ρ|`, m.
///
/// `r_ref` is the position of the reference and `offset` is `ρ`, both in m.
///
/// The tide has full relative accuracy for any `ρ`:
///
/// `-(μ/r³) (ρ - f r_ref)`, `f = q (3 + 3q + q²)/(1 + (1 + q)^{3/2})`, `q = ρ·(ρ + 2 r_ref)/r_ref²`,
/// `r² = r_ref² (1 + q)`.
///
/// Source: Battin, An Introduction to the Mathematics and Methods of Astrodynamics, AIAA 1999, chapter 8, the
/// disturbing function (Encke's form).
#[inline(always)]
pub(crate) fn tide<S: Real>(mu: f64, r_ref: &Vec3<f64>, offset: Vec3<S>) -> (Vec3<S>, S) {
    let (s, r_ref_s) = (S::of, Vec3::<S>::of(r_ref));
    // q = ρ·(ρ + 2 r_ref)/r_ref²,  root = √(1 + q),  r = |r_ref| root
    let r2 = r_ref.dot(*r_ref);
    let q = offset.dot(offset + r_ref_s * s(2.0)) / s(r2);
    let square = s(1.0) + q;
    let square = S::select(square.less(s(0.0)), s(0.0), square);
    let root = square.sqrt();
    let distance = s(r2.sqrt()) * root;
    // f = n/a,  n = q (3 + 3q + q²),  a = 1 + root³;  both divisions in one
    let n = q * q.mul_add(s(3.0) + q, s(3.0));
    let (a, cube) = (square.mul_add(root, s(1.0)), s(r2) * square * distance);
    let inverse = s(1.0) / (a * cube);
    let f = n * cube * inverse;
    ((offset - r_ref_s * f) * (s(-mu) * a * inverse), distance)
}

/// Returns true if `mu`, m³/s², is within 1 % of the Earth's gravitational parameter, which includes the
/// rounded value 4e14. No other planet has a similar value.
pub(crate) fn is_earth(mu: f64) -> bool {
    (mu / 3.986_004_418e14 - 1.0).abs() < 1e-2 // as in onorbit_rs/visuals/earth_shape.py
}

/// Smallest accepted distance from a planet's centre, in equatorial radii. For comparison, the polar radius
/// of the Earth is 0.9966 equatorial radii.
pub(crate) const SURFACE: f64 = 0.996;

/// Returns the cube of the smallest possible radius of a planet, m³, from its gravitational parameter `mu`,
/// m³/s².
///
/// For the Earth, recognised by its `μ`, the radius is 6353 km, which is also the lower limit of gravity
/// fields. The radii of other planets are unknown, but no planet is denser than osmium, `ρ = 22 600 kg/m³`,
/// so `R³ = 3 μ/(4π G ρ)` with `μ = G m`. Below the surface, the field of a point mass grows without bound
/// and differs from that of the planet.
pub(crate) fn lowest_ground_cubed(mu: f64) -> f64 {
    const G_RHO: f64 = 6.674e-11 * 22_600.0;
    const EARTH: f64 = SURFACE * 6_378_137.0; // WGS84
    if is_earth(mu) { EARTH * EARTH * EARTH } else { 3.0 * mu / (4.0 * std::f64::consts::PI * G_RHO) }
}
