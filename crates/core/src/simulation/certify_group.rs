//! Certificate of a group of several systems: its momentum and its energy, through all events.

use super::certificate::{Check, ENERGY, MOMENTUM};
use super::recording::GroupRows;
use crate::spatial::Vec3;

/// Returns the checks of the momentum and the energy of a group of systems.
///
/// `max |P − P₀ − ∫F dt|` and `max |L − L₀ − ∫T dt|`, the latter about the centre of mass of the group, are relative to
/// the largest sums of the magnitudes of the momenta of the bodies, and `max |T − T₀ − W|` to the sum of `|ΔW|` and the
/// largest kinetic energy.
pub fn certify_group(rows: &GroupRows) -> Vec<Check> {
    let vector = |column: &[f64], k: usize, part: usize| Vec3::from_slice(&column[6 * k + 3 * part..]);
    let (mut drift, mut scales) = ([0.0_f64; 2], [0.0_f64; 2]);
    let (mut energy, mut worked, mut largest) = (0.0_f64, 0.0, 0.0_f64);
    for k in 0..rows.rows() {
        for part in 0..2 {
            let open = |k: usize| vector(&rows.momentum, k, part) - vector(&rows.impulse, k, part);
            drift[part] = drift[part].max((open(k) - open(0)).norm());
            scales[part] = scales[part].max(rows.scales[2 * k + part]);
        }
        scales[0] = scales[0].max(vector(&rows.momentum, k, 0).norm());
        let open = |k: usize| rows.kinetic_energy[k] - rows.work[k];
        energy = energy.max((open(k) - open(0)).abs());
        worked += (rows.work[k] - rows.work[k.saturating_sub(1)]).abs();
        largest = largest.max(rows.kinetic_energy[k]);
    }
    let relative = |error: f64, scale: f64| if error == 0.0 { 0.0 } else { error / scale };
    vec![
        Check { name: "linear_momentum_drift_rel", value: relative(drift[0], scales[0]), gate: MOMENTUM },
        Check { name: "angular_momentum_drift_rel", value: relative(drift[1], scales[1]), gate: MOMENTUM },
        Check { name: "energy_balance_error_rel", value: relative(energy, worked + largest), gate: ENERGY },
    ]
}
