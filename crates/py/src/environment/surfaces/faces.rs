//! Faces of the visual geometry.

use super::{PySurface, SurfaceKind, optics};
use crate::errors::{IntoPython, fields};
use onorbit_core::environment::surfaces::Surface;
use pyo3::prelude::*;

/// Faces of a body's visual geometry. A body consists of a link and all links that are fixed to it.
///
/// Boxes, cylinders and spheres are represented exactly, capsules with an error of at most 2 % of the
/// projected area of their ends. For meshes and all other shapes, the construction of the simulation raises
/// ``EffectError``.
///
/// The force on each face depends on its angle of incidence and acts at its centroid, which results in a
/// torque. Faces do not shadow each other.
///
/// Parameters
/// ----------
/// drag_coefficient : float
///     Drag coefficient C_D.
/// specular : float
///     Fraction of the light that is reflected specularly.
/// diffuse : float
///     Fraction of the light that is reflected diffusely; the remainder is absorbed.
///
/// Raises
/// ------
/// EffectError
///     If a number is outside its range, or the fractions add up to more than 1.
#[pyclass(name = "Faces", extends = PySurface, frozen, module = "onorbit_rs")]
pub(super) struct PyFaces;

#[pymethods]
impl PyFaces {
    #[new]
    #[pyo3(signature = (*, drag_coefficient=2.2, specular=0.0, diffuse=0.0))]
    fn new(
        py: Python<'_>,
        drag_coefficient: f64,
        specular: f64,
        diffuse: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        Surface::cannonball(0.0, drag_coefficient, 0.0).map_err(|error| error.into_python(py))?;
        let kind = SurfaceKind::Faces { drag_coefficient, optics: optics(py, specular, diffuse)? };
        let keywords =
            fields!(py, "drag_coefficient": drag_coefficient, "specular": specular, "diffuse": diffuse);
        Ok(PySurface::new(kind, "Faces", &keywords)?.add_subclass(Self))
    }
}
