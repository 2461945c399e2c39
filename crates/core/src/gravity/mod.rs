//! The gravity of a planet and of bodies beyond it.
//!
//! [`Gravity`] is the full field chosen: a point mass at the planet's centre and all that disturbs it.
//! Robot and reference feel the same one.

use nalgebra::Vector3;

/// The full field chosen for a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Gravity {
    mu: f64,
}

impl Gravity {
    /// The field of a point mass with `mu`, m³/s².
    pub fn point_mass(mu: f64) -> Self {
        Self { mu }
    }

    /// Gravitational parameter of the planet, m³/s².
    pub fn mu(&self) -> f64 {
        self.mu
    }

    /// Acceleration at `r` from the planet's centre, m, axes of `I`, at `t` seconds of simulation: m/s².
    pub fn acceleration(&self, _t: f64, r: &Vector3<f64>) -> Vector3<f64> {
        point_mass(self.mu, r)
    }
}

/// Acceleration of a point mass's field, `g = -μ r / |r|³`, m/s², axes of `r`.
///
/// Every user of the field calls this one expression, so that a reference which obeys it
/// differs from it by exactly zero.
pub(crate) fn point_mass(mu: f64, r: &Vector3<f64>) -> Vector3<f64> {
    let r2 = r.norm_squared();
    r * (-mu / (r2 * r2.sqrt()))
}

/// Cube of the radius below which no solid body of this `μ = G m` can have its surface, m³.
///
/// `R³ = 3 μ/(4π G ρ)` with osmium's `ρ = 22 600 kg/m³`: `R` = 3980 km for the Earth's mass. The
/// true surface lies higher and is not ours to know; far below it the field of a point mass
/// means nothing and grows without bound.
pub(crate) fn smallest_radius_cubed(mu: f64) -> f64 {
    const G_RHO: f64 = 6.674e-11 * 22_600.0;
    3.0 * mu / (4.0 * std::f64::consts::PI * G_RHO)
}
