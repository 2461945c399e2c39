//! Gains of control laws, read from Python arguments.

use crate::arrays::{Input, fixed, wrong_shape};
use crate::errors::{fields, raise};
use onorbit_core::control::{ComputedTorque, PerJoint};
use pyo3::prelude::*;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Reads a task-space gain: a number, a (6,) array or a (6, 6) array. Returns the (6, 6) matrix, row-major.
pub(super) fn gains(value: Any<'_, '_>, name: &str) -> PyResult<[f64; 36]> {
    if let Ok(gain) = value.extract::<f64>() {
        return Ok(ComputedTorque::diagonal([gain; 6]));
    }
    match Input::new(value, name)?.shape() {
        [6] => Ok(ComputedTorque::diagonal(fixed(value, name, &[6])?)),
        [6, 6] => fixed(value, name, &[6, 6]),
        other => Err(wrong_shape(value.py(), name, "a number, (6,) or (6, 6)", other)),
    }
}

/// Reads a gain or limit of joints, which is a number or a (k,) array. Returns it with its length, which is 1
/// for a number and for the default.
pub(super) fn per_joint(value: Option<Any<'_, '_>>, name: &str, default: f64) -> PyResult<(PerJoint, usize)> {
    let Some(value) = value else { return Ok((default.into(), 1)) };
    if let Ok(number) = value.extract::<f64>() {
        return Ok((number.into(), 1));
    }
    let input = Input::new(value, name)?;
    match input.shape() {
        [n] if *n > 0 => Ok((PerJoint::new(input.data().to_vec()), *n)),
        other => Err(wrong_shape(value.py(), name, "a number or (k,), one per joint", other)),
    }
}

/// Returns the common length of those gains that have more than one entry; 1 if all are numbers. Different
/// lengths are an error.
pub(super) fn one_count(py: Python<'_>, gains: &[&(PerJoint, usize)]) -> PyResult<usize> {
    let mut counts: Vec<usize> = gains.iter().map(|gain| gain.1).filter(|n| *n > 1).collect();
    counts.sort_unstable();
    counts.dedup();
    match counts[..] {
        [] => Ok(1),
        [n] => Ok(n),
        _ => {
            let message = format!(
                "the arrays of gains and limits have the lengths {counts:?}; each must have one entry per joint"
            );
            Err(raise(py, "ShapeError", &message, &fields!(py, "name": "gains", "got": counts)))
        }
    }
}
