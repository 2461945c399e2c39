//! References along a line with a superimposed parabola.

use super::{Any, PyReference, pose, vector};
use crate::pickling::call_of;
use nalgebra::Vector3;
use onorbit_core::reference::LineParabola;
use pyo3::prelude::*;

/// Line with a superimposed parabola, from rest to rest with constant attitude.
///
/// The position is ``p(t) = p0 + s d + s (1 - s) h``, with the initial position ``p0`` and a quintic
/// polynomial ``s`` of time that rises from 0 to 1 within the duration.
///
/// Parameters
/// ----------
/// start_pose : (4, 4) array
///     Initial pose of the tool in ``frame``, m.
/// displacement : (3,) array
///     Displacement ``d``, axes of ``frame``, m.
/// duration : float
///     Duration, s.
/// height : (3,) array, optional
///     Coefficient ``h`` of the parabola, axes of ``frame``, m; the offset from the line is a quarter of
///     ``h`` at half the distance. Default: zero, a straight line.
/// frame : {"world", "lvlh", "base"} or Target, optional
///     Frame of the reference, or ``"SYSTEM/FRAME"`` (see :class:`Reference`); default: W.
///
/// Raises
/// ------
/// ControlError, InputError, ShapeError
///     If the duration is not positive, another value is invalid, or an array has the wrong shape.
#[pyclass(name = "LineParabola", extends = PyReference, frozen, module = "onorbit_rs")]
pub(super) struct PyLineParabola;

#[pymethods]
impl PyLineParabola {
    #[new]
    #[pyo3(signature = (start_pose, *, displacement, duration, height=None, frame=None))]
    fn new(
        py: Python<'_>,
        start_pose: Any<'_, '_>,
        displacement: Any<'_, '_>,
        duration: f64,
        height: Option<Any<'_, '_>>,
        frame: Option<Any<'_, '_>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let call = call_of!(py, "LineParabola", start_pose, displacement, duration, height, frame)?;
        let start = pose(start_pose)?;
        let displacement = vector(displacement, "displacement")?;
        let height = height.map_or(Ok(Vector3::zeros()), |value| vector(value, "height"))?;
        let path = LineParabola::from_pose(start, displacement, height, duration);
        Ok(PyClassInitializer::from(PyReference::new(py, path, frame, call)?).add_subclass(Self))
    }
}
