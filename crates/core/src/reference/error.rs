//! Errors of references.

use crate::number_text::{choice, count, exact, exact_list, unlike};
use crate::orbit::OrbitError;
use crate::spatial::SplineError;

/// Errors of references: invalid arguments, or a reference that cannot be evaluated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // the messages explain the fields
pub enum ReferenceError {
    #[error(
        "'{name}' of the reference contains {value}; expected finite numbers between -1e60 and 1e60 (SI units)",
        value = exact(*value)
    )]
    NotFinite { name: &'static str, value: f64 },
    #[error("the array '{name}' of the reference has {got}; expected {expected}", got = count(*got, "number"))]
    WrongLength { name: &'static str, expected: usize, got: usize },
    #[error(
        "the duration of the reference is {value} s; it must be finite and at least 1e-12 s",
        value = exact(*value)
    )]
    DurationNotPositive { value: f64 },
    #[error(
        "the ramp of the reference is {value}; it must be above 0 and at most 0.5, as a fraction of the duration",
        value = exact(*value)
    )]
    Ramp { value: f64 },
    #[error(
        "the limit '{name}' of the reference is {value}; it must be positive (omit it for no limit)",
        value = exact(*value)
    )]
    LimitNotPositive { name: String, value: f64 },
    #[error(
        "the limits do not determine the duration of the reference, because it does not move or no limit \
         applies to its motion; give a duration or times, or limit a rate or acceleration of this motion"
    )]
    NoLimit,
    #[error(
        "the limits do not determine the time between points {point} and {next} of the reference, because the \
         points coincide or no limit applies to the motion between them; remove one of the points, give times, or \
         limit this motion",
        next = point + 1
    )]
    SamePoint { point: usize },
    #[error(
        "the axis of the reference has length {length}; give a vector with a length of at least 1e-9",
        length = unlike(*length, &[1e-9])
    )]
    NoAxis { length: f64 },
    #[error(
        "the reference moves joint {joint}, but the robot has {known}",
        known = choice(*count, "joint")
    )]
    NoJoint { joint: usize, count: usize },
    #[error(
        "the upper left 3 × 3 block R of the pose is not a rotation matrix: RᵀR differs from the identity, or det R \
         from 1, by {error}, but both must agree within 1e-6; give an orthonormal, right-handed R",
        error = unlike(*error, &[1e-6])
    )]
    NotARotation { error: f64 },
    #[error("the last row of the pose is {row}; it must be [0, 0, 0, 1]", row = exact_list(row))]
    LastRow { row: [f64; 4] },
    #[error("the points of the reference do not define a curve: {0}")]
    Spline(#[from] SplineError),
    #[error("the orbital frame of the reference cannot be computed: {0}")]
    Orbit(#[from] OrbitError),
}

/// Checks that numbers are finite and small enough that products of several such numbers are finite.
///
/// # Errors
/// [`ReferenceError::NotFinite`] for the first invalid number.
pub(super) fn check_numbers<'a>(
    name: &'static str,
    numbers: impl IntoIterator<Item = &'a f64>,
) -> Result<(), ReferenceError> {
    match numbers.into_iter().find(|x| x.is_nan() || x.abs() > 1e60) {
        Some(&value) => Err(ReferenceError::NotFinite { name, value }),
        None => Ok(()),
    }
}

/// Shortest accepted duration of a motion, s. It keeps rates and accelerations far below the overflow limit.
pub(super) const SHORTEST: f64 = 1e-12;
