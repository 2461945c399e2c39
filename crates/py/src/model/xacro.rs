//! Robots from xacro files.

use crate::errors::IntoPython;
use onorbit_core::model::{Model, ModelWarning, urdf};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::Path;

/// Reads a robot from a xacro file, which the Python module `onorbit_rs.robots.expand` expands to URDF.
///
/// Error messages name the file but no line, because the line number would refer to the expanded text, which
/// the user does not see.
pub(super) fn from_xacro(
    py: Python<'_>,
    path: &Path,
    arguments: Option<&Bound<'_, PyDict>>,
    options: &urdf::Options<'_>,
) -> PyResult<Model> {
    let expand = py.import("onorbit_rs.robots.expand")?.getattr("expand")?;
    let (text, remarks): (String, Vec<String>) =
        expand.call1((path, options.packages, arguments))?.extract()?;
    let folder = std::path::absolute(path).ok().and_then(|path| path.parent().map(Path::to_owned));
    let mut model = urdf::from_str(&text, folder.as_deref(), options).map_err(|mut error| {
        error.file = Some(path.to_owned());
        error.line = None;
        error.into_python(py)
    })?;
    for remark in remarks {
        model.warn(ModelWarning::Note(remark));
    }
    Ok(model)
}
