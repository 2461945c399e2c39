//! Reading of robots from files.

use super::PyModel;
use super::link_change::link_changes;
use super::xacro::from_xacro;
use crate::errors::{IntoPython, fields};
use crate::pickling::{ConstructorCall, absolute, deep_copy};
use onorbit_core::model::{Model, urdf};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};

/// Reads a URDF or xacro file; the base of the robot may be massless if `is_part` is true. Also returns the
/// keyword arguments with which the same file can be read from another working directory.
pub(super) fn read_file<'py>(
    py: Python<'py>,
    path: &Path,
    package_paths: Option<Vec<PathBuf>>,
    xacro_arguments: Option<&Bound<'py, PyDict>>,
    xacro: bool,
    links: Option<&Bound<'py, PyDict>>,
    is_part: bool,
) -> PyResult<(Model, Bound<'py, PyDict>)> {
    let changes = link_changes(links)?;
    let packages: Vec<PathBuf> =
        package_paths.unwrap_or_default().iter().map(|path| absolute(path)).collect();
    let keywords = fields!(py, "path": absolute(path), "package_paths": packages.clone());
    keywords.set_item("xacro_arguments", xacro_arguments.map(|given| given.copy()).transpose()?)?;
    keywords.set_item("xacro", xacro)?;
    keywords.set_item("links", deep_copy(links.map(Bound::as_any))?)?;
    let options = urdf::Options { packages: &packages, changes: &changes, is_part };
    let has_xacro_extension = path.extension().is_some_and(|end| end.eq_ignore_ascii_case("xacro"));
    let model = if xacro || has_xacro_extension || xacro_arguments.is_some() {
        from_xacro(py, path, xacro_arguments, &options)?
    } else {
        urdf::from_file(path, &options).map_err(|error| error.into_python(py))?
    };
    Ok((model, keywords))
}

/// Reads a robot from the text of a URDF.
pub(super) fn from_urdf_string(
    py: Python<'_>,
    text: &str,
    folder: Option<PathBuf>,
    package_paths: Option<Vec<PathBuf>>,
) -> PyResult<PyModel> {
    let packages = package_paths.unwrap_or_default();
    let options = urdf::Options { packages: &packages, ..Default::default() };
    let model = urdf::from_str(text, folder.as_deref(), &options).map_err(|error| error.into_python(py))?;
    let packages: Vec<PathBuf> = packages.iter().map(|path| absolute(path)).collect();
    let folder = folder.as_deref().map(absolute);
    let keywords = fields!(py, "text": text, "folder": folder, "package_paths": packages);
    let call = ConstructorCall::with_keywords("Model.from_urdf_string", &keywords)?;
    PyModel::wrap(py, model, Some(call), &[])
}
