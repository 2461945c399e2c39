//! Check of the base's rotations against the rotations that its angular velocities imply.

use super::error_measures::{relative, worst};
use super::trace_row::BaseMotion;
use crate::spatial::{Quat, Vec3, log_so3};
use serde::{Deserialize, Serialize};

/// Bound on the rounding error of the attitude in one step of the integrator, in units of the machine
/// epsilon. It covers a product of two unit quaternions and its normalisation.
const QUATERNION: f64 = 8.0;
/// Bound on the relative rounding error of a rotation, in units of the machine epsilon. It covers the
/// exponential of the step, the rates at both ends of the step, and this check.
const TURN: f64 = 16.0;

/// Sum of small rotation vectors in W, rad, and the square of the largest magnitude of its partial sums,
/// rad².
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Drift {
    sum: Vec3<f64>,
    largest: f64,
}

impl Drift {
    fn add(&mut self, turn: Vec3<f64>) {
        self.sum += turn;
        self.largest = worst(self.largest, self.sum.dot(self.sum));
    }

    fn largest(&self) -> f64 {
        self.largest.sqrt()
    }
}

/// Sums of the attitude check over all intervals so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Attitude {
    residual: Drift,
    commutator: Drift,
    resolution: Drift,
    /// Bound on the rounding error contained in the residual, rad.
    rounding: f64,
    /// Bound on the error of the parabola of [`Attitude::add`] over intervals that end with a jump of the
    /// angular acceleration, rad.
    unresolved: f64,
    /// Difference between the integrals of the cubic and of the parabola of [`Attitude::add`], divided by
    /// `h⁴`, rad/s⁴, in the last interval without a jump.
    snap: f64,
    /// Sum of `h⁴` over the intervals since the last interval without a jump, s⁴.
    since: f64,
}

/// Safety factor for the error bound of an interval that ends with a jump. The bound uses the `snap` of the
/// neighbouring intervals.
const JUMP: f64 = 4.0;

impl Attitude {
    /// Adds an interval. With `Ṙ = R [ω×]`, the Magnus expansion
    /// `log(R₀ᵀ R₁) = ∫ω dt + ½ ∫∫ ω(s) × ω(t) ds dt + …` (`s < t`) becomes
    ///
    /// `h (ω₀ + ω₁)/2 + h²/12 (ω̇₀⁺ − ω̇₁⁻) + h²/12 ω₀ × ω₁ + O(h⁵)`
    ///
    /// with the length `h` of the interval, the angular velocities `ω₀` and `ω₁` at its ends and the angular
    /// accelerations `ω̇₀⁺` just after its start and `ω̇₁⁻` just before its end, in base axes. The first two
    /// terms are the integral of the cubic through the data. The third term is the commutator, which is
    /// missing if attitudes are composed from `exp(∫ω dt)`, however accurate the rates are. If a wrench jumps
    /// at the second row, `ω̇₁⁻` may be unknown. It is then computed from the parabola through the other
    /// data: `ω̇₁⁻ = 2 (ω₁ − ω₀)/h − ω̇₀⁺`. The value with the smaller residual is used. The error of the
    /// parabola is `d h⁴/72` with the third derivative `d` of the rates, which is estimated from the
    /// neighbouring intervals.
    #[inline]
    pub(super) fn add(&mut self, before: &BaseMotion, now: &BaseMotion) {
        let h = now.time - before.time;
        let (w0, w1) = (before.rate, now.rate);
        let turn = turn_between(before.attitude, now.attitude);
        let commutator = w0.cross(w1) * (h * h / 12.0);
        let implied = (w1 - w0) * (2.0 / h) - before.change_after;
        let open = |last: Vec3<f64>| {
            let integral = (before.change_after - last).scale_add(h * h / 12.0, (w0 + w1) * (0.5 * h));
            turn - integral - commutator
        };
        let (smooth, jumping) = (open(now.change_before), open(implied));
        let is_smooth = smooth.dot(smooth) <= jumping.dot(jumping);
        let rot_wb = before.attitude.matrix();
        self.residual.add(rot_wb * if is_smooth { smooth } else { jumping });
        self.commutator.add(rot_wb * commutator);
        if is_smooth {
            // the difference between cubic and parabola bounds the interpolation error
            self.resolution.add(rot_wb * (smooth - jumping));
            let snap = (smooth - jumping).norm() / h.powi(4);
            self.unresolved += JUMP * self.since * self.snap.max(snap);
            (self.snap, self.since) = (snap, 0.0);
        } else if now.is_cut {
            self.since += h.powi(4);
        }
        let moved = h * (before.rates + now.rates) + h * h * (before.changes + now.changes);
        self.rounding += f64::EPSILON * (TURN * moved + QUATERNION);
    }

    /// Returns the ratio of the residual to the sum of the commutator and the interpolation error of the
    /// rates.
    ///
    /// If that sum is zero, a residual within the bounds of rounding errors and jumps still passes `gate`,
    /// and a larger residual fails.
    pub(super) fn consistency(&self, gate: f64) -> f64 {
        let bounds = self.rounding + self.unresolved + JUMP * self.since * self.snap;
        let scale = self.commutator.largest() + self.resolution.largest() + bounds / gate;
        relative(self.residual.largest(), scale)
    }
}

/// Returns the rotation vector from attitude `q0` to `q1`, rad, with a relative error of a few times the
/// machine epsilon.
///
/// `q₀* q₁ = q₀* (q₁ − q₀) + |q₀|²`: the vector part is computed from the difference `q₁ − q₀`, which is
/// exact for neighbouring attitudes, so that no digits cancel. The quaternions need not have unit norm,
/// because the angle does not depend on their norms.
fn turn_between(q0: Quat<f64>, q1: Quat<f64>) -> Vec3<f64> {
    let w = q0.v.dot(q1.v) + q0.w * q1.w;
    let q1 = if w < 0.0 { Quat { v: -q1.v, w: -q1.w } } else { q1 };
    let step = Quat { v: q1.v - q0.v, w: q1.w - q0.w };
    let v = step.v * q0.w - q0.v * step.w - q0.v.cross(step.v);
    log_so3(Quat { v, w: w.abs() })
}

#[cfg(test)]
mod tests {
    use super::{Quat, turn_between};
    use crate::spatial::{Vec3, exp_so3};

    #[test]
    fn small_turns_keep_their_digits_whatever_the_attitude() {
        // q₁ = q₀ + q₀ (θ/2, 0) − |θ|²/8 q₀ has the rounding error of q₁, which is 1e-16/|θ| relative to the
        // rotation
        for angle in [1e-2, 1e-5, 1e-8] {
            let q0 = exp_so3(Vec3::new(0.7, -1.9, 0.4)).normalized();
            let theta = Vec3::new(0.6, 0.0, -0.8) * angle;
            for flip in [1.0, -1.0] {
                let q1 = q0.product(exp_so3(theta));
                let q1 = Quat { v: q1.v * flip, w: q1.w * flip };
                let off = (turn_between(q0, q1) - theta).norm();
                assert!(off < 1e-15, "{angle}: {off}");
            }
        }
    }

    #[test]
    fn neighbours_on_a_grid_of_exact_numbers_give_the_exact_turn() {
        // attitudes with 26 bits each, for which every product is exact, so that the rotation is known to the
        // last digit
        let exact = |x: f64| (x * 67_108_864.0).round() / 67_108_864.0;
        let q0 = Quat { v: Vec3::new(exact(0.1), exact(-0.7), exact(0.3)), w: exact(0.64) };
        let ulp = 1.0 / 67_108_864.0;
        let q1 = Quat { v: q0.v + Vec3::new(ulp, 0.0, 0.0), w: q0.w };
        let v = Vec3::new(q0.w, -q0.v.z, q0.v.y) * ulp; // (q₀* dq) for dq = (ulp, 0, 0), 0
        let w = q0.v.dot(q1.v) + q0.w * q1.w;
        let expected = v * (2.0 / w);
        let off = (turn_between(q0, q1) - expected).norm() / expected.norm();
        assert!(off < 1e-15, "{off:e}");
    }
}
