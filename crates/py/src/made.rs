//! How objects come back from a pickle: by the call that made them.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::path::{Path, PathBuf};

/// Constructor, arguments and keywords that make an object again.
pub(crate) struct Made(Py<PyTuple>);

impl Made {
    /// Records a construction by keywords only.
    pub(crate) fn by(constructor: &str, keywords: &Bound<'_, PyDict>) -> PyResult<Self> {
        Self::with(constructor, (), keywords)
    }

    /// Records a construction by arguments and keywords.
    pub(crate) fn with<'py, A>(
        constructor: &str,
        arguments: A,
        keywords: &Bound<'py, PyDict>,
    ) -> PyResult<Self>
    where
        A: IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>>,
        PyErr: From<A::Error>,
    {
        let py = keywords.py();
        let arguments = arguments.into_pyobject(py)?;
        Ok(Self((constructor, arguments, keywords).into_pyobject(py)?.unbind()))
    }

    /// The arguments and keywords, if `constructor` made the object.
    pub(crate) fn call_of<'py>(
        &self,
        py: Python<'py>,
        constructor: &str,
    ) -> PyResult<Option<(Bound<'py, PyTuple>, Bound<'py, PyDict>)>> {
        let (made_by, arguments, keywords) = self.0.bind(py).extract::<(String, _, _)>()?;
        Ok((made_by == constructor).then_some((arguments, keywords)))
    }

    /// What `__reduce__` returns.
    pub(crate) fn again<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Py<PyTuple>)> {
        Ok((py.import("onorbit_rs.rebuild")?.getattr("rebuild")?, self.0.clone_ref(py)))
    }

    /// What `__reduce__` of a robot returns: its file may be another by the time it is read again. It is read here
    /// once, too: what is refused where it is sent is told, an error on arrival stops a worker of a pool in silence.
    pub(crate) fn robot_again<'py>(
        &self,
        robot: &Bound<'py, PyAny>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let py = robot.py();
        let print = py.import("onorbit_rs.robots.fingerprint")?.call_method1("fingerprint", (robot,))?;
        let rebuild = py.import("onorbit_rs.rebuild")?.getattr("rebuild_robot")?;
        let arguments = self.0.bind(py).add((print,))?;
        rebuild.call1(arguments.cast::<PyTuple>()?)?;
        Ok((rebuild, arguments))
    }
}

/// A path that means the same in another folder.
pub(crate) fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// Returns a deep copy, which later changes of the original do not affect.
pub(crate) fn copied<'py>(value: Option<&Bound<'py, PyAny>>) -> PyResult<Option<Bound<'py, PyAny>>> {
    value.map(|value| value.py().import("copy")?.call_method1("deepcopy", (value,))).transpose()
}
