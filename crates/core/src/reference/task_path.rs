//! Interface of a path that a frame of the robot follows.

use super::TaskSample;
use std::fmt::Debug;

/// Path of a frame: a pose with its velocity and acceleration as functions of time, in the axes of a frame.
///
/// The time of a path starts at zero. A new kind of path is one file with one `impl`.
pub trait TaskPath: Send + Sync + Debug {
    /// Returns the desired pose and motion at `t`, s since the start of the path; outside `0..duration` the
    /// first or last pose is held.
    fn sample(&self, t: f64) -> TaskSample<f64>;

    /// Returns the time at which the path comes to rest, s: 0 if it never moves, infinity if it never comes
    /// to rest.
    fn duration(&self) -> f64;
}
