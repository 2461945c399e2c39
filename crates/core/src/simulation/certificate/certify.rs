//! Computation of a certificate from a trace.

use super::checks::{ATTITUDE, CENTER, Certificate, JOINT_STEP_DOUBLING, PairChecks};
use super::removed_rows::row_checks;
use super::row_checks::RowChecks;
use super::step_doubling::StepDoubling;
use crate::model::Model;
use crate::simulation::trace::Trace;

/// Computes the certificate of a run of `model` from the trace of the run. If the trace has no rows, all
/// errors of the rows are zero.
pub fn certify(model: &Model, trace: &Trace) -> Certificate {
    let RowChecks { balance, center, residuals, attitude, is_free, opening, .. } =
        row_checks(model, trace, trace.rows());
    // without external forces, the check of the centre of mass does not depend on the spacing of the rows
    let doubling = StepDoubling { model, trace, size: balance.size(), gate: JOINT_STEP_DOUBLING };
    let center_error = center.error(balance.size(), CENTER);
    let pairs = if trace.rows_suffice {
        Some(PairChecks {
            center_of_mass_error_rel: center_error,
            base_rows_residual_rel: residuals.residual(balance.size()),
            base_rows_gate: residuals.gate(balance.size()),
            attitude_consistency: attitude.consistency(ATTITUDE),
        })
    } else {
        trace.pair_checks
    };
    Certificate {
        linear_momentum_drift_rel: balance.linear(),
        angular_momentum_drift_rel: balance.angular(),
        energy_balance_error_rel: balance.energy(trace.work_done),
        center_of_mass_error_rel: pairs
            .map(|pairs| pairs.center_of_mass_error_rel)
            .or_else(|| is_free.then_some(center_error)),
        base_rows_residual_rel: pairs.map(|pairs| pairs.base_rows_residual_rel),
        base_rows_gate: pairs.map_or(0.0, |pairs| pairs.base_rows_gate),
        attitude_consistency: pairs.map(|pairs| pairs.attitude_consistency),
        attitude_step_doubling_rad: trace.attitude_step_doubling,
        joint_step_doubling_rel: doubling.joints(),
        position_step_doubling_rel: doubling.origin(center.path()),
        loop_opening: opening,
    }
}
