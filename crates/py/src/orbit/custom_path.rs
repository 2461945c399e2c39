//! Paths through given positions, with or without attitudes.

use super::{Any, PyOrbit, base};
use crate::arrays::{Input, array_of, wrong_shape};
use crate::errors::{IntoPython, fields, raise};
use nalgebra::{SVector, Vector3, Vector4};
use onorbit_core::number_text::short;
use onorbit_core::orbit::{CustomPath, Ends, Orbit, PathPoints};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::sync::Arc;

/// Path with continuous acceleration through given positions.
///
/// Parameters
/// ----------
/// times : (T,) array
///     Simulation times, s.
/// positions : (T, 3) array
///     Positions from the planet's centre, inertial axes, m.
/// velocities : (T, 3) array, optional
///     Velocities, inertial axes, m/s. Default: those of the spline through the positions.
/// accelerations : (T, 3) array, optional
///     Accelerations, inertial axes, m/s²; only together with ``velocities``.
/// attitudes : (T, 4) array, optional
///     Quaternions (x, y, z, w) of the rotation from the axes of the path to inertial axes; :meth:`frame`
///     returns this rotation.
/// mu : float, optional
///     Gravitational parameter, m³/s²; None means that there is no planet.
/// ends : {"error", "coast"}
///     Behaviour before the first and after the last time: ``error`` raises ``PathError``; ``coast``
///     continues with the velocity and angular velocity of the nearest end.
///
/// Raises
/// ------
/// PathError
///     If the points are invalid, or successive attitudes differ by more than 2 rad.
/// OrbitError
///     If ``mu`` is not positive.
/// InputError, ShapeError
///     If ``ends`` is unknown, or an array has the wrong shape.
#[pyclass(name = "CustomPath", extends = PyOrbit, frozen, module = "onorbit_rs")]
pub(super) struct PyCustomPath {
    path: Arc<CustomPath>,
}

type Rows<const D: usize> = Vec<SVector<f64, D>>;

/// Reads the rows of a (T, D) array, and stores the array in `keywords`.
fn table<const D: usize>(value: Any<'_, '_>, name: &str, keywords: &Bound<'_, PyDict>) -> PyResult<Rows<D>> {
    let input = Input::new(value, name)?;
    match input.shape() {
        [_, width] if *width == D => {
            keywords.set_item(name, array_of(value.py(), input.shape(), input.data()))?;
            Ok(input.data().chunks_exact(D).map(SVector::from_column_slice).collect())
        }
        other => Err(wrong_shape(value.py(), name, &format!("(T, {D})"), other)),
    }
}

#[pymethods]
impl PyCustomPath {
    #[new]
    #[pyo3(signature = (
        times, positions, *, velocities=None, accelerations=None, attitudes=None, mu=None, ends="error",
    ))]
    fn new(
        py: Python<'_>,
        times: Any<'_, '_>,
        positions: Any<'_, '_>,
        velocities: Option<Any<'_, '_>>,
        accelerations: Option<Any<'_, '_>>,
        attitudes: Option<Any<'_, '_>>,
        mu: Option<f64>,
        ends: &str,
    ) -> PyResult<PyClassInitializer<Self>> {
        let keywords = fields!(py, "mu": mu, "ends": ends);
        let behaviour = match ends {
            "error" => Ends::Error,
            "coast" => Ends::Coast,
            other => {
                let message = format!("ends is '{other}'; the choices are 'error' and 'coast'");
                return Err(raise(py, "InputError", &message, &fields!(py, "name": "ends", "got": other)));
            }
        };
        let instants = Input::new(times, "times")?;
        if instants.shape().len() != 1 {
            return Err(wrong_shape(py, "times", "(T,)", instants.shape()));
        }
        let instants = instants.data().to_vec();
        keywords.set_item("times", array_of(py, &[instants.len()], &instants))?;
        let optional = |value: Option<Any<'_, '_>>, name| -> PyResult<Option<Vec<Vector3<f64>>>> {
            value.map(|value| table::<3>(value, name, &keywords)).transpose()
        };
        let points = PathPoints {
            times: instants,
            positions: table(positions, "positions", &keywords)?,
            velocities: optional(velocities, "velocities")?,
            accelerations: optional(accelerations, "accelerations")?,
            attitudes: attitudes
                .map(|value| -> PyResult<Vec<Vector4<f64>>> { table(value, "attitudes", &keywords) })
                .transpose()?,
        };
        let path =
            py.detach(|| CustomPath::new(points, mu, behaviour)).map_err(|error| error.into_python(py))?;
        let path = Arc::new(path);
        let orbit = base(Arc::clone(&path) as Arc<dyn Orbit>, "CustomPath", &PyTuple::empty(py), &keywords)?;
        Ok(PyClassInitializer::from(orbit).add_subclass(Self { path }))
    }

    /// First and last of the given simulation times, s.
    #[getter]
    fn span(&self) -> (f64, f64) {
        self.path.span()
    }

    /// True if attitudes were given.
    #[getter]
    fn has_attitudes(&self) -> bool {
        self.path.has_attitudes()
    }

    fn __repr__(&self) -> String {
        let (start, end) = self.path.span();
        format!("<CustomPath: {} s to {} s>", short(start), short(end))
    }
}
