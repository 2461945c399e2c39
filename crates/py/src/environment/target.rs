//! Systems on which effects act, and lookup of their links by path.

use super::surfaces::SurfaceAssignment;
use crate::errors::{IntoPython, fields, raise};
use onorbit_core::model::{Model, ModelError};
use pyo3::prelude::*;

/// System on which effects act.
pub(crate) struct Target<'a> {
    /// Name of the system.
    pub(crate) name: &'a str,
    pub(crate) model: &'a Model,
    /// Surfaces that were declared with the system.
    pub(crate) surfaces: Option<&'a SurfaceAssignment>,
}

/// Returns the indices of the system and of the frame with the path `SYSTEM/LINK`. If there is only one
/// system, its name may be omitted.
pub(super) fn frame_at(py: Python<'_>, targets: &[Target<'_>], path: &str) -> PyResult<(usize, usize)> {
    let on_system = |system: usize, frame: &str| {
        let frame = targets[system].model.frame(frame).map_err(|error| error.into_python(py))?;
        Ok((system, frame))
    };
    let parts = path.split_once('/').and_then(|(name, frame)| Some((named(targets, name)?, frame)));
    match (targets, parts) {
        ([_], None) => on_system(0, path),
        ([only], Some((_, frame))) => on_system(0, if only.model.frame(path).is_ok() { path } else { frame }),
        (_, Some((system, frame))) => on_system(system, frame),
        (_, None) => Err(no_system(py, targets, path)),
    }
}

/// Returns the index of the system with this name, or `None` if there is no such system.
pub(super) fn named(targets: &[Target<'_>], name: &str) -> Option<usize> {
    targets.iter().position(|target| target.name == name)
}

/// Returns the error for a path whose first part is not the name of a system.
pub(super) fn no_system(py: Python<'_>, targets: &[Target<'_>], path: &str) -> PyErr {
    let example = targets
        .first()
        .map_or_else(String::new, |target| format!("{}/{}", target.name, target.model.body_frame(0).name));
    let message = match path.split_once('/') {
        None => format!("'{path}' is not a link of a system; write SYSTEM/LINK, such as '{example}'"),
        Some((name, _)) => {
            let candidates = targets.iter().map(|target| target.name.to_owned()).collect();
            ModelError::UnknownName { what: "system", name: name.to_owned(), candidates }.to_string()
        }
    };
    raise(py, "WorldError", &message, &fields!(py, "name": path))
}
