//! Validation of shapes and values before a batch is computed.

use super::call::{Call, RowsMut, Wrenches};
use super::kernels::Kernel;
use crate::model::{Model, QUATERNION};
use crate::number_text::{choice, count, short, unlike};
use crate::orbit::OrbitError;
use thiserror::Error;

/// Errors of batches: invalid inputs, and results that are not finite.
#[derive(Clone, Debug, PartialEq, Error)]
#[allow(missing_docs)] // the messages explain the fields
pub enum InputError {
    #[error("the array '{name}' has {got} per state; expected {expected} for this robot", got = count(*got, "number"))]
    WrongLength { name: &'static str, expected: usize, got: usize },
    #[error("the array '{name}' has {got}; expected {expected}", got = count(*got, "number"))]
    WrongTotal { name: &'static str, expected: usize, got: usize },
    #[error(
        "the array '{name}' has {got}, but the first argument has {expected}; give one row per state",
        got = count(*got, "row"), expected = count(*expected, "state")
    )]
    WrongBatch { name: &'static str, expected: usize, got: usize },
    #[error("the array '{name}' has {got}; expected a multiple of {width}, which is the length of a row", got = count(*got, "number"))]
    Ragged { name: &'static str, width: usize, got: usize },
    #[error(
        "the array 'times' has {got}, which is not a multiple of the number of orbits, {orbits}; give the \
         same number of times for each orbit",
        got = count(*got, "number")
    )]
    UnevenTimes { orbits: usize, got: usize },
    #[error("the number of {what} is {got}; this function requires {expected}")]
    WrongCount { what: &'static str, expected: usize, got: usize },
    #[error("output {output} holds {got}; it must hold {expected}", got = count(*got, "number"))]
    WrongOutput { output: usize, expected: usize, got: usize },
    #[error("the number of states is {got}; expected 1; use Evaluator::many for several states")]
    NotSingle { got: usize },
    #[error(
        "frame {frame} does not exist; the robot has {known}",
        known = choice(*count, "frame")
    )]
    UnknownFrame { frame: usize, count: usize },
    /// A number that is not finite. `state` is `None` if the array has one row, for one or for all states.
    #[error(
        "the array '{name}' holds {value}{of_state}; expected finite numbers",
        value = short(*value), of_state = in_state(*state)
    )]
    NotFinite { name: &'static str, state: Option<usize>, value: f64 },
    #[error(
        "the quaternion {name}[3:7] (x, y, z, w) of state {state} has norm {norm}; it must be 1 within \
         1e-6; normalise it",
        norm = unlike(*norm, &[1.0])
    )]
    QuaternionNorm { name: &'static str, state: usize, norm: f64 },
    #[error(
        "the result for state {state} is not finite: either the mass matrix is singular, because some \
         motion of the joints moves no inertia in this configuration, or products of very large values \
         overflow; give the massless links an inertia, or the joints a rotor_inertia, and check the units \
         of the state"
    )]
    Singular { state: usize },
    #[error("the values of state {state} are so large that their products overflow; check their units")]
    Overflow { state: usize },
    #[error(
        "the integrator of the rollout is 'dormand_prince', which adapts its steps to one state; choose 'rk4' or \
         'semi_implicit_euler', or run a simulation per state"
    )]
    Adaptive,
    #[error(
        "the reference is given in an orbital frame, but a rollout has no orbit; give the reference in the frame 'world' or \
             'base', or use a Simulation"
    )]
    NeedsOrbit,
    #[error("{problem}")]
    Controller { problem: String },
    #[error("state {state}: {problem}")]
    OpenStart { state: usize, problem: String },
    #[error("threads is 0; it must be at least 1; omit it to use all cores")]
    NoThreads,
    #[error(
        "the run from state {state} diverged: its positions or rates are no longer finite; reduce time_step, \
         the initial rates, the torques, the gains or the joint damping"
    )]
    Diverged { state: usize },
    #[error("orbit {orbit}: {source}")]
    Orbit { orbit: usize, source: OrbitError },
    /// An orbital element, of one state or of all states, that does not describe an ellipse, or a `mu` that
    /// is not positive and finite.
    #[error(
        "{name} is {value}{of_state}; it must be {expected}",
        value = short(*value), of_state = in_state(*state)
    )]
    NotAnEllipse { name: &'static str, state: Option<usize>, value: f64, expected: &'static str },
    #[error(
        "the array '{name}' has {got}; expected 1 for all states{each}",
        got = count(*got, "number"),
        each = if *states == 1 { String::new() } else { format!(", or {states}, one per state") }
    )]
    WrongElements { name: &'static str, states: usize, got: usize },
}

/// Formats the index of a state for a message; returns an empty text for `None`.
fn in_state(state: Option<usize>) -> String {
    state.map_or_else(String::new, |state| format!(" in state {state}"))
}

/// Largest accepted deviation of the norm of a quaternion from 1.
pub(super) const UNIT_NORM: f64 = 1e-6;

/// Checks the widths and the number of rows of inputs and outputs, and that the frames of the call exist.
pub(super) fn check_shapes(call: &Call<'_>, outputs: &[RowsMut<'_>]) -> Result<(), InputError> {
    let names = call.kernel.inputs();
    if call.inputs.len() != names.len() {
        return Err(InputError::WrongCount { what: "inputs", expected: names.len(), got: call.inputs.len() });
    }
    let count = call.count();
    for (name, rows) in names.iter().zip(call.inputs) {
        let expected = Kernel::width(name, call.model);
        if rows.width != expected {
            return Err(InputError::WrongLength { name, expected, got: rows.width });
        }
        if rows.data.len() != count * expected {
            if expected == 0 {
                return Err(InputError::WrongTotal { name, expected, got: rows.data.len() });
            }
            check_whole(name, rows.data, expected)?;
            let got = rows.data.len() / expected;
            return Err(InputError::WrongBatch { name, expected: count, got });
        }
    }
    for frame in call.kernel.frame().into_iter().chain(call.external.iter().map(|wrenches| wrenches.frame)) {
        check_frame(call.model, frame)?;
    }
    let (widths, expected_outputs) = call.kernel.widths(call.model);
    if outputs.len() != expected_outputs {
        return Err(InputError::WrongCount {
            what: "outputs",
            expected: expected_outputs,
            got: outputs.len(),
        });
    }
    for (output, (out, width)) in outputs.iter().zip(widths).enumerate() {
        if out.len() != count * width {
            return Err(InputError::WrongOutput { output, expected: count * width, got: out.len() });
        }
    }
    for Wrenches { rows, .. } in call.external {
        if rows.len() != 6 && rows.len() != 6 * count {
            check_whole("external wrench", rows, 6)?;
            let got = rows.len() / 6;
            return Err(InputError::WrongBatch { name: "external wrench", expected: count, got });
        }
    }
    Ok(())
}

/// Checks that the robot has a frame with the index `frame`.
pub(super) fn check_frame(model: &Model, frame: usize) -> Result<(), InputError> {
    let count = model.frames().len();
    if frame < count { Ok(()) } else { Err(InputError::UnknownFrame { frame, count }) }
}

/// Checks that the length of the data is a multiple of `width`.
pub(super) fn check_whole(name: &'static str, data: &[f64], width: usize) -> Result<(), InputError> {
    let got = data.len();
    if got.is_multiple_of(width.max(1)) { Ok(()) } else { Err(InputError::Ragged { name, width, got }) }
}

/// Checks that all numbers are finite. `width` is the number of values per state, from which the error
/// derives the index of the state if there are several rows.
pub(super) fn check_finite(name: &'static str, data: &[f64], width: usize) -> Result<(), InputError> {
    // 0 · x is 0 only for a finite x, and a single pass of additions is cheap
    let sum: f64 = data.iter().map(|x| x * 0.0).sum();
    if sum == 0.0 {
        return Ok(());
    }
    let index = data.iter().position(|x| !x.is_finite()).unwrap_or(0);
    let state = (data.len() > width).then(|| index / width.max(1));
    Err(InputError::NotFinite { name, state, value: data[index] })
}

/// Checks that the quaternion of each configuration in the array `name` has unit norm within [`UNIT_NORM`].
pub(super) fn check_quaternions(name: &'static str, q: &[f64], nq: usize) -> Result<(), InputError> {
    for (state, row) in q.chunks_exact(nq).enumerate() {
        let norm = row[QUATERNION].iter().map(|x| x * x).sum::<f64>().sqrt();
        if (norm - 1.0).abs() > UNIT_NORM {
            return Err(InputError::QuaternionNorm { name, state, norm });
        }
    }
    Ok(())
}
