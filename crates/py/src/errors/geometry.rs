//! Converts errors of collision shapes and distances to Python exceptions.

use super::{IntoPython, fields, raise};
use onorbit_core::geometry::GeometryError;
use pyo3::prelude::*;

impl IntoPython for GeometryError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let (class, fields) = match &self {
            Self::NoCollision { link, .. } | Self::Collision { link, .. } => {
                ("ModelError", fields!(py, "link": link))
            }
            Self::Length { name, got, .. } => ("InputError", fields!(py, "name": name, "got": got)),
            Self::NotConverged { gap, .. } => ("ConvergenceError", fields!(py, "residual": gap)),
            Self::Hull { .. } | Self::EmptyCompound | Self::Pose { .. } | Self::Unavailable(_) => {
                ("InputError", fields!(py,))
            }
        };
        raise(py, class, &self.to_string(), &fields)
    }
}
