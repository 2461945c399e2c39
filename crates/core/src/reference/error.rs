//! What can be wrong with a reference.

use crate::orbit::OrbitError;

/// A reference that makes no sense.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // the fields are what the messages say
pub enum ReferenceError {
    #[error("{name} of the reference is not finite")]
    NotFinite { name: &'static str },
    #[error("duration of the reference is {value} s, it must be positive")]
    DurationNotPositive { value: f64 },
    #[error(
        "ramp of the reference is {value} s, it must be above 0 and at most half the duration, {longest} s"
    )]
    Ramp { value: f64, longest: f64 },
    #[error(
        "rotation of the reference pose is not a rotation: RᵀR differs from 1 by {error}, at most 1e-6 is accepted"
    )]
    NotARotation { error: f64 },
    #[error("the reference is given in the frame of an orbit: {0}")]
    Orbit(#[from] OrbitError),
}
