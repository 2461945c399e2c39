//! Attaches one robot to another.

use crate::arrays::fixed;
use crate::errors::{IntoPython, fields, plain};
use crate::made::{Made, copied};
use crate::model::PyModel;
use nalgebra::Isometry3;
use onorbit_core::model::Mount;
use onorbit_core::reference::Hold;
use pyo3::prelude::*;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Attach one robot to another, such as an arm to a bus, and return the combined robot.
///
/// ``other`` is fixed to a frame of ``model``. The base and the name of the result are those of ``model``.
///
/// Parameters
/// ----------
/// model : Model
///     The robot that carries the other, such as a bus.
/// frame : str
///     Link or frame of ``model`` to attach to.
/// other : Model
///     The robot to attach, such as an arm.
/// other_frame : str, optional
///     Mounting frame of ``other``. It must be fixed to the base of ``other``. Defaults to its root link.
/// pose : (4, 4) array, optional
///     Homogeneous transform of the mounting frame in ``frame``, m. Defaults to the identity.
/// prefix : str, optional
///     Prefix for the names of all links, joints and frames of ``other``, such as ``"left_"``.
///
/// Returns
/// -------
/// Model
///
/// Raises
/// ------
/// FrameError
///     If a frame does not exist.
/// ModelError
///     If both robots have a link, joint or frame of the same name, or if joints move ``other_frame``.
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
    let known = whole.warnings().to_vec(); // they were issued when the two robots were loaded
    PyModel::wrap(py, whole, Some(made), &known)
}

/// Converts a (4, 4) homogeneous transform.
fn isometry(pose: Any<'_, '_>) -> PyResult<Isometry3<f64>> {
    let poses = Hold::from_rows(&[fixed(pose, "pose", &[4, 4])?])
        .map_err(|error| plain(pose.py(), "ModelError", &error.to_string()))?;
    Ok(poses[0].isometry())
}
