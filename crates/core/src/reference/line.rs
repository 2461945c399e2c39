//! Straight line between two poses.

use super::{Hold, ReferenceError, TaskLimits, TaskPath, TaskSample, TimeLaw};
use crate::spatial::{Mat3, Motion, Vec3, exp_so3, log_rotation};

/// Straight line `p(t) = p₀ + s d` with the attitude `R(t) = exp(s θ) R₀` on a geodesic of SO(3), where
/// `s(t)` is a time law, `p₀` and `R₀` are the position, m, and the attitude at the start, `d` is the
/// displacement, m, and `θ` the rotation vector, rad.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    start: Hold,
    displacement: Vec3<f64>,
    /// Rotation vector in the axes of the reference's frame, rad.
    turn: Vec3<f64>,
    law: TimeLaw,
}

impl Line {
    /// Creates the line from `start` to `end` with the time law `law`. The attitude rotates by the smaller
    /// angle.
    pub fn new(start: Hold, end: &Hold, law: TimeLaw) -> Self {
        let turn = log_rotation(&(end.rot_fd * start.rot_fd.transpose()));
        Self { displacement: end.pos_f - start.pos_f, turn, start, law }
    }

    /// Creates the line from `start` to `end`, from rest to rest, in the shortest time that respects
    /// `limits`.
    ///
    /// # Errors
    /// [`ReferenceError::LimitNotPositive`] for an invalid limit; [`ReferenceError::NoLimit`] if the limits
    /// do not determine a time; the errors of [`TimeLaw::quintic`] for the duration that they determine.
    pub fn within(start: Hold, end: &Hold, limits: &TaskLimits) -> Result<Self, ReferenceError> {
        limits.check()?;
        let mut line = Self::new(start, end, TimeLaw::quintic(1.0)?);
        let (linear, angular) = (line.displacement.norm(), line.turn.norm());
        let duration = limits.linear.time_for(linear).max(limits.angular.time_for(angular));
        if duration == 0.0 {
            return Err(ReferenceError::NoLimit);
        }
        line.law = TimeLaw::quintic(duration)?;
        Ok(line)
    }
}

impl TaskPath for Line {
    fn sample(&self, t: f64) -> TaskSample<f64> {
        let (s, rate, acceleration) = self.law.at(t);
        let rot: Mat3<f64> = exp_so3(self.turn * s).matrix();
        let along = |x: f64| Motion::new(self.displacement * x, self.turn * x);
        TaskSample {
            rot_wd: rot * self.start.rot_fd,
            pos_w: self.start.pos_f + self.displacement * s,
            velocity: along(rate),
            acceleration: along(acceleration),
        }
    }

    fn duration(&self) -> f64 {
        self.law.duration()
    }
}
