//! NRLMSISE-00, the empirical atmosphere model of the Naval Research Laboratory.

use super::error::AtmosphereError;
use super::model::Atmosphere;
use super::point::AtmospherePoint;
use super::space_indices::{MagneticActivity, SpaceIndices};
use super::space_weather::SpaceWeather;
use nrlmsise00::{Input, MagneticActivity as Magnetic, Model};

/// NRLMSISE-00 atmosphere: total density including anomalous oxygen, for given space weather. The model
/// requires an epoch.
///
/// The model is defined from the surface upwards and is fitted to data up to 1000 km; above that altitude,
/// it extrapolates the profiles of helium and hydrogen. The crate `nrlmsise00` evaluates the model in double
/// precision. Daily indices from a table change at midnight UTC.
///
/// Source: Picone, Hedin, Drob and Aikin, J. Geophysical Research 107(A12), 2002.
#[derive(Debug)]
pub struct Nrlmsise00 {
    model: Box<Model>,
    weather: SpaceWeather,
}

impl Nrlmsise00 {
    /// Creates the model for the given space weather.
    pub fn new(weather: SpaceWeather) -> Self {
        Self { model: Box::new(Model::new()), weather }
    }
}

impl Atmosphere for Nrlmsise00 {
    fn name(&self) -> &'static str {
        "NRLMSISE-00"
    }

    fn density(&self, point: &AtmospherePoint<'_>) -> Result<f64, AtmosphereError> {
        let (day, seconds) = point.earth.utc(point.time)?;
        let SpaceIndices { f107, f107a, activity } = match &self.weather {
            SpaceWeather::Constant(indices) => *indices,
            SpaceWeather::Table(table) => table.at(day, seconds)?,
        };
        let magnetic = match activity {
            MagneticActivity::Daily(ap) => Magnetic::Daily { ap },
            MagneticActivity::History(ap) => Magnetic::History { ap },
        };
        let geodetic = &point.geodetic;
        let output = self.model.gtd7d::<f64>(&Input::consistent(
            super::space_weather_table::day_of_year(day),
            seconds,
            geodetic.altitude * 1e-3,
            geodetic.latitude.to_degrees(),
            geodetic.longitude.to_degrees(),
            f107a,
            f107,
            magnetic,
        ));
        Ok(output.total_mass)
    }
}
