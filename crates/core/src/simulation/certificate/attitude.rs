//! Recorded turns against those that the recorded rates imply.

use super::instant::Instant;
use super::{relative, worst};
use crate::spatial::{Vec3, log_so3};

/// What rounding may leave of one turn between two quaternions, rad.
const ROUNDING: f64 = 1e-14;

/// A sum of small turns in W, and the farthest it came.
#[derive(Default)]
struct Drift {
    sum: Vec3<f64>,
    largest: f64,
}

impl Drift {
    fn add(&mut self, turn: Vec3<f64>) {
        self.sum += turn;
        self.largest = worst(self.largest, self.sum.norm());
    }
}

/// Running sums over the intervals.
#[derive(Default)]
pub(super) struct Attitude {
    residual: Drift,
    commutator: Drift,
    resolution: Drift,
    intervals: u32,
}

impl Attitude {
    /// With `Ṙ = R [ω×]`, `log(R₀ᵀ R₁) = ∫ω dt + ½ ∫∫ ω(s) × ω(t) ds dt + …` (`s < t`, Magnus):
    ///
    /// `h (ω₀ + ω₁)/2 + h²/12 (ω̇₀⁺ − ω̇₁⁻) + h²/12 ω₀ × ω₁ + O(h⁵)`.
    ///
    /// The first two terms are the integral of the cubic through the data. The last one is the
    /// commutator; composing `exp(∫ω dt)` misses it, whatever the order of the rates.
    /// Where a wrench jumps at the second row, `ω̇₁⁻` is not known and follows from the parabola
    /// through the rest: `ω̇₁⁻ = 2 (ω₁ − ω₀)/h − ω̇₀⁺`. The closer of the two holds.
    pub(super) fn add(&mut self, before: &Instant<'_>, now: &Instant<'_>) {
        let h = now.time - before.time;
        let (w0, w1) = (before.rate(), now.rate());
        let turn = log_so3(before.attitude.conjugate().product(now.attitude));
        let commutator = w0.cross(w1) * (h * h / 12.0);
        let implied = (w1 - w0) * (2.0 / h) - before.turn_after();
        let open = |last: Vec3<f64>| {
            let integral = (before.turn_after() - last).scale_add(h * h / 12.0, (w0 + w1) * (0.5 * h));
            turn - integral - commutator
        };
        let (smooth, jumping) = (open(now.turn_before), open(implied));
        let is_smooth = smooth.norm() <= jumping.norm();
        let rot_wb = before.attitude.matrix();
        self.residual.add(rot_wb * if is_smooth { smooth } else { jumping });
        self.commutator.add(rot_wb * commutator);
        if is_smooth {
            // how much the cubic changes the parabola: a bound on what the data do not resolve
            self.resolution.add(rot_wb * (smooth - jumping));
        }
        self.intervals += 1;
    }

    /// What is open over the commutator, what the rates do not resolve, and rounding, which adds up
    /// like a random walk.
    pub(super) fn consistency(&self) -> f64 {
        let rounding = ROUNDING * f64::from(self.intervals).sqrt();
        relative(self.residual.largest, self.commutator.largest + self.resolution.largest + rounding)
    }
}
