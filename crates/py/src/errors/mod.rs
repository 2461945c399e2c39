//! The one bridge from errors of the core to the classes of `onorbit_rs.exceptions`.

mod batch;
mod control;
mod earth;
mod environment;
mod gravity;
mod model;
mod orbit;
mod simulation;

pub(crate) use simulation::SimulationErrorExt;

use onorbit_core::text_file::TextFileError;
use pyo3::exceptions::{PyException, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::Path;

/// An error of the core that knows its Python class.
pub(crate) trait IntoPython {
    fn into_python(self, py: Python<'_>) -> PyErr;
}

/// `onorbit_rs.exceptions.<class>(message, **fields)`.
pub(crate) fn raise(py: Python<'_>, class: &str, message: &str, fields: &Bound<'_, PyDict>) -> PyErr {
    let make = || -> PyResult<Bound<'_, PyAny>> {
        let module = py.import("onorbit_rs.exceptions")?;
        module.getattr(class)?.call((message,), Some(fields))
    };
    match make() {
        Ok(error) => PyErr::from_value(error),
        Err(interrupt) if is_interrupt(py, &interrupt) => {
            // a Ctrl-C was pending: it is raised, and the error is what it came during
            let context = make().map(PyErr::from_value).ok();
            interrupt.set_context(py, context);
            interrupt
        }
        Err(_) => PyRuntimeError::new_err(message.to_owned()),
    }
}

/// Whether this is a Ctrl-C, or what else ends a program: no error of a call.
pub(crate) fn is_interrupt(py: Python<'_>, error: &PyErr) -> bool {
    !error.is_instance_of::<PyException>(py)
}

/// The error, with the file that it is about before its message.
pub(crate) fn in_file(py: Python<'_>, path: &Path, error: impl IntoPython) -> PyErr {
    let error = error.into_python(py);
    let value = error.value(py);
    let told = value.getattr("message").and_then(|message| message.extract::<String>());
    let message = format!("{}: {}", path.display(), told.unwrap_or_else(|_| value.to_string()));
    let _ = value.setattr("message", message); // without it the message stays as it was
    error
}

/// Bytes of a table of the Earth's orientation or of space weather, which take ten million.
pub(crate) const LARGEST_TABLE: usize = 100_000_000;

/// A text file that cannot be read; `what` it was to be.
pub(crate) fn unreadable(py: Python<'_>, path: &Path, what: &str, error: &TextFileError) -> PyErr {
    let file = path.display();
    let (class, message) = match error {
        TextFileError::NotFound => ("NotFoundError", format!("{file}: there is no such {what}")),
        error => ("ReadError", format!("{file}: the {what} cannot be read: {error}")),
    };
    raise(py, class, &message, &fields!(py, "path": file.to_string(), "kind": what))
}

/// An error without fields.
pub(crate) fn plain(py: Python<'_>, class: &str, message: &str) -> PyErr {
    raise(py, class, message, &PyDict::new(py))
}

/// An array whose shape is not the one expected.
pub(crate) fn shape_error<'py>(
    py: Python<'py>,
    message: &str,
    name: impl IntoPyObject<'py>,
    expected: impl IntoPyObject<'py>,
    got: impl IntoPyObject<'py>,
) -> PyErr {
    raise(py, "ShapeError", message, &fields!(py, "name": name, "expected": expected, "got": got))
}

/// Collects the fields of an error; what cannot be converted is left out of them.
macro_rules! fields {
    ($py:expr, $($name:literal: $value:expr),* $(,)?) => {{
        let fields = pyo3::types::PyDict::new($py);
        $( let _ = fields.set_item($name, $value); )*
        fields
    }};
}
pub(crate) use fields;
