//! Converts errors of the systems and events of a world to Python exceptions.

use super::{IntoPython, fields, raise};
use onorbit_core::world::WorldError;
use pyo3::prelude::*;

impl IntoPython for WorldError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        let name = match &self {
            Self::NoSystems => "systems".to_owned(),
            Self::SystemName { name } | Self::SystemTwice { name } | Self::EventTwice { name } => {
                name.clone()
            }
            Self::NoSuchEvent { name, .. } | Self::NotTriggered { name, .. } => name.clone(),
            Self::Circle { names } => names.clone(),
            Self::OwnSystem { event, .. }
            | Self::AfterItself { event }
            | Self::UnknownSystem { event, .. }
            | Self::UnknownFrame { event, .. }
            | Self::UnknownEvent { event, .. }
            | Self::UnknownBrake { event, .. }
            | Self::Merged { event, .. }
            | Self::Number { event, .. }
            | Self::LatchWithoutCapture { event }
            | Self::LatchContact { event, .. }
            | Self::SeatInLoop { event, .. } => event.clone(),
            Self::BrakeTwice { name }
            | Self::BrakeJoint { name, .. }
            | Self::JointWithTwoBrakes { name, .. }
            | Self::SlipTorque { name, .. }
            | Self::HeldJointMoves { name, .. } => name.clone(),
            Self::OwnReferenceFrame { system } | Self::ReferenceFrame { system, .. } => system.clone(),
        };
        raise(py, "WorldError", &message, &fields!(py, "name": name))
    }
}
