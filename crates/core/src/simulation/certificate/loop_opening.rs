//! Check that closed loops remain closed and mimic joints follow their leaders.

use crate::model::{BASE_NQ, Constraint, Model};
use crate::simulation::columns::LOOPS;
use crate::simulation::trace::Trace;
use std::ops::Range;

/// Returns the largest opening of a loop, m or rad, or deviation of a mimic joint from its leader, rad or m,
/// in the rows `range`; `None` without loops and mimic joints.
pub(super) fn loop_opening(model: &Model, trace: &Trace, range: Range<usize>) -> Option<f64> {
    let start = LOOPS.parts.iter().find(|part| part.name == "opening").map_or(0, |part| part.start);
    let openings = trace.loops.iter().flat_map(|column| {
        let rows =
            column.values[column.width * range.start..column.width * range.end].chunks_exact(column.width);
        rows.flat_map(move |row| row[start..].iter().copied())
    });
    let mimics = model.closures().iter().filter_map(|closure| match closure.constraint {
        Constraint::Mimic { joint, leader, ratio, offset } => Some((joint, leader, ratio, offset)),
        Constraint::Frames { .. } => None,
    });
    // φ = q − ratio q_leader − offset
    let deviations = mimics.flat_map(|(joint, leader, ratio, offset)| {
        let rows = trace.q[model.nq() * range.start..model.nq() * range.end].chunks_exact(model.nq());
        rows.map(move |q| (q[BASE_NQ + joint] - ratio * q[BASE_NQ + leader] - offset).abs())
    });
    openings.chain(deviations).reduce(f64::max)
}
