//! What can be wrong with a set of mean elements and with what SGP4 makes of them.

use crate::number_text::{count, short, unlike};
use std::ops::RangeInclusive;

/// An element set that cannot be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ElementSetError {
    /// A line of a TLE is too long or too short.
    #[error("line {line} of the TLE has {got}, 69 are needed (is something missing or wrapped?)", got = count(*got, "column"))]
    Length {
        /// 1 or 2.
        line: u8,
        /// Columns given, without blanks at the end.
        got: usize,
    },
    /// A column holds something that cannot stand there.
    #[error("line {line} of the TLE, column {column}: {got:?} where {expected} is needed")]
    Column {
        /// 1 or 2.
        line: u8,
        /// First column of the field, from 1.
        column: usize,
        /// What stands there.
        got: String,
        /// What should.
        expected: &'static str,
    },
    /// The digits do not add up.
    #[error(
        "line {line} of the TLE, column 69: the checksum is {got}, the line adds up to {expected}: \
         copy the line again, or accept it with check_checksum=False"
    )]
    Checksum {
        /// 1 or 2.
        line: u8,
        /// What stands in column 69.
        got: u8,
        /// What the line adds up to.
        expected: u8,
    },
    /// The lines belong to two satellites.
    #[error(
        "line 1 of the TLE is of satellite {first:?}, line 2 of {second:?}: give two lines of one satellite"
    )]
    TwoSatellites {
        /// Number in line 1.
        first: String,
        /// Number in line 2.
        second: String,
    },
    /// A message lacks an entry.
    #[error("the OMM has no {key}: SGP4 needs it")]
    Missing {
        /// Keyword of CCSDS 502.0-B.
        key: &'static str,
    },
    /// An entry of a message makes no sense.
    #[error("the OMM's {key} is {got:?}, {expected} is needed")]
    Entry {
        /// Keyword of CCSDS 502.0-B.
        key: &'static str,
        /// What was given.
        got: String,
        /// What is needed.
        expected: &'static str,
    },
    /// A number lies where no orbit is.
    #[error("{name} is {got}, it must lie within {} to {}", short(*range.start()), short(*range.end()), got = unlike(*got, &[*range.start(), *range.end()]))]
    Range {
        /// Which element.
        name: &'static str,
        /// What was given, in the unit of the element set.
        got: f64,
        /// What is accepted.
        range: RangeInclusive<f64>,
    },
}

/// SGP4's refusals, by the number that the reference code gives them.
///
/// Number 5 (epoch elements below the surface) is no longer raised by it, nor here: such sets are
/// propagated and decay.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Sgp4Error {
    /// 1: mean eccentricity, drag and secular effects included.
    #[error(
        "SGP4 error 1 at t = {time} s: the mean eccentricity is {eccentricity}, it must lie in [-0.001, 1): \
         the elements do not reach so far from their epoch",
        time = short(*time), eccentricity = short(*eccentricity)
    )]
    MeanEccentricity {
        /// Time since the epoch, s.
        time: f64,
        /// What came out.
        eccentricity: f64,
    },
    /// 2: mean motion.
    #[error(
        "SGP4 error 2 at t = {time} s: the mean motion is {mean_motion} rev/day, it must be positive",
        time = short(*time), mean_motion = short(*mean_motion)
    )]
    MeanMotion {
        /// Time since the epoch, s.
        time: f64,
        /// What came out.
        mean_motion: f64,
    },
    /// 3: eccentricity with the pull of Sun and Moon.
    #[error(
        "SGP4 error 3 at t = {time} s: the eccentricity perturbed by Sun and Moon is {eccentricity}, it must lie \
         in [0, 1]: the elements do not reach so far from their epoch",
        time = short(*time), eccentricity = short(*eccentricity)
    )]
    PerturbedEccentricity {
        /// Time since the epoch, s.
        time: f64,
        /// What came out.
        eccentricity: f64,
    },
    /// 4: semi-latus rectum.
    #[error(
        "SGP4 error 4 at t = {time} s: the semi-latus rectum is {semi_latus_rectum} m, it must not be negative: \
         the elements do not reach so far from their epoch",
        time = short(*time), semi_latus_rectum = short(*semi_latus_rectum)
    )]
    SemiLatusRectum {
        /// Time since the epoch, s.
        time: f64,
        /// What came out, m.
        semi_latus_rectum: f64,
    },
    /// 6: below the surface.
    #[error(
        "SGP4 error 6 at t = {time} s: the satellite has decayed, it is {distance} m from the Earth's centre, \
         less than {radius} m: end the run earlier",
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
    /// An error of the reference code.
    #[error("SGP4 error {code} at t = {time} s, by the reference code: {}", reason(*.code), time = short(*time))]
    OfReference {
        /// Time since the epoch, s.
        time: f64,
        /// Its error code.
        code: u8,
    },
}

/// Returns the meaning of an error code of the reference code.
fn reason(code: u8) -> &'static str {
    match code {
        1 => "the mean eccentricity is out of range",
        2 => "the mean motion is not positive",
        3 => "the eccentricity perturbed by Sun and Moon is out of range",
        4 => "the semi-latus rectum is negative",
        _ => "it gave no state",
    }
}

impl Sgp4Error {
    /// The number that the reference code gives it.
    pub fn code(&self) -> u8 {
        match self {
            Self::MeanEccentricity { .. } => 1,
            Self::MeanMotion { .. } => 2,
            Self::PerturbedEccentricity { .. } => 3,
            Self::SemiLatusRectum { .. } => 4,
            Self::Decayed { .. } => 6,
            Self::OfReference { code, .. } => *code,
        }
    }

    /// Time since the epoch, s.
    pub fn time(&self) -> f64 {
        match *self {
            Self::MeanEccentricity { time, .. }
            | Self::MeanMotion { time, .. }
            | Self::PerturbedEccentricity { time, .. }
            | Self::SemiLatusRectum { time, .. }
            | Self::Decayed { time, .. }
            | Self::OfReference { time, .. } => time,
        }
    }

    /// The offending value, in the unit of its message; NaN for errors of the reference code.
    pub fn value(&self) -> f64 {
        match *self {
            Self::MeanEccentricity { eccentricity, .. }
            | Self::PerturbedEccentricity { eccentricity, .. } => eccentricity,
            Self::MeanMotion { mean_motion, .. } => mean_motion,
            Self::SemiLatusRectum { semi_latus_rectum, .. } => semi_latus_rectum,
            Self::Decayed { distance, .. } => distance,
            Self::OfReference { .. } => f64::NAN,
        }
    }
}
