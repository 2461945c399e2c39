//! Removal of rows from a trace, after adding them to the checks of the certificate.

use super::base_rows::BaseRows;
use super::loop_opening::loop_opening;
use super::row_checks::RowChecks;
use super::row_reader::RowReader;
use super::trace_row::TraceRow;
use crate::model::{BASE_NQ, Model};
use crate::simulation::trace::Trace;
use std::ops::Range;

/// Smallest number of last rows that [`drop_checked_rows`] keeps. They cannot be checked yet, because a trial
/// step may remove the last rows again and the last row may lack its acceleration.
const LEAST_KEPT: usize = 16;

/// Number of rows at the start of a trace that are already in the checks of its removed rows: the first row
/// of the run, and the last two of the rows that were checked when rows were removed.
const CHECKED: usize = 3;

/// Removes all rows except the first one and the last `keep` (at least 16), after adding them to
/// [`Trace::removed`], so that the certificate still covers all rows. Every column of the trace must have the
/// same number of rows.
pub fn drop_checked_rows(trace: &mut Trace, keep: usize, model: &Model) {
    let rows = trace.rows().max(1);
    let widths: Vec<usize> = trace.columns().map(|(_, column)| column.len() / rows).collect();
    remove_checked(trace, keep, model, &widths);
}

/// Removes rows like [`drop_checked_rows`], given the number of values per row of each column, and returns
/// the number of removed rows.
pub(in crate::simulation) fn remove_checked(
    trace: &mut Trace,
    keep: usize,
    model: &Model,
    widths: &[usize],
) -> usize {
    let excess = trace.rows().saturating_sub(keep.max(LEAST_KEPT) + 1);
    if excess > 0 {
        let checks = row_checks(model, trace, excess + CHECKED);
        trace.removed = Some(Box::new(checks.with_removed(excess)));
        trace.remove(excess, widths);
    }
    excess
}

/// Returns the checks of the first `end` rows of a trace and of the rows that were removed from it.
pub(super) fn row_checks(model: &Model, trace: &Trace, end: usize) -> RowChecks {
    let (mut checks, start) = match &trace.removed {
        Some(removed) => ((**removed).clone(), CHECKED),
        None => (RowChecks::new(model), 0),
    };
    add_rows(&mut checks, model, trace, start.min(end)..end);
    checks
}

/// Adds the rows of `trace` with the indices `range`. The interval that ends at the first of these rows is
/// included if there is a row before it. The balances and the checks of intervals omit rows without an
/// acceleration.
fn add_rows(checks: &mut RowChecks, model: &Model, trace: &Trace, range: Range<usize>) {
    let mut reader = RowReader::new(model, trace);
    let mut base_rows = BaseRows::new(model);
    base_rows.largest = std::mem::take(&mut checks.residuals);
    let mut last = range.start.checked_sub(1).map(|before| reader.row(before));
    for k in range.start..range.end.min(reader.rows()) {
        let now = reader.row(k);
        checks.balance.add(&now);
        // an impact is recorded as two rows at the same time, without a step between them
        if let Some(before) = last.as_ref().filter(|before: &&TraceRow<'_>| before.time < now.time) {
            checks.center.add(&before.mass_motion(), &now.mass_motion());
            if trace.rows_suffice {
                base_rows.add(model, before, &now);
                checks.attitude.add(&before.base, &now.base);
            }
        }
        last = Some(now);
    }
    checks.residuals = base_rows.largest;
    checks.is_free &= trace.impulse[6 * range.start..6 * range.end].iter().all(|x| *x == 0.0);
    let opening = loop_opening(model, trace, range.clone());
    checks.opening = checks.opening.into_iter().chain(opening).reduce(f64::max);
    for q in trace.q[model.nq() * range.start..model.nq() * range.end].chunks_exact(model.nq()) {
        for ((lowest, highest), x) in checks.joints.iter_mut().zip(&q[BASE_NQ..]) {
            (*lowest, *highest) = (lowest.min(*x), highest.max(*x));
        }
    }
}
