//! Sample of a task reference.

use crate::spatial::{Mat3, Motion, Real, Vec3, pose_rows};

/// Desired pose of a frame D, and the velocity and acceleration at its origin, in the axes of the reference,
/// which are called W in the names of the fields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaskSample<S> {
    /// Rotation from D axes to W axes.
    pub rot_wd: Mat3<S>,
    /// Position of the origin, m.
    pub pos_w: Vec3<S>,
    /// Velocity of the origin, m/s, and angular velocity, rad/s.
    pub velocity: Motion<S>,
    /// Acceleration of the origin, m/s², and angular acceleration, rad/s².
    pub acceleration: Motion<S>,
}

impl<S: Real> TaskSample<S> {
    /// Returns a sample at rest in the given pose.
    #[inline(always)]
    pub fn at_rest(rot_wd: Mat3<S>, pos_w: Vec3<S>) -> Self {
        Self { rot_wd, pos_w, velocity: Motion::zero(), acceleration: Motion::zero() }
    }
}

impl TaskSample<f64> {
    /// Returns the sample with its numbers copied to every lane of `S`.
    #[inline(always)]
    pub fn lift<S: Real>(&self) -> TaskSample<S> {
        let motion = |m: &Motion<f64>| Motion::new(Vec3::of(&m.linear), Vec3::of(&m.angular));
        TaskSample {
            rot_wd: Mat3::of(&self.rot_wd),
            pos_w: Vec3::of(&self.pos_w),
            velocity: motion(&self.velocity),
            acceleration: motion(&self.acceleration),
        }
    }

    /// Returns the motion of a frame whose motion relative to the frame of `self` is `inner`.
    ///
    /// `p = p_f + R x`, `v = v_f + ω × Rx + R ẋ`, `a = a_f + α × Rx + ω × (ω × Rx) + 2 ω × R ẋ + R ẍ`;
    /// angular velocity `ω + R ω'` and angular acceleration `α + ω × R ω' + R α'`. The position `x`, its
    /// derivatives `ẋ` and `ẍ`, and `ω'` and `α'` belong to `inner`, the other symbols to `self`: position
    /// `p_f`, rotation `R`, velocity `v_f`, acceleration `a_f`, angular velocity `ω` and angular acceleration
    /// `α`.
    #[must_use]
    pub fn carry(&self, inner: &Self) -> Self {
        let (r, w, alpha) = (&self.rot_wd, self.velocity.angular, self.acceleration.angular);
        let (arm, slip, spin) = (*r * inner.pos_w, *r * inner.velocity.linear, *r * inner.velocity.angular);
        let swept = w.cross(arm);
        Self {
            rot_wd: *r * inner.rot_wd,
            pos_w: self.pos_w + arm,
            velocity: Motion::new(self.velocity.linear + swept + slip, w + spin),
            acceleration: Motion::new(
                self.acceleration.linear
                    + alpha.cross(arm) // Euler
                    + w.cross(swept) // centripetal
                    + w.cross(slip) * 2.0 // Coriolis
                    + *r * inner.acceleration.linear,
                alpha + w.cross(spin) + *r * inner.acceleration.angular,
            ),
        }
    }

    /// Returns the pose as a homogeneous `(4, 4)` matrix, row-major.
    pub fn pose_rows(&self) -> [f64; 16] {
        pose_rows(&self.rot_wd, self.pos_w)
    }
}
