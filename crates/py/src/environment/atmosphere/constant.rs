//! Atmosphere with constant density.

use super::PyAtmosphere;
use crate::errors::{IntoPython, fields};
use onorbit_core::environment::atmosphere::ConstantAtmosphere;
use pyo3::prelude::*;

/// Atmosphere with the same density everywhere and at all times.
///
/// Parameters
/// ----------
/// density : float
///     Density, kg/m³.
///
/// Raises
/// ------
/// EffectError
///     If the density is negative or not finite.
#[pyclass(name = "ConstantAtmosphere", extends = PyAtmosphere, frozen, module = "onorbit_rs")]
pub(super) struct PyConstantAtmosphere;

#[pymethods]
impl PyConstantAtmosphere {
    #[new]
    fn new(py: Python<'_>, density: f64) -> PyResult<PyClassInitializer<Self>> {
        let atmosphere = ConstantAtmosphere::new(density).map_err(|error| error.into_python(py))?;
        let keywords = fields!(py, "density": density);
        Ok(PyAtmosphere::new(atmosphere, "ConstantAtmosphere", &keywords)?.add_subclass(Self))
    }
}
