//! Momentum and energy of several systems, computed from the rows of their traces.

use super::trace::Trace;
use crate::dynamics::Momentum;
use crate::spatial::Vec3;

/// Row `k` of the trace of a system, and the mass of the system, kg.
#[derive(Clone, Copy)]
pub(super) struct SystemRow<'a> {
    pub(super) trace: &'a Trace,
    pub(super) k: usize,
    pub(super) mass: f64,
}

impl SystemRow<'_> {
    fn vector(&self, column: &[f64], width: usize, start: usize) -> Vec3<f64> {
        Vec3::from_slice(&column[width * self.k + start..])
    }

    fn center(&self) -> Vec3<f64> {
        self.vector(&self.trace.center_of_mass, 3, 0)
    }

    fn linear(&self) -> Vec3<f64> {
        self.vector(&self.trace.momentum, 6, 0)
    }
}

/// Momentum and kinetic energy of several systems.
pub(super) struct GroupSum {
    /// Momentum in W axes, N s and N m s; the angular part is about the common centre of mass.
    pub(super) momentum: Momentum<f64>,
    /// Sum of the kinetic energies in W, J.
    pub(super) kinetic_energy: f64,
    /// Position of the common centre of mass in W, m.
    pub(super) center: Vec3<f64>,
    /// Velocity of the common centre of mass in W, m/s.
    pub(super) velocity: Vec3<f64>,
}

impl GroupSum {
    /// Computes the sums over the rows of all systems.
    pub(super) fn of(systems: &[SystemRow<'_>]) -> Self {
        let (mut mass, mut linear, mut first_moment) = (0.0, Vec3::zero(), Vec3::zero());
        for system in systems {
            mass += system.mass;
            linear += system.linear();
            first_moment += system.center() * system.mass;
        }
        let (center, velocity) = (first_moment * (1.0 / mass), linear * (1.0 / mass));
        let (mut angular, mut kinetic_energy) = (Vec3::<f64>::zero(), 0.0);
        for system in systems {
            // L = Σ [L_i + (c_i − c) × (P_i − m_i v)]
            let relative = system.linear() - velocity * system.mass;
            let own = system.vector(&system.trace.momentum, 6, 3);
            angular += own + (system.center() - center).cross(relative);
            kinetic_energy += system.trace.kinetic_energy[system.k];
        }
        Self { momentum: Momentum { linear, angular }, kinetic_energy, center, velocity }
    }
}
