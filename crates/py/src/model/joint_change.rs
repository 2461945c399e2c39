//! Changes to the damping, friction, rotor inertia and spring of joints, read from Python arguments.

use super::PyModel;
use super::merged_call::merged_call;
use crate::errors::{IntoPython, fields};
use onorbit_core::model::JointChange;
use pyo3::prelude::*;

/// Returns a copy of the robot with some properties of one joint replaced.
pub(super) fn with_joint(model: &Bound<'_, PyModel>, change: &JointChange) -> PyResult<PyModel> {
    let py = model.py();
    let old = &model.get().model;
    let new = old.with_joint(change).map_err(|error| error.into_python(py))?;
    let keywords = fields!(
        py,
        "damping": change.damping,
        "friction": change.friction,
        "static_friction": change.static_friction,
        "rotor_inertia": change.rotor_inertia,
        "stiffness": change.stiffness,
        "cubic_stiffness": change.cubic_stiffness,
        "rest_position": change.rest_position,
    );
    let call = merged_call(model, "Model.with_joint", &change.joint, keywords)?;
    PyModel::wrap(py, new, Some(call), old.warnings())
}
