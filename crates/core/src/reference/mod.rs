//! What a tool or the joints should follow: positions, velocities and accelerations that agree, as
//! functions of time.
//!
//! All lanes share the time, so that references are evaluated in `f64`, once per instant, and
//! [lifted](TaskSample::lift). A path of a frame is a [`TaskPath`], in one of four
//! [frames](ReferenceFrame); a path of joints is a [`JointPath`].

mod error;
mod frame;
mod hold;
mod joint;
mod line_parabola;
mod sample;
mod task;
mod time_law;

pub use error::ReferenceError;
pub use frame::{ReferenceFrame, Target};
pub use hold::Hold;
pub use joint::{JointHold, JointPath, JointReference, JointSample, joint_start_offset};
pub use line_parabola::LineParabola;
pub use sample::TaskSample;
pub use task::{TaskPath, TaskReference};
pub use time_law::{RateLimit, TimeLaw};
