//! Robots with a different base, and conversion of their states.

use super::{Any, Array, PyModel};
use crate::arrays::{Input, array_of, wrong_shape};
use crate::errors::IntoPython;
use crate::pickling::ConstructorCall;
use onorbit_core::dynamics;
use onorbit_core::model::Model;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Returns a copy of the robot in which `link` is the base.
pub(super) fn rerooted(model: &Bound<'_, PyModel>, link: &str) -> PyResult<PyModel> {
    let py = model.py();
    let old = &model.get().model;
    let new = old.rerooted(link).map_err(|error| error.into_python(py))?;
    let call = ConstructorCall::new("Model.rerooted", (model, link), &PyDict::new(py))?;
    PyModel::wrap(py, new, Some(call), old.warnings())
}

/// Returns the configuration and the velocity of `to` with which the links have the same poses and twists as
/// in the state `(q, v)` of `from`.
pub(super) fn transfer_state<'py>(
    py: Python<'py>,
    from: &Model,
    (q, v): (Any<'_, '_>, Any<'_, '_>),
    to: &Model,
) -> PyResult<(Array<'py>, Array<'py>)> {
    let (q, v) = (Input::new(q, "q")?, Input::new(v, "v")?);
    for (input, name, n) in [(&q, "q", from.nq()), (&v, "v", from.nv())] {
        if input.shape() != [n] {
            return Err(wrong_shape(py, name, &format!("({n},)"), input.shape()));
        }
    }
    let state = dynamics::transfer_state(from, q.data(), v.data(), to);
    let (q, v) = state.map_err(|error| error.into_python(py))?;
    Ok((array_of(py, &[q.len()], &q), array_of(py, &[v.len()], &v)))
}
