//! Computation of the rows of the balance of a group of several systems.

use super::equations::EquationsOfMotion;
use super::group_balance::GroupRow;
use super::group_sum::{GroupSum, SystemRow};
use super::recording::Ledger;
use super::run_state::RunState;
use super::state::State;
use crate::spatial::Scalar;
use crate::world::Balance;

impl<S: Scalar> RunState<'_, S> {
    /// Returns the impulse, the work and the dissipated energy of the group at `state`: the values of the
    /// current trees plus those of previous trees.
    pub(super) fn totals(&self, state: &State<S>) -> Ledger {
        let mut all = self.ledger;
        for tree in &state.trees {
            all.impulse.linear += tree.impulse.linear.map(|x| x.value());
            all.impulse.angular += tree.impulse.angular.map(|x| x.value());
            all.work += tree.work.value();
            all.dissipated += tree.dissipated.value();
        }
        all.impulse.angular += state.orbital.map(|x| x.value());
        all
    }

    /// Adds a row to the balance for the last recorded rows of the systems, which belong to the current state
    /// or, if `is_within_step`, to the state in the row buffer.
    #[inline(never)]
    pub(super) fn add_group_row(&mut self, is_within_step: bool) {
        let state = if is_within_step { &self.row_buffers.0 } else { &self.state };
        let Ledger { impulse, work, .. } = self.totals(state);
        let EquationsOfMotion { trees, members, .. } = &self.equations;
        let system = |number: usize| members.system(number, trees, &state.trees);
        let rows = self.systems.iter().enumerate().map(|(number, run)| {
            let trace = &run.recorder.trace;
            SystemRow { trace, k: trace.rows() - 1, mass: system(number).1.model.mass() }
        });
        let GroupSum { momentum, kinetic_energy, center, velocity } = GroupSum::of(&rows.collect::<Vec<_>>());
        let mut scales = [0.0; 2];
        for number in 0..self.systems.len() {
            let (state, own) = system(number);
            let parts = Balance::scales_in_frame(velocity, &own.data, &state.q, center);
            scales = [0, 1].map(|i| scales[i] + parts[i]);
        }
        self.balance.add(&GroupRow { momentum, impulse, kinetic_energy, work, scales });
    }
}
