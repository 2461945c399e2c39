//! Attachment of one robot to another.

use super::part::PyRobotPart;
use super::{Any, PyModel};
use crate::arrays::{fixed, type_name};
use crate::errors::{IntoPython, fields, plain, raise};
use crate::pickling::{ConstructorCall, deep_copy};
use nalgebra::Isometry3;
use onorbit_core::model::Mount;
use onorbit_core::number_text::exact;
use onorbit_core::reference::Hold;
use pyo3::prelude::*;
use std::path::PathBuf;

/// Attach one robot to another, such as an arm to a bus, and return the combined robot.
///
/// ``other`` is fixed to a frame of ``model``. The result has the base and the name of ``model``. Joints are
/// numbered depth first: the joints of ``other`` come after all joints of ``model`` if ``frame`` is fixed to
/// the base, otherwise after the joints that descend from the body of ``frame``.
///
/// Parameters
/// ----------
/// model : Model
///     Robot to which the other one is attached, such as a bus.
/// frame : str
///     Link or frame of ``model`` to which ``other`` is attached.
/// other : Model or path
///     Robot to attach, such as an arm. If it is a URDF or xacro file, its base may be massless.
/// other_frame : str, optional
///     Mounting frame of ``other``. Defaults to its root link. If the frame is on a link that joints move,
///     ``other`` is first re-rooted at that link (:meth:`Model.rerooted`).
/// pose : (4, 4) array, optional
///     Pose of the mounting frame relative to ``frame``, a homogeneous transform, m. Defaults to the
///     identity.
/// prefix : str, optional
///     Prefix for the names of all links, joints, frames and loops of ``other``, such as ``"left_"``.
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
///     If a link, joint, frame or loop of one robot has the same name as one of the other, the pose is
///     invalid, or the file of ``other`` does not describe a valid robot.
/// InputError, ShapeError
///     If ``pose`` is not finite or has the wrong shape.
/// NotFoundError, ReadError
///     If the file of ``other`` does not exist or cannot be read.
#[pyfunction]
#[pyo3(signature = (model, frame, other, other_frame=None, *, pose=None, prefix=""))]
pub(super) fn attach(
    model: &Bound<'_, PyModel>,
    frame: &str,
    other: Any<'_, '_>,
    other_frame: Option<&str>,
    pose: Option<Any<'_, '_>>,
    prefix: &str,
) -> PyResult<PyModel> {
    let py = model.py();
    let mount = Mount {
        frame: other_frame.map(str::to_owned),
        pose: pose.map(isometry).transpose()?.unwrap_or_default(),
        prefix: prefix.to_owned(),
        ..Mount::default()
    };
    let other = model_or_part(other)?;
    let bus = &model.get().model;
    let (arm, is_part) = match other.cast::<PyModel>() {
        Ok(model) => (&*model.get().model, false),
        Err(_) => (&other.cast::<PyRobotPart>()?.get().model, true),
    };
    let whole = bus.attach(frame, arm, &mount).map_err(|error| error.into_python(py))?;
    // the warnings of models were issued when the models were loaded; those of a part are issued here
    let known = if is_part { bus.warnings().to_vec() } else { whole.warnings().to_vec() };
    let keywords = fields!(py, "pose": deep_copy(pose)?, "prefix": prefix);
    let call = ConstructorCall::new("attach", (model, frame, &other, other_frame), &keywords)?;
    PyModel::wrap(py, whole, Some(call), &known)
}

/// Returns `other` if it is a robot; if it is a path, reads the robot from the file.
fn model_or_part<'py>(other: Any<'_, 'py>) -> PyResult<Bound<'py, PyAny>> {
    if other.is_instance_of::<PyModel>() || other.is_instance_of::<PyRobotPart>() {
        return Ok(other.clone());
    }
    let py = other.py();
    let Ok(path) = other.extract::<PathBuf>() else {
        let got = type_name(other);
        let message = format!("other is of type {got}; expected a Model or the path of a URDF or xacro file");
        return Err(raise(py, "DtypeError", &message, &fields!(py, "name": "other", "got": got)));
    };
    Ok(Bound::new(py, PyRobotPart::from_urdf(py, path, None, None, false, None)?)?.into_any())
}

/// Reads the argument `pose`, a (4, 4) homogeneous transform, m.
pub(crate) fn isometry(pose: Any<'_, '_>) -> PyResult<Isometry3<f64>> {
    let refuse = |message: &str| plain(pose.py(), "ModelError", message);
    let rows = fixed::<16>(pose, "pose", &[4, 4])?;
    if let Some(entry) = rows.iter().find(|entry| entry.abs() > 1e12) {
        return Err(refuse(&format!(
            "the pose holds {}; expected numbers between -1e12 and 1e12 (positions in m); check the units",
            exact(*entry)
        )));
    }
    let poses = Hold::from_rows(&[rows]).map_err(|error| refuse(&error.to_string()))?;
    Ok(poses[0].isometry())
}
