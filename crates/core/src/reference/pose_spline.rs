//! Splines through poses.

use super::{Hold, ReferenceError, TaskLimits, TaskPath, TaskSample, Timing};
use crate::spatial::{Ends, Motion, Quat, RotationSpline, Spline, Vec3, log_rotation};

/// Quintic C² splines through poses, which are waypoints or samples of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseSpline {
    position: Spline,
    attitude: RotationSpline,
}

impl PoseSpline {
    /// Creates the motion from rest to rest through `poses`. The frame also stops at the inner poses if
    /// `stops` is true.
    ///
    /// With stops, each piece is a straight line with the attitude on a geodesic. If limits are given, they
    /// determine the times: with stops, each piece has the shortest duration that respects the limits;
    /// without stops, the times of all pieces are scaled by a common factor such that the whole path respects
    /// the limits.
    ///
    /// # Errors
    /// [`ReferenceError`] for fewer than two poses, a wrong number of times, times that are not finite or do
    /// not increase, successive attitudes half a turn apart, and limits that are not positive or do not
    /// determine the times; with limits, also for successive poses that coincide.
    pub fn waypoints(
        poses: &[Hold],
        timing: &Timing<Vec<f64>, TaskLimits>,
        stops: bool,
    ) -> Result<Self, ReferenceError> {
        let through = |times: &[f64]| -> Result<Self, ReferenceError> {
            let (positions, attitudes) = rows(poses);
            Ok(if stops {
                let attitude = RotationSpline::resting(times, &attitudes)?;
                Self { position: Spline::resting(times, 3, &positions)?, attitude }
            } else {
                let attitude = RotationSpline::interpolating(times, &attitudes, Ends::Rest)?;
                Self { position: Spline::interpolating(times, 3, &positions, Ends::Rest)?, attitude }
            })
        };
        match timing {
            Timing::Given(times) => through(times),
            Timing::Limits(limits) => {
                limits.check()?;
                let mut times = rest_times(poses, |a, b| {
                    let turn = log_rotation(&(b.rot_fd * a.rot_fd.transpose())).norm();
                    limits.linear.time_for((b.pos_f - a.pos_f).norm()).max(limits.angular.time_for(turn))
                })?;
                let path = through(&times)?;
                if stops {
                    return Ok(path);
                }
                let stretch = limits.stretch(&path, &times);
                times.iter_mut().for_each(|t| *t *= stretch);
                through(&times)
            }
        }
    }

    /// Creates the spline through K samples of a motion at `times` (K,), s. The `velocities` (K, 6) are
    /// linear, m/s, then angular, rad/s, in the axes of the frame in which the poses are given, or `None` if
    /// they are not known. The first pose is held before the first time, and the last pose after the last
    /// time.
    ///
    /// # Errors
    /// [`ReferenceError`] for fewer than two samples, wrong lengths, numbers that are not finite or exceed
    /// 1e60 in magnitude, times that do not increase, or successive attitudes half a turn apart.
    pub fn sampled(
        times: &[f64],
        poses: &[Hold],
        velocities: Option<&[f64]>,
    ) -> Result<Self, ReferenceError> {
        let (positions, attitudes) = rows(poses);
        let Some(velocities) = velocities else {
            let attitude = RotationSpline::interpolating(times, &attitudes, Ends::Free)?;
            return Ok(Self { position: Spline::interpolating(times, 3, &positions, Ends::Free)?, attitude });
        };
        if velocities.len() != 6 * poses.len() {
            let (expected, got) = (6 * poses.len(), velocities.len());
            return Err(ReferenceError::WrongLength { name: "velocities", expected, got });
        }
        let slopes: Vec<f64> = velocities.chunks_exact(6).flat_map(|row| row[..3].to_vec()).collect();
        let rates: Vec<Vec3<f64>> = velocities
            .chunks_exact(6)
            .zip(poses)
            .map(|(row, pose)| pose.rot_fd.transpose_mul(Vec3::from_slice(&row[3..])))
            .collect();
        let position = Spline::with_slopes(times, 3, &positions, &slopes)?;
        Ok(Self { position, attitude: RotationSpline::with_rates(times, &attitudes, &rates)? })
    }
}

/// Returns the times of the waypoints, s, starting at zero, or an error if the duration of a piece is zero,
/// because its two points coincide or no limit applies to the motion between them. `time_for` returns the
/// duration of the piece between two points, s.
pub(super) fn rest_times<P>(
    points: &[P],
    time_for: impl Fn(&P, &P) -> f64,
) -> Result<Vec<f64>, ReferenceError> {
    let mut times = vec![0.0];
    for (point, pair) in points.windows(2).enumerate() {
        let duration = time_for(&pair[0], &pair[1]);
        if duration == 0.0 {
            return Err(ReferenceError::SamePoint { point });
        }
        times.push(times[point] + duration);
    }
    Ok(times)
}

fn rows(poses: &[Hold]) -> (Vec<f64>, Vec<Quat<f64>>) {
    let positions = poses.iter().flat_map(|pose| [pose.pos_f.x, pose.pos_f.y, pose.pos_f.z]).collect();
    (positions, poses.iter().map(|pose| Quat::from_matrix(&pose.rot_fd)).collect())
}

impl TaskPath for PoseSpline {
    fn sample(&self, t: f64) -> TaskSample<f64> {
        let (mut p, mut v, mut a) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        self.position.sample(t, &mut p, &mut v, &mut a);
        let (attitude, omega, alpha) = self.attitude.sample(t);
        TaskSample {
            rot_wd: attitude.matrix(),
            pos_w: Vec3::from_slice(&p),
            velocity: Motion::new(Vec3::from_slice(&v), omega),
            acceleration: Motion::new(Vec3::from_slice(&a), alpha),
        }
    }

    fn duration(&self) -> f64 {
        self.position.times().last().map_or(0.0, |end| end.max(0.0))
    }
}
