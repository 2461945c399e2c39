//! Momentum and energy of all systems of a world, from their traces.

use super::recording::GroupRows;
use super::trace::Trace;
use crate::model::Model;
use crate::spatial::Vec3;

/// Returns the momentum and the kinetic energy of all systems at the times that their traces share. `impulse`, `work`,
/// `dissipated` and `scales` stay empty.
pub fn world_rows(systems: &[(&Trace, &Model)]) -> GroupRows {
    let mut rows = GroupRows { systems: (0..systems.len()).collect(), ..GroupRows::default() };
    let mut at = vec![0; systems.len()];
    let time = |at: &[usize], i: usize| systems[i].0.time.get(at[i]).copied();
    while let Some(times) = (0..systems.len()).map(|i| time(&at, i)).collect::<Option<Vec<f64>>>() {
        let latest = times.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if let Some(behind) = times.iter().position(|t| *t < latest) {
            at[behind] += 1;
            continue;
        }
        // a system that has a further row at this time jumps there
        let jumps: Vec<bool> =
            (0..at.len()).map(|i| systems[i].0.time.get(at[i] + 1) == Some(&latest)).collect();
        if jumps.iter().any(|jumps| *jumps) && !jumps.iter().all(|jumps| *jumps) {
            at.iter_mut().zip(jumps).for_each(|(at, jumps)| *at += usize::from(jumps));
            continue;
        }
        add_row(&mut rows, latest, systems, &at);
        at.iter_mut().for_each(|at| *at += 1);
    }
    rows
}

/// Adds the row of a time; `at` are the rows of the systems.
fn add_row(rows: &mut GroupRows, t: f64, systems: &[(&Trace, &Model)], at: &[usize]) {
    let row = |column: &[f64], k: usize, width: usize| Vec3::from_slice(&column[k * width..]);
    let all = || systems.iter().zip(at);
    let (mut mass, mut linear, mut first_moment) = (0.0, Vec3::zero(), Vec3::zero());
    for ((trace, model), &k) in all() {
        mass += model.mass();
        linear += row(&trace.momentum, k, 6);
        first_moment += row(&trace.center_of_mass, k, 3) * model.mass();
    }
    let (center, velocity) = (first_moment * (1.0 / mass), linear * (1.0 / mass));
    let (mut angular, mut energy) = (Vec3::<f64>::zero(), 0.0);
    for ((trace, model), &k) in all() {
        // L = Σ [L_i + (c_i − c) × (P_i − m_i v)]
        let relative = row(&trace.momentum, k, 6) - velocity * model.mass();
        let own = Vec3::from_slice(&trace.momentum[6 * k + 3..]);
        angular += own + (row(&trace.center_of_mass, k, 3) - center).cross(relative);
        energy += trace.kinetic_energy[k];
    }
    rows.time.push(t);
    for v in [linear, angular] {
        rows.momentum.extend([v.x, v.y, v.z]);
    }
    rows.kinetic_energy.push(energy);
}
