//! Attachment of one robot to another, such as an arm to a spacecraft bus.

use super::builder::ModelBuilder;
use super::description::{Description, Joint, JointKind, Link};
use super::error::ModelError;
use super::tree::Model;
use crate::spatial::{Mat3, Vec3};
use nalgebra::{Isometry3, Rotation3};

/// Placement of a robot on a frame of another robot.
#[derive(Clone, Debug, Default)]
pub struct Mount {
    /// Mounting frame of the attached robot; `None` selects its root link.
    pub frame: Option<String>,
    /// Joints between the frame to which the robot is attached and the robot, each followed by a massless
    /// link of the same name; usually empty.
    pub joints: Vec<Joint>,
    /// Pose of the mounting frame in the frame to which the robot is attached or, if there are `joints`, in
    /// the link after the last joint.
    pub pose: Isometry3<f64>,
    /// Prefix for the names of the links, joints, frames and loops of the attached robot.
    pub prefix: String,
}

impl Model {
    /// Returns this robot with `other` attached to the frame `frame`. The base remains the base of this
    /// robot.
    ///
    /// If the mounting frame of `other` is not on its root link, the tree of `other` is traversed from the
    /// link of that frame ([`Model::rerooted`]).
    ///
    /// Joints are numbered depth first: the joints of `other` follow all joints of this robot if `frame` is
    /// fixed to the base; otherwise they follow directly after the joints below the body of `frame`.
    ///
    /// # Errors
    /// [`ModelError`] for an unknown frame, a name that both robots have, too many joints, or an invalid
    /// joint of `mount`, and the errors of [`ModelBuilder::build`].
    pub fn attach(&self, frame: &str, other: &Self, mount: &Mount) -> Result<Self, ModelError> {
        let carrier = &self.frames[self.frame(frame)?];
        // `other` is attached to the link that names the body, so that its joints follow those already below
        // that link
        let mut on_link = isometry(self.pose_in_link(carrier));
        let mut link = self.body_frame(carrier.body).name.clone();
        let (robot, in_root) = match &mount.frame {
            Some(name) => other.rooted_below(name)?,
            None => (other.description().clone(), Isometry3::identity()),
        };
        let robot = robot.prefixed(&mount.prefix);
        let mut builder = ModelBuilder::from_description(self.description().clone())?;
        builder.keep_notes(self).keep_notes(other);
        let mut name = format!("{frame}_to_{}", robot.links[0].name);
        while builder.has_joint(&name) {
            name.push('_'); // the generated name must differ from the names of all other joints
        }
        for joint in &mount.joints {
            let behind = joint.name.clone();
            let joint = Joint { origin: on_link * joint.origin, ..joint.clone() };
            builder.add(&link, joint, Link::new(&behind, None))?;
            (link, on_link) = (behind, Isometry3::identity());
        }
        let joint = Joint::new(&name, JointKind::Fixed, on_link * mount.pose * in_root.inverse());
        builder.add_robot(&link, joint, robot).map_err(|error| error.suggest_prefix(&mount.prefix))?;
        builder.build()
    }

    /// Returns this robot with `prefix` before the names of all links, joints, frames and loops.
    ///
    /// # Errors
    /// [`ModelError`] if the description is not valid.
    pub fn prefixed(&self, prefix: &str) -> Result<Self, ModelError> {
        let mut builder = ModelBuilder::from_description(self.description().clone().prefixed(prefix))?;
        builder.keep_notes(self);
        builder.build()
    }

    /// Returns the description of this robot with a new root, and the pose of the frame `name` in the new
    /// root. The new root is the link that names the body of the frame.
    fn rooted_below(&self, name: &str) -> Result<(Description, Isometry3<f64>), ModelError> {
        let frame = &self.frames[self.frame(name)?];
        let root = &self.body_frame(frame.body).name;
        Ok((self.description().rerooted(root)?, isometry(self.pose_in_link(frame))))
    }
}

fn isometry((rotation, position): (Mat3<f64>, Vec3<f64>)) -> Isometry3<f64> {
    let rotation = Rotation3::from_matrix_unchecked(rotation.to_nalgebra());
    Isometry3::from_parts(position.to_nalgebra().into(), rotation.into())
}
