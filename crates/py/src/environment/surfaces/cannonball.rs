//! Surfaces with the same cross-section in all directions.

use super::{PySurface, SurfaceKind};
use crate::errors::{IntoPython, fields};
use onorbit_core::environment::surfaces::Surface;
use pyo3::prelude::*;

/// Surface with the same cross-section in all directions. Forces act at the body's centre of mass, so there
/// is no torque.
///
/// Parameters
/// ----------
/// area : float
///     Cross-sectional area, m².
/// drag_coefficient : float
///     Drag coefficient C_D.
/// reflectivity : float
///     Radiation pressure coefficient C_R: 1 if all light is absorbed, 2 for a flat mirror that faces the
///     Sun.
///
/// Raises
/// ------
/// EffectError
///     If a number is negative or not finite, or ``reflectivity`` is above 2.
#[pyclass(name = "Cannonball", extends = PySurface, frozen, module = "onorbit_rs")]
pub(super) struct PyCannonball;

#[pymethods]
impl PyCannonball {
    #[new]
    #[pyo3(signature = (area, *, drag_coefficient=2.2, reflectivity=1.0))]
    fn new(
        py: Python<'_>,
        area: f64,
        drag_coefficient: f64,
        reflectivity: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        Surface::cannonball(area, drag_coefficient, reflectivity).map_err(|error| error.into_python(py))?;
        let keywords =
            fields!(py, "area": area, "drag_coefficient": drag_coefficient, "reflectivity": reflectivity);
        let kind = SurfaceKind::Cannonball { area, drag_coefficient, reflectivity };
        Ok(PySurface::new(kind, "Cannonball", &keywords)?.add_subclass(Self))
    }
}
