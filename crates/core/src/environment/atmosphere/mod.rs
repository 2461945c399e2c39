//! Density of the atmosphere.
//!
//! [`Atmosphere`] is the trait of all models. To add a model, add a file and a line in this module.

mod constant;
mod error;
mod exponential;
mod harris_priester;
mod local_atmosphere;
mod model;
mod nrlmsise00;
mod point;
mod space_indices;
mod space_weather;
mod space_weather_table;

pub use constant::ConstantAtmosphere;
pub use error::AtmosphereError;
pub use exponential::{ExponentialAtmosphere, Layer};
pub use harris_priester::HarrisPriester;
pub use local_atmosphere::LocalAtmosphere;
pub use model::{Atmosphere, densities_at, densities_over};
pub use nrlmsise00::Nrlmsise00;
pub use point::AtmospherePoint;
pub use space_indices::{MagneticActivity, SpaceIndices};
pub use space_weather::SpaceWeather;
pub use space_weather_table::SpaceWeatherTable;
