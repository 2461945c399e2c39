//! What a tool should follow: pose, velocity and acceleration as functions of time, in W axes.
//!
//! Kinds are plain data and generic over the scalar; [`TaskReference`] lists them.

mod hold;
mod line_parabola;
mod sample;

pub use hold::Hold;
pub use line_parabola::LineParabola;
pub use sample::TaskSample;

use crate::spatial::Real;

/// A reference for a frame of the robot; a new kind is one file and one line here.
#[derive(Clone, Debug, PartialEq)]
pub enum TaskReference {
    /// Stay.
    Hold(Hold),
    /// A straight line with a parabola across it.
    LineParabola(LineParabola),
}

impl TaskReference {
    /// Where the frame should be at the time `t`, s.
    #[inline(always)]
    pub fn sample<S: Real>(&self, t: S) -> TaskSample<S> {
        match self {
            Self::Hold(hold) => hold.sample(),
            Self::LineParabola(line) => line.sample(t),
        }
    }
}

/// A reference that makes no sense.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // the fields are what the messages say
pub enum ReferenceError {
    #[error("{name} of the reference is not finite")]
    NotFinite { name: &'static str },
    #[error("duration of the reference is {value} s, it must be positive")]
    DurationNotPositive { value: f64 },
    #[error(
        "rotation of the reference pose is not a rotation: RᵀR differs from 1 by {error}, at most 1e-6 is accepted"
    )]
    NotARotation { error: f64 },
}
