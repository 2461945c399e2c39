//! Converts errors of robots and their files to Python exceptions.

use super::{IntoPython, fields, plain, raise};
use onorbit_core::model::ModelError;
use onorbit_core::model::urdf::{UrdfError, UrdfProblem};
use pyo3::prelude::*;

impl IntoPython for ModelError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        match &self {
            Self::UnknownName { what, name, candidates } => {
                let fields = fields!(
                    py, "name": name, "kind": what, "known": candidates, "suggestion": self.suggestion(),
                );
                raise(py, "FrameError", &message, &fields)
            }
            Self::NotFinite { name, .. } | Self::OutOfRange { name, .. } => {
                raise(py, "ModelError", &message, &fields!(py, "link": name))
            }
            Self::MasslessSubtree { joint, link } => {
                raise(py, "ModelError", &message, &fields!(py, "joint": joint, "link": link))
            }
            Self::MassNotPositive { link, .. }
            | Self::IndefiniteInertia { link, .. }
            | Self::AsymmetricInertia { link, .. }
            | Self::SingularBase { link, .. } => {
                raise(py, "ModelError", &message, &fields!(py, "link": link))
            }
            Self::ZeroAxis { joint }
            | Self::LimitIsNan { joint, .. }
            | Self::Negative { joint, .. }
            | Self::FixedJoint { joint, .. }
            | Self::NoStiffness { joint }
            | Self::RepellingSpring { joint, .. }
            | Self::StaticBelowKinetic { joint, .. }
            | Self::LimitsReversed { joint, .. } => {
                raise(py, "ModelError", &message, &fields!(py, "joint": joint))
            }
            _ => plain(py, "ModelError", &message),
        }
    }
}

impl IntoPython for UrdfError {
    fn into_python(self, py: Python<'_>) -> PyErr {
        let message = self.to_string();
        let path = self.file.as_ref().map(|file| file.display().to_string());
        let fields = fields!(py, "path": path);
        let class = match &*self.problem {
            UrdfProblem::NotFound => "NotFoundError",
            UrdfProblem::IsFolder | UrdfProblem::Unreadable { .. } => "ReadError",
            _ => "ModelError",
        };
        raise(py, class, &message, &fields)
    }
}
