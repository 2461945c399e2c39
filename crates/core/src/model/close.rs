//! Addition of closed loops to a robot.

use super::builder::ModelBuilder;
use super::closed_loop::{Loop, SHORTEST};
use super::error::ModelError;
use super::lookup::find;
use super::tree::Model;
use nalgebra::Isometry3;

impl ModelBuilder {
    /// Adds a closed loop between two frames that were added before.
    ///
    /// # Errors
    /// [`ModelError`] for an unknown frame, a loop that connects a frame with itself, an empty name, the name
    /// of another loop, a pose that is not finite, or a length outside [1e-6 m, 1e12 m).
    pub fn close(&mut self, closing: Loop) -> Result<&mut Self, ModelError> {
        let names = self.description.links.iter().map(|link| link.name.as_str());
        let names = names.chain(self.description.frames.iter().map(|(name, ..)| name.as_str()));
        for frame in &closing.frames {
            find("frame", frame, names.clone())?;
        }
        let name = || closing.name.clone();
        if closing.name.is_empty() {
            return Err(ModelError::EmptyName { what: "loop" });
        }
        if self.description.loops.iter().any(|other| other.name == closing.name) {
            return Err(ModelError::DuplicateName { what: "loop", name: name() });
        }
        if closing.frames[0] == closing.frames[1] {
            return Err(ModelError::LoopWithItself { name: name(), frame: closing.frames[0].clone() });
        }
        let are_finite = |pose: &Isometry3<f64>| pose.to_homogeneous().iter().all(|x| x.is_finite());
        if !closing.poses.iter().all(are_finite) {
            return Err(ModelError::NotFinite { what: "a pose", name: name() });
        }
        if let Some(length) = closing.length.filter(|length| !(SHORTEST..1e12).contains(length)) {
            let expected = "at least 1e-6 m and below 1e12 m, or the kind 'spherical' for a distance of zero";
            return Err(ModelError::OutOfRange { what: "the length", name: name(), value: length, expected });
        }
        self.description.loops.push(closing);
        Ok(self)
    }
}

impl Model {
    /// Returns this robot with further closed loops.
    ///
    /// # Errors
    /// The errors of [`ModelBuilder::close`] and [`ModelBuilder::build`].
    pub fn closed(&self, loops: &[Loop]) -> Result<Self, ModelError> {
        let mut builder = ModelBuilder::from_description(self.description().clone())?;
        builder.keep_notes(self);
        for closing in loops {
            builder.close(closing.clone())?;
        }
        builder.build()
    }
}
