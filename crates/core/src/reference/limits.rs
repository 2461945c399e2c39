//! Limits of rates and accelerations of a motion.

use super::{JointPath, JointSample, ReferenceError, TaskPath};

/// Limits of a rate and of its derivative; infinity means no limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateLimit {
    /// Largest rate, m/s or rad/s.
    pub rate: f64,
    /// Largest acceleration, m/s² or rad/s².
    pub acceleration: f64,
}

/// Largest rate of the quintic multiplied by the duration, `15/8`; it occurs at half the duration.
const PEAK_RATE: f64 = 1.875;

/// Largest acceleration of the quintic multiplied by the squared duration, `10/√3`; it occurs at `u = ½ ± √3/6`.
const PEAK_ACCELERATION: f64 = 5.773_502_691_896_258;

/// Number of instants per piece at which peaks are searched. Peaks between these instants exceed the found ones by a
/// fraction of less than [`MARGIN`], which is added to the result.
const LOOKS: usize = 400;
const MARGIN: f64 = 1e-4;

impl RateLimit {
    /// No limit on rate and acceleration.
    pub const NONE: Self = Self { rate: f64::INFINITY, acceleration: f64::INFINITY };

    /// Returns the shortest time, s, of the quintic over `distance`: `max(15/8 d/v, √(10/√3 d/a))`.
    pub fn time_for(&self, distance: f64) -> f64 {
        (PEAK_RATE * distance / self.rate).max((PEAK_ACCELERATION * distance / self.acceleration).sqrt())
    }

    /// Checks that both limits are positive, possibly infinite; `names` are those of the rate and the acceleration in
    /// messages.
    ///
    /// # Errors
    /// [`ReferenceError::LimitNotPositive`].
    fn check(&self, names: [&str; 2]) -> Result<(), ReferenceError> {
        let mut limits = names.into_iter().zip([self.rate, self.acceleration]);
        match limits.find(|(_, x)| x.is_nan() || *x <= 0.0) {
            Some((name, value)) => Err(ReferenceError::LimitNotPositive { name: name.to_owned(), value }),
            None => Ok(()),
        }
    }

    /// Returns the factor by which the duration of a motion with the peaks `rate` and `acceleration` must grow. A
    /// factor `k` divides rates by `k` and accelerations by `k²`.
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
    /// [`ReferenceError::LimitNotPositive`].
    pub(super) fn check(&self) -> Result<(), ReferenceError> {
        self.linear.check(["speed", "acceleration"])?;
        self.angular.check(["angular_speed", "angular_acceleration"])
    }

    /// Returns the factor by which the duration of `path`, smooth between neighbouring `times`, must grow to
    /// respect the limits.
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
/// [`ReferenceError::LimitNotPositive`].
pub(super) fn check_joint_limits(limits: &[RateLimit]) -> Result<(), ReferenceError> {
    let check = |(j, limit): (usize, &RateLimit)| {
        limit.check([format!("speed[{j}]").as_str(), format!("acceleration[{j}]").as_str()])
    };
    limits.iter().enumerate().try_for_each(check)
}

/// Returns the factor by which the duration of `path`, smooth between neighbouring `times`, must grow for all
/// joints to respect their limits.
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

/// Returns the instants in each piece between neighbouring `times`.
fn instants(times: &[f64]) -> impl Iterator<Item = f64> {
    let piece = |ends: &[f64]| {
        let (from, length) = (ends[0], ends[1] - ends[0]);
        (0..=LOOKS).map(move |i| from + length * i as f64 / LOOKS as f64)
    };
    times.windows(2).flat_map(piece)
}

/// Timing of a path.
#[derive(Clone, Debug, PartialEq)]
pub enum Timing<T, L> {
    /// Given times, s: a duration, or the time of each point.
    Given(T),
    /// The shortest times that respect the limits.
    Limits(L),
}
