//! Gravity-gradient torque.

use super::{Kind, PyEffect};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Gravity-gradient torque ``3μ/r³ r̂ × I r̂`` on each body about its centre of mass.
///
/// The effect requires an orbit around a planet.
#[pyclass(name = "GravityGradient", extends = PyEffect, frozen, module = "onorbit_rs")]
pub(super) struct PyGravityGradient;

#[pymethods]
impl PyGravityGradient {
    #[new]
    fn new(py: Python<'_>) -> PyResult<PyClassInitializer<Self>> {
        let effect = PyEffect::new(Kind::GravityGradient, "GravityGradient", &PyDict::new(py))?;
        Ok(effect.add_subclass(Self))
    }

    fn __repr__(&self) -> &'static str {
        "GravityGradient()"
    }
}
