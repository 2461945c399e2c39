//! Converts errors of controllers and references to Python exceptions.

use super::{IntoPython, fields, plain, raise, shape_error, with_message};
use onorbit_core::control::ControlError;
use onorbit_core::reference::ReferenceError;
use onorbit_core::spatial::SplineError;
use pyo3::prelude::*;

impl IntoPython for ReferenceError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        match &self {
            Self::DurationNotPositive { value } => {
                raise(py, "ControlError", &message, &fields!(py, "name": "duration", "got": value))
            }
            Self::Ramp { value } => {
                raise(py, "ControlError", &message, &fields!(py, "name": "ramp", "got": value))
            }
            Self::LimitNotPositive { name, value } => {
                raise(py, "ControlError", &message, &fields!(py, "name": name, "got": value))
            }
            Self::LastRow { row } => {
                raise(py, "ControlError", &message, &fields!(py, "name": "pose", "got": row.to_vec()))
            }
            Self::WrongLength { name, expected, got } => shape_error(py, &message, name, expected, got),
            Self::NoJoint { joint, .. } => {
                raise(py, "ControlError", &message, &fields!(py, "name": "joint", "got": joint))
            }
            Self::Spline(SplineError::WrongLength { name, expected, got }) => {
                shape_error(py, &message, name, expected, got)
            }
            _ => plain(py, "ControlError", &message),
        }
    }
}

impl IntoPython for ControlError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        match self {
            Self::User(error) => match error.downcast::<PyErr>() {
                Ok(raised) => *raised, // the same object, including its traceback
                Err(other) => plain(py, "ControlError", &other.to_string()),
            },
            Self::OfControl { source, .. } => with_message(py, source.into_python(py), &message),
            Self::WrongLength { name, expected, got } => shape_error(py, &message, name, expected, got),
            Self::NotFinite { name, value }
            | Self::Negative { name, value }
            | Self::TooLarge { name, value, .. } => {
                raise(py, "ControlError", &message, &fields!(py, "name": name, "got": value))
            }
            Self::CommandLength { name, points, joints, got, .. } => {
                shape_error(py, &message, name, points * joints, got)
            }
            Self::CommandNumber { name, value, .. } => {
                raise(py, "InputError", &message, &fields!(py, "name": name, "got": value))
            }
            Self::TimesNotIncreasing { after, before, .. } => raise(
                py,
                "InputError",
                &message,
                &fields!(py, "name": "times", "got": after, "expected": before),
            ),
            Self::PastTrajectory { end, now, .. } => {
                raise(py, "InputError", &message, &fields!(py, "name": "start", "got": end, "expected": now))
            }
            Self::NotPositive { name } | Self::Zero { name } => {
                raise(py, "ControlError", &message, &fields!(py, "name": name, "got": 0.0))
            }
            Self::Timeout { value } => {
                raise(py, "ControlError", &message, &fields!(py, "name": "timeout", "got": value))
            }
            Self::TimeoutGain { gain, .. } | Self::CommandGain { gain, .. } => {
                raise(py, "ControlError", &message, &fields!(py, "name": gain, "got": 0.0, "expected": "> 0"))
            }
            Self::UnknownControl { ref name, ref known } => {
                raise(py, "ControlError", &message, &fields!(py, "name": name, "expected": known.clone()))
            }
            Self::NotExternal { ref control, .. }
            | Self::ControlEnded { ref control }
            | Self::GripEffort { ref control, .. }
            | Self::GripOption { ref control, .. }
            | Self::NothingOpposes { ref control, .. }
            | Self::TooWide { ref control, .. }
            | Self::FingerWithoutContact { ref control, .. } => {
                raise(py, "ControlError", &message, &fields!(py, "name": control))
            }
            Self::OtherControls { .. } | Self::OtherMemory { .. } => plain(py, "CheckpointError", &message),
            _ => plain(py, "ControlError", &message),
        }
    }
}
