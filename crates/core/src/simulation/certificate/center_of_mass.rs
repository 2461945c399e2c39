//! Check of the path of the centre of mass against the integral of the momentum.

use super::error_measures::{relative, worst};
use super::trace_row::MassMotion;
use crate::spatial::Vec3;
use serde::{Deserialize, Serialize};

/// Bound on the relative rounding error of the position in one step, in units of the machine epsilon.
const ROUNDING: f64 = 4.0;

/// Gap, m, between the recorded centre of mass and the position obtained by integrating the momentum.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct CenterOfMass {
    gap: Vec3<f64>,
    /// Square of the largest gap, m².
    largest: f64,
    path: f64,
    /// Bound on the rounding error contained in the gap, m; in each step the position is rounded relative to
    /// its magnitude.
    rounding: f64,
}

impl CenterOfMass {
    /// Adds an interval of length `h`, s, in which the centre of mass moves by
    /// `Δc = h (P₀ + P₁)/2m + h²/12m (F₀⁺ − F₁⁻)`, which is of fourth order, with the momenta `P₀` and `P₁`
    /// at both ends and the mass `m`.
    ///
    /// `F₀⁺` is the force just after the first row and `F₁⁻` that just before the second row. If a wrench
    /// jumps there, `F₁⁻` is computed from the impulse `J` of the interval: `F₁⁻ = 2J/h − F₀⁺`. The value
    /// with the smaller gap is used.
    #[inline]
    pub(super) fn add(&mut self, before: &MassMotion, now: &MassMotion) {
        let h = now.time - before.time;
        let step = now.center - before.center;
        let trapezoid = (before.momentum + now.momentum) * (0.5 * h);
        let implied = (now.impulse - before.impulse) * (2.0 / h) - before.force_after;
        let gap = |last: Vec3<f64>| {
            let moved = (before.force_after - last).scale_add(h * h / 12.0, trapezoid);
            step - moved * (1.0 / now.mass)
        };
        let (smooth, jumping) = (gap(now.force_before), gap(implied));
        self.gap += if jumping.dot(jumping) < smooth.dot(smooth) { jumping } else { smooth };
        self.largest = worst(self.largest, self.gap.dot(self.gap));
        self.path += step.norm();
        let size = before.center.dot(before.center).max(now.center.dot(now.center)).sqrt();
        self.rounding += ROUNDING * f64::EPSILON * size;
    }

    /// Returns the length of the path of the centre of mass, m.
    pub(super) fn path(&self) -> f64 {
        self.path
    }

    /// Returns the largest gap divided by the sum of the path and the `size` of the robot, m. If rounding
    /// errors explain the gap, the result does not exceed `gate`.
    pub(super) fn error(&self, size: f64, gate: f64) -> f64 {
        relative(self.largest.sqrt(), self.path + size + self.rounding / gate)
    }
}
