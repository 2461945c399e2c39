//! Circles and screw motions.

use super::error::check_numbers;
use super::{Hold, ReferenceError, TaskLimits, TaskPath, TaskSample, TimeLaw, Timing};
use crate::spatial::{Mat3, Motion, Vec3, exp_so3};
use nalgebra::Vector3;

/// Screw motion `p(t) = c + exp(s θ u)(p₀ − c) + s d u`, with `R(t) = exp(s θ u) R₀` or constant attitude,
/// where `s(t)` is a time law, `p₀` and `R₀` are the position, m, and the attitude at the start, `c` is a
/// point on the axis, m, `u` the unit vector of the axis, `θ` the angle, rad, and `d` the advance, m.
///
/// If the attitude rotates, the motion is the exponential of a twist on SE(3). Without advance `d`, the path
/// is a circle.
#[derive(Clone, Debug, PartialEq)]
pub struct Screw {
    start: Hold,
    center: Vec3<f64>,
    axis: Vec3<f64>,
    angle: f64,
    advance: f64,
    turns: bool,
    law: TimeLaw,
}

impl Screw {
    /// Creates the motion from `start` about the line through `center` (m) along `axis` (length 1e-9 or
    /// more), by `angle` (rad, right-handed, of any magnitude) and, along the axis, by `advance` (m). The
    /// attitude rotates with the motion if `turns` is true; otherwise it is constant.
    ///
    /// # Errors
    /// [`ReferenceError::NotFinite`] for numbers that are not finite or exceed 1e60 in magnitude;
    /// [`ReferenceError::NoAxis`] for an axis that is too short.
    pub fn new(
        start: Hold,
        center: Vector3<f64>,
        axis: Vector3<f64>,
        angle: f64,
        advance: f64,
        turns: bool,
        law: TimeLaw,
    ) -> Result<Self, ReferenceError> {
        check_numbers("center", &center)?;
        check_numbers("axis", &axis)?;
        check_numbers("angle", [&angle])?;
        check_numbers("advance", [&advance])?;
        let length = axis.norm();
        if length < 1e-9 {
            return Err(ReferenceError::NoAxis { length });
        }
        let axis = (axis / length).into();
        Ok(Self { start, center: center.into(), axis, angle, advance, turns, law })
    }

    /// Creates the motion of [`Screw::new`] with a given duration, s, or with the shortest duration that
    /// respects given limits. `ramp` is the fraction of [`TimeLaw::ramped`]; `None` selects the quintic time
    /// law.
    ///
    /// # Errors
    /// The errors of [`Screw::new`] and of the constructors of [`TimeLaw`].
    pub fn timed(
        start: Hold,
        center: Vector3<f64>,
        axis: Vector3<f64>,
        angle: f64,
        advance: f64,
        turns: bool,
        timing: &Timing<f64, TaskLimits>,
        ramp: Option<f64>,
    ) -> Result<Self, ReferenceError> {
        let mut screw = Self::new(start, center, axis, angle, advance, turns, TimeLaw::quintic(1.0)?)?;
        screw.law = match (timing, ramp) {
            (Timing::Given(duration), None) => TimeLaw::quintic(*duration)?,
            (Timing::Given(duration), Some(ramp)) => TimeLaw::ramped(*duration, ramp)?,
            (Timing::Limits(limits), ramp) => TimeLaw::within(limits, ramp, |law| screw.with_law(law))?,
        };
        Ok(screw)
    }

    /// Returns the same path with a different time law.
    #[must_use]
    pub fn with_law(&self, law: TimeLaw) -> Self {
        Self { law, ..self.clone() }
    }
}

impl TaskPath for Screw {
    fn sample(&self, t: f64) -> TaskSample<f64> {
        let (s, rate, acceleration) = self.law.at(t);
        let (u, rot): (_, Mat3<f64>) = (self.axis, exp_so3(self.axis * (self.angle * s)).matrix());
        let (omega, alpha) = (u * (self.angle * rate), u * (self.angle * acceleration));
        let arm = rot * (self.start.pos_f - self.center);
        // ṗ = ω × r + d ṡ u,  p̈ = α × r + ω × (ω × r) + d s̈ u
        let swept = omega.cross(arm);
        let velocity = swept + u * (self.advance * rate);
        let linear = alpha.cross(arm) + omega.cross(swept) + u * (self.advance * acceleration);
        let (rot_wd, omega, alpha) = match self.turns {
            true => (rot * self.start.rot_fd, omega, alpha),
            false => (self.start.rot_fd, Vec3::zero(), Vec3::zero()),
        };
        TaskSample {
            rot_wd,
            pos_w: self.center + arm + u * (self.advance * s),
            velocity: Motion::new(velocity, omega),
            acceleration: Motion::new(linear, alpha),
        }
    }

    fn duration(&self) -> f64 {
        self.law.duration()
    }
}
