//! Splines through joint positions.

use super::limits::{check_joint_limits, joint_stretch};
use super::pose_spline::rest_times;
use super::{JointPath, JointSample, RateLimit, ReferenceError, Timing};
use crate::spatial::{Ends, Spline};

/// Quintic splines through joint positions, which are waypoints or samples of a motion. All joints reach a
/// point at the same time.
#[derive(Clone, Debug, PartialEq)]
pub struct JointSpline {
    spline: Spline,
}

impl JointSpline {
    /// Creates the motion of `count` joints from rest to rest through `points`, `(K, count)`, rad or m. The
    /// joints also stop at the inner points if `stops` is true.
    ///
    /// If limits are given, one per joint, they determine the times. With stops, each piece has the shortest
    /// duration that respects the limits. Without stops, the times of all pieces are scaled by a common
    /// factor such that the whole path respects the limits.
    ///
    /// # Errors
    /// [`ReferenceError`] for fewer than two points, wrong lengths, numbers that are not finite or exceed
    /// 1e60 in magnitude, times that do not increase, and limits that are not positive or do not determine
    /// the times; with limits, also for successive points that coincide.
    pub fn waypoints(
        count: usize,
        points: &[f64],
        timing: &Timing<Vec<f64>, Vec<RateLimit>>,
        stops: bool,
    ) -> Result<Self, ReferenceError> {
        let through = |times: &[f64]| {
            let spline = match stops {
                true => Spline::resting(times, count, points),
                false => Spline::interpolating(times, count, points, Ends::Rest),
            };
            Ok(Self { spline: spline? })
        };
        match timing {
            Timing::Given(times) => through(times),
            Timing::Limits(limits) => {
                if limits.len() != count {
                    let (name, got) = ("limits", limits.len());
                    return Err(ReferenceError::WrongLength { name, expected: count, got });
                }
                check_joint_limits(limits)?;
                let rows: Vec<&[f64]> = points.chunks_exact(count.max(1)).collect();
                let mut times = rest_times(&rows, |a, b| {
                    let joints = a.iter().zip(*b).zip(limits);
                    joints.map(|((a, b), limit)| limit.time_for((b - a).abs())).fold(0.0, f64::max)
                })?;
                let path = through(&times)?;
                if stops {
                    return Ok(path);
                }
                let stretch = joint_stretch(limits, &path, &times);
                times.iter_mut().for_each(|t| *t *= stretch);
                through(&times)
            }
        }
    }

    /// Creates a motion that starts at `start` (n,) and moves one joint after the other. Each element of
    /// `moves` moves a joint to a position, rad or m, from rest to rest, while the other joints are held.
    ///
    /// # Errors
    /// The errors of [`JointSpline::waypoints`]; [`ReferenceError::NoJoint`] for a joint that does not exist.
    pub fn one_by_one(
        start: &[f64],
        moves: &[(usize, f64)],
        timing: &Timing<Vec<f64>, Vec<RateLimit>>,
    ) -> Result<Self, ReferenceError> {
        let (mut now, mut points) = (start.to_vec(), start.to_vec());
        for &(joint, goal) in moves {
            *now.get_mut(joint).ok_or(ReferenceError::NoJoint { joint, count: start.len() })? = goal;
            points.extend_from_slice(&now);
        }
        Self::waypoints(start.len(), &points, timing, true)
    }

    /// Creates the spline through K samples of the motion of `count` joints at `times`, `(K,)`, s:
    /// `positions`, `(K, count)`, rad or m, and `rates`, `(K, count)`, rad/s or m/s, or `None` if the rates
    /// are not known. The first positions are held before the first time, and the last positions after the
    /// last time.
    ///
    /// # Errors
    /// [`ReferenceError`] for fewer than two samples, wrong lengths, numbers that are not finite or exceed
    /// 1e60 in magnitude, or times that do not increase.
    pub fn sampled(
        count: usize,
        times: &[f64],
        positions: &[f64],
        rates: Option<&[f64]>,
    ) -> Result<Self, ReferenceError> {
        let spline = match rates {
            None => Spline::interpolating(times, count, positions, Ends::Free),
            Some(rates) => Spline::with_slopes(times, count, positions, rates),
        };
        Ok(Self { spline: spline? })
    }
}

impl JointPath for JointSpline {
    fn count(&self) -> usize {
        self.spline.width()
    }

    fn sample(&self, t: f64, out: &mut JointSample) {
        self.spline.sample(t, &mut out.q, &mut out.v, &mut out.a);
    }

    fn duration(&self) -> f64 {
        self.spline.times().last().map_or(0.0, |end| end.max(0.0))
    }
}
