//! How fast a path is gone along.

use super::ReferenceError;

/// `s(t)` from 0 to 1, at rest and without acceleration at both ends; 0 before, 1 after.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeLaw {
    duration: f64,
    /// Time to reach the constant rate, s; the quintic where there is none.
    ramp: Option<f64>,
}

/// Largest rate of the quintic, at half time: `15/8 /T`.
const PEAK_RATE: f64 = 1.875;

/// Largest acceleration of the quintic, at `u = ½ ± √3/6`: `10/√3 /T²`.
const PEAK_ACCELERATION: f64 = 5.773_502_691_896_258;

/// The most a motion may reach: a rate and its derivative, infinite where nothing limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateLimit {
    /// m/s or rad/s.
    pub rate: f64,
    /// m/s² or rad/s².
    pub acceleration: f64,
}

impl RateLimit {
    /// No limit.
    pub const NONE: Self = Self { rate: f64::INFINITY, acceleration: f64::INFINITY };

    /// The least time, s, in which the quintic goes over `distance`: `max(15/8 d/v, √(10/√3 d/a))`.
    pub fn time_for(&self, distance: f64) -> f64 {
        (PEAK_RATE * distance / self.rate).max((PEAK_ACCELERATION * distance / self.acceleration).sqrt())
    }
}

impl TimeLaw {
    /// The quintic over `duration`, s.
    ///
    /// # Errors
    /// [`ReferenceError::NotFinite`], [`ReferenceError::DurationNotPositive`].
    pub fn quintic(duration: f64) -> Result<Self, ReferenceError> {
        if !duration.is_finite() {
            return Err(ReferenceError::NotFinite { name: "duration" });
        }
        if duration <= 0.0 {
            return Err(ReferenceError::DurationNotPositive { value: duration });
        }
        Ok(Self { duration, ramp: None })
    }

    /// A constant rate between two ramps of `ramp` seconds, all in `duration`, s.
    ///
    /// # Errors
    /// As [`TimeLaw::quintic`]; [`ReferenceError::Ramp`] for a ramp longer than half of it.
    pub fn ramped(duration: f64, ramp: f64) -> Result<Self, ReferenceError> {
        let law = Self::quintic(duration)?;
        if !(ramp > 0.0 && ramp <= 0.5 * duration) {
            return Err(ReferenceError::Ramp { value: ramp, longest: 0.5 * duration });
        }
        Ok(Self { ramp: Some(ramp), ..law })
    }

    /// When it comes to rest, s.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// `s` and its first two derivatives in time.
    pub fn at(&self, t: f64) -> (f64, f64, f64) {
        match self.ramp {
            None => quintic(t, self.duration),
            Some(ramp) => ramped(t, self.duration, ramp),
        }
    }
}

/// `s = 10u³ − 15u⁴ + 6u⁵` with `u = t/T` kept in 0..1.
fn quintic(t: f64, duration: f64) -> (f64, f64, f64) {
    let per_s = 1.0 / duration;
    let u = (t * per_s).clamp(0.0, 1.0);
    let v = 1.0 - u;
    let s = u * u * u * (10.0 + u * (6.0 * u - 15.0));
    let rate = 30.0 * u * u * v * v * per_s; // 30u² − 60u³ + 30u⁴
    let acceleration = 60.0 * u * v * (v - u) * per_s * per_s; // 60u − 180u² + 120u³
    (s, rate, acceleration)
}

/// `ṡ = c (3u² − 2u³)` with `u = t/r` on the ramp, `ṡ = c = 1/(T − r)` between the ramps.
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
