//! One robot of two: an arm on a bus.

use crate::arrays::fixed;
use crate::errors::{IntoPython, fields, plain};
use crate::made::{Made, copied};
use crate::model::PyModel;
use nalgebra::Isometry3;
use onorbit_core::model::Mount;
use onorbit_core::reference::Hold;
use pyo3::prelude::*;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// One robot of two: ``other`` fixed to a frame of ``model``, whose base stays the base.
///
/// Parameters
/// ----------
/// model : Model
///     Such as a bus. The new robot has its name.
/// frame : str
///     Where on it: a link or frame.
/// other : Model
///     Such as an arm.
/// other_frame : str, optional
///     The frame of ``other`` that is put there, fixed to its base; its root link where not given.
/// pose : (4, 4) array, optional
///     Pose of that frame in ``frame``, m.
/// prefix : str, optional
///     Put before the names of the links, joints and frames of ``other``: ``"left_"``.
///
/// Raises
/// ------
/// FrameError
///     There is no such frame.
/// ModelError
///     Both have a link, joint or frame of the same name, or ``other_frame`` is moved by joints.
#[pyfunction]
#[pyo3(signature = (model, frame, other, other_frame=None, *, pose=None, prefix=""))]
pub(crate) fn attach(
    model: &Bound<'_, PyModel>,
    frame: &str,
    other: &Bound<'_, PyModel>,
    other_frame: Option<&str>,
    pose: Option<Any<'_, '_>>,
    prefix: &str,
) -> PyResult<PyModel> {
    let py = model.py();
    let mount = Mount {
        frame: other_frame.map(str::to_owned),
        pose: pose.map(isometry).transpose()?.unwrap_or_default(),
        prefix: prefix.to_owned(),
    };
    let (bus, arm) = (&model.get().model, &other.get().model);
    let whole = bus.attach(frame, arm, &mount).map_err(|error| error.into_python(py))?;
    let keywords = fields!(py, "pose": copied(pose)?, "prefix": prefix);
    let made = Made::with("attach", (model, frame, other, other_frame), &keywords)?;
    let known = whole.warnings().to_vec(); // they were told of the two
    PyModel::wrap(py, whole, Some(made), &known)
}

/// A (4, 4) pose.
fn isometry(pose: Any<'_, '_>) -> PyResult<Isometry3<f64>> {
    let poses = Hold::from_rows(&[fixed(pose, "pose", &[4, 4])?])
        .map_err(|error| plain(pose.py(), "ModelError", &error.to_string()))?;
    Ok(poses[0].isometry())
}
