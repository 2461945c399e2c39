//! NRLMSISE-00: the empirical model of the Naval Research Laboratory.

use super::{AirPlace, Atmosphere, AtmosphereError, MagneticActivity, SpaceIndices, SpaceWeather};
use nrlmsise00::{Input, MagneticActivity as Magnetic, Model};

/// Total density, anomalous oxygen included, under the given space weather; needs an epoch.
///
/// From the surface up; fitted to 1000 km, above which its profiles of helium and hydrogen go on. The crate
/// `nrlmsise00` computes it, in double precision. Indices of a table change at midnight UTC.
///
/// Source: Picone, Hedin, Drob and Aikin, J. Geophysical Research 107(A12), 2002.
#[derive(Debug)]
pub struct Nrlmsise00 {
    model: Box<Model>,
    weather: SpaceWeather,
}

impl Nrlmsise00 {
    /// The model under this space weather.
    pub fn new(weather: SpaceWeather) -> Self {
        Self { model: Box::new(Model::new()), weather }
    }
}

impl Atmosphere for Nrlmsise00 {
    fn name(&self) -> &'static str {
        "NRLMSISE-00"
    }

    fn density(&self, place: &AirPlace<'_>) -> Result<f64, AtmosphereError> {
        let (day, seconds) = place.earth.utc(place.time)?;
        let SpaceIndices { f107, f107a, activity } = match &self.weather {
            SpaceWeather::Constant(indices) => *indices,
            SpaceWeather::Table(table) => table.at(day, seconds)?,
        };
        let magnetic = match activity {
            MagneticActivity::Daily(ap) => Magnetic::Daily { ap },
            MagneticActivity::History(ap) => Magnetic::History { ap },
        };
        let at = &place.geodetic;
        let output = self.model.gtd7d::<f64>(&Input::consistent(
            super::space_weather_table::day_of_year(day),
            seconds,
            at.altitude * 1e-3,
            at.latitude.to_degrees(),
            at.longitude.to_degrees(),
            f107a,
            f107,
            magnetic,
        ));
        Ok(output.total_mass)
    }
}
