//! Attachment of one robot to another, such as an arm to a bus.

use super::builder::ModelBuilder;
use super::description::{Joint, JointKind};
use super::error::ModelError;
use super::tree::Model;
use crate::spatial::{Mat3, Vec3};
use nalgebra::{Isometry3, Rotation3};

/// Placement of a robot on a frame of another robot.
#[derive(Clone, Debug, Default)]
pub struct Mount {
    /// Mounting frame of the attached robot, fixed to its base; `None` selects its root link.
    pub frame: Option<String>,
    /// Pose of the mounting frame in the frame that it is attached to.
    pub pose: Isometry3<f64>,
    /// Prefix for the names of the attached robot's links, joints and frames.
    pub prefix: String,
}

impl Model {
    /// Returns this robot with `other` fixed to the frame `frame`. The base remains that of this robot.
    ///
    /// Joints are numbered depth first: those of `other` come after all joints of this robot if `frame` is fixed to the
    /// base, otherwise directly after the joints below the body of `frame`.
    ///
    /// # Errors
    /// [`ModelError`] for an unknown frame, a mounting frame that is moved by joints, a name that both robots
    /// have, or too many joints.
    pub fn attach(&self, frame: &str, other: &Self, mount: &Mount) -> Result<Self, ModelError> {
        let carrier = &self.frames[self.frame(frame)?];
        // the robot is attached to the link that names the body: its joints follow those already below that link
        let on_link = isometry(self.pose_in_link(carrier));
        let link = &self.body_frame(carrier.body).name;
        let in_root = match &mount.frame {
            Some(name) => other.pose_in_root(name)?,
            None => Isometry3::identity(),
        };
        let robot = other.description().clone().prefixed(&mount.prefix);
        let mut builder = ModelBuilder::from_description(self.description().clone())?;
        builder.keep_notes(self).keep_notes(other);
        let mut name = format!("{frame}_to_{}", robot.links[0].name);
        while builder.has_joint(&name) {
            name.push('_'); // the generated name must differ from the names of all other joints
        }
        let joint = Joint::new(&name, JointKind::Fixed, on_link * mount.pose * in_root.inverse());
        builder.add_robot(link, joint, robot).map_err(|error| error.suggest_prefix(&mount.prefix))?;
        builder.build()
    }

    /// Returns the pose of a frame of the base in the frame of the root link.
    fn pose_in_root(&self, name: &str) -> Result<Isometry3<f64>, ModelError> {
        let frame = &self.frames[self.frame(name)?];
        if frame.body != 0 {
            let on_base = self.frames.iter().filter(|frame| frame.body == 0);
            let candidates = on_base.map(|frame| frame.name.clone()).collect();
            return Err(ModelError::FrameMoves { name: name.to_owned(), candidates });
        }
        Ok(isometry((frame.rot_kf, frame.pos_kf)))
    }
}

fn isometry((rotation, position): (Mat3<f64>, Vec3<f64>)) -> Isometry3<f64> {
    let rotation = Rotation3::from_matrix_unchecked(rotation.to_nalgebra());
    Isometry3::from_parts(position.to_nalgebra().into(), rotation.into())
}
