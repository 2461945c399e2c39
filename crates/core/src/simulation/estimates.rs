//! Error estimates of a system over a run during which its tree may change.

use super::certificate::PairChecks;
use super::trace::{CoordinateDrift, Trace};
use serde::{Deserialize, Serialize};

/// Error estimates of a tree or of a system.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Estimates {
    /// Sum of the estimated attitude errors of the steps, rad; `None` if they are not estimated.
    pub(super) turn: Option<f64>,
    /// Sums of the differences between a step and two half steps: one entry for the base's origin, then one
    /// per joint. Empty without step doubling.
    pub(super) drifts: Vec<CoordinateDrift>,
    /// Results of the checks that need every step; `None` if they are not evaluated during the run.
    pub(super) checks: Option<PairChecks>,
}

impl Estimates {
    /// Extracts the estimates of a system from those of its tree; `joints` are the indices of its joints in
    /// the tree.
    pub(super) fn of_part(self, joints: &[usize]) -> Self {
        if self.drifts.is_empty() {
            return self;
        }
        let coordinates = std::iter::once(0).chain(joints.iter().map(|joint| joint + 1));
        Self { drifts: coordinates.map(|i| self.drifts[i]).collect(), ..self }
    }

    /// Combines these estimates with the estimates `before` of the preceding interval.
    pub(super) fn after(self, before: &Self) -> Self {
        let sum = |a: Option<f64>, b: Option<f64>| a.zip(b).map(|(a, b)| a + b);
        let drifts = self.drifts.iter().zip(&before.drifts);
        Self {
            turn: sum(self.turn, before.turn),
            drifts: drifts.map(|(now, before)| now.after(before)).collect(),
            checks: self.checks.zip(before.checks).map(|(now, before)| now.worse(&before)),
        }
    }

    /// Writes the estimates to a trace.
    pub(super) fn write(self, trace: &mut Trace) {
        trace.pair_checks = self.checks;
        trace.attitude_step_doubling = self.turn;
        trace.step_doubling = self.drifts;
    }
}
