//! Space weather during a run.

use super::space_indices::SpaceIndices;
use super::space_weather_table::SpaceWeatherTable;

/// Solar and geomagnetic indices during a run.
#[derive(Clone, Debug, PartialEq)]
pub enum SpaceWeather {
    /// Constant indices.
    Constant(SpaceIndices),
    /// Indices of each day.
    Table(SpaceWeatherTable),
}
