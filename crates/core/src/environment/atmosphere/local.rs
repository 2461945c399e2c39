//! The air around a robot, from two looks at the model.

use super::{AirPlace, Atmosphere, AtmosphereError};
use crate::earth::Earth;
use nalgebra::Vector3;

/// How far from its centre a local density is trusted, m.
///
/// Sideways the density of no model changes faster than by e within a third of the Earth's radius, so the
/// density is wrong by at most 5e-5 of itself there; upwards the change of the scale height over 100 m is less.
const TRUST: f64 = 100.0;

/// Rise over which the scale height is taken, m.
const RISE: f64 = 100.0;

/// Density about a place: `ρ(r) = ρ₀ exp(-κ û·(r - r₀))`, `û` up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalAir {
    time: f64,
    centre: Vector3<f64>,
    up: Vector3<f64>,
    density: f64,
    /// One by the scale height, 1/m.
    decay: f64,
}

impl LocalAir {
    /// About `centre`, axes of `I`, m.
    ///
    /// # Errors
    /// What the model refuses at the centre or 100 m above.
    pub fn new(
        atmosphere: &dyn Atmosphere,
        earth: &Earth,
        time: f64,
        centre: &Vector3<f64>,
    ) -> Result<Self, AtmosphereError> {
        let place = AirPlace::new(earth, time, centre)?;
        let density = atmosphere.density(&place)?;
        let above = atmosphere.density(&place.raised(RISE))?;
        // κ = ln(ρ/ρ⁺)/Δh
        let decay = if above > 0.0 && density > 0.0 { (density / above).ln() / RISE } else { 0.0 };
        Ok(Self { time, centre: *centre, up: place.up, density, decay })
    }

    /// Density at `r`, axes of `I`, m, at `time`: kg/m³; none beyond 100 m from the centre.
    #[inline(always)]
    pub fn density(&self, r: &Vector3<f64>) -> Option<f64> {
        let offset = r - self.centre;
        let is_near = offset.norm_squared() <= TRUST * TRUST;
        is_near.then(|| self.density * (-self.decay * self.up.dot(&offset)).exp())
    }

    /// Whether this is the air about `centre` at `time`.
    pub(in crate::environment) fn is_about(&self, time: f64, centre: &Vector3<f64>) -> bool {
        self.time == time && self.centre == *centre
    }
}
