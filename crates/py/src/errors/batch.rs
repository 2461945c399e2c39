//! Converts errors of batched calls to Python exceptions.

use super::{IntoPython, fields, plain, raise, shape_error};
use onorbit_core::batch::InputError;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

impl IntoPython for InputError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        match &self {
            Self::WrongLength { name, expected, got }
            | Self::WrongTotal { name, expected, got }
            | Self::WrongBatch { name, expected, got } => shape_error(py, &message, name, expected, got),
            Self::WrongElements { name, states, got } => shape_error(py, &message, name, states, got),
            Self::UnevenTimes { orbits, got } => shape_error(py, &message, "times", orbits, got),
            Self::Ragged { name, width, got } => shape_error(py, &message, name, width, got),
            Self::WrongCount { what, expected, got } => shape_error(py, &message, what, expected, got),
            Self::WrongOutput { expected, got, .. } => shape_error(py, &message, "out", expected, got),
            Self::NotSingle { got } => shape_error(py, &message, "states", 1, got),
            Self::UnknownFrame { frame, count } => raise(
                py,
                "InputError",
                &message,
                &fields!(py, "name": "frame", "got": frame, "expected": count),
            ),
            Self::NotFinite { name, value, .. } => {
                raise(py, "InputError", &message, &fields!(py, "name": name, "got": value))
            }
            Self::Singular { .. } | Self::Overflow { .. } => plain(py, "ConvergenceError", &message),
            Self::Adaptive => {
                let fields = fields!(py, "name": "integrator", "got": "dormand_prince");
                raise(py, "InputError", &message, &fields)
            }
            Self::NoThreads => raise(py, "InputError", &message, &fields!(py, "name": "threads", "got": 0)),
            Self::NeedsOrbit | Self::Controller { .. } => plain(py, "ControlError", &message),
            Self::OpenStart { .. } => plain(py, "InputError", &message),
            Self::Orbit { orbit, source } => {
                let error = source.clone().into_python(py);
                for (name, value) in [("index", orbit.into_py_any(py)), ("message", message.into_py_any(py))]
                {
                    let _ = value.and_then(|value| error.value(py).setattr(name, value));
                }
                error
            }
            Self::NotAnEllipse { name, value, expected, .. } => {
                let fields = fields!(py, "name": name, "got": value, "expected": expected);
                raise(py, "InputError", &message, &fields)
            }
            Self::Diverged { .. } => plain(py, "SimulationError", &message),
            Self::QuaternionNorm { name, norm, .. } => {
                raise(py, "InputError", &message, &fields!(py, "name": name, "got": norm, "expected": 1.0))
            }
        }
    }
}
