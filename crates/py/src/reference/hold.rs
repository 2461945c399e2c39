//! Constant pose as a reference.

use super::{Any, PyReference, pose};
use crate::pickling::call_of;
use pyo3::prelude::*;

/// Reference that holds a constant pose.
///
/// Parameters
/// ----------
/// pose : (4, 4) array
///     Pose of the tool in ``frame``, m.
/// frame : {"world", "lvlh", "base"} or Target, optional
///     Frame of the reference, or ``"SYSTEM/FRAME"`` (see :class:`Reference`); default: W.
///
/// Raises
/// ------
/// ControlError, InputError, ShapeError
///     If the pose is not a rigid transform or not finite, has the wrong shape, or ``frame`` is unknown.
#[pyclass(name = "Hold", extends = PyReference, frozen, module = "onorbit_rs")]
pub(super) struct PyHold;

#[pymethods]
impl PyHold {
    #[new]
    #[pyo3(signature = (pose, *, frame=None))]
    fn new(
        py: Python<'_>,
        pose: Any<'_, '_>,
        frame: Option<Any<'_, '_>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let call = call_of!(py, "Hold", pose, frame)?;
        Ok(PyClassInitializer::from(PyReference::new(py, Ok(self::pose(pose)?), frame, call)?)
            .add_subclass(Self))
    }
}
