//! Checks of the change of momentum against the impulse and of the change of energy against the work.

use super::error_measures::{relative, worst};
use super::trace_row::TraceRow;
use crate::dynamics::Momentum;
use crate::spatial::Vec3;

/// Largest errors of the balances since the first row, and the scales by which the errors are divided.
#[derive(Clone, Debug, Default)]
pub(super) struct Balance {
    first: Option<First>,
    linear: f64,
    angular: f64,
    energy: f64,
    relative_momentum: f64,
    momentum: f64,
    spin: f64,
    angular_scale: f64,
    size: f64,
    last_work: f64,
    worked: f64,
    energy_about_com: f64,
    energy_w: f64,
    mass: f64,
    /// Time since the first row, s.
    duration: f64,
}

/// Time, momentum, impulse and energy in the first row.
#[derive(Clone, Copy, Debug)]
struct First {
    time: f64,
    momentum: Momentum<f64>,
    impulse: Momentum<f64>,
    /// Kinetic energy less the work, J.
    energy: f64,
}

impl Balance {
    pub(super) fn add(&mut self, now: &TraceRow<'_>) {
        let open = now.kinetic_energy - now.work;
        let first = *self.first.get_or_insert(First {
            time: now.time,
            momentum: now.momentum,
            impulse: now.impulse,
            energy: open,
        });
        let drift = |h: Vec3<f64>, h0: Vec3<f64>, j: Vec3<f64>, j0: Vec3<f64>| ((h - h0) - (j - j0)).norm();
        let (h, h0, j, j0) = (&now.momentum, &first.momentum, &now.impulse, &first.impulse);
        self.linear = worst(self.linear, drift(h.linear, h0.linear, j.linear, j0.linear));
        self.angular = worst(self.angular, drift(h.angular, h0.angular, j.angular, j0.angular));
        self.energy = worst(self.energy, (open - first.energy).abs());

        self.relative_momentum = self.relative_momentum.max(now.relative_momentum);
        self.momentum = self.momentum.max(h.linear.norm());
        self.spin = self.spin.max(now.spin);
        self.angular_scale = self.angular_scale.max(now.angular);
        self.size = self.size.max(now.size);
        (self.mass, self.duration) = (now.mass, now.time - first.time);
        self.worked += (now.work - self.last_work).abs();
        self.last_work = now.work;
        // E_com = E − P²/2m
        let translational = h.linear.dot(h.linear) / (2.0 * now.mass);
        self.energy_about_com = self.energy_about_com.max(now.kinetic_energy - translational);
        self.energy_w = self.energy_w.max(now.kinetic_energy);
    }

    /// Returns the largest radius of gyration of the robot in any row so far, m.
    pub(super) fn size(&self) -> f64 {
        self.size
    }

    /// Returns the drift of linear momentum relative to a scale. The scale is the momentum of the bodies
    /// relative to the centre of mass (for a single body, the momentum scale of its spin) or, if larger, the
    /// total momentum, which determines the rounding error.
    pub(super) fn linear(&self) -> f64 {
        let relative_momentum = if self.relative_momentum > 0.0 { self.relative_momentum } else { self.spin };
        relative(self.linear, relative_momentum.max(self.momentum))
    }

    /// Returns the drift of angular momentum relative to a scale. The scale is the sum `Σ |Lₖ|` of the
    /// magnitudes of the angular momenta of the bodies or, if larger, a fraction of the moments of the linear
    /// momenta that covers their rounding errors.
    pub(super) fn angular(&self) -> f64 {
        const ROUNDING: f64 = 1e-4;
        let moments = ROUNDING * self.size * self.momentum.max(self.relative_momentum);
        relative(self.angular, self.angular_scale.max(moments))
    }

    /// Returns the error of the energy balance relative to a scale. The scale is the sum of three energies:
    /// the sum `Σ |ΔW|` of the work between rows or, if larger, `work_done`, the same sum over all steps, J;
    /// the largest energy relative to the centre of mass; and a fraction of the largest energy in W that
    /// covers its rounding error. The scale is at least the energy of a motion that covers a millionth of the
    /// robot's size in the duration of the run.
    pub(super) fn energy(&self, work_done: f64) -> f64 {
        const ROUNDING: f64 = 1e-3;
        const REST: f64 = 1e-6;
        let creep = REST * self.size / self.duration.max(f64::MIN_POSITIVE);
        let rest = self.mass * creep * creep;
        let moved = self.worked.max(work_done) + self.energy_about_com + ROUNDING * self.energy_w;
        relative(self.energy, moved.max(rest))
    }
}
