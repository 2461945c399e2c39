//! Timing of references: a given duration, or the shortest duration within limits.

use super::Any;
use super::row;
use crate::arrays::{Input, wrong_shape};
use crate::errors::plain;
use onorbit_core::reference::{RateLimit, TaskLimits, Timing};
use pyo3::prelude::*;

/// Reads either a duration or times, or the limits of a tool's motion: speed, acceleration, angular speed and
/// angular acceleration. Giving both or neither is an error.
pub(super) fn of_task<T>(
    py: Python<'_>,
    given: Option<T>,
    limits: [Option<f64>; 4],
) -> PyResult<Timing<T, TaskLimits>> {
    let is_limited = limits.iter().any(Option::is_some);
    let [rate, acceleration, angular_rate, angular_acceleration] =
        limits.map(|limit| limit.unwrap_or(f64::INFINITY));
    match given {
        Some(given) if !is_limited => Ok(Timing::Given(given)),
        None if is_limited => Ok(Timing::Limits(TaskLimits {
            linear: RateLimit { rate, acceleration },
            angular: RateLimit { rate: angular_rate, acceleration: angular_acceleration },
        })),
        Some(_) => Err(both(py)),
        None => Err(neither(py)),
    }
}

/// Reads either times, s, or limits of the rates and accelerations of `count` joints. Giving both or neither
/// is an error.
pub(super) fn of_joints(
    py: Python<'_>,
    count: usize,
    times: Option<Any<'_, '_>>,
    rate: Option<Any<'_, '_>>,
    acceleration: Option<Any<'_, '_>>,
) -> PyResult<Timing<Vec<f64>, Vec<RateLimit>>> {
    let each = |value: Option<Any<'_, '_>>, name| match value {
        None => Ok(vec![f64::INFINITY; count]),
        Some(value) => per_joint(value, name, count),
    };
    match (times, rate.is_some() || acceleration.is_some()) {
        (Some(times), false) => Ok(Timing::Given(row(times, "times")?)),
        (None, true) => {
            let (rates, accelerations) = (each(rate, "speed")?, each(acceleration, "acceleration")?);
            let limits = rates.into_iter().zip(accelerations);
            Ok(Timing::Limits(limits.map(|(rate, acceleration)| RateLimit { rate, acceleration }).collect()))
        }
        (Some(_), true) => Err(both(py)),
        (None, false) => Err(neither(py)),
    }
}

/// Returns one value per joint. The argument is one number for all joints, or an (n,) array.
fn per_joint(value: Any<'_, '_>, name: &str, count: usize) -> PyResult<Vec<f64>> {
    if let Ok(one) = value.extract::<f64>() {
        return Ok(vec![one; count]);
    }
    let input = Input::new(value, name)?;
    match input.shape() {
        [n] if *n == count => Ok(input.data().to_vec()),
        other => Err(wrong_shape(value.py(), name, &format!("a number or ({count},)"), other)),
    }
}

/// Returns the error for a reference with neither times nor limits.
fn neither(py: Python<'_>) -> PyErr {
    plain(
        py,
        "ControlError",
        "the reference has neither times (or a duration) nor limits; give one of the two",
    )
}

/// Returns the error for a reference with both times and limits.
fn both(py: Python<'_>) -> PyErr {
    plain(py, "ControlError", "the reference has both times (or a duration) and limits; omit one of the two")
}
