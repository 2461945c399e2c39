//! Converts errors of environment effects to Python exceptions.

use super::{IntoPython, fields, plain, raise};
use onorbit_core::environment::EnvironmentError;
use onorbit_core::environment::atmosphere::AtmosphereError;
use onorbit_core::environment::surfaces::SurfaceError;
use pyo3::prelude::*;

impl IntoPython for EnvironmentError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        match &self {
            Self::Gravity(error) => error.clone().into_python(py),
            Self::User(error) => match error.0.downcast_ref::<PyErr>() {
                Some(raised) => raised.clone_ref(py), // the same object, including its traceback
                None => plain(py, "EffectError", &message),
            },
            Self::NotFinite { name, value } => {
                raise(py, "EffectError", &message, &fields!(py, "name": name, "got": value))
            }
            Self::EmptyInterval { start, end } => {
                raise(py, "EffectError", &message, &fields!(py, "name": "start, end", "got": (*start, *end)))
            }
            Self::Atmosphere(source) => source.clone().into_python(py),
            Self::Surface(source) => source.clone().into_python(py),
            Self::Earth(source) => source.clone().into_python(py),
            _ => plain(py, "EffectError", &message),
        }
    }
}

impl IntoPython for AtmosphereError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        let fields = match &self {
            Self::Earth(source) => return source.clone().into_python(py),
            Self::BelowSurface { altitude } => {
                fields!(py, "name": "altitude", "got": altitude, "expected": "at least 0 m")
            }
            Self::OutsideLayers { altitude, lowest, highest, .. } => {
                fields!(py, "name": "altitude", "got": altitude, "expected": (lowest, highest))
            }
            Self::Value { name, value, expected } => {
                fields!(py, "name": name, "got": value, "expected": expected)
            }
            Self::MissingSpaceWeather { name, date, .. } => fields!(py, "name": name, "got": date),
            Self::OutsideTable { date, first, last, .. } => {
                fields!(py, "name": "date", "got": date, "expected": (first, last))
            }
            _ => fields!(py,),
        };
        raise(py, "EffectError", &message, &fields)
    }
}

impl IntoPython for SurfaceError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        let fields = match &self {
            Self::Value { name, value, expected } => {
                fields!(py, "name": name, "got": value, "expected": expected)
            }
            Self::Reflection { specular, diffuse } => {
                fields!(py, "name": "specular, diffuse", "got": (*specular, *diffuse))
            }
            _ => fields!(py, "name": "surfaces"),
        };
        raise(py, "EffectError", &message, &fields)
    }
}
