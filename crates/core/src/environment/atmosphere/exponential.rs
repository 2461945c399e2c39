//! Exponential atmosphere in layers.

use super::error::{AtmosphereError, positive};
use super::model::Atmosphere;
use super::point::AtmospherePoint;

/// Layer from altitude `base` upwards, with the density `ρ = density exp(-(h - base)/scale_height)` at the
/// geodetic altitude `h`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Altitude of the base, m.
    pub base: f64,
    /// Density at the base, kg/m³.
    pub density: f64,
    /// Altitude difference, m, over which the density decreases by a factor of e.
    pub scale_height: f64,
}

/// Exponential atmosphere, `ρ = ρ₀ exp(-(h - h₀)/H)` in each layer, with the geodetic altitude `h`, the
/// density `ρ₀` at the base `h₀` of the layer and its scale height `H`.
///
/// The first layer also applies below its base, and the last layer extends to infinity. The density may be
/// discontinuous between layers, by up to 3 % in Vallado's table.
#[derive(Clone, Debug, PartialEq)]
pub struct ExponentialAtmosphere {
    layers: Vec<Layer>,
}

impl ExponentialAtmosphere {
    /// Creates the atmosphere from layers in ascending order.
    ///
    /// # Errors
    /// [`AtmosphereError::NoLayers`] for an empty list, [`AtmosphereError::LayerOrder`] for bases that are
    /// not finite or do not ascend, and [`AtmosphereError::Value`] for a density or scale height that is not
    /// positive and finite.
    pub fn new(layers: Vec<Layer>) -> Result<Self, AtmosphereError> {
        if layers.is_empty() {
            return Err(AtmosphereError::NoLayers);
        }
        for (index, layer) in layers.iter().enumerate() {
            positive("density", layer.density, "a finite density above 0 kg/m³")?;
            positive("scale_height", layer.scale_height, "a finite height above 0 m")?;
            let (altitude, previous) =
                (layer.base, index.checked_sub(1).map_or(f64::MIN, |k| layers[k].base));
            if !(altitude.is_finite() && altitude > previous) {
                return Err(AtmosphereError::LayerOrder { index, altitude, previous });
            }
        }
        Ok(Self { layers })
    }

    /// Creates the atmosphere with the layers of Vallado's table for moderate solar activity, the last of
    /// which begins at 1000 km.
    ///
    /// Source: Vallado, Fundamentals of Astrodynamics and Applications, 4th edition, 2013, table 8-4 (U.S.
    /// Standard Atmosphere to 25 km, CIRA-72 above).
    pub fn table() -> Self {
        let layer = |&[base, density, scale_height]: &[f64; 3]| Layer {
            base: base * 1e3,
            density,
            scale_height: scale_height * 1e3,
        };
        Self { layers: TABLE.iter().map(layer).collect() }
    }

    /// Returns the density, kg/m³, at a geodetic altitude, m.
    pub fn at(&self, altitude: f64) -> f64 {
        let above = self.layers.partition_point(|layer| layer.base <= altitude);
        let layer = &self.layers[above.saturating_sub(1)];
        // ρ = ρ₀ exp(-(h - h₀)/H)
        layer.density * ((layer.base - altitude) / layer.scale_height).exp()
    }
}

impl Atmosphere for ExponentialAtmosphere {
    fn name(&self) -> &'static str {
        "exponential atmosphere"
    }

    fn density(&self, point: &AtmospherePoint<'_>) -> Result<f64, AtmosphereError> {
        Ok(self.at(point.geodetic.altitude))
    }
}

/// Layers of the table: altitude of the base, km; density at the base, kg/m³; scale height, km.
const TABLE: [[f64; 3]; 28] = [
    [0.0, 1.225, 7.249],
    [25.0, 3.899e-2, 6.349],
    [30.0, 1.774e-2, 6.682],
    [40.0, 3.972e-3, 7.554],
    [50.0, 1.057e-3, 8.382],
    [60.0, 3.206e-4, 7.714],
    [70.0, 8.770e-5, 6.549],
    [80.0, 1.905e-5, 5.799],
    [90.0, 3.396e-6, 5.382],
    [100.0, 5.297e-7, 5.877],
    [110.0, 9.661e-8, 7.263],
    [120.0, 2.438e-8, 9.473],
    [130.0, 8.484e-9, 12.636],
    [140.0, 3.845e-9, 16.149],
    [150.0, 2.070e-9, 22.523],
    [180.0, 5.464e-10, 29.740],
    [200.0, 2.789e-10, 37.105],
    [250.0, 7.248e-11, 45.546],
    [300.0, 2.418e-11, 53.628],
    [350.0, 9.518e-12, 53.298],
    [400.0, 3.725e-12, 58.515],
    [450.0, 1.585e-12, 60.828],
    [500.0, 6.967e-13, 63.822],
    [600.0, 1.454e-13, 71.835],
    [700.0, 3.614e-14, 88.667],
    [800.0, 1.170e-14, 124.64],
    [900.0, 5.245e-15, 181.05],
    [1000.0, 3.019e-15, 268.00],
];
