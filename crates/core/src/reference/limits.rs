//! Limits of the rates and accelerations of a motion.

use super::{JointPath, JointSample, ReferenceError, TaskPath};

/// Limits of a rate and of its time derivative; infinity means no limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateLimit {
    /// Largest rate, m/s or rad/s.
    pub rate: f64,
    /// Largest acceleration, m/s² or rad/s².
    pub acceleration: f64,
}

/// Largest rate of the quintic over a unit distance, multiplied by the duration: `15/8`, at half the
/// duration.
const PEAK_RATE: f64 = 1.875;

/// Largest acceleration of the quintic over a unit distance, multiplied by the squared duration: `10/√3`, at
/// `u = ½ ± √3/6`.
const PEAK_ACCELERATION: f64 = 5.773_502_691_896_258;

/// Number of intervals into which each piece is divided in the search for peaks. Peaks between the instants
/// of the search exceed the peaks found by a fraction of less than [`MARGIN`]; the result is therefore
/// increased by this fraction.
const LOOKS: usize = 400;
const MARGIN: f64 = 1e-4;

impl RateLimit {
    /// No limit on rate and acceleration.
    pub const NONE: Self = Self { rate: f64::INFINITY, acceleration: f64::INFINITY };

    /// Returns the shortest duration, s, of the quintic over the distance `d` (`distance`), m or rad:
    /// `max(15/8 d/v, √(10/√3 d/a))` with the limits `v` of the rate and `a` of the acceleration.
    pub fn time_for(&self, distance: f64) -> f64 {
        (PEAK_RATE * distance / self.rate).max((PEAK_ACCELERATION * distance / self.acceleration).sqrt())
    }

    /// Checks that both limits are positive; they may be infinite. `names` are the names that messages use
    /// for the limits of the rate and of the acceleration.
    ///
    /// # Errors
    /// [`ReferenceError::LimitNotPositive`] for the first invalid limit.
    fn check(&self, names: [&str; 2]) -> Result<(), ReferenceError> {
        let mut limits = names.into_iter().zip([self.rate, self.acceleration]);
        match limits.find(|(_, x)| x.is_nan() || *x <= 0.0) {
            Some((name, value)) => Err(ReferenceError::LimitNotPositive { name: name.to_owned(), value }),
            None => Ok(()),
        }
    }

    /// Returns the factor by which the duration of a motion with the peak values `rate` and `acceleration`
    /// must be multiplied to respect the limits. A factor `k` divides rates by `k` and accelerations by `k²`.
    fn stretch(&self, rate: f64, acceleration: f64) -> f64 {
        (rate / self.rate).max((acceleration / self.acceleration).sqrt())
    }
}

/// Limits of the motion of a frame: linear and angular.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaskLimits {
    /// Limits of the velocity and acceleration of the origin, m/s and m/s².
    pub linear: RateLimit,
    /// Limits of the angular velocity and angular acceleration, rad/s and rad/s².
    pub angular: RateLimit,
}

impl TaskLimits {
    /// Checks that all four limits are positive.
    ///
    /// # Errors
    /// [`ReferenceError::LimitNotPositive`] for the first invalid limit.
    pub(super) fn check(&self) -> Result<(), ReferenceError> {
        self.linear.check(["speed", "acceleration"])?;
        self.angular.check(["angular_speed", "angular_acceleration"])
    }

    /// Returns the factor by which the duration of `path` must be multiplied to respect the limits; it is
    /// below 1 for a path that may be faster. The path must be smooth between successive `times`, s.
    pub fn stretch(&self, path: &dyn TaskPath, times: &[f64]) -> f64 {
        let peak = instants(times).map(|t| path.sample(t)).fold(0.0, |peak: f64, now| {
            let (v, a) = (now.velocity, now.acceleration);
            peak.max(self.linear.stretch(v.linear.norm(), a.linear.norm()))
                .max(self.angular.stretch(v.angular.norm(), a.angular.norm()))
        });
        peak * (1.0 + MARGIN)
    }
}

/// Checks that the limits of all joints are positive.
///
/// # Errors
/// [`ReferenceError::LimitNotPositive`] for the first invalid limit.
pub(super) fn check_joint_limits(limits: &[RateLimit]) -> Result<(), ReferenceError> {
    let check = |(j, limit): (usize, &RateLimit)| {
        limit.check([format!("speed[{j}]").as_str(), format!("acceleration[{j}]").as_str()])
    };
    limits.iter().enumerate().try_for_each(check)
}

/// Returns the factor by which the duration of `path` must be multiplied so that all joints respect their
/// limits; it is below 1 for a path that may be faster. The path must be smooth between successive `times`,
/// s.
pub(super) fn joint_stretch(limits: &[RateLimit], path: &dyn JointPath, times: &[f64]) -> f64 {
    let mut now = JointSample::new(path.count());
    let mut peak = 0.0_f64;
    for t in instants(times) {
        path.sample(t, &mut now);
        for (limit, (v, a)) in limits.iter().zip(now.v.iter().zip(&now.a)) {
            peak = peak.max(limit.stretch(v.abs(), a.abs()));
        }
    }
    peak * (1.0 + MARGIN)
}

/// Returns the instants, s, at which each piece between successive `times` is evaluated.
fn instants(times: &[f64]) -> impl Iterator<Item = f64> {
    let piece = |ends: &[f64]| {
        let (from, length) = (ends[0], ends[1] - ends[0]);
        (0..=LOOKS).map(move |i| from + length * i as f64 / LOOKS as f64)
    };
    times.windows(2).flat_map(piece)
}

/// Timing of a path: given times, or limits that determine the times.
#[derive(Clone, Debug, PartialEq)]
pub enum Timing<T, L> {
    /// Given times, s: a duration, or the time of each point.
    Given(T),
    /// Limits, which determine the times.
    Limits(L),
}
