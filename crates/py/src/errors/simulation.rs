//! Converts errors of runs to Python exceptions, some of which have the trace of the run so far.

use super::{IntoPython, fields, plain, raise, shape_error, with_message};
use onorbit_core::contact::ContactError;
use onorbit_core::control::ControlError;
use onorbit_core::simulation::SimulationError;
use pyo3::prelude::*;

/// Converts the error of a run to a Python exception. Errors during a run also get the trace so far, if it is
/// given, as the attribute `trace`.
pub(crate) trait SimulationErrorExt {
    fn into_python_with(self, py: Python<'_>, trace: Option<Py<PyAny>>) -> PyErr;
}

impl SimulationErrorExt for SimulationError {
    fn into_python_with(self, py: Python<'_>, trace: Option<Py<PyAny>>) -> PyErr {
        let message = self.to_string();
        match self {
            Self::WrongLength { name, expected, got } => shape_error(py, &message, name, expected, got),
            Self::OfSystem { source, .. } => with_message(py, source.into_python_with(py, trace), &message),
            Self::NotFinite { name, value, .. } | Self::NotPositive { name, value } => {
                raise(py, "InputError", &message, &fields!(py, "name": name, "got": value))
            }
            Self::QuaternionNorm { norm } => {
                raise(py, "InputError", &message, &fields!(py, "name": "q", "got": norm, "expected": 1.0))
            }
            Self::TimeNotFinite { t } => {
                raise(py, "InputError", &message, &fields!(py, "name": "t", "got": t))
            }
            Self::TimeStep { value } => raise(
                py,
                "InputError",
                &message,
                &fields!(py, "name": "time_step", "got": value, "expected": (1e-12, 1e9)),
            ),
            Self::OutOfRange { name, value, limit, .. } => raise(
                py,
                "InputError",
                &message,
                &fields!(py, "name": name, "got": value, "expected": (-limit, limit)),
            ),
            Self::Tolerance { value } => {
                raise(py, "InputError", &message, &fields!(py, "name": "tolerance", "got": value))
            }
            Self::RereferenceBeyond { value } => {
                raise(py, "InputError", &message, &fields!(py, "name": "rereference_beyond", "got": value))
            }
            Self::Restitution { value } => {
                raise(py, "InputError", &message, &fields!(py, "name": "restitution", "got": value))
            }
            Self::OutsideLimits { joint, value, lower, upper, .. } => raise(
                py,
                "InputError",
                &message,
                &fields!(py, "name": joint, "got": value, "expected": (lower, upper)),
            ),
            Self::OpenLoop { name, .. } | Self::OpenMimic { joint: name, .. } => {
                raise(py, "InputError", &message, &fields!(py, "name": name))
            }
            Self::CannotClose(_) => plain(py, "InputError", &message),
            Self::StepTooSmall { time, step } | Self::StepsTooShort { time, step, .. } => raise(
                py,
                "SimulationError",
                &message,
                &fields!(py, "time": time, "step": step, "trace": trace),
            ),
            Self::Earth(source) => source.into_python(py),
            Self::Contacts(source) => source.into_python(py),
            Self::Contact { time, source: ContactError::Painleve { contact, friction, limit, .. } } => raise(
                py,
                "SimulationError",
                &message,
                &fields!(
                    py,
                    "time": time,
                    "name": contact,
                    "got": friction,
                    "expected": limit,
                    "trace": trace,
                ),
            ),
            Self::Contact { time, .. } => {
                raise(py, "SimulationError", &message, &fields!(py, "time": time, "trace": trace))
            }
            Self::RecordEvery => plain(py, "InputError", &message),
            Self::EffectTwice { effect, body } => {
                raise(py, "EffectError", &message, &fields!(py, "name": effect, "got": body))
            }
            Self::EffectOnNoSystem { effect, .. } => {
                raise(py, "EffectError", &message, &fields!(py, "name": effect))
            }
            Self::NeedsOrbit { .. } => plain(py, "OrbitError", &message),
            Self::NeedsTool | Self::OtherTool { .. } => plain(py, "ControlError", &message),
            Self::ReferenceStartsAway { position, angle, tolerance, .. } => raise(
                py,
                "ControlError",
                &message,
                &fields!(py, "name": "reference", "got": (position, angle), "expected": tolerance.to_vec()),
            ),
            Self::JointsStartAway { offset, tolerance, .. } => raise(
                py,
                "ControlError",
                &message,
                &fields!(py, "name": "reference", "got": offset, "expected": tolerance),
            ),
            Self::UnknownFrame { .. } | Self::TooManyRows { .. } => plain(py, "InputError", &message),
            Self::Diverged { time, q, v, .. } => raise(
                py,
                "SimulationError",
                &message,
                &fields!(py, "time": time, "q": q, "v": v, "trace": trace),
            ),
            Self::PastTime { t, time } => {
                raise(py, "InputError", &message, &fields!(py, "name": "t", "got": t, "expected": time))
            }
            Self::AfterEnd { t, end } => {
                raise(py, "InputError", &message, &fields!(py, "name": "t", "got": t, "expected": end))
            }
            Self::Ended => plain(py, "SimulationError", &message),
            Self::CommandedJoint { joint, control } => {
                raise(py, "ControlError", &message, &fields!(py, "name": joint, "got": control))
            }
            Self::Orbit { time, source } => with_trace(py, source.into_python(py), time, trace),
            Self::Environment { time, source } => with_trace(py, source.into_python(py), time, trace),
            Self::Gravity(source) => source.into_python(py),
            Self::Checkpoint(_) => plain(py, "CheckpointError", &message),
            Self::Reference { time, source } => with_trace(py, source.into_python(py), time, trace),
            Self::Control(source @ ControlError::User(_)) => {
                let raised = source.into_python(py);
                let _ = raised.value(py).setattr("trace", trace); // objects without attributes cannot have a trace
                raised
            }
            Self::Control(source) => source.into_python(py),
            Self::EngineAttitude { time, length, .. } => {
                let fields = fields!(py, "name": "q", "got": length, "expected": 1.0);
                with_trace(py, raise(py, "EngineError", &message, &fields), time, trace)
            }
            Self::World(source) => source.into_python(py),
            Self::Model(source) => source.into_python(py),
            Self::EngineOfWorld { name, .. } => {
                raise(py, "EngineError", &message, &fields!(py, "name": name, "got": "engine"))
            }
            Self::Engine(source) => match source.downcast::<PyErr>() {
                Ok(raised) => {
                    let _ = raised.value(py).setattr("trace", trace);
                    *raised // the same object, including its traceback
                }
                Err(other) => plain(py, "SimulationError", &other.to_string()),
            },
        }
    }
}

/// Sets the attributes `time`, s, and `trace`, the trace of the run so far, of an exception, and returns it.
fn with_trace(py: Python<'_>, error: PyErr, time: f64, trace: Option<Py<PyAny>>) -> PyErr {
    let value = error.value(py);
    let _ = value.setattr("time", time);
    let _ = value.setattr("trace", trace);
    error
}
