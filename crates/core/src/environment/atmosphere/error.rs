//! Where a model of the air says nothing.

use crate::earth::EarthError;
use crate::number_text::{short, unlike};

/// Refusals of the models of the air; each carries the offending numbers.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AtmosphereError {
    /// A place is inside the Earth.
    #[error(
        "altitude is {altitude} m, below the surface: the air is known from 0 m on",
        altitude = short(*altitude)
    )]
    BelowSurface {
        /// Geodetic altitude, m.
        altitude: f64,
    },
    /// A place is outside the layers that a model has.
    #[error(
        "altitude is {altitude} m, {model} is defined from {lowest} m to {highest} m: an exponential atmosphere or \
         NRLMSISE-00 goes on beyond",
        altitude = unlike(*altitude, &[*lowest, *highest]), lowest = short(*lowest), highest = short(*highest)
    )]
    OutsideLayers {
        /// The model.
        model: &'static str,
        /// Geodetic altitude, m.
        altitude: f64,
        /// Lowest altitude of the model, m.
        lowest: f64,
        /// Highest altitude of the model, m.
        highest: f64,
    },
    /// A parameter makes no sense.
    #[error("{name} is {value}, {expected} is needed", value = short(*value))]
    Value {
        /// Which parameter.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is accepted.
        expected: &'static str,
    },
    /// Layers do not follow each other upwards.
    #[error(
        "layer {index} begins at {altitude} m, not above the one before it at {previous} m",
        altitude = unlike(*altitude, &[*previous]), previous = short(*previous)
    )]
    LayerOrder {
        /// Index of the layer.
        index: usize,
        /// Where it begins, m.
        altitude: f64,
        /// Where the layer before begins, m.
        previous: f64,
    },
    /// There are no layers.
    #[error("an exponential atmosphere needs at least one layer, none is given")]
    NoLayers,
    /// A table of space weather lacks a number that the day needs.
    #[error(
        "space weather: {name} of {date} is missing from {table}, and the run needs it: give a table that holds it, or constants"
    )]
    MissingSpaceWeather {
        /// What the table is called.
        table: String,
        /// Which column.
        name: &'static str,
        /// Which day.
        date: String,
    },
    /// A run takes place on a day that a table of space weather does not have.
    #[error(
        "space weather: {date} is outside of {table}, which runs from {first} to {last}: give constants there"
    )]
    OutsideTable {
        /// What the table is called.
        table: String,
        /// The day asked for.
        date: String,
        /// First day of the table.
        first: String,
        /// Last day of the table.
        last: String,
    },
    /// A table of space weather cannot be read.
    #[error("space weather, line {line}: {problem}")]
    Table {
        /// Line, from 1.
        line: usize,
        /// What is wrong.
        problem: String,
    },
    /// The Earth cannot say.
    #[error(transparent)]
    Earth(#[from] EarthError),
}

/// `value` if it is above zero and finite.
pub(super) fn positive(name: &'static str, value: f64) -> Result<f64, AtmosphereError> {
    if value.is_finite() && value > 0.0 {
        return Ok(value);
    }
    Err(AtmosphereError::Value { name, value, expected: "a finite number above 0" })
}
