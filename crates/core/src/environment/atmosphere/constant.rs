//! Atmosphere of constant density.

use super::error::AtmosphereError;
use super::model::Atmosphere;
use super::point::AtmospherePoint;

/// Atmosphere with the same density at every altitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantAtmosphere {
    density: f64,
}

impl ConstantAtmosphere {
    /// Creates an atmosphere with the given density, kg/m³.
    ///
    /// # Errors
    /// [`AtmosphereError::Value`] if `density` is negative or not finite.
    pub fn new(density: f64) -> Result<Self, AtmosphereError> {
        if density.is_finite() && density >= 0.0 {
            return Ok(Self { density });
        }
        let (name, expected) = ("density", "a finite density of at least 0 kg/m³");
        Err(AtmosphereError::Value { name, value: density, expected })
    }
}

impl Atmosphere for ConstantAtmosphere {
    fn name(&self) -> &'static str {
        "constant density"
    }

    fn density(&self, _point: &AtmospherePoint<'_>) -> Result<f64, AtmosphereError> {
        Ok(self.density)
    }
}
