//! Converts all errors of the core to the exception classes of `onorbit_rs.exceptions`.

mod batch;
mod contact;
mod control;
mod earth;
mod environment;
mod geometry;
mod gravity;
mod model;
mod orbit;
mod simulation;
mod world;

pub(crate) use simulation::SimulationErrorExt;

use onorbit_core::text_file::TextFileError;
use pyo3::exceptions::{PyException, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::Path;

/// Error of the core that is converted to a Python exception.
pub(crate) trait IntoPython {
    /// Returns the exception, with the fields of the error as attributes.
    fn into_python(self, py: Python<'_>) -> PyErr;
}

/// Returns the exception `onorbit_rs.exceptions.<class>(message, **fields)`.
pub(crate) fn raise(py: Python<'_>, class: &str, message: &str, fields: &Bound<'_, PyDict>) -> PyErr {
    let construct = || -> PyResult<Bound<'_, PyAny>> {
        let module = py.import("onorbit_rs.exceptions")?;
        module.getattr(class)?.call((message,), Some(fields))
    };
    match construct() {
        Ok(error) => PyErr::from_value(error),
        Err(interrupt) if is_interrupt(py, &interrupt) => {
            // if a Ctrl-C is pending, it is raised with the error as its context
            let context = construct().map(PyErr::from_value).ok();
            interrupt.set_context(py, context);
            interrupt
        }
        Err(_) => PyRuntimeError::new_err(message.to_owned()),
    }
}

/// Returns true for a Ctrl-C or another exception that is not a subclass of Python's `Exception`.
pub(crate) fn is_interrupt(py: Python<'_>, error: &PyErr) -> bool {
    !error.is_instance_of::<PyException>(py)
}

/// Returns the error with the name of the file at the beginning of its message.
pub(crate) fn in_file(py: Python<'_>, path: &Path, error: impl IntoPython) -> PyErr {
    let error = error.into_python(py);
    let value = error.value(py);
    let original = value.getattr("message").and_then(|message| message.extract::<String>());
    let message = format!("{}: {}", path.display(), original.unwrap_or_else(|_| value.to_string()));
    with_message(py, error, &message)
}

/// Replaces the message of an exception that has one, and returns the exception.
pub(crate) fn with_message(py: Python<'_>, error: PyErr, message: &str) -> PyErr {
    let _ = error.value(py).setattr("message", message); // if this fails, the message is unchanged
    error
}

/// Largest accepted size of a table of Earth orientation or space weather, in bytes. Published tables have up
/// to ten million bytes.
pub(crate) const LARGEST_TABLE: usize = 100_000_000;

/// Returns the error for a text file that cannot be read; `what` names its content.
pub(crate) fn unreadable(py: Python<'_>, path: &Path, what: &str, error: &TextFileError) -> PyErr {
    let file = path.display();
    let (class, message) = match error {
        TextFileError::NotFound => {
            ("NotFoundError", format!("{file}: there is no such {what}; check the path"))
        }
        error => ("ReadError", format!("the {what} {file} cannot be read: {error}")),
    };
    raise(py, class, &message, &fields!(py, "path": file.to_string(), "kind": what))
}

/// Returns the exception `onorbit_rs.exceptions.<class>(message)`, without fields.
pub(crate) fn plain(py: Python<'_>, class: &str, message: &str) -> PyErr {
    raise(py, class, message, &PyDict::new(py))
}

/// Returns the error for an array with an unexpected shape.
pub(crate) fn shape_error<'py>(
    py: Python<'py>,
    message: &str,
    name: impl IntoPyObject<'py>,
    expected: impl IntoPyObject<'py>,
    got: impl IntoPyObject<'py>,
) -> PyErr {
    raise(py, "ShapeError", message, &fields!(py, "name": name, "expected": expected, "got": got))
}

/// Collects the fields of an error; fields that cannot be converted are omitted.
macro_rules! fields {
    ($py:expr, $($name:literal: $value:expr),* $(,)?) => {{
        let fields = pyo3::types::PyDict::new($py);
        $( let _ = fields.set_item($name, $value); )*
        fields
    }};
}
pub(crate) use fields;
