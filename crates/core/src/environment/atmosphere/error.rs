//! Errors of atmosphere models.

use crate::earth::EarthError;
use crate::number_text::{exact, short, unlike};

/// Errors of atmosphere models.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AtmosphereError {
    /// A position is inside the Earth.
    #[error(
        "altitude is {altitude} m; expected at least 0 m, because the density is not defined below the \
         ellipsoid of the Earth; in a run, raise the orbit or end the run earlier",
        altitude = short(*altitude)
    )]
    BelowSurface {
        /// Geodetic altitude, m.
        altitude: f64,
    },
    /// An altitude is outside the range of a model.
    #[error(
        "altitude is {altitude} m, but {model} is defined from {lowest} m to {highest} m; use an \
         exponential atmosphere or NRLMSISE-00",
        altitude = unlike(*altitude, &[*lowest, *highest]), lowest = short(*lowest), highest = short(*highest)
    )]
    OutsideLayers {
        /// Name of the model.
        model: &'static str,
        /// Geodetic altitude, m.
        altitude: f64,
        /// Lowest altitude of the model, m.
        lowest: f64,
        /// Highest altitude of the model, m.
        highest: f64,
    },
    /// A parameter is outside its range.
    #[error("{name} is {value}; expected {expected}", value = exact(*value))]
    Value {
        /// Name of the parameter.
        name: &'static str,
        /// Given value, in the unit that `expected` states.
        value: f64,
        /// Text that describes the accepted range.
        expected: &'static str,
    },
    /// The base of a layer is not a finite altitude above the base of the previous layer.
    #[error(
        "layer {index} begins at {altitude} m; expected a finite altitude{}",
        above_previous(*index, *previous), altitude = unlike(*altitude, &[*previous])
    )]
    LayerOrder {
        /// Index of the layer, counted from 0.
        index: usize,
        /// Altitude of the base of this layer, m.
        altitude: f64,
        /// Altitude of the base of the previous layer, m; not used for the first layer.
        previous: f64,
    },
    /// The list of layers is empty.
    #[error("the exponential atmosphere has no layers; give at least one layer")]
    NoLayers,
    /// A table of space weather lacks a value that the run requires.
    #[error(
        "space weather: {name} of {date} is missing from {table}, but is required; give a complete table \
         or constants"
    )]
    MissingSpaceWeather {
        /// Name of the table.
        table: String,
        /// Name of the column.
        name: &'static str,
        /// Date of the day.
        date: String,
    },
    /// A day is outside the table of space weather.
    #[error(
        "space weather: {date} is outside {table}, which covers {first} to {last}; give a table that \
         includes this date, or constants"
    )]
    OutsideTable {
        /// Name of the table.
        table: String,
        /// Day that the run requires.
        date: String,
        /// First day of the table.
        first: String,
        /// Last day of the table.
        last: String,
    },
    /// A table of space weather cannot be read.
    #[error("space weather, line {line}: {problem}")]
    Table {
        /// Number of the line, counted from 1.
        line: usize,
        /// Description of the problem.
        problem: String,
    },
    /// The time or the position of the Sun is unknown.
    #[error(transparent)]
    Earth(#[from] EarthError),
}

/// Returns the part of a message that states the lower bound of the base of layer `index`, or an empty text
/// for the first layer, which has no bound. `previous` is the base of the layer before, m.
fn above_previous(index: usize, previous: f64) -> String {
    let lower = |before| format!(" above {} m, where layer {before} begins", short(previous));
    index.checked_sub(1).map_or_else(String::new, lower)
}

/// Returns `value`, or an error if it is not finite and positive. `expected` describes the accepted range in
/// the message.
pub(super) fn positive(
    name: &'static str,
    value: f64,
    expected: &'static str,
) -> Result<f64, AtmosphereError> {
    if value.is_finite() && value > 0.0 {
        return Ok(value);
    }
    Err(AtmosphereError::Value { name, value, expected })
}
