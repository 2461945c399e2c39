//! The centre of mass against the integral of momentum.

use super::instant::MassMotion;
use super::numbers::{Numbers, Restore};
use super::{relative, worst};
use crate::spatial::Vec3;

/// Rounding of one step of the position, in units of ε.
const ROUNDING: f64 = 4.0;

/// Running difference between where the centre of mass is and where its momentum takes it.
#[derive(Default)]
pub(super) struct CenterOfMass {
    gap: Vec3<f64>,
    /// Square of the largest gap, m².
    largest: f64,
    path: f64,
    /// Bound of what rounding leaves of the gap, m: each step rounds the position at its own size.
    rounding: f64,
}

impl CenterOfMass {
    /// `Δc = h (P₀ + P₁)/2m + h²/12m (F₀⁺ − F₁⁻)`, of fourth order.
    ///
    /// `F₁⁻` is the force at the second row; where a wrench jumps there, what impulse and first
    /// force imply: `F₁⁻ = 2J/h − F₀`. The closer of the two holds.
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

    /// Length of the path, m.
    pub(super) fn path(&self) -> f64 {
        self.path
    }

    /// Largest gap over the path and the `size` of the robot; rounding within its bound passes `gate`.
    pub(super) fn error(&self, size: f64, gate: f64) -> f64 {
        relative(self.largest.sqrt(), self.path + size + self.rounding / gate)
    }
}

impl Numbers for CenterOfMass {
    fn save(&self, to: &mut Vec<f64>) {
        to.extend([self.gap.x, self.gap.y, self.gap.z, self.largest, self.path, self.rounding]);
    }

    fn restore(&mut self, from: &mut Restore<'_>) {
        (self.gap, self.largest, self.path) = (from.vector(), from.next(), from.next());
        self.rounding = from.next();
    }
}
