//! Pickles objects by recording the call that constructed them.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};
use std::path::{Path, PathBuf};

/// Function and arguments that rebuild an object: the value of `__reduce__`.
pub(crate) type Reduced<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>);

/// Constructor, arguments and keywords with which an object is reconstructed.
pub(crate) struct ConstructorCall(Py<PyTuple>);

impl ConstructorCall {
    /// Records a call that has only keyword arguments.
    pub(crate) fn with_keywords(constructor: &str, keywords: &Bound<'_, PyDict>) -> PyResult<Self> {
        Self::new(constructor, (), keywords)
    }

    /// Records a call that has only keyword arguments. Arrays, lists and tuples are copied, so later changes
    /// to them do not affect the record.
    pub(crate) fn with_copies(constructor: &str, keywords: &Bound<'_, PyDict>) -> PyResult<Self> {
        let copies = keywords.copy()?;
        for (name, value) in keywords.iter() {
            let is_list = value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>();
            if is_list || value.hasattr("__array__")? {
                copies.set_item(name, deep_copy(Some(&value))?)?;
            }
        }
        Self::new(constructor, (), &copies)
    }

    /// Records a call with positional and keyword arguments.
    pub(crate) fn new<'py, A>(
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

    /// Returns the arguments and keywords if the object was constructed by `constructor`, otherwise `None`.
    pub(crate) fn arguments_of<'py>(
        &self,
        py: Python<'py>,
        constructor: &str,
    ) -> PyResult<Option<(Bound<'py, PyTuple>, Bound<'py, PyDict>)>> {
        let (own, arguments, keywords) = self.0.bind(py).extract::<(String, _, _)>()?;
        Ok((own == constructor).then_some((arguments, keywords)))
    }

    /// Returns the value of `__reduce__` for this call.
    pub(crate) fn reduce<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let rebuild = py.import("onorbit_rs.common.pickling")?.getattr("rebuild")?;
        Ok((rebuild, self.0.bind(py).clone().into_any()))
    }

    /// Returns the value of `__reduce__` of a robot whose file may change before it is read again.
    ///
    /// The file is read in this process as well, so that an error is reported here; in a worker of a pool, an
    /// error would stop the worker silently.
    pub(crate) fn reduce_robot<'py>(&self, robot: &Bound<'py, PyAny>) -> PyResult<Reduced<'py>> {
        let py = robot.py();
        let print = py.import("onorbit_rs.robots.fingerprint")?.call_method1("fingerprint", (robot,))?;
        let rebuild = py.import("onorbit_rs.robots.pickling")?.getattr("rebuild_robot")?;
        let arguments = self.0.bind(py).add((print,))?;
        rebuild.call1(arguments.cast::<PyTuple>()?)?;
        Ok((rebuild, arguments))
    }
}

/// Records the call of a constructor, given its name and one variable per argument that has the name and the
/// value of the argument.
macro_rules! call_of {
    ($py:expr, $constructor:literal, $($name:ident),+ $(,)?) => {{
        let keywords = pyo3::types::PyDict::new($py);
        $(keywords.set_item(stringify!($name), $name)?;)+
        $crate::pickling::ConstructorCall::with_copies($constructor, &keywords)
    }};
}
pub(crate) use call_of;

/// Returns the absolute path, which is valid in any working directory.
pub(crate) fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// Returns a deep copy of a value, if there is one. Later changes to the original do not affect the copy.
pub(crate) fn deep_copy<'py>(value: Option<&Bound<'py, PyAny>>) -> PyResult<Option<Bound<'py, PyAny>>> {
    value.map(|value| value.py().import("copy")?.call_method1("deepcopy", (value,))).transpose()
}
