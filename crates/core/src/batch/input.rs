//! What is checked before a kernel runs.

use super::kernel::Kernel;
use super::space::Call;
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
    #[error("{name} has {got} numbers per state, expected {expected} for this robot")]
    WrongLength { name: &'static str, expected: usize, got: usize },
    #[error("{name} has {got} states, the first argument has {expected}")]
    WrongBatch { name: &'static str, expected: usize, got: usize },
    #[error("{name} holds {value} in state {state}, it must be finite")]
    NotFinite { name: &'static str, state: usize, value: f64 },
    #[error(
        "the quaternion of state {state} has norm {norm}, at most 1e-6 off 1 is accepted; it is x, y, z, w in \
         q[3:7]: normalise it first"
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
        "state {state} diverged: it is no longer finite; shorten time_step, or soften gains and joint damping"
    )]
    Diverged { state: usize },
    #[error("orbit {orbit}: {source}")]
    Orbit { orbit: usize, source: OrbitError },
    #[error("{name} is {value} in state {state}, it must be {expected}")]
    NoEllipse { name: &'static str, state: usize, value: f64, expected: &'static str },
}

/// Largest deviation of a quaternion from unit norm.
pub(super) const UNIT_NORM: f64 = 1e-6;

/// Refuses rows of another width or number than the kernel takes.
pub(super) fn check_shapes(call: &Call<'_>) -> Result<(), InputError> {
    let count = call.count();
    for (name, rows) in call.kernel.inputs().iter().zip(call.inputs) {
        let expected = Kernel::width(name, call.model);
        if rows.width != expected {
            return Err(InputError::WrongLength { name, expected, got: rows.width });
        }
        let got = rows.data.len().checked_div(expected).unwrap_or(count); // a robot may have no joints
        if got != count {
            return Err(InputError::WrongBatch { name, expected: count, got });
        }
    }
    match call.external.iter().find(|one| one.rows.len() != 6 && one.rows.len() != 6 * count) {
        Some(one) => {
            Err(InputError::WrongBatch { name: "external wrench", expected: count, got: one.rows.len() / 6 })
        }
        None => Ok(()),
    }
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
