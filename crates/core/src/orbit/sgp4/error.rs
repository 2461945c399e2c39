//! Errors of element sets and of SGP4.

use crate::number_text::{count, short, unlike};
use std::ops::RangeInclusive;

/// Errors of element sets that cannot be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ElementSetError {
    /// A line of a TLE is too long or too short.
    #[error("line {line} of the TLE has {got}; expected 69 (is the line truncated or wrapped?)", got = count(*got, "column"))]
    Length {
        /// Line number, 1 or 2.
        line: u8,
        /// Number of columns given, without trailing blanks.
        got: usize,
    },
    /// A field of a TLE holds an invalid character or number.
    #[error("line {line} of the TLE, column {column}, is {got:?}; expected {expected}")]
    Column {
        /// Line number, 1 or 2.
        line: u8,
        /// First column of the field, counted from 1.
        column: usize,
        /// Text of the field.
        got: String,
        /// Description of the expected text.
        expected: &'static str,
    },
    /// The checksum of a line of a TLE differs from the one computed from the line.
    #[error(
        "line {line} of the TLE, column 69: the checksum is {got}, but columns 1 to 68 give {expected}; copy \
         the line again, or accept it with check_checksum=False"
    )]
    Checksum {
        /// Line number, 1 or 2.
        line: u8,
        /// Digit in column 69.
        got: u8,
        /// Checksum computed from columns 1 to 68.
        expected: u8,
    },
    /// The two lines of a TLE belong to different satellites.
    #[error(
        "line 1 of the TLE belongs to satellite {first:?}, but line 2 to satellite {second:?}; give both lines of one \
         satellite"
    )]
    TwoSatellites {
        /// Satellite number in line 1.
        first: String,
        /// Satellite number in line 2.
        second: String,
    },
    /// An entry of an Orbit Mean-Elements Message (OMM) is missing.
    #[error("the OMM has no entry {key}, which SGP4 requires; add the entry")]
    Missing {
        /// Keyword of CCSDS 502.0-B.
        key: &'static str,
    },
    /// An entry of an Orbit Mean-Elements Message (OMM) is invalid.
    #[error("the OMM's {key} is {got:?}; expected {expected}")]
    Entry {
        /// Keyword of CCSDS 502.0-B.
        key: &'static str,
        /// Given text.
        got: String,
        /// Description of the expected text.
        expected: &'static str,
    },
    /// An element is outside its accepted range.
    #[error(
        "{name} of the element set is {got}{unit}; it must be {}{unit}",
        bounds(range),
        got = unlike(*got, &[*range.start(), *range.end()])
    )]
    Range {
        /// Name of the element.
        name: &'static str,
        /// Value given, in the unit of the element set.
        got: f64,
        /// Accepted range, in the unit of the element set.
        range: RangeInclusive<f64>,
        /// Unit with a leading blank, such as ` deg`, or empty.
        unit: &'static str,
    },
}

/// Errors of SGP4, with the error numbers of the reference implementation.
///
/// As in current versions of the reference implementation, error 5 (epoch elements below the surface) does
/// not occur: such orbits are propagated and decay.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Sgp4Error {
    /// Error 1: the mean eccentricity with drag and secular perturbations is out of range.
    #[error(
        "SGP4 error 1 at t = {time} s: the mean eccentricity is {eccentricity}; it must lie in [-0.001, 1); \
         check the elements, or give elements with an epoch nearer to this time",
        time = short(*time), eccentricity = unlike(*eccentricity, &[-0.001, 1.0])
    )]
    MeanEccentricity {
        /// Time since the epoch, s.
        time: f64,
        /// Mean eccentricity.
        eccentricity: f64,
    },
    /// Error 2: the mean motion is not positive.
    #[error(
        "SGP4 error 2 at t = {time} s: the mean motion is {mean_motion} rev/day; it must be positive; \
         check the elements, or give elements with an epoch nearer to this time",
        time = short(*time), mean_motion = short(*mean_motion)
    )]
    MeanMotion {
        /// Time since the epoch, s.
        time: f64,
        /// Mean motion, rev/day.
        mean_motion: f64,
    },
    /// Error 3: the eccentricity with the perturbations by Sun and Moon is out of range.
    #[error(
        "SGP4 error 3 at t = {time} s: the eccentricity perturbed by Sun and Moon is {eccentricity}; it \
         must lie in [0, 1]; check the elements, or give elements with an epoch nearer to this time",
        time = short(*time), eccentricity = unlike(*eccentricity, &[0.0, 1.0])
    )]
    PerturbedEccentricity {
        /// Time since the epoch, s.
        time: f64,
        /// Eccentricity with the perturbations by Sun and Moon.
        eccentricity: f64,
    },
    /// Error 4: the semi-latus rectum is negative.
    #[error(
        "SGP4 error 4 at t = {time} s: the semi-latus rectum is {semi_latus_rectum} m; it must not be \
         negative; check the elements, or give elements with an epoch nearer to this time",
        time = short(*time), semi_latus_rectum = short(*semi_latus_rectum)
    )]
    SemiLatusRectum {
        /// Time since the epoch, s.
        time: f64,
        /// Semi-latus rectum, m.
        semi_latus_rectum: f64,
    },
    /// Error 6: the position is below the surface.
    #[error(
        "SGP4 error 6 at t = {time} s: the satellite has decayed and is {distance} m from the Earth's \
         centre; expected at least {radius} m; end the run earlier",
        time = short(*time), distance = unlike(*distance, &[*radius]), radius = short(*radius)
    )]
    Decayed {
        /// Time since the epoch, s.
        time: f64,
        /// Distance from the Earth's centre, m.
        distance: f64,
        /// Equatorial radius of the Earth model, m.
        radius: f64,
    },
    /// An error reported by the reference implementation.
    #[error(
        "SGP4 error {code} of the reference implementation at t = {time} s: {}; check the elements, or give \
         elements with an epoch nearer to this time",
        reason(*.code), time = short(*time)
    )]
    External {
        /// Time since the epoch, s.
        time: f64,
        /// Error code of the reference implementation.
        code: u8,
    },
}

/// Returns a range as text. A lower bound of [`f64::MIN_POSITIVE`] is written as "above 0", and an upper
/// bound of `1 - f64::EPSILON` as "below 1".
fn bounds(range: &RangeInclusive<f64>) -> String {
    let (start, end) = (*range.start(), *range.end());
    let lower =
        if start == f64::MIN_POSITIVE { "above 0".to_owned() } else { format!("at least {}", short(start)) };
    let upper =
        if end == 1.0 - f64::EPSILON { "below 1".to_owned() } else { format!("at most {}", short(end)) };
    format!("{lower} and {upper}")
}

/// Returns the text for an error code of the reference implementation. Codes other than 1 to 4 have the text
/// "it returned no state".
fn reason(code: u8) -> &'static str {
    match code {
        1 => "the mean eccentricity is out of range",
        2 => "the mean motion is not positive",
        3 => "the eccentricity perturbed by Sun and Moon is out of range",
        4 => "the semi-latus rectum is negative",
        _ => "it returned no state",
    }
}

impl Sgp4Error {
    /// Returns the error number that the reference implementation uses.
    pub fn code(&self) -> u8 {
        match self {
            Self::MeanEccentricity { .. } => 1,
            Self::MeanMotion { .. } => 2,
            Self::PerturbedEccentricity { .. } => 3,
            Self::SemiLatusRectum { .. } => 4,
            Self::Decayed { .. } => 6,
            Self::External { code, .. } => *code,
        }
    }

    /// Returns the time at which the error occurred, s since the epoch.
    pub fn time(&self) -> f64 {
        match *self {
            Self::MeanEccentricity { time, .. }
            | Self::MeanMotion { time, .. }
            | Self::PerturbedEccentricity { time, .. }
            | Self::SemiLatusRectum { time, .. }
            | Self::Decayed { time, .. }
            | Self::External { time, .. } => time,
        }
    }

    /// Returns the offending value, in the unit of the message; NaN for [`Sgp4Error::External`].
    pub fn value(&self) -> f64 {
        match *self {
            Self::MeanEccentricity { eccentricity, .. }
            | Self::PerturbedEccentricity { eccentricity, .. } => eccentricity,
            Self::MeanMotion { mean_motion, .. } => mean_motion,
            Self::SemiLatusRectum { semi_latus_rectum, .. } => semi_latus_rectum,
            Self::Decayed { distance, .. } => distance,
            Self::External { .. } => f64::NAN,
        }
    }
}
