//! What can be wrong with a controller.

use thiserror::Error;

/// A controller that cannot work, or that failed while it ran.
#[derive(Debug, Error)]
#[allow(missing_docs)] // the fields are what the messages say
pub enum ControlError {
    #[error("{name} has {got} numbers, expected {expected}")]
    WrongLength { name: &'static str, expected: String, got: usize },
    #[error("{name} holds {value}, it must be finite")]
    NotFinite { name: &'static str, value: f64 },
    #[error("{name} is {value}, it must not be negative")]
    Negative { name: &'static str, value: f64 },
    #[error(
        "frame '{frame}' is moved by {joints} joints: a position and an attitude need at least 6 between it and the base"
    )]
    TooFewJoints { frame: String, joints: usize },
    #[error("the controller returned {value} for joint {joint} at t = {time} s, a torque must be finite")]
    TorqueNotFinite { joint: usize, time: f64, value: f64 },
    /// What a user's controller raised, handed back untouched.
    #[error(transparent)]
    User(Box<dyn std::error::Error + Send + Sync>),
}
