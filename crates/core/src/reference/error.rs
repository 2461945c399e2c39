//! Errors of references.

use crate::number_text::{count, list, short};
use crate::orbit::OrbitError;
use crate::spatial::SplineError;

/// Errors of references that are invalid or cannot be evaluated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // the fields are what the messages say
pub enum ReferenceError {
    #[error(
        "{name} of the reference is not finite or exceeds 1e60 in SI units; check the values and their \
    units"
    )]
    NotFinite { name: &'static str },
    #[error("{name} of the reference has {got}; expected {expected}", got = count(*got, "number"))]
    WrongLength { name: &'static str, expected: usize, got: usize },
    #[error(
        "duration of the reference is {value} s; it must be at least 1e-12 s",
        value = short(*value)
    )]
    DurationNotPositive { value: f64 },
    #[error(
        "ramp of the reference is {value}; it is a fraction of the duration and must be above 0 and at most \
         0.5",
        value = short(*value)
    )]
    Ramp { value: f64 },
    #[error(
        "a limit of the reference is {value}; it must be positive, or be omitted for no limit",
        value = short(*value)
    )]
    LimitNotPositive { value: f64 },
    #[error("the duration of the reference is undetermined; give times, or limit a rate or an acceleration")]
    NoLimit,
    #[error(
        "points {point} and {next} of the reference coincide, so limits do not determine the time between \
         them; remove one, or give times",
        next = point + 1
    )]
    SamePoint { point: usize },
    #[error("the axis of the reference has length {length}; give it a direction", length = short(*length))]
    NoAxis { length: f64 },
    #[error("the reference moves joint {joint}, but the robot has joints 0 to {last}", last = count.saturating_sub(1))]
    NoJoint { joint: usize, count: usize },
    #[error(
        "the rotation part of the pose is not a rotation matrix: RᵀR differs from 1 by {error}; it must be \
         within 1e-6",
        error = short(*error)
    )]
    NotARotation { error: f64 },
    #[error("the last row of the pose is {row}; it must be [0, 0, 0, 1]", row = list(row))]
    LastRow { row: [f64; 4] },
    #[error("the points of the reference do not define a curve: {0}")]
    Spline(#[from] SplineError),
    #[error("the pose of the orbital frame of the reference could not be computed: {0}")]
    Orbit(#[from] OrbitError),
}

/// Returns true if a number is finite and so small that products of several such numbers are finite.
pub(super) fn is_number(x: &f64) -> bool {
    x.abs() <= 1e60
}

/// Shortest duration of a motion, s; rates overflow for shorter ones.
pub(super) const SHORTEST: f64 = 1e-12;
