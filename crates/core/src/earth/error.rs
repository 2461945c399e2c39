//! Errors of epochs, of the rotation of the Earth, and of the positions of the Sun and the Moon.

use crate::number_text::{count, exact, short, unlike};

/// Errors of the `earth` module; each holds the offending values.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EarthError {
    /// A text does not represent an instant.
    #[error(
        "epoch is '{text}', but {fault}; expected an instant and its time scale, such as \
         '2024-03-01T12:00:00 UTC'"
    )]
    Epoch {
        /// Given text.
        text: String,
        /// Description of what is wrong with the text, and of what is accepted.
        fault: String,
    },
    /// An epoch in UTC is before 1972, when UTC adopted leap seconds.
    #[error("epoch '{text}' is before 1972, when UTC adopted leap seconds; give the epoch in TAI or TT")]
    BeforeUtc {
        /// Given text.
        text: String,
    },
    /// A quantity depends on the date, but no epoch is given.
    #[error(
        "{what} requires an epoch, but none is given; set 'epoch', for example to '2024-03-01T12:00:00 UTC'"
    )]
    NeedsEpoch {
        /// Name of the quantity.
        what: &'static str,
    },
    /// A time is outside the span in which a quantity is known.
    #[error(
        "{what} is available only from {from} to {to}, but is required at t = {time} s after the epoch \
         {epoch}; choose an epoch for which the whole run lies in this span",
        time = short(*time)
    )]
    OutsideSpan {
        /// Name of the quantity.
        what: &'static str,
        /// Requested simulation time, s.
        time: f64,
        /// Epoch of the run.
        epoch: String,
        /// First instant at which the quantity is known.
        from: String,
        /// Last instant at which the quantity is known.
        to: String,
    },
    /// A time or another input is infinite or NaN.
    #[error("{name} is {value}; expected a finite number", value = short(*value))]
    NotFinite {
        /// Name of the input.
        name: &'static str,
        /// Given value: infinite or NaN.
        value: f64,
    },
    /// An Earth-orientation parameter is implausible.
    #[error(
        "{name} is {value}{place}; expected {expected}",
        value = exact(*value), place = row.map_or_else(String::new, |row| format!(" in row {row}"))
    )]
    Parameter {
        /// Name of the parameter.
        name: &'static str,
        /// Given value, in the unit that `expected` states.
        value: f64,
        /// Index of the row of the table, counted from 0; `None` for constant parameters.
        row: Option<usize>,
        /// Text that describes the accepted range.
        expected: &'static str,
    },
    /// A table of Earth-orientation parameters cannot be read.
    #[error("line {line} of the Earth-orientation table: {problem}")]
    Table {
        /// Number of the line, counted from 1.
        line: usize,
        /// Description of the problem.
        problem: String,
    },
    /// A position is so near the Earth's centre that its latitude is not unique.
    #[error(
        "position is {distance} m from the Earth's centre; expected at least {minimum} m, because geodetic \
         coordinates are not unique near the centre",
        distance = unlike(*distance, &[*minimum]), minimum = short(*minimum)
    )]
    NearCentre {
        /// Distance from the Earth's centre, m.
        distance: f64,
        /// Smallest accepted distance, m.
        minimum: f64,
    },
    /// The epochs of the orbit and of the Earth differ.
    #[error(
        "the epoch of the orbit is {orbit}, but that of the Earth of the run is {run}; give both the same epoch"
    )]
    OtherEpoch {
        /// Epoch of the orbit.
        orbit: String,
        /// Epoch of the Earth.
        run: String,
    },
    /// The inertial axes of the orbit and of the Earth differ.
    #[error(
        "the orbit has {orbit} axes, but the Earth has {run} axes; create the Earth with the axes of the orbit"
    )]
    OtherAxes {
        /// Name of the axes of the orbit.
        orbit: &'static str,
        /// Name of the axes of the Earth.
        run: &'static str,
    },
    /// A number in a segment of a SPICE kernel is implausible.
    #[error(
        "{name} of a segment of the kernel is {value}; expected {expected}; download the kernel again, \
         because it may be damaged",
        value = exact(*value)
    )]
    Segment {
        /// Name of the number.
        name: &'static str,
        /// Given value, in the unit that `expected` states.
        value: f64,
        /// Text that describes the accepted range.
        expected: &'static str,
    },
    /// A table of Earth-orientation parameters has too few rows to be interpolated.
    #[error("the table of Earth-orientation parameters has {got}; give at least 2 rows", got = count(*got, "row"))]
    ShortTable {
        /// Number of rows in the table.
        got: usize,
    },
    /// A segment of a SPICE kernel does not consist of complete intervals.
    #[error(
        "a segment of the kernel has {got}, which is not a positive multiple of 3 × {per_interval} (3 components with \
         {per_interval} per interval); download the kernel again, because it may be damaged",
        got = count(*got, "coefficient")
    )]
    SegmentLength {
        /// Number of coefficients in the segment.
        got: usize,
        /// Number of coefficients of one component in one interval.
        per_interval: usize,
    },
    /// An array has the wrong length.
    #[error("the array '{name}' has {got}; expected {expected}", got = count(*got, "number"))]
    WrongLength {
        /// Name of the array.
        name: &'static str,
        /// Required number of elements.
        expected: usize,
        /// Number of elements of the given array.
        got: usize,
    },
}
