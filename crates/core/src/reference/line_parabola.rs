//! Straight line with a lateral parabola, the trajectory of the OnOrbitROS paper.

use super::error::check_numbers;
use super::{Hold, ReferenceError, TaskPath, TaskSample, TimeLaw};
use crate::spatial::{Motion, Vec3};
use nalgebra::{Matrix3, Vector3};

/// Line with a lateral parabola, `p(t) = p₀ + s d + s(1 − s) h`, with constant attitude, where `s(t)` is the
/// quintic time law from 0 to 1, `p₀` the start position, `d` the displacement and `h` the coefficient of the
/// parabola, m.
///
/// The motion starts and ends at rest with zero acceleration. The start pose is held before the motion and
/// the end pose after it.
#[derive(Clone, Debug, PartialEq)]
pub struct LineParabola {
    start: Hold,
    displacement: Vec3<f64>,
    height: Vec3<f64>,
    law: TimeLaw,
}

impl LineParabola {
    /// Creates the motion from the pose `(rot_fd, pos_f)` by `displacement` (m) in `duration` (s). `height`
    /// (m) is the coefficient `h` of the parabola, whose lateral offset reaches a quarter of `h` halfway. All
    /// vectors are in the axes of the frame of the reference.
    ///
    /// # Errors
    /// [`ReferenceError`] for an invalid pose, numbers that are not finite or exceed 1e60 in magnitude, or a
    /// duration below 1e-12 s.
    pub fn new(
        rot_fd: Matrix3<f64>,
        pos_f: Vector3<f64>,
        displacement: Vector3<f64>,
        height: Vector3<f64>,
        duration: f64,
    ) -> Result<Self, ReferenceError> {
        Self::from_pose(Hold::new(rot_fd, pos_f)?, displacement, height, duration)
    }

    /// Creates the motion from the pose `start`; other arguments as for [`LineParabola::new`].
    ///
    /// # Errors
    /// The errors of [`LineParabola::new`].
    pub fn from_pose(
        start: Hold,
        displacement: Vector3<f64>,
        height: Vector3<f64>,
        duration: f64,
    ) -> Result<Self, ReferenceError> {
        check_numbers("displacement", &displacement)?;
        check_numbers("height", &height)?;
        let law = TimeLaw::quintic(duration)?;
        Ok(Self { start, displacement: displacement.into(), height: height.into(), law })
    }
}

impl TaskPath for LineParabola {
    fn sample(&self, t: f64) -> TaskSample<f64> {
        let (s, rate, acceleration) = self.law.at(t);
        let (d, h) = (self.displacement, self.height);
        // p = p₀ + s d + s(1−s) h,  dp/ds = d + (1−2s) h,  d²p/ds² = −2 h
        let slope = d + h * (1.0 - 2.0 * s);
        TaskSample {
            rot_wd: self.start.rot_fd,
            pos_w: self.start.pos_f + d * s + h * (s * (1.0 - s)),
            velocity: Motion::new(slope * rate, Vec3::zero()),
            acceleration: Motion::new(slope * acceleration - h * (2.0 * rate * rate), Vec3::zero()),
        }
    }

    fn duration(&self) -> f64 {
        self.law.duration()
    }
}
