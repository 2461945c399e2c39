//! How fast a motion may be.

use super::{JointPath, JointSample, ReferenceError, TaskPath};

/// The most a motion may reach: a rate and its derivative, infinite where nothing limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateLimit {
    /// m/s or rad/s.
    pub rate: f64,
    /// m/s² or rad/s².
    pub acceleration: f64,
}

/// Largest rate of the quintic, at half time: `15/8 /T`.
const PEAK_RATE: f64 = 1.875;

/// Largest acceleration of the quintic, at `u = ½ ± √3/6`: `10/√3 /T²`.
const PEAK_ACCELERATION: f64 = 5.773_502_691_896_258;

/// Instants at which a piece is looked at for its peaks; what lies between them, less than
/// [`MARGIN`] of a peak, is added.
const LOOKS: usize = 400;
const MARGIN: f64 = 1e-4;

impl RateLimit {
    /// No limit.
    pub const NONE: Self = Self { rate: f64::INFINITY, acceleration: f64::INFINITY };

    /// The least time, s, in which the quintic goes over `distance`: `max(15/8 d/v, √(10/√3 d/a))`.
    pub fn time_for(&self, distance: f64) -> f64 {
        (PEAK_RATE * distance / self.rate).max((PEAK_ACCELERATION * distance / self.acceleration).sqrt())
    }

    /// Whether both numbers are positive.
    ///
    /// # Errors
    /// [`ReferenceError::LimitNotPositive`].
    pub(super) fn check(&self) -> Result<(), ReferenceError> {
        match [self.rate, self.acceleration].into_iter().find(|x| x.is_nan() || *x <= 0.0) {
            Some(value) => Err(ReferenceError::LimitNotPositive { value }),
            None => Ok(()),
        }
    }

    /// By how much a motion with these peaks must be slower: time stretched by `k` divides rates by
    /// `k` and accelerations by `k²`.
    fn stretch(&self, rate: f64, acceleration: f64) -> f64 {
        (rate / self.rate).max((acceleration / self.acceleration).sqrt())
    }
}

/// Limits of a frame's motion: linear and angular.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaskLimits {
    /// Of the origin, m/s and m/s².
    pub linear: RateLimit,
    /// Of the attitude, rad/s and rad/s².
    pub angular: RateLimit,
}

impl TaskLimits {
    /// Whether all four are positive.
    ///
    /// # Errors
    /// [`ReferenceError::LimitNotPositive`].
    pub(super) fn check(&self) -> Result<(), ReferenceError> {
        self.linear.check()?;
        self.angular.check()
    }

    /// By how much `path`, smooth between neighbouring `times`, must be slower to just keep to the limits.
    pub fn stretch(&self, path: &dyn TaskPath, times: &[f64]) -> f64 {
        let peak = instants(times).map(|t| path.sample(t)).fold(0.0, |peak: f64, now| {
            let (v, a) = (now.velocity, now.acceleration);
            peak.max(self.linear.stretch(v.linear.norm(), a.linear.norm()))
                .max(self.angular.stretch(v.angular.norm(), a.angular.norm()))
        });
        peak * (1.0 + MARGIN)
    }
}

/// By how much `path`, smooth between neighbouring `times`, must be slower for every joint to just keep to
/// its limit.
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

/// Instants in every piece between neighbouring `times`.
fn instants(times: &[f64]) -> impl Iterator<Item = f64> {
    let piece = |ends: &[f64]| {
        let (from, length) = (ends[0], ends[1] - ends[0]);
        (0..=LOOKS).map(move |i| from + length * i as f64 / LOOKS as f64)
    };
    times.windows(2).flat_map(piece)
}

/// How a path's times come about.
#[derive(Clone, Debug, PartialEq)]
pub enum Timing<T, L> {
    /// Given, s: a duration, or the time of each point.
    Given(T),
    /// As short as the limits allow.
    Limits(L),
}
