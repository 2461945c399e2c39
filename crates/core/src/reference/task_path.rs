//! Interface of a path that a frame of the robot follows.

use super::TaskSample;
use std::fmt::Debug;

/// Path of a frame: a pose with its velocity and acceleration as functions of time, in the axes of a given
/// frame.
///
/// The time of a path starts at zero. To add a kind of path, implement this trait in a new file.
pub trait TaskPath: Send + Sync + Debug {
    /// Returns the desired pose and motion `t` seconds after the start of the path. The first pose is held
    /// before the start, and the last pose after the end.
    fn sample(&self, t: f64) -> TaskSample<f64>;

    /// Returns the time at which the path comes to rest, s. It is 0 for a path that never moves and infinity
    /// for a path that never comes to rest.
    fn duration(&self) -> f64;
}
