//! Space weather during a run.

use super::space_indices::SpaceIndices;
use super::space_weather_table::SpaceWeatherTable;

/// Solar and geomagnetic indices during a run.
#[derive(Clone, Debug, PartialEq)]
pub enum SpaceWeather {
    /// Indices that are constant during the run.
    Constant(SpaceIndices),
    /// Indices from a table with one row per day.
    Table(SpaceWeatherTable),
}
