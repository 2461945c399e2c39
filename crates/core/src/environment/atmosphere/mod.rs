//! The density of the air.
//!
//! [`Atmosphere`] is the one trait; a new model is one file and one line here.

mod constant;
mod error;
mod exponential;
mod harris_priester;
mod local;
mod nrlmsise00;
mod place;
mod space_weather;
mod space_weather_table;

pub use constant::ConstantAtmosphere;
pub use error::AtmosphereError;
pub use exponential::{ExponentialAtmosphere, Layer};
pub use harris_priester::HarrisPriester;
pub use local::LocalAir;
pub use nrlmsise00::Nrlmsise00;
pub use place::AirPlace;
pub use space_weather::{MagneticActivity, SpaceIndices, SpaceWeather};
pub use space_weather_table::SpaceWeatherTable;

use crate::earth::{Earth, Geodetic};
use nalgebra::Vector3;

/// A model of the air's density.
pub trait Atmosphere: Send + Sync + std::fmt::Debug {
    /// Short name, for messages.
    fn name(&self) -> &'static str;

    /// Density, kg/m³; a pure function of the place, which lies outside the Earth.
    ///
    /// # Errors
    /// [`AtmosphereError`] where the model says nothing about that place or time.
    fn density(&self, place: &AirPlace<'_>) -> Result<f64, AtmosphereError>;
}

/// Density at many places: latitudes and longitudes in rad, altitudes in m, instants in s of simulation; kg/m³.
///
/// # Errors
/// The first refusal.
pub fn densities_over(
    atmosphere: &dyn Atmosphere,
    earth: &Earth,
    [altitudes, latitudes, longitudes, times]: [&[f64]; 4],
    out: &mut [f64],
) -> Result<(), AtmosphereError> {
    let places = altitudes.iter().zip(latitudes).zip(longitudes).zip(times);
    for (density, (((&altitude, &latitude), &longitude), &time)) in out.iter_mut().zip(places) {
        let geodetic = Geodetic { latitude, longitude, altitude };
        *density = atmosphere.density(&AirPlace::at(earth, time, geodetic)?)?;
    }
    Ok(())
}

/// Density at many positions from the Earth's centre, axes of `I`, m, row after row; kg/m³.
///
/// # Errors
/// The first refusal.
pub fn densities_at(
    atmosphere: &dyn Atmosphere,
    earth: &Earth,
    positions: &[f64],
    times: &[f64],
    out: &mut [f64],
) -> Result<(), AtmosphereError> {
    for ((density, r), &time) in out.iter_mut().zip(positions.chunks_exact(3)).zip(times) {
        *density = atmosphere.density(&AirPlace::new(earth, time, &Vector3::from_column_slice(r))?)?;
    }
    Ok(())
}
