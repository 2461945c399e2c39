//! The centre of mass against the integral of momentum.

use super::instant::Instant;
use super::{relative, worst};
use crate::spatial::Vec3;

/// Running difference between where the centre of mass is and where its momentum takes it.
#[derive(Default)]
pub(super) struct CenterOfMass {
    gap: Vec3<f64>,
    largest: f64,
    path: f64,
}

impl CenterOfMass {
    /// `Δc = h (P₀ + P₁)/2m + h²/12m (F₀⁺ − F₁⁻)`, of fourth order.
    ///
    /// `F₁⁻` is the force at the second row; where a wrench jumps there, what impulse and first
    /// force imply: `F₁⁻ = 2J/h − F₀`. The closer of the two holds.
    pub(super) fn add(&mut self, before: &Instant<'_>, now: &Instant<'_>) {
        let h = now.time - before.time;
        let step = now.center_of_mass - before.center_of_mass;
        let trapezoid = (before.momentum.linear + now.momentum.linear) * (0.5 * h);
        let impulse = now.impulse.linear - before.impulse.linear;
        let implied = impulse * (2.0 / h) - before.force;
        let gap = |last: Vec3<f64>| {
            let moved = (before.force - last).scale_add(h * h / 12.0, trapezoid);
            step - moved * (1.0 / now.mass)
        };
        let (smooth, jumping) = (gap(now.force), gap(implied));
        self.gap += if jumping.norm() < smooth.norm() { jumping } else { smooth };
        self.largest = worst(self.largest, self.gap.norm());
        self.path += step.norm();
    }

    /// Largest gap over the path and the `size` of the robot.
    pub(super) fn error(&self, size: f64) -> f64 {
        relative(self.largest, self.path + size)
    }
}
