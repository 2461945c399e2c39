//! Exceptions of runs that end early.

use crate::errors::{SimulationErrorExt, fields, raise};
use onorbit_core::control::ControlError;
use onorbit_core::number_text::short;
use onorbit_core::simulation::SimulationError;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

/// Returns the exception for a run that ended with an error. `last` is the time of the last row, s.
///
/// If a Ctrl-C was raised in a Python controller or in an external engine, or is pending while the run fails,
/// the exception is `RunInterrupted` with the error as its context.
pub(crate) fn run_failure(
    py: Python<'_>,
    error: SimulationError,
    last: Option<f64>,
    trace: Option<Py<PyAny>>,
) -> PyErr {
    let ctrl_c = match &error {
        SimulationError::Control(ControlError::User(source)) | SimulationError::Engine(source) => source
            .downcast_ref::<PyErr>()
            .filter(|error| error.is_instance_of::<PyKeyboardInterrupt>(py))
            .map(|error| error.clone_ref(py)),
        _ => match py.check_signals() {
            Err(other) if !other.is_instance_of::<PyKeyboardInterrupt>(py) => return other,
            checked => checked.err(),
        },
    };
    let (Some(ctrl_c), Some(time)) = (ctrl_c, last) else {
        return error.into_python_with(py, trace);
    };
    let interrupted = run_interrupted(py, ctrl_c, time, trace);
    interrupted.set_context(py, Some(error.into_python_with(py, None)));
    interrupted
}

/// Returns the exception for an error raised between two steps, at `time`, s. Ctrl-C becomes
/// `RunInterrupted`; other errors are unchanged.
pub(crate) fn interrupted(py: Python<'_>, error: PyErr, time: f64, trace: Option<Py<PyAny>>) -> PyErr {
    if error.is_instance_of::<PyKeyboardInterrupt>(py) {
        run_interrupted(py, error, time, trace)
    } else {
        error // an error of the callback
    }
}

/// Returns `RunInterrupted` at simulation time `time`, s, with the signal as its cause.
fn run_interrupted(py: Python<'_>, signal: PyErr, time: f64, trace: Option<Py<PyAny>>) -> PyErr {
    let message = format!("the run was interrupted at t = {} s", short(time));
    let fields = fields!(py, "time": time, "trace": trace);
    let error = raise(py, "RunInterrupted", &message, &fields);
    error.set_cause(py, Some(signal));
    error
}
