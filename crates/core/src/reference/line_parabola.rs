//! The paper's trajectory: straight ahead, with a parabola to the side so that the arm can follow.

use super::{Hold, ReferenceError, TaskSample};
use crate::spatial::{Mat3, Motion, Real, Vec3};
use nalgebra::{Matrix3, Vector3};

/// `p(t) = p₀ + s d + s(1 − s) h`, attitude held; `s` is the quintic from 0 to 1 over the duration.
///
/// Starts and ends at rest without acceleration; before and after it holds the ends.
#[derive(Clone, Debug, PartialEq)]
pub struct LineParabola {
    start: Hold,
    displacement: Vec3<f64>,
    height: Vec3<f64>,
    duration: f64,
}

impl LineParabola {
    /// From the pose `(rot_wd, pos_w)` by `displacement` (m, W axes), with `height` (m, W axes)
    /// whose quarter is reached half way, in `duration`, s.
    ///
    /// # Errors
    /// [`ReferenceError`] for a pose that is none, numbers that are not finite, or a duration
    /// that is not positive.
    pub fn new(
        rot_wd: Matrix3<f64>,
        pos_w: Vector3<f64>,
        displacement: Vector3<f64>,
        height: Vector3<f64>,
        duration: f64,
    ) -> Result<Self, ReferenceError> {
        let start = Hold::new(rot_wd, pos_w)?;
        for (name, v) in [("displacement", &displacement), ("height", &height)] {
            if !v.iter().all(|x| x.is_finite()) {
                return Err(ReferenceError::NotFinite { name });
            }
        }
        if !duration.is_finite() {
            return Err(ReferenceError::NotFinite { name: "duration" });
        }
        if duration <= 0.0 {
            return Err(ReferenceError::DurationNotPositive { value: duration });
        }
        Ok(Self { start, displacement: displacement.into(), height: height.into(), duration })
    }

    /// Where the frame should be at `t`, s.
    #[inline(always)]
    pub fn sample<S: Real>(&self, t: S) -> TaskSample<S> {
        let (s, rate, acceleration) = quintic(t, self.duration);
        let (d, h) = (Vec3::<S>::of(&self.displacement), Vec3::<S>::of(&self.height));
        let (one, two) = (S::of(1.0), S::of(2.0));
        // p = p₀ + s d + s(1−s) h,  dp/ds = d + (1−2s) h,  d²p/ds² = −2 h
        let slope = d + h * (one - two * s);
        let pos_w = Vec3::of(&self.start.pos_w) + d * s + h * (s * (one - s));
        let velocity = slope * rate;
        let acceleration = slope * acceleration - h * (two * rate * rate);
        TaskSample {
            rot_wd: Mat3::of(&self.start.rot_wd),
            pos_w,
            velocity: Motion::new(velocity, Vec3::zero()),
            acceleration: Motion::new(acceleration, Vec3::zero()),
        }
    }
}

/// `s = 10u³ − 15u⁴ + 6u⁵` with `u = t/T` kept in 0..1, and its first two derivatives in time.
#[inline(always)]
fn quintic<S: Real>(t: S, duration: f64) -> (S, S, S) {
    let (zero, one) = (S::of(0.0), S::of(1.0));
    let (per_s, u) = (S::of(1.0 / duration), t * S::of(1.0 / duration));
    let u = S::select(S::less(u, zero), zero, S::select(S::less(one, u), one, u));
    let (u2, v) = (u * u, one - u);
    let s = u2 * u * (S::of(10.0) + u * (S::of(6.0) * u - S::of(15.0)));
    let rate = S::of(30.0) * u2 * v * v * per_s; // 30u² − 60u³ + 30u⁴
    let acceleration = S::of(60.0) * u * v * (one - u - u) * per_s * per_s; // 60u − 180u² + 120u³
    (s, rate, acceleration)
}

#[cfg(test)]
mod tests {
    use super::LineParabola;
    use nalgebra::{Matrix3, Vector3};

    #[test]
    fn velocity_and_acceleration_are_the_derivatives_of_position() {
        let line = LineParabola::new(
            Matrix3::identity(),
            Vector3::new(-0.1, -0.2, 0.5),
            Vector3::new(0.5, 0.1, 0.0),
            Vector3::new(0.0, 0.0, 0.4),
            1.7,
        )
        .expect("a valid reference");
        let h = 1e-4;
        for i in 1..170 {
            let t = f64::from(i) * 0.01;
            let at = |t: f64| line.sample(t);
            let (before, now, after) = (at(t - h), at(t), at(t + h));
            let velocity = (after.pos_w - before.pos_w) * (0.5 / h);
            let acceleration = (after.velocity.linear - before.velocity.linear) * (0.5 / h);
            // central differences: h² times a third derivative of at most 60 · 0.6/T³
            assert!((velocity - now.velocity.linear).norm() < 1e-7);
            assert!((acceleration - now.acceleration.linear).norm() < 1e-6);
        }
        assert!((line.sample(5.0).pos_w.x - 0.4).abs() < 1e-15);
        assert_eq!(line.sample(5.0).velocity.linear.norm(), 0.0);
    }
}
