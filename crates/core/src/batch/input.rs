//! What is checked before a kernel runs.

use super::kernel::Kernel;
use super::space::{Call, RowsMut};
use crate::model::Model;
use crate::number_text::{count, short, unlike};
use crate::orbit::OrbitError;
use thiserror::Error;

/// Wrenches on the body that carries a frame: in the frame's axes, about its origin, N and N m, linear first.
#[derive(Clone, Copy, Debug)]
pub struct Wrenches<'a> {
    /// Index of the frame.
    pub frame: usize,
    /// Six numbers for all states, or six for each, (B, 6).
    pub rows: &'a [f64],
}

/// Numbers that no kernel can take.
#[derive(Clone, Debug, PartialEq, Error)]
#[allow(missing_docs)] // the fields are what the messages say
pub enum InputError {
    #[error("{name} has {got} per state, expected {expected} for this robot", got = count(*got, "number"))]
    WrongLength { name: &'static str, expected: usize, got: usize },
    #[error("{name} has {got}, the first argument has {expected}", got = count(*got, "state"))]
    WrongBatch { name: &'static str, expected: usize, got: usize },
    #[error("{name} has {got}, which is not a whole number of rows of {width}", got = count(*got, "number"))]
    Ragged { name: &'static str, width: usize, got: usize },
    #[error("{got} {what} are given, this kernel has {expected}")]
    WrongCount { what: &'static str, expected: usize, got: usize },
    #[error("output {output} has room for {got}, it must be {expected}", got = count(*got, "number"))]
    WrongRoom { output: usize, expected: usize, got: usize },
    #[error("{got} states are given where one is computed: compute them with Evaluator::many")]
    NotSingle { got: usize },
    #[error("frame {frame} is asked for, the robot has frames 0 to {last}", last = count.saturating_sub(1))]
    UnknownFrame { frame: usize, count: usize },
    #[error("{name} holds {value} in state {state}, it must be finite", value = short(*value))]
    NotFinite { name: &'static str, state: usize, value: f64 },
    #[error(
        "the quaternion of state {state} has norm {norm}, at most 1e-6 off 1 is accepted; it is x, y, z, w in \
         q[3:7]: normalise it first",
        norm = unlike(*norm, &[1.0])
    )]
    QuaternionNorm { state: usize, norm: f64 },
    #[error(
        "state {state} is singular: in this configuration nothing resists the motion of some joint; give the links \
         around it an inertia or the joint a rotor (or its numbers are so large that their products overflow)"
    )]
    Singular { state: usize },
    #[error("the numbers of state {state} are so large that their products overflow: are their units right?")]
    Overflow { state: usize },
    #[error(
        "a rollout steps all states alike: take 'rk4' or 'semi_implicit_euler', or simulate states one by one"
    )]
    Adaptive,
    #[error("the reference is given in the frame of an orbit, a rollout is in empty space: use a simulation")]
    NeedsOrbit,
    #[error("threads is 0, it must be at least 1; leave it out for all cores")]
    NoThreads,
    #[error(
        "state {state} diverged: it is no longer finite; shorten time_step, lower the initial rates, or soften gains and joint damping"
    )]
    Diverged { state: usize },
    #[error("orbit {orbit}: {source}")]
    Orbit { orbit: usize, source: OrbitError },
    #[error("{name} is {value} in state {state}, it must be {expected}", value = short(*value))]
    NoEllipse { name: &'static str, state: usize, value: f64, expected: &'static str },
}

/// Largest deviation of a quaternion from unit norm.
pub(super) const UNIT_NORM: f64 = 1e-6;

/// Refuses rows of another width or number than the kernel takes, outputs with other room than it needs, and frames
/// that the robot does not have.
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
            check_whole(name, rows.data, expected)?;
            let got = rows.data.len() / expected.max(1); // a robot may have no joints
            return Err(InputError::WrongBatch { name, expected: count, got });
        }
    }
    for frame in call.kernel.frame().into_iter().chain(call.external.iter().map(|one| one.frame)) {
        check_frame(call.model, frame)?;
    }
    let (widths, outputs_wanted) = call.kernel.widths(call.model);
    if outputs.len() != outputs_wanted {
        return Err(InputError::WrongCount { what: "outputs", expected: outputs_wanted, got: outputs.len() });
    }
    for (output, (out, width)) in outputs.iter().zip(widths).enumerate() {
        if out.len() != count * width {
            return Err(InputError::WrongRoom { output, expected: count * width, got: out.len() });
        }
    }
    match call.external.iter().find(|one| one.rows.len() != 6 && one.rows.len() != 6 * count) {
        Some(one) => {
            Err(InputError::WrongBatch { name: "external wrench", expected: count, got: one.rows.len() / 6 })
        }
        None => Ok(()),
    }
}

/// Refuses a frame that the robot does not have.
pub(super) fn check_frame(model: &Model, frame: usize) -> Result<(), InputError> {
    let count = model.frames().len();
    if frame < count { Ok(()) } else { Err(InputError::UnknownFrame { frame, count }) }
}

/// Refuses numbers that make no whole number of rows.
pub(super) fn check_whole(name: &'static str, data: &[f64], width: usize) -> Result<(), InputError> {
    let got = data.len();
    if got.is_multiple_of(width.max(1)) { Ok(()) } else { Err(InputError::Ragged { name, width, got }) }
}

/// Refuses rows that are not finite.
pub(super) fn check_finite(name: &'static str, data: &[f64], width: usize) -> Result<(), InputError> {
    // a sum is finite only if every term is, and one pass of additions is cheap
    let sum: f64 = data.iter().map(|x| x * 0.0).sum();
    if sum == 0.0 {
        return Ok(());
    }
    let index = data.iter().position(|x| !x.is_finite()).unwrap_or(0);
    Err(InputError::NotFinite { name, state: index / width.max(1), value: data[index] })
}

/// Refuses quaternions off unit norm.
pub(super) fn check_quaternions(q: &[f64], nq: usize) -> Result<(), InputError> {
    for (state, row) in q.chunks_exact(nq).enumerate() {
        let norm = row[3..7].iter().map(|x| x * x).sum::<f64>().sqrt();
        if (norm - 1.0).abs() > UNIT_NORM {
            return Err(InputError::QuaternionNorm { state, norm });
        }
    }
    Ok(())
}
