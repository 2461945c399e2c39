//! Accumulates the checks on neighbouring steps during the run.

use super::attitude::Attitude;
use super::base_rows::BaseRows;
use super::center_of_mass::CenterOfMass;
use super::instant::{BaseMotion, MassMotion, Reader};
use super::numbers::{Numbers, Restore};
use super::{ATTITUDE, CENTER, PairChecks};
use crate::model::Model;
use crate::simulation::trace::Trace;

/// Running checks of a run.
///
/// The two that are sums over the run see every step. The base rows, a maximum, see those steps for which
/// [`Stream::look_closely`] is called.
pub(in crate::simulation) struct Stream {
    attitude: Attitude,
    center: CenterOfMass,
    base_rows: BaseRows,
    /// Largest radius of gyration seen, m.
    size: f64,
}

impl Stream {
    pub(in crate::simulation) fn new(model: &Model) -> Self {
        let (attitude, center) = (Attitude::default(), CenterOfMass::default());
        Self { attitude, center, base_rows: BaseRows::new(model), size: 0.0 }
    }

    /// Adds a step.
    #[inline]
    pub(in crate::simulation) fn add(
        &mut self,
        before: (&BaseMotion, &MassMotion),
        now: (&BaseMotion, &MassMotion),
    ) {
        self.attitude.add(before.0, now.0);
        self.center.add(before.1, now.1);
    }

    /// Adds a step whose two ends are the rows of `trace`.
    pub(in crate::simulation) fn look_closely(&mut self, model: &Model, trace: &Trace) {
        let mut reader = Reader::new(model, trace);
        if reader.rows() < 2 || trace.time[1] <= trace.time[0] {
            return;
        }
        let (before, now) = (reader.instant(0), reader.instant(1));
        self.size = self.size.max(before.size).max(now.size);
        self.base_rows.add(model, &before, &now);
    }

    /// What was found so far.
    pub(in crate::simulation) fn checks(&self) -> PairChecks {
        PairChecks {
            center_of_mass_error_rel: self.center.error(self.size, CENTER),
            base_rows_residual_rel: self.base_rows.residual(self.size),
            base_rows_gate: self.base_rows.gate(),
            attitude_consistency: self.attitude.consistency(ATTITUDE),
        }
    }

    /// All numbers, for a checkpoint.
    pub(in crate::simulation) fn save(&self, to: &mut Vec<f64>) {
        self.attitude.save(to);
        self.center.save(to);
        self.base_rows.save(to);
        to.push(self.size);
    }

    /// Takes up what [`Stream::save`] gave; false if these are not all of its numbers.
    pub(in crate::simulation) fn restore(&mut self, from: &mut Restore<'_>) {
        self.attitude.restore(from);
        self.center.restore(from);
        self.base_rows.restore(from);
        self.size = from.next();
    }
}
