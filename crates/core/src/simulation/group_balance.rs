//! Certificate of a group of several systems: balances of its momentum and energy over the whole run,
//! including all events.

use super::certificate::{Check, ENERGY, MOMENTUM};
use crate::dynamics::Momentum;
use serde::{Deserialize, Serialize};

/// Errors of the momentum and of the energy of a group of several systems, accumulated over the rows of a
/// run.
///
/// The index 0 marks values in the first row. The checks are:
///
/// - `max |P − P₀ − ∫F dt|`, with the linear momentum `P` and the external force `F`, relative to the largest
///   `|P|` or, if that is larger, the largest sum of the magnitudes of the linear momenta of the bodies
///   relative to the centre of mass of the group,
/// - `max |L − L₀ − ∫T dt|`, with the angular momentum `L` about the centre of mass of the group and the
///   external moment `T` about the same point, relative to the largest sum of the magnitudes of the angular
///   momenta of the bodies about this point,
/// - `max |E − E₀ − W|`, with the kinetic energy `E` and the work `W`, relative to the sum of `Σ |ΔW|` and
///   the largest `E`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GroupBalance {
    /// Indices of the systems in the world.
    pub systems: Vec<usize>,
    /// Values of `P − ∫F dt`, N s, `L − ∫T dt`, N m s, and `E − W`, J, in the first row; `None` before that
    /// row.
    first: Option<(Momentum<f64>, f64)>,
    /// Work `W` in the last row, J.
    work: f64,
    /// Largest errors of the linear and of the angular momentum, N s and N m s.
    drift: [f64; 2],
    /// Largest scales of the linear and of the angular momentum, N s and N m s.
    scales: [f64; 2],
    /// Largest error of the energy, J.
    energy_error: f64,
    /// Sum of the magnitudes of the changes of the work, J.
    worked: f64,
    /// Largest kinetic energy, J.
    largest_energy: f64,
}

/// Row of the balance of a group.
pub(super) struct GroupRow {
    /// Momentum, N s and N m s; the angular part is about the centre of mass of the group.
    pub(super) momentum: Momentum<f64>,
    /// Time integral of the external forces, N s, and of their moments about the centre of mass of the group,
    /// N m s.
    pub(super) impulse: Momentum<f64>,
    /// Kinetic energy of the group in W, J.
    pub(super) kinetic_energy: f64,
    /// Work done on the group by motors, external wrenches, contacts and springs, less the energy dissipated
    /// in joints, captures and brakes, J.
    pub(super) work: f64,
    /// Sums of the magnitudes of the momenta of the bodies: linear, N s, relative to the centre of mass of
    /// the group, and angular about it, N m s.
    pub(super) scales: [f64; 2],
}

impl GroupBalance {
    /// Adds a row to the balance.
    pub(super) fn add(&mut self, row: &GroupRow) {
        let open = Momentum {
            linear: row.momentum.linear - row.impulse.linear,
            angular: row.momentum.angular - row.impulse.angular,
        };
        let open_energy = row.kinetic_energy - row.work;
        let has_rows = self.first.is_some();
        let (start, start_energy) = self.first.get_or_insert((open, open_energy));
        let drift = [(open.linear - start.linear).norm(), (open.angular - start.angular).norm()];
        self.energy_error = self.energy_error.max((open_energy - *start_energy).abs());
        for part in 0..2 {
            self.drift[part] = self.drift[part].max(drift[part]);
            self.scales[part] = self.scales[part].max(row.scales[part]);
        }
        self.scales[0] = self.scales[0].max(row.momentum.linear.norm());
        if has_rows {
            self.worked += (row.work - self.work).abs();
        }
        self.work = row.work;
        self.largest_energy = self.largest_energy.max(row.kinetic_energy);
    }

    /// Returns the balance with `systems` as the indices of its systems in the world.
    pub(super) fn of_systems(self, systems: &[usize]) -> Self {
        Self { systems: systems.to_vec(), ..self }
    }

    /// Returns the checks of linear momentum, angular momentum and energy.
    pub fn checks(&self) -> Vec<Check> {
        let relative = |error: f64, scale: f64| if error == 0.0 { 0.0 } else { error / scale };
        let [linear, angular] = [0, 1].map(|part| relative(self.drift[part], self.scales[part]));
        let energy = relative(self.energy_error, self.worked + self.largest_energy);
        vec![
            Check { name: "linear_momentum_drift_rel", value: linear, gate: MOMENTUM },
            Check { name: "angular_momentum_drift_rel", value: angular, gate: MOMENTUM },
            Check { name: "energy_balance_error_rel", value: energy, gate: ENERGY },
        ]
    }
}
