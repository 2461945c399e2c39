//! Input of a user-defined controller.

use crate::model::Model;
use crate::reference::TaskSample;

/// State of the robot at a control tick, with the joints to drive and the desired motion of the tracked
/// frame.
#[derive(Clone, Copy, Debug)]
pub struct Observation<'a> {
    /// Simulation time, s.
    pub time: f64,
    /// Configuration, `(nq,)`, m and rad.
    pub q: &'a [f64],
    /// Velocity, `(nv,)`, m/s and rad/s.
    pub v: &'a [f64],
    /// Model of the robot.
    pub model: &'a Model,
    /// Indices of the joints to drive, in the order of the torques.
    pub joints: &'a [usize],
    /// Desired pose and motion of the tracked frame, relative to the base if the reference is, otherwise in
    /// W; `None` if the controller has no reference.
    pub desired: Option<TaskSample<f64>>,
}
