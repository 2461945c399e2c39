//! Checks that compare successive steps, accumulated during the run.

use super::attitude::Attitude;
use super::base_rows::{BaseRows, Residuals};
use super::center_of_mass::CenterOfMass;
use super::checks::{ATTITUDE, CENTER, PairChecks};
use super::row_reader::RowReader;
use super::trace_row::{BaseMotion, MassMotion};
use crate::model::Model;
use crate::simulation::trace::Trace;
use serde::{Deserialize, Serialize};

/// Checks that compare successive steps, for a run whose rows are not sufficient for these checks.
///
/// The checks of the attitude and of the centre of mass are sums over the run and use every step. The check
/// of the base rows is a maximum and uses only the steps for which [`Stream::add_rows`] is called.
pub(in crate::simulation) struct Stream {
    attitude: Attitude,
    center: CenterOfMass,
    base_rows: BaseRows,
    /// Largest radius of gyration of the robot in any row so far, m.
    size: f64,
}

/// Sums and maxima of a [`Stream`], for checkpoints.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::simulation) struct Sums {
    attitude: Attitude,
    center: CenterOfMass,
    residuals: Residuals,
    size: f64,
}

impl Stream {
    pub(in crate::simulation) fn new(model: &Model) -> Self {
        let (attitude, center) = (Attitude::default(), CenterOfMass::default());
        Self { attitude, center, base_rows: BaseRows::new(model), size: 0.0 }
    }

    /// Adds a step from `before` to `now` to the checks of the attitude and of the centre of mass.
    #[inline]
    pub(in crate::simulation) fn add(
        &mut self,
        before: (&BaseMotion, &MassMotion),
        now: (&BaseMotion, &MassMotion),
    ) {
        self.attitude.add(before.0, now.0);
        self.center.add(before.1, now.1);
    }

    /// Adds the step between the two rows of `trace` to the check of the base rows. Does nothing unless there
    /// are two rows at different times.
    pub(in crate::simulation) fn add_rows(&mut self, model: &Model, trace: &Trace) {
        let mut reader = RowReader::new(model, trace);
        if reader.rows() < 2 || trace.time[1] <= trace.time[0] {
            return;
        }
        let (before, now) = (reader.row(0), reader.row(1));
        self.size = self.size.max(before.size).max(now.size);
        self.base_rows.add(model, &before, &now);
    }

    /// Returns the results for all steps so far.
    pub(in crate::simulation) fn checks(&self) -> PairChecks {
        PairChecks {
            center_of_mass_error_rel: self.center.error(self.size, CENTER),
            base_rows_residual_rel: self.base_rows.largest.residual(self.size),
            base_rows_gate: self.base_rows.largest.gate(self.size),
            attitude_consistency: self.attitude.consistency(ATTITUDE),
        }
    }

    /// Returns the sums and maxima so far.
    pub(in crate::simulation) fn sums(&self) -> Sums {
        Sums {
            attitude: self.attitude.clone(),
            center: self.center.clone(),
            residuals: self.base_rows.largest.clone(),
            size: self.size,
        }
    }

    /// Restores the sums that [`Stream::sums`] returned.
    pub(in crate::simulation) fn set_sums(&mut self, sums: Sums) {
        let Sums { attitude, center, residuals, size } = sums;
        (self.attitude, self.center, self.base_rows.largest, self.size) = (attitude, center, residuals, size);
    }
}
