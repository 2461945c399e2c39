//! Time laws: progress along a path as a function of time.

use super::error::{SHORTEST, check_numbers};
use super::{ReferenceError, TaskLimits, TaskPath};

/// Time law `s(t)` from 0 to 1 with zero rate and acceleration at both ends; before the start `s` is 0 and
/// after the end it is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeLaw {
    duration: f64,
    /// Fraction of the duration until the constant rate is reached; `None` for the quintic time law.
    ramp: Option<f64>,
}

impl TimeLaw {
    /// Creates the quintic time law with a `duration` in s.
    ///
    /// # Errors
    /// [`ReferenceError::NotFinite`] and [`ReferenceError::DurationNotPositive`] for an invalid duration.
    pub fn quintic(duration: f64) -> Result<Self, ReferenceError> {
        check_numbers("duration", [&duration])?;
        if duration < SHORTEST {
            return Err(ReferenceError::DurationNotPositive { value: duration });
        }
        Ok(Self { duration, ramp: None })
    }

    /// Creates a time law with a constant rate between two ramps, each of which lasts the fraction `ramp` of
    /// `duration` (s).
    ///
    /// # Errors
    /// The errors of [`TimeLaw::quintic`], and [`ReferenceError::Ramp`] for a fraction outside (0, ½].
    pub fn ramped(duration: f64, ramp: f64) -> Result<Self, ReferenceError> {
        let law = Self::quintic(duration)?;
        if !(ramp > 0.0 && ramp <= 0.5) {
            return Err(ReferenceError::Ramp { value: ramp });
        }
        Ok(Self { ramp: Some(ramp), ..law })
    }

    /// Returns the time law of shortest duration with which a path respects `limits`. `path_with` returns the
    /// path for a given time law. The duration has a relative accuracy of 1e-4. `ramp` is the fraction of
    /// [`TimeLaw::ramped`]; `None` selects the quintic time law.
    ///
    /// # Errors
    /// [`ReferenceError::LimitNotPositive`] for an invalid limit, [`ReferenceError::Ramp`] for an invalid
    /// ramp, [`ReferenceError::NoLimit`] if the limits do not determine the duration,
    /// [`ReferenceError::NotFinite`] if a limit is so small that the duration exceeds 1e60 s, and
    /// [`ReferenceError::DurationNotPositive`] if the limits are so large that it is below 1e-12 s.
    pub fn within<P: TaskPath>(
        limits: &TaskLimits,
        ramp: Option<f64>,
        path_with: impl Fn(Self) -> P,
    ) -> Result<Self, ReferenceError> {
        limits.check()?;
        let law = ramp.map_or_else(|| Self::quintic(1.0), |ramp| Self::ramped(1.0, ramp))?;
        let share = ramp.unwrap_or(0.25);
        let duration = limits.stretch(&path_with(law), &[0.0, share, 0.5, 1.0 - share, 1.0]);
        if duration == 0.0 {
            return Err(ReferenceError::NoLimit);
        }
        Ok(Self { ramp, ..Self::quintic(duration)? })
    }

    /// Returns the duration, s.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Returns `s`, 0 to 1, and its first two time derivatives, 1/s and 1/s², `t` seconds after the start.
    pub fn at(&self, t: f64) -> (f64, f64, f64) {
        match self.ramp {
            None => quintic(t, self.duration),
            Some(ramp) => ramped(t, self.duration, ramp * self.duration),
        }
    }
}

/// Returns `s = 10u³ − 15u⁴ + 6u⁵`, with `u = t/T` clamped to 0..1 and the duration `T`, and its first two
/// time derivatives.
fn quintic(t: f64, duration: f64) -> (f64, f64, f64) {
    let per_s = 1.0 / duration;
    let u = (t * per_s).clamp(0.0, 1.0);
    let v = 1.0 - u;
    let s = u * u * u * (10.0 + u * (6.0 * u - 15.0));
    let rate = 30.0 * u * u * v * v * per_s; // 30u² − 60u³ + 30u⁴
    let acceleration = 60.0 * u * v * (v - u) * per_s * per_s; // 60u − 180u² + 120u³
    (s, rate, acceleration)
}

/// Returns the ramped time law and its first two time derivatives: `ṡ = c (3u² − 2u³)` with `u = t/r` on a
/// ramp of duration `r`, and `ṡ = c = 1/(T − r)` between the ramps.
fn ramped(t: f64, duration: f64, ramp: f64) -> (f64, f64, f64) {
    let t = t.clamp(0.0, duration);
    let cruise = 1.0 / (duration - ramp);
    let up = |t: f64| {
        let u = t / ramp;
        let s = cruise * ramp * u * u * u * (1.0 - 0.5 * u); // ∫ 3u² − 2u³
        (s, cruise * u * u * (3.0 - 2.0 * u), cruise * 6.0 * u * (1.0 - u) / ramp)
    };
    if t < ramp {
        up(t)
    } else if t > duration - ramp {
        let (s, rate, acceleration) = up(duration - t);
        (1.0 - s, rate, -acceleration)
    } else {
        (cruise * (t - 0.5 * ramp), cruise, 0.0)
    }
}
