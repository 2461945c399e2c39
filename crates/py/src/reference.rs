//! References for a tool.

use crate::arrays::fixed;
use crate::errors::{IntoPython, fields, raise};
use nalgebra::{Matrix3, Matrix4, RowVector4, Vector3};
use onorbit_core::reference::{Hold, LineParabola, TaskReference};
use pyo3::prelude::*;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Hold a pose (4, 4) in W.
#[pyclass(name = "Hold", frozen, module = "onorbit_rs")]
pub(crate) struct PyHold {
    reference: TaskReference,
}

#[pymethods]
impl PyHold {
    #[new]
    fn new(py: Python<'_>, pose: Any<'_, '_>) -> PyResult<Self> {
        let (rot, pos) = split(pose)?;
        let hold = Hold::new(rot, pos).map_err(|error| error.into_python(py))?;
        Ok(Self { reference: hold.into() })
    }
}

/// ``p(t) = p0 + s d + s (1 - s) h`` in W axes with ``s`` the quintic from 0 to 1 over ``duration`` s, attitude held.
///
/// ``start_pose`` (4, 4); ``displacement`` ``d`` (3,) m; ``height`` ``h`` (3,) m, a quarter of it is reached half way.
#[pyclass(name = "LineParabola", frozen, module = "onorbit_rs")]
pub(crate) struct PyLineParabola {
    reference: TaskReference,
}

#[pymethods]
impl PyLineParabola {
    #[new]
    #[pyo3(signature = (start_pose, *, displacement, duration, height=None))]
    fn new(
        py: Python<'_>,
        start_pose: Any<'_, '_>,
        displacement: Any<'_, '_>,
        duration: f64,
        height: Option<Any<'_, '_>>,
    ) -> PyResult<Self> {
        let (rot, pos) = split(start_pose)?;
        let displacement = Vector3::from(fixed::<3>(displacement, "displacement", &[3])?);
        let height = Vector3::from(height.map_or(Ok([0.0; 3]), |value| fixed::<3>(value, "height", &[3]))?);
        let line = LineParabola::new(rot, pos, displacement, height, duration);
        Ok(Self { reference: line.map_err(|error| error.into_python(py))?.into() })
    }
}

/// The reference inside a Python object.
pub(crate) fn extract(value: Any<'_, '_>) -> PyResult<TaskReference> {
    if let Ok(hold) = value.cast::<PyHold>() {
        return Ok(hold.get().reference.clone());
    }
    if let Ok(line) = value.cast::<PyLineParabola>() {
        return Ok(line.get().reference.clone());
    }
    let py = value.py();
    let got = value.get_type().name()?.to_string();
    let message = format!("reference is of type {got}, a Hold or a LineParabola is needed");
    let fields = fields!(py, "name": "reference", "expected": "Hold or LineParabola", "got": got);
    Err(raise(py, "DtypeError", &message, &fields))
}

/// Rotation and position of a (4, 4) pose.
fn split(pose: Any<'_, '_>) -> PyResult<(Matrix3<f64>, Vector3<f64>)> {
    let py = pose.py();
    let pose = Matrix4::from_row_slice(&fixed::<16>(pose, "pose", &[4, 4])?);
    let last = pose.fixed_view::<1, 4>(3, 0).into_owned();
    if last != RowVector4::new(0.0, 0.0, 0.0, 1.0) {
        let row = [last[0], last[1], last[2], last[3]];
        let message = format!("the last row of the pose is {row:?}, it must be [0, 0, 0, 1]");
        return Err(raise(py, "ControlError", &message, &fields!(py, "name": "pose", "got": row.to_vec())));
    }
    Ok((pose.fixed_view::<3, 3>(0, 0).into_owned(), pose.fixed_view::<3, 1>(0, 3).into_owned()))
}
