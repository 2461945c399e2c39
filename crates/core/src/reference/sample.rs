//! One instant of a reference.

use crate::spatial::{Mat3, Motion, Real, Vec3, pose_rows};

/// Desired pose, velocity and acceleration of a frame, in W axes at its origin.
#[derive(Clone, Copy, Debug)]
pub struct TaskSample<S> {
    /// Takes the desired frame's components to W.
    pub rot_wd: Mat3<S>,
    /// Origin, m.
    pub pos_w: Vec3<S>,
    /// Velocity, m/s and rad/s.
    pub velocity: Motion<S>,
    /// Acceleration, m/s² and rad/s².
    pub acceleration: Motion<S>,
}

impl<S: Real> TaskSample<S> {
    /// At rest at a pose.
    #[inline(always)]
    pub fn at_rest(rot_wd: Mat3<S>, pos_w: Vec3<S>) -> Self {
        Self { rot_wd, pos_w, velocity: Motion::zero(), acceleration: Motion::zero() }
    }
}

impl TaskSample<f64> {
    /// The pose as a row-major `(4, 4)` matrix.
    pub fn pose_rows(&self) -> [f64; 16] {
        pose_rows(&self.rot_wd, self.pos_w)
    }
}
