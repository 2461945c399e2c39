//! Reference motion of a frame of the robot: a path and the frame in which it is given.

use super::frame::lvlh_motion;
use super::{MovingFrame, ReferenceError, ReferenceFrame, TaskPath, TaskSample};
use crate::spatial::{Mat3, Vec3, log_rotation};
use std::sync::Arc;

/// Reference of a frame: a path and the frame in which it is given.
#[derive(Clone, Debug)]
pub struct TaskReference {
    /// Path, in the axes and about the origin of `frame`.
    pub path: Arc<dyn TaskPath>,
    /// Frame that gives the axes and the origin of `path`.
    pub frame: ReferenceFrame,
}

impl<P: TaskPath + 'static> From<P> for TaskReference {
    /// Creates a reference whose path is given in W.
    fn from(path: P) -> Self {
        Self { path: Arc::new(path), frame: ReferenceFrame::World }
    }
}

impl TaskReference {
    /// Returns the desired motion at simulation time `t`, s, on a path that starts at `start`, s. The motion
    /// is in W axes, or in base axes if [`TaskReference::is_relative_to_base`] returns true. For a frame of
    /// another system, the present motion of that frame is used.
    ///
    /// # Errors
    /// [`ReferenceError::Orbit`] if the local orbital frame L is not defined at `t`.
    pub fn sample(&self, t: f64, start: f64) -> Result<TaskSample<f64>, ReferenceError> {
        let inner = self.path.sample(t - start);
        Ok(match &self.frame {
            ReferenceFrame::World | ReferenceFrame::Base => inner,
            ReferenceFrame::Lvlh(orbit) => lvlh_motion(&**orbit, t)?.carry(&inner),
            ReferenceFrame::Target(target) => target.sample(t).carry(&inner),
            ReferenceFrame::System(moving) => moving.motion().carry(&inner),
        })
    }

    /// Returns true if the samples are relative to the robot's base, in base axes.
    pub fn is_relative_to_base(&self) -> bool {
        matches!(self.frame, ReferenceFrame::Base)
    }

    /// Returns the frame in which the reference is given if it belongs to another system, otherwise `None`.
    pub fn moving_frame(&self) -> Option<&MovingFrame> {
        match &self.frame {
            ReferenceFrame::System(moving) => Some(moving),
            _ => None,
        }
    }

    /// Returns true if the reference is given in a local orbital frame, whose motion depends on an orbit.
    pub fn needs_orbit(&self) -> bool {
        matches!(self.frame, ReferenceFrame::Lvlh(_))
    }

    /// Returns the time from the start of the path until it comes to rest in the frame of the reference, s.
    pub fn duration(&self) -> f64 {
        self.path.duration()
    }

    /// Returns the distance, m, and the angle, rad, between a frame with the pose `(rot, pos)` and the start
    /// of the reference at the time `start`, s. The pose is relative to the base, in base axes, if
    /// [`TaskReference::is_relative_to_base`] returns true; otherwise it is in W.
    ///
    /// # Errors
    /// The errors of [`TaskReference::sample`].
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
