//! What a frame of the robot should follow.

use super::frame::lvlh_motion;
use super::{ReferenceError, ReferenceFrame, TaskSample};
use crate::spatial::{Mat3, Vec3, log_rotation};
use std::fmt::Debug;
use std::sync::Arc;

/// A pose with its velocity and acceleration as functions of time, in the axes of a frame.
///
/// The clock of a path starts at zero. A new kind is one file with one `impl`.
pub trait TaskPath: Send + Sync + Debug {
    /// Where the frame should be at `t`, s since the path began; the ends are held outside.
    fn sample(&self, t: f64) -> TaskSample<f64>;

    /// When it comes to rest, s; 0 for one that never moves, infinite for one that never rests.
    fn duration(&self) -> f64;
}

/// A path and the frame it is given in.
#[derive(Clone, Debug)]
pub struct TaskReference {
    /// The path.
    pub path: Arc<dyn TaskPath>,
    /// Whose axes and origin the path has.
    pub frame: ReferenceFrame,
}

impl<P: TaskPath + 'static> From<P> for TaskReference {
    /// In W.
    fn from(path: P) -> Self {
        Self { path: Arc::new(path), frame: ReferenceFrame::World }
    }
}

impl TaskReference {
    /// Where the frame should be at `t`, s of simulation, on a path begun at `start`: in W axes, or in
    /// those of the base where [`TaskReference::is_relative_to_base`].
    ///
    /// # Errors
    /// [`ReferenceError::Orbit`] where L is not defined; no other frame can fail.
    pub fn sample(&self, t: f64, start: f64) -> Result<TaskSample<f64>, ReferenceError> {
        let inner = self.path.sample(t - start);
        Ok(match &self.frame {
            ReferenceFrame::World | ReferenceFrame::Base => inner,
            ReferenceFrame::Lvlh(orbit) => lvlh_motion(&**orbit, t)?.carry(&inner),
            ReferenceFrame::Target(target) => target.sample(t).carry(&inner),
        })
    }

    /// Whether samples are relative to the robot's base.
    pub fn is_relative_to_base(&self) -> bool {
        matches!(self.frame, ReferenceFrame::Base)
    }

    /// Whether samples need an orbit.
    pub fn needs_orbit(&self) -> bool {
        matches!(self.frame, ReferenceFrame::Lvlh(_))
    }

    /// When the path comes to rest in its frame, s since it began.
    pub fn duration(&self) -> f64 {
        self.path.duration()
    }

    /// How far a frame at `(rot, pos)` is from the reference's first instant, begun at `start`: m, rad.
    ///
    /// # Errors
    /// As [`TaskReference::sample`].
    pub fn start_offset(
        &self,
        rot: &Mat3<f64>,
        pos: Vec3<f64>,
        start: f64,
    ) -> Result<(f64, f64), ReferenceError> {
        let desired = self.sample(start, start)?;
        let turn = log_rotation(&(desired.rot_wd * rot.transpose()));
        Ok(((desired.pos_w - pos).norm(), turn.norm()))
    }
}
