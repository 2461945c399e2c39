//! Momentum and energy of all systems of a world, from their traces.

use super::group_sum::{SystemRow, add_sum};
use super::recording::GroupRows;
use super::trace::Trace;
use crate::model::Model;

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
        let at_time = systems.iter().zip(&at);
        let at_time = at_time.map(|((trace, model), &k)| SystemRow { trace, k, mass: model.mass() });
        add_sum(latest, &at_time.collect::<Vec<_>>(), &mut rows);
        at.iter_mut().for_each(|at| *at += 1);
    }
    rows
}
