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
