//! Harris-Priester atmosphere, whose density has a bulge that lags behind the Sun.

use super::error::AtmosphereError;
use super::model::Atmosphere;
use super::point::AtmospherePoint;
use crate::earth::Earth;
use nalgebra::{Rotation3, Unit, Vector3};
use std::f64::consts::PI;

/// Harris-Priester atmosphere for mean solar activity, with a density between a night profile `ρm` and a day
/// profile `ρM`.
///
/// `ρ = ρm + (ρM - ρm) cosⁿ(ψ/2)` with the exponent `n`, where `ψ` is the angle, at the Earth's centre,
/// between the position and the apex of the density bulge, which lies the angle `lag` east of the Sun. The
/// model is defined from 100 to 1000 km of geodetic altitude. Between the tabulated altitudes, the profiles
/// are exponential.
///
/// Source: Montenbruck and Gill, Satellite Orbits, Springer 2000, section 3.5.2 and table 3.8.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HarrisPriester {
    exponent: f64,
    lag: f64,
}

impl HarrisPriester {
    /// Creates the model with exponent `n`, from 2 (low inclinations) to 6 (polar orbits), and with the
    /// angle `lag`, rad, which is usually about π/6 (30°).
    ///
    /// # Errors
    /// [`AtmosphereError::Value`] for an exponent outside 2 to 6 or a lag outside ±π.
    pub fn new(exponent: f64, lag: f64) -> Result<Self, AtmosphereError> {
        if !(2.0..=6.0).contains(&exponent) {
            let (name, expected) = ("exponent", "a number from 2 (low inclination) to 6 (polar orbit)");
            return Err(AtmosphereError::Value { name, value: exponent, expected });
        }
        if !(-PI..=PI).contains(&lag) {
            let expected = "an angle from -π to π rad (30° is 0.524)";
            return Err(AtmosphereError::Value { name: "lag", value: lag, expected });
        }
        Ok(Self { exponent, lag })
    }

    /// Returns the unit vector towards the apex of the bulge at `time`, s, in axes of `I`: the direction of
    /// the Sun, rotated by the lag about the Earth's axis.
    fn bulge(&self, earth: &Earth, time: f64) -> Result<Vector3<f64>, AtmosphereError> {
        let sun = earth.sun(time)?.normalize();
        let axis = Unit::try_new(earth.angular_velocity(time), 0.0).unwrap_or_else(Vector3::z_axis);
        Ok(Rotation3::from_axis_angle(&axis, self.lag) * sun)
    }

    /// Returns the density, kg/m³, at a geodetic altitude, m, and at the angle `ψ` from the apex of the bulge
    /// whose cosine is `cos_psi`.
    ///
    /// # Errors
    /// [`AtmosphereError::OutsideLayers`] below 100 km and above 1000 km.
    pub fn at(&self, altitude: f64, cos_psi: f64) -> Result<f64, AtmosphereError> {
        let km = altitude * 1e-3;
        let [lowest, highest] = [TABLE[0][0], TABLE[TABLE.len() - 1][0]];
        if !(lowest..=highest).contains(&km) {
            let (model, lowest, highest) = ("the Harris-Priester atmosphere", lowest * 1e3, highest * 1e3);
            return Err(AtmosphereError::OutsideLayers { model, altitude, lowest, highest });
        }
        let above = TABLE.partition_point(|row| row[0] <= km).clamp(1, TABLE.len() - 1);
        let ([h0, night0, day0], [h1, night1, day1]) = (TABLE[above - 1], TABLE[above]);
        // ρ(h) = ρ_i (ρ_{i+1}/ρ_i)^x,  x = (h - h_i)/(h_{i+1} - h_i)
        let x = (km - h0) / (h1 - h0);
        let (night, day) = (night0 * (night1 / night0).powf(x), day0 * (day1 / day0).powf(x));
        // cosⁿ ψ/2 = ((1 + cos ψ)/2)^{n/2}
        let bulge = (0.5 + 0.5 * cos_psi).max(0.0).powf(0.5 * self.exponent);
        // ρ = ρm + (ρM - ρm) cosⁿ(ψ/2)
        Ok((night + (day - night) * bulge) * G_PER_KM3)
    }
}

impl Default for HarrisPriester {
    /// Creates the model with an exponent of 4 and a lag of π/6 (30°).
    fn default() -> Self {
        Self { exponent: 4.0, lag: std::f64::consts::FRAC_PI_6 }
    }
}

impl Atmosphere for HarrisPriester {
    fn name(&self) -> &'static str {
        "the Harris-Priester atmosphere"
    }

    fn density(&self, point: &AtmospherePoint<'_>) -> Result<f64, AtmosphereError> {
        let bulge = self.bulge(point.earth, point.time)?;
        self.at(point.geodetic.altitude, point.position.normalize().dot(&bulge))
    }
}

const G_PER_KM3: f64 = 1e-12;

/// Rows of the table: altitude, km; night density and day density, g/km³.
const TABLE: [[f64; 3]; 50] = [
    [100.0, 497_400.0, 497_400.0],
    [120.0, 24_900.0, 24_900.0],
    [130.0, 8377.0, 8710.0],
    [140.0, 3899.0, 4059.0],
    [150.0, 2122.0, 2215.0],
    [160.0, 1263.0, 1344.0],
    [170.0, 800.8, 875.8],
    [180.0, 528.3, 601.0],
    [190.0, 361.7, 429.7],
    [200.0, 255.7, 316.2],
    [210.0, 183.9, 239.6],
    [220.0, 134.1, 185.3],
    [230.0, 99.49, 145.5],
    [240.0, 74.88, 115.7],
    [250.0, 57.09, 93.08],
    [260.0, 44.03, 75.55],
    [270.0, 34.30, 61.82],
    [280.0, 26.97, 50.95],
    [290.0, 21.39, 42.26],
    [300.0, 17.08, 35.26],
    [320.0, 10.99, 25.11],
    [340.0, 7.214, 18.19],
    [360.0, 4.824, 13.37],
    [380.0, 3.274, 9.955],
    [400.0, 2.249, 7.492],
    [420.0, 1.558, 5.684],
    [440.0, 1.091, 4.355],
    [460.0, 0.7701, 3.362],
    [480.0, 0.5474, 2.612],
    [500.0, 0.3916, 2.042],
    [520.0, 0.2819, 1.605],
    [540.0, 0.2042, 1.267],
    [560.0, 0.1488, 1.005],
    [580.0, 0.1092, 0.7997],
    [600.0, 0.08070, 0.6390],
    [620.0, 0.06012, 0.5123],
    [640.0, 0.04519, 0.4121],
    [660.0, 0.03430, 0.3325],
    [680.0, 0.02632, 0.2691],
    [700.0, 0.02043, 0.2185],
    [720.0, 0.01607, 0.1779],
    [740.0, 0.01281, 0.1452],
    [760.0, 0.01036, 0.1190],
    [780.0, 0.008496, 0.09776],
    [800.0, 0.007069, 0.08059],
    [840.0, 0.004680, 0.05741],
    [880.0, 0.003200, 0.04210],
    [920.0, 0.002210, 0.03130],
    [960.0, 0.001560, 0.02360],
    [1000.0, 0.001150, 0.01810],
];
