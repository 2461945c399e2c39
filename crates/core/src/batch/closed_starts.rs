//! Initial states of the runs of a robot with closed loops.

use super::input::InputError;
use crate::model::Model;
use crate::simulation::closed_start;

/// Returns the initial states, `(count, nq)` and `(count, nv)`, of `count` runs, starting with run `first`:
/// the rows of `q0`, `(B, nq)`, and `v0`, `(B, nv)`, with their loops closed as at the start of a simulation;
/// `None` if the robot has no closed loops and no mimic joints.
///
/// # Errors
/// [`InputError::OpenStart`] for the first of these states in which a loop is open, a mimic joint does not
/// follow its leader or the constraints cannot be satisfied.
pub(super) fn closed_starts(
    model: &Model,
    [q0, v0]: [&[f64]; 2],
    (first, count): (usize, usize),
) -> Result<Option<[Vec<f64>; 2]>, InputError> {
    if model.closures().is_empty() {
        return Ok(None);
    }
    let (nq, nv, held) = (model.nq(), model.nv(), vec![false; model.joint_count()]);
    let [mut q, mut v] = [Vec::with_capacity(count * nq), Vec::with_capacity(count * nv)];
    for state in first..first + count {
        let given = [&q0[state * nq..(state + 1) * nq], &v0[state * nv..(state + 1) * nv]];
        let closed = closed_start(model, given.map(<[f64]>::to_vec), &held);
        let closed = closed.map_err(|error| InputError::OpenStart { state, problem: error.to_string() })?;
        q.extend_from_slice(&closed[0]);
        v.extend_from_slice(&closed[1]);
    }
    Ok(Some([q, v]))
}
