//! Gravity-gradient torque.

use super::{Kind, PyEffect};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Gravity-gradient torque on each body about its centre of mass.
///
/// In the gravity of a point mass, the torque is ``3μ/r³ r̂ × I r̂``, with the gravitational parameter ``μ``,
/// the body's inertia ``I`` about its centre of mass, its distance ``r`` from the planet's centre, and the
/// unit vector ``r̂`` from the planet's centre to the body. The gradients of gravity fields and third bodies
/// of the run contribute as well. The effect requires an orbit around a planet.
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
