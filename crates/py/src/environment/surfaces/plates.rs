//! Surfaces that consist of flat plates.

use super::{Any, PySurface, SurfaceKind, optics};
use crate::arrays::{Input, wrong_shape};
use crate::errors::{IntoPython, fields};
use onorbit_core::model::Model;
use pyo3::prelude::*;

/// Flat plates that are exposed on one side; a thin panel consists of two such plates.
///
/// Parameters
/// ----------
/// areas : (N,) array
///     Areas, m².
/// normals : (N, 3) array
///     Outward normals of any length, in the axes of the link or frame.
/// centroids : (N, 3) array
///     Centroids relative to the origin of the link or frame, in its axes, m.
/// drag_coefficient, specular, diffuse : float
///     Drag coefficient C_D and fractions of reflected light, as for ``Faces``.
///
/// Raises
/// ------
/// EffectError, ShapeError
///     If there are no plates, a number is outside its range, a normal is zero, or an array has the wrong
///     shape.
#[pyclass(name = "Plates", extends = PySurface, frozen, module = "onorbit_rs")]
pub(super) struct PyPlates;

#[pymethods]
impl PyPlates {
    #[new]
    #[pyo3(signature = (areas, normals, centroids, *, drag_coefficient=2.2, specular=0.0, diffuse=0.0))]
    fn new(
        py: Python<'_>,
        areas: Any<'_, '_>,
        normals: Any<'_, '_>,
        centroids: Any<'_, '_>,
        drag_coefficient: f64,
        specular: f64,
        diffuse: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        let areas = Input::new(areas, "areas")?;
        if areas.shape().len() != 1 {
            return Err(wrong_shape(py, "areas", "(N,)", areas.shape()));
        }
        let (normals, centroids) = (rows(normals, "normals")?, rows(centroids, "centroids")?);
        let keywords =
            fields!(py, "drag_coefficient": drag_coefficient, "specular": specular, "diffuse": diffuse);
        keywords.set_item("areas", areas.data())?;
        keywords.set_item("normals", normals.clone())?;
        keywords.set_item("centroids", centroids.clone())?;
        let (areas, optics) = (areas.data().to_vec(), optics(py, specular, diffuse)?);
        // the checks do not depend on the robot
        let model =
            Model::rigid_body(1.0, nalgebra::Matrix3::identity()).map_err(|error| error.into_python(py))?;
        let kind = SurfaceKind::Plates { areas, normals, centroids, drag_coefficient, optics };
        kind.on(py, (0, &model), 0)?;
        Ok(PySurface::new(kind, "Plates", &keywords)?.add_subclass(Self))
    }
}

/// Returns the rows of an `(N, 3)` array.
fn rows(value: Any<'_, '_>, name: &str) -> PyResult<Vec<[f64; 3]>> {
    let input = Input::new(value, name)?;
    match input.shape() {
        [_, 3] => Ok(input.data().chunks_exact(3).map(|row| [row[0], row[1], row[2]]).collect()),
        other => Err(wrong_shape(value.py(), name, "(N, 3)", other)),
    }
}
