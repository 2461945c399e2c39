//! The field of a point mass: its pull, the gradient of it, and the tide between two places.

use crate::spatial::{Real, Vec3};
use nalgebra::{Matrix3, Vector3};

/// Acceleration of a point mass's field, `g = -μ r / |r|³`, m/s², axes of `r`.
///
/// Every user of the field calls this one expression, so that a reference which obeys it
/// differs from it by exactly zero.
pub(crate) fn point_mass(mu: f64, r: &Vector3<f64>) -> Vector3<f64> {
    let r2 = r.norm_squared();
    r * (-mu / (r2 * r2.sqrt()))
}

/// Its gradient `∂g/∂r = μ/|r|³ (3 r̂ r̂ᵀ - 1)`, 1/s².
pub(crate) fn point_mass_gradient(mu: f64, r: &Vector3<f64>) -> Matrix3<f64> {
    let r2 = r.norm_squared();
    (r * r.transpose() * (3.0 / r2) - Matrix3::identity()) * (mu / (r2 * r2.sqrt()))
}

/// Tide `g(R + ρ) - g(R)` of a point mass, m/s², to full relative accuracy for any `ρ`.
///
/// `-(μ/r³) (ρ - f R)`, `f = q (3 + 3q + q²)/(1 + (1 + q)^{3/2})`, `q = ρ·(ρ + 2R)/R²`, `r² = R² (1 + q)`;
/// `origin` is `R`, `offset` is `ρ`, m. Returns the tide and the distance `r = |R + ρ|`.
///
/// Source: Battin, AIAA 1999, chapter 8, the disturbing function (Encke's form).
#[inline(always)]
pub(crate) fn tide<S: Real>(mu: f64, origin: &Vec3<f64>, offset: Vec3<S>) -> (Vec3<S>, S) {
    let (s, origin_s) = (S::of, Vec3::<S>::of(origin));
    // q = ρ·(ρ + 2R)/R²,  s = √(1 + q),  r = R s
    let r2 = origin.dot(*origin);
    let q = offset.dot(offset + origin_s * s(2.0)) / s(r2);
    let square = s(1.0) + q;
    let square = S::select(square.less(s(0.0)), s(0.0), square);
    let root = square.sqrt();
    let distance = s(r2.sqrt()) * root;
    // f = n/a,  n = q (3 + 3q + q²),  a = 1 + s³;  both divisions in one
    let n = q * q.mul_add(s(3.0) + q, s(3.0));
    let (a, cube) = (square.mul_add(root, s(1.0)), s(r2) * square * distance);
    let inverse = s(1.0) / (a * cube);
    let f = n * cube * inverse;
    ((offset - origin_s * f) * (s(-mu) * a * inverse), distance)
}

/// Whether this is the Earth's `μ`, m³/s², in whatever version, a rounded 4e14 included: no other planet's is near it.
pub(crate) fn is_earth(mu: f64) -> bool {
    (mu / 3.986_004_418e14 - 1.0).abs() < 1e-2 // as in onorbit_rs/planet.py
}

/// Share of a planet's largest radius from which on there is an outside: the Earth's poles lie at 0.9966 of it.
pub(crate) const SURFACE: f64 = 0.996;

/// Cube of the distance from the centre of a planet of this `μ = G m` below which all is ground, m³.
///
/// The Earth is known by its `μ`: 6353 km, where fields end too. Of other planets the surface is not ours to know, but none
/// lies below `R³ = 3 μ/(4π G ρ)` with osmium's `ρ = 22 600 kg/m³`: deep in the ground the field of a point mass means
/// nothing and grows without bound.
pub(crate) fn lowest_ground_cubed(mu: f64) -> f64 {
    const G_RHO: f64 = 6.674e-11 * 22_600.0;
    const EARTH: f64 = SURFACE * 6_378_137.0; // WGS84
    if is_earth(mu) { EARTH * EARTH * EARTH } else { 3.0 * mu / (4.0 * std::f64::consts::PI * G_RHO) }
}
