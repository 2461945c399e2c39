//! Converts errors of gravity fields and their files to Python exceptions.

use super::{IntoPython, fields, raise};
use onorbit_core::gravity::GravityError;
use pyo3::prelude::*;

impl IntoPython for GravityError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let fields = match &self {
            Self::Earth(error) => return error.clone().into_python(py),
            Self::NotFinite { name, value } | Self::NotPositive { name, value, .. } => {
                fields!(py, "name": name, "got": value)
            }
            Self::Degree { degree } | Self::ZonalDegree { degree } => {
                fields!(py, "name": "degree", "got": degree)
            }
            Self::BeyondModel { degree, highest, .. } => {
                fields!(py, "name": "degree", "got": degree, "expected": highest)
            }
            Self::OrderAboveDegree { degree, order } => {
                fields!(py, "name": "order", "got": order, "expected": degree)
            }
            Self::UnknownModel { name, known } => {
                fields!(py, "name": "model", "got": name, "expected": known)
            }
            Self::WrongLength { name, expected, got } => {
                fields!(py, "name": name, "got": got, "expected": expected)
            }
            Self::NotFound { file } | Self::Unreadable { file, .. } => {
                fields!(py, "path": file, "kind": "gravity field")
            }
            Self::Truncated { file, .. } => fields!(py, "path": file),
            Self::Header { file, key, .. } => fields!(py, "path": file, "name": key),
            Self::Row { file, line, .. }
            | Self::CutRow { file, line, .. }
            | Self::Twice { file, line, .. }
            | Self::VariesWithTime { file, line, .. } => fields!(py, "path": file, "line": line),
            Self::BelowSurface { distance, minimum } => {
                fields!(py, "name": "r", "got": distance, "expected": minimum)
            }
            Self::Units { name, value, expected } => {
                fields!(py, "name": name, "got": value, "expected": expected)
            }
            Self::Implausible { value, limit, .. } => {
                fields!(py, "name": "c, s", "got": value, "expected": limit)
            }
            Self::NoSuchTerm { name, value, .. } => fields!(py, "name": name, "got": value, "expected": 0.0),
            Self::OtherGravity { what } => fields!(py, "name": what),
            Self::OtherPlanet { field, orbit } => {
                fields!(py, "name": "mu", "got": orbit, "expected": field)
            }
            _ => fields!(py,),
        };
        let class = match &self {
            Self::NotFound { .. } => "NotFoundError",
            Self::Unreadable { .. } => "ReadError",
            _ => "GravityError",
        };
        raise(py, class, &self.to_string(), &fields)
    }
}
