//! Robots from xacro files, which Python expands.

use crate::errors::IntoPython;
use onorbit_core::model::{LinkChange, Model, ModelWarning, urdf};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};

/// Text and remarks come from `onorbit_rs.robots.expand`; errors name the file, and no line: it
/// would be one of the expanded text, which nobody sees.
pub(crate) fn from_xacro(
    py: Python<'_>,
    path: &Path,
    packages: &[PathBuf],
    arguments: Option<&Bound<'_, PyDict>>,
    changes: &[LinkChange],
) -> PyResult<Model> {
    let expand = py.import("onorbit_rs.robots.expand")?.getattr("expand")?;
    let (text, remarks): (String, Vec<String>) = expand.call1((path, packages, arguments))?.extract()?;
    let folder = std::path::absolute(path).ok().and_then(|path| path.parent().map(Path::to_owned));
    let mut model = urdf::from_str(&text, folder.as_deref(), packages, changes).map_err(|mut error| {
        error.file = Some(path.to_owned());
        error.line = None;
        error.into_python(py)
    })?;
    for remark in remarks {
        model.warn(ModelWarning::Note(remark));
    }
    Ok(model)
}
