//! Fixed point that serves as the reference orbit.

use super::{Any, PyOrbit, base};
use crate::arrays::{array_of, fixed};
use crate::errors::{IntoPython, fields, raise};
use nalgebra::{Quaternion, UnitQuaternion, Vector3, Vector4};
use onorbit_core::number_text::unlike;
use onorbit_core::orbit::{FixedFrame, Orbit};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::sync::Arc;

/// Fixed point in inertial axes, which serves as the reference orbit.
///
/// The point has no local orbital frame: :meth:`lvlh` raises ``OrbitError``, and :meth:`frame` returns the
/// attitude. With ``mu``, the robot falls away from the point, unless the gravity mode of the simulation is
/// ``carried``.
///
/// Parameters
/// ----------
/// position : (3,) array, optional
///     Position from the planet's centre or, without ``mu``, from any origin; inertial axes, m. Default:
///     zero.
/// attitude : (4,) array, optional
///     Quaternion (x, y, z, w) from the axes of the reference to inertial axes; default: no rotation.
/// mu : float, optional
///     Gravitational parameter, m³/s²; None means that there is no planet.
///
/// Raises
/// ------
/// InputError, OrbitError
///     If a number is not finite or the attitude is not a unit quaternion, or if ``mu`` is not positive.
#[pyclass(name = "FixedFrame", extends = PyOrbit, frozen, module = "onorbit_rs")]
pub(super) struct PyFixedFrame;

#[pymethods]
impl PyFixedFrame {
    #[new]
    #[pyo3(signature = (*, position=None, attitude=None, mu=None))]
    fn new(
        py: Python<'_>,
        position: Option<Any<'_, '_>>,
        attitude: Option<Any<'_, '_>>,
        mu: Option<f64>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let position = position.map_or(Ok([0.0; 3]), |p| fixed::<3>(p, "position", &[3]))?;
        let attitude = attitude.map_or(Ok([0.0, 0.0, 0.0, 1.0]), |q| fixed::<4>(q, "attitude", &[4]))?;
        let vector = Vector4::from(attitude);
        let norm = vector.norm();
        if (norm - 1.0).abs() > 1e-6 {
            let message = format!(
                "attitude (x, y, z, w) has norm {}; it must be 1 within 1e-6; normalise it",
                unlike(norm, &[1.0])
            );
            let fields = fields!(py, "name": "attitude", "got": norm, "expected": 1.0);
            return Err(raise(py, "InputError", &message, &fields));
        }
        let turn = UnitQuaternion::from_quaternion(Quaternion::from_vector(vector));
        let frame =
            FixedFrame::new(Vector3::from(position), turn, mu).map_err(|error| error.into_python(py))?;
        let (p, q) = (array_of(py, &[3], &position), array_of(py, &[4], &attitude));
        let keywords = fields!(py, "position": p, "attitude": q, "mu": mu);
        let orbit = base(Arc::new(frame) as Arc<dyn Orbit>, "FixedFrame", &PyTuple::empty(py), &keywords)?;
        Ok(PyClassInitializer::from(orbit).add_subclass(Self))
    }

    fn __repr__(&self) -> &'static str {
        "<FixedFrame>"
    }
}
