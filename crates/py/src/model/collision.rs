//! Collision shapes that are added to links.

use super::attach::isometry;
use super::shape::PyShape;
use super::{Any, PyModel};
use crate::errors::{IntoPython, fields};
use crate::pickling::{ConstructorCall, deep_copy};
use onorbit_core::model::Visual;
use pyo3::prelude::*;

/// Returns a copy of the robot with another collision shape on a link.
pub(super) fn with_collision(
    model: &Bound<'_, PyModel>,
    link: &str,
    shape: &Bound<'_, PyShape>,
    pose: Option<Any<'_, '_>>,
) -> PyResult<PyModel> {
    let py = model.py();
    let visual = Visual {
        pose: pose.map(isometry).transpose()?.unwrap_or_default(),
        geometry: shape.get().geometry.clone(),
        rgba: None,
    };
    let old = &model.get().model;
    let new = old.with_collision(link, visual).map_err(|error| error.into_python(py))?;
    let keywords = fields!(py, "pose": deep_copy(pose)?);
    let call = ConstructorCall::new("Model.with_collision", (model, link, shape), &keywords)?;
    PyModel::wrap(py, new, Some(call), old.warnings())
}
