//! What can be wrong with a reference.

use crate::number_text::{count, list, short};
use crate::orbit::OrbitError;
use crate::spatial::SplineError;

/// A reference that makes no sense.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // the fields are what the messages say
pub enum ReferenceError {
    #[error("{name} of the reference is not finite, or beyond 1e60 in SI units")]
    NotFinite { name: &'static str },
    #[error("{name} of the reference has {got}, expected {expected}", got = count(*got, "number"))]
    WrongLength { name: &'static str, expected: usize, got: usize },
    #[error(
        "duration of the reference is {value} s, it must be positive, at least 1e-12 s",
        value = short(*value)
    )]
    DurationNotPositive { value: f64 },
    #[error(
        "ramp of the reference is {value}, it must be above 0 and at most 0.5: its share of the duration",
        value = short(*value)
    )]
    Ramp { value: f64 },
    #[error(
        "a limit of the reference is {value}, it must be positive; leave it out for none",
        value = short(*value)
    )]
    LimitNotPositive { value: f64 },
    #[error("nothing tells how long the reference takes: give times, or limit a rate or acceleration it has")]
    NoLimit,
    #[error(
        "points {point} and {next} of the reference are the same, so no limit gives a time between them: leave one \
         out, or give times",
        next = point + 1
    )]
    SamePoint { point: usize },
    #[error("the axis of the reference has length {length}, a direction is needed", length = short(*length))]
    NoAxis { length: f64 },
    #[error("joint {joint} is to move, there are joints 0 to {last}", last = count.saturating_sub(1))]
    NoJoint { joint: usize, count: usize },
    #[error(
        "the rotation part of the pose is not a rotation matrix: RᵀR differs from 1 by {error}, at most 1e-6 is accepted",
        error = short(*error)
    )]
    NotARotation { error: f64 },
    #[error("the last row of the pose is {row}, it must be [0, 0, 0, 1]", row = list(row))]
    LastRow { row: [f64; 4] },
    #[error("the points of the reference give no curve: {0}")]
    Spline(#[from] SplineError),
    #[error("the reference is given in the frame of an orbit: {0}")]
    Orbit(#[from] OrbitError),
}

/// Returns whether a number is finite and products of a few like it are.
pub(super) fn is_number(x: &f64) -> bool {
    x.abs() <= 1e60
}

/// Shortest duration of a motion, s; rates over less overflow.
pub(super) const SHORTEST: f64 = 1e-12;
