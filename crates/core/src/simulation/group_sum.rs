//! Momentum and energy of several systems, from the rows of their traces.

use super::recording::GroupRows;
use super::trace::Trace;
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

/// Adds a row with the momentum and the kinetic energy of several systems; returns their centre of mass in W, m, and its
/// velocity, m/s.
pub(super) fn add_sum(t: f64, systems: &[SystemRow<'_>], rows: &mut GroupRows) -> [Vec3<f64>; 2] {
    let (mut mass, mut linear, mut first_moment) = (0.0, Vec3::zero(), Vec3::zero());
    for system in systems {
        mass += system.mass;
        linear += system.linear();
        first_moment += system.center() * system.mass;
    }
    let (center, velocity) = (first_moment * (1.0 / mass), linear * (1.0 / mass));
    let (mut angular, mut energy) = (Vec3::<f64>::zero(), 0.0);
    for system in systems {
        // L = Σ [L_i + (c_i − c) × (P_i − m_i v)]
        let relative = system.linear() - velocity * system.mass;
        angular += system.vector(&system.trace.momentum, 6, 3) + (system.center() - center).cross(relative);
        energy += system.trace.kinetic_energy[system.k];
    }
    rows.time.push(t);
    for v in [linear, angular] {
        rows.momentum.extend([v.x, v.y, v.z]);
    }
    rows.kinetic_energy.push(energy);
    [center, velocity]
}
