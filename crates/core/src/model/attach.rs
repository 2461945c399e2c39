//! One tree of two robots: an arm on a bus.

use super::builder::ModelBuilder;
use super::description::{Joint, JointKind};
use super::error::ModelError;
use super::tree::Model;
use nalgebra::{Isometry3, Rotation3};

/// How a robot sits on a frame of another.
#[derive(Clone, Debug, Default)]
pub struct Mount {
    /// The frame that is put on the other's; the root link where `None`.
    pub frame: Option<String>,
    /// Its pose in the frame it is put on.
    pub pose: Isometry3<f64>,
    /// Put before the names of the robot's links, joints and frames.
    pub prefix: String,
}

impl Model {
    /// This robot with `other` fixed to one of its frames; its own root link stays the base.
    ///
    /// # Errors
    /// No such frame, a frame of `other` that its joints move, a name that both have, or too many joints.
    pub fn attach(&self, frame: &str, other: &Self, mount: &Mount) -> Result<Self, ModelError> {
        let (carrier, on_carrier) = self.description.frame(frame)?;
        let in_root = match &mount.frame {
            Some(name) => other.pose_in_root(name)?,
            None => Isometry3::identity(),
        };
        let robot = other.description().clone().prefixed(&mount.prefix);
        let mut builder = ModelBuilder::from_description(self.description().clone())?;
        builder.keep_notes(self).keep_notes(other);
        let mut name = format!("{frame}_to_{}", robot.links[0].name);
        while builder.has_joint(&name) {
            name.push('_'); // nobody has chosen it: it must not be what is refused
        }
        let joint = Joint::new(&name, JointKind::Fixed, on_carrier * mount.pose * in_root.inverse());
        builder.add_robot(&carrier.name, joint, robot).map_err(|error| error.of_prefix(&mount.prefix))?;
        builder.build()
    }

    /// Pose of a frame in the root link's, for a frame that no joint moves.
    fn pose_in_root(&self, name: &str) -> Result<Isometry3<f64>, ModelError> {
        let frame = &self.frames[self.frame(name)?];
        if frame.body != 0 {
            let on_base = self.frames.iter().filter(|frame| frame.body == 0);
            let candidates = on_base.map(|frame| frame.name.clone()).collect();
            return Err(ModelError::FrameMoves { name: name.to_owned(), candidates });
        }
        let rotation = Rotation3::from_matrix_unchecked(frame.rot_kf.to_nalgebra());
        Ok(Isometry3::from_parts(frame.pos_kf.to_nalgebra().into(), rotation.into()))
    }
}
