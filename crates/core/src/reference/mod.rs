//! Reference motions of a tool or of joints: consistent positions, velocities and accelerations as functions
//! of time.
//!
//! References are evaluated in `f64` once per instant, because all lanes share the time, and are then
//! [copied](TaskSample::lift) to the lanes. A path of a frame is a [`TaskPath`], given in one of five
//! [frames](ReferenceFrame). A path of joints is a [`JointPath`].

mod error;
mod frame;
mod hold;
mod joint;
mod joint_spline;
mod limits;
mod line;
mod line_parabola;
mod pose_spline;
mod sample;
mod screw;
mod table;
mod task;
mod task_path;
mod time_law;

pub use error::ReferenceError;
pub use frame::{MovingFrame, ReferenceFrame, Target};
pub use hold::Hold;
pub use joint::{JointHold, JointPath, JointReference, JointSample, joint_start_offset};
pub use joint_spline::JointSpline;
pub use limits::{RateLimit, TaskLimits, Timing};
pub use line::Line;
pub use line_parabola::LineParabola;
pub use pose_spline::PoseSpline;
pub use sample::TaskSample;
pub use screw::Screw;
pub use table::{joint_table, task_table};
pub use task::TaskReference;
pub use task_path::TaskPath;
pub use time_law::TimeLaw;
