//! Changes to the damping, friction, rotor inertia and spring of joints, read from Python arguments.

use super::PyModel;
use crate::errors::{IntoPython, fields};
use crate::pickling::ConstructorCall;
use onorbit_core::model::JointChange;
use pyo3::prelude::*;
use pyo3::types::PyDict;

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
    let call = call_of_with_joint(model, &change.joint, keywords)?;
    PyModel::wrap(py, new, Some(call), old.warnings())
}

/// Returns the call that reconstructs `model.with_joint(name, **keywords)`. Successive changes of one joint are
/// merged into a single call, so that intermediate models do not remain in memory.
fn call_of_with_joint(
    model: &Bound<'_, PyModel>,
    name: &str,
    keywords: Bound<'_, PyDict>,
) -> PyResult<ConstructorCall> {
    let py = model.py();
    let call = model.get().constructor_call.as_ref();
    let call = call.map(|call| call.arguments_of(py, "Model.with_joint")).transpose()?;
    if let Some((arguments, earlier)) = call.flatten() {
        let (origin, joint): (Bound<'_, PyAny>, String) = arguments.extract()?;
        if joint == name {
            let merged = earlier.copy()?;
            for (key, value) in keywords.iter().filter(|(_, value)| !value.is_none()) {
                merged.set_item(key, value)?;
            }
            return ConstructorCall::new("Model.with_joint", (origin, name), &merged);
        }
    }
    ConstructorCall::new("Model.with_joint", (model, name), &keywords)
}
