//! Rows of the balance of a group of several systems.

use super::equations::EquationsOfMotion;
use super::recording::Ledger;
use super::run_state::RunState;
use crate::dynamics::base_rotation;
use crate::spatial::{Scalar, Vec3};
use crate::world::Balance;

impl<S: Scalar> RunState<'_, S> {
    /// Returns the amounts of the group: those of the current trees and those of the trees before them.
    pub(super) fn ledger_totals(&self) -> Ledger {
        let mut all = self.ledger;
        for state in &self.state.trees {
            all.impulse.linear += state.impulse.linear.map(|x| x.value());
            all.impulse.angular += state.impulse.angular.map(|x| x.value());
            all.work += state.work.value();
            all.dissipated += state.dissipated.value();
        }
        all
    }

    /// Adds a row of the balance for the state of the last row of the systems.
    pub(super) fn add_group_row(&mut self, t: f64, is_within_step: bool) {
        if self.systems.len() < 2 {
            return;
        }
        let state = if is_within_step { &self.row_buffers.0 } else { &self.state };
        let (mut impulse, mut work, mut dissipated) =
            (self.ledger.impulse, self.ledger.work, self.ledger.dissipated);
        for tree in &state.trees {
            impulse.linear += tree.impulse.linear.map(|x| x.value());
            impulse.angular += tree.impulse.angular.map(|x| x.value());
            work += tree.work.value();
            dissipated += tree.dissipated.value();
        }
        impulse.angular += state.orbital.map(|x| x.value());
        let EquationsOfMotion { trees, members, .. } = &self.equations;
        let last = |column: &[f64], width: usize| Vec3::from_slice(&column[column.len() - width..]);
        let rows = || {
            self.systems.iter().enumerate().map(|(number, run)| {
                let (state, system) = members.system(number, trees, &state.trees);
                (&run.recorder.trace, state, system)
            })
        };
        let (mut mass, mut linear, mut first_moment) = (0.0, Vec3::zero(), Vec3::zero());
        for (trace, _, system) in rows() {
            mass += system.model.mass();
            linear += last(&trace.momentum, 6);
            first_moment += last(&trace.center_of_mass, 3) * system.model.mass();
        }
        let (center, velocity) = (first_moment * (1.0 / mass), linear * (1.0 / mass));
        let (mut angular, mut energy, mut scales) = (Vec3::<f64>::zero(), 0.0, [0.0; 2]);
        for (trace, state, system) in rows() {
            // L = Σ [L_i + (c_i − c) × (P_i − m_i v)]
            let relative = last(&trace.momentum, 6) - velocity * system.model.mass();
            let lever = last(&trace.center_of_mass, 3) - center;
            angular += Vec3::from_slice(&trace.momentum[trace.momentum.len() - 3..]) + lever.cross(relative);
            energy += trace.kinetic_energy.last().copied().unwrap_or(0.0);
            let values = |x: &[S]| x.iter().map(|x| x.value()).collect::<Vec<f64>>();
            let (q, mut v) = (values(&state.q), values(&state.v));
            (Vec3::from_slice(&v) - base_rotation::<f64>(&q).transpose_mul(velocity)).write(&mut v);
            let balance = Balance::of(&system.model, &q, &v, center);
            scales = [0, 1].map(|i| scales[i] + balance.scales[i]);
        }
        let group = &mut self.group;
        group.time.push(t);
        let vectors = [
            (&mut group.momentum, [linear, angular]),
            (&mut group.impulse, [impulse.linear, impulse.angular]),
        ];
        for (column, vectors) in vectors {
            vectors.iter().for_each(|v| column.extend([v.x, v.y, v.z]));
        }
        group.kinetic_energy.push(energy);
        group.work.push(work);
        group.dissipated.push(dissipated);
        group.scales.extend(scales);
    }
}
