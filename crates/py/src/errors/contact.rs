//! Converts errors of contacts to Python exceptions.

use super::{IntoPython, fields, raise};
use onorbit_core::contact::ContactError;
use pyo3::prelude::*;

impl IntoPython for ContactError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        let fields = match &self {
            Self::Parameter { name, got, range, .. } => {
                fields!(py, "name": name, "got": got, "expected": range)
            }
            Self::DuplicateName { name } => fields!(py, "name": name),
            Self::Overlap { contact, depth, .. } => fields!(py, "name": contact, "got": depth),
            Self::Painleve { contact, friction, limit, .. } => {
                fields!(py, "name": contact, "got": friction, "expected": limit)
            }
            Self::Unsolved { contacts, change, .. } => fields!(py, "name": contacts, "got": change),
            Self::NoLink { contact, pattern, .. } => fields!(py, "name": contact, "got": pattern),
            Self::NoShape { contact, .. }
            | Self::NoPieces { contact }
            | Self::SameLink { contact }
            | Self::ImpactLaw { contact, .. }
            | Self::Geometry { contact, .. } => fields!(py, "name": contact),
        };
        raise(py, "WorldError", &message, &fields)
    }
}
