//! Robots that are read from files only to be attached to another robot.

use super::file::read_file;
use crate::pickling::{ConstructorCall, Reduced};
use onorbit_core::model::Model;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// Robot that is read from a file to be attached to another robot; its base may be massless.
#[pyclass(name = "RobotPart", frozen, module = "onorbit_rs._core")]
pub(super) struct PyRobotPart {
    pub(super) model: Model,
    constructor_call: ConstructorCall,
}

#[pymethods]
impl PyRobotPart {
    /// Read a URDF or xacro file.
    ///
    /// Parameters
    /// ----------
    /// path, package_paths, xacro_arguments, xacro, links
    ///     Path and options of the file, as for :meth:`Model.from_urdf`.
    ///
    /// Returns
    /// -------
    /// RobotPart
    ///
    /// Raises
    /// ------
    /// ModelError, InputError, ShapeError, NotFoundError, ReadError
    ///     As for :meth:`Model.from_urdf`.
    #[staticmethod]
    #[pyo3(signature = (path, *, package_paths=None, xacro_arguments=None, xacro=false, links=None))]
    pub(super) fn from_urdf(
        py: Python<'_>,
        path: PathBuf,
        package_paths: Option<Vec<PathBuf>>,
        xacro_arguments: Option<&Bound<'_, PyDict>>,
        xacro: bool,
        links: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let (model, keywords) = read_file(py, &path, package_paths, xacro_arguments, xacro, links, true)?;
        let constructor_call = ConstructorCall::with_keywords("RobotPart.from_urdf", &keywords)?;
        Ok(Self { model, constructor_call })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        self.constructor_call.reduce(py)
    }

    fn __repr__(&self) -> String {
        format!("<RobotPart '{}'>", self.model.name())
    }
}
