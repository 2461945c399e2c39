//! Robots from files.

use crate::errors::{IntoPython, fields};
use crate::link_change::link_changes;
use crate::made::{Made, absolute, copied};
use crate::xacro::from_xacro;
use onorbit_core::model::{Model, urdf};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::path::{Path, PathBuf};

/// Reads a URDF or xacro file; also returns the keyword arguments that read it again from another folder.
pub(crate) fn read_file<'py>(
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
    keywords.set_item("links", copied(links.map(Bound::as_any))?)?;
    let options = urdf::Options { packages: &packages, changes: &changes, is_part };
    let is_named_so = path.extension().is_some_and(|end| end.eq_ignore_ascii_case("xacro"));
    let model = if xacro || is_named_so || xacro_arguments.is_some() {
        from_xacro(py, path, xacro_arguments, &options)?
    } else {
        urdf::from_file(path, &options).map_err(|error| error.into_python(py))?
    };
    Ok((model, keywords))
}

/// A robot of a file that is to be attached to another. It need not be able to float by itself: its base may lack mass.
#[pyclass(name = "RobotPart", frozen, module = "onorbit_rs._core")]
pub(crate) struct PyRobotPart {
    pub(crate) model: Model,
    made: Made,
}

#[pymethods]
impl PyRobotPart {
    /// Read a URDF or xacro file; arguments as in :meth:`Model.from_urdf`.
    #[staticmethod]
    #[pyo3(signature = (path, *, package_paths=None, xacro_arguments=None, xacro=false, links=None))]
    pub(crate) fn from_urdf(
        py: Python<'_>,
        path: PathBuf,
        package_paths: Option<Vec<PathBuf>>,
        xacro_arguments: Option<&Bound<'_, PyDict>>,
        xacro: bool,
        links: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let (model, keywords) = read_file(py, &path, package_paths, xacro_arguments, xacro, links, true)?;
        Ok(Self { model, made: Made::by("RobotPart.from_urdf", &keywords)? })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Py<PyTuple>)> {
        self.made.again(py)
    }

    fn __repr__(&self) -> String {
        format!("<RobotPart '{}'>", self.model.name())
    }
}
