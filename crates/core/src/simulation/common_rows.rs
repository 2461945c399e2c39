//! Computation of the momentum and energy of all systems of a world from their traces.

use super::group_sum::{GroupSum, SystemRow};
use super::trace::Trace;
use crate::model::Model;

/// Momentum and kinetic energy of all systems of a world, with a row for each time that all traces contain,
/// or two rows if every trace has two rows at that time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WorldRows {
    /// Times of the rows, s, `(T,)`.
    pub time: Vec<f64>,
    /// Linear momentum, N s, and angular momentum about the common centre of mass, N m s, axes of W,
    /// `(T, 6)`.
    pub momentum: Vec<f64>,
    /// Kinetic energy of all systems in W, J, `(T,)`.
    pub kinetic_energy: Vec<f64>,
}

impl WorldRows {
    /// Returns the number of rows.
    pub fn rows(&self) -> usize {
        self.time.len()
    }

    fn add(&mut self, t: f64, sum: &GroupSum) {
        self.time.push(t);
        for v in [sum.momentum.linear, sum.momentum.angular] {
            self.momentum.extend([v.x, v.y, v.z]);
        }
        self.kinetic_energy.push(sum.kinetic_energy);
    }
}

/// Computes the momentum and the kinetic energy of all systems at the times that their traces have in common.
/// If only some traces have a row both before and after an event, the row after the event is used.
pub fn world_rows(systems: &[(&Trace, &Model)]) -> WorldRows {
    world_rows_between(systems, f64::NEG_INFINITY, f64::INFINITY)
}

/// Computes the rows of [`world_rows`] at the times `since ≤ t < until`, s.
pub fn world_rows_between(systems: &[(&Trace, &Model)], since: f64, until: f64) -> WorldRows {
    let mut rows = WorldRows::default();
    let rows_before =
        |t: f64| systems.iter().map(move |(trace, _)| trace.time.partition_point(|own| *own < t));
    let mut at: Vec<usize> = rows_before(since).collect();
    let ends: Vec<usize> = rows_before(until).collect();
    let time = |at: &[usize], i: usize| systems[i].0.time[..ends[i]].get(at[i]).copied();
    while let Some(times) = (0..systems.len()).map(|i| time(&at, i)).collect::<Option<Vec<f64>>>() {
        let latest = times.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if let Some(behind) = times.iter().position(|t| *t < latest) {
            at[behind] += 1;
            continue;
        }
        // a system that has another row at this time changes its velocity there
        let jumps: Vec<bool> =
            (0..at.len()).map(|i| systems[i].0.time.get(at[i] + 1) == Some(&latest)).collect();
        if jumps.iter().any(|jumps| *jumps) && !jumps.iter().all(|jumps| *jumps) {
            at.iter_mut().zip(jumps).for_each(|(at, jumps)| *at += usize::from(jumps));
            continue;
        }
        let at_time = systems.iter().zip(&at);
        let at_time = at_time.map(|((trace, model), &k)| SystemRow { trace, k, mass: model.mass() });
        rows.add(latest, &GroupSum::of(&at_time.collect::<Vec<_>>()));
        at.iter_mut().for_each(|at| *at += 1);
    }
    rows
}
