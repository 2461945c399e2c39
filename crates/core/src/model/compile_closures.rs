//! Compilation of closed loops and mimic joints into constraints of a model.

use super::closed_loop::{Loop, LoopKind, Mimic, SHORTEST};
use super::closure::{Closure, Constraint};
use super::error::{ModelError, ModelWarning};
use super::frame::Frame;
use super::tree::Model;
use crate::spatial::{Mat3, Vec3};
use nalgebra::Isometry3;

impl Model {
    /// Returns the constraints for the loops and the mimic joints of the description, or an error for unknown
    /// frames or leaders, loops within a body or of zero length, and joints that mimic each other.
    pub(super) fn compile_closures(&self) -> Result<Vec<Closure>, ModelError> {
        let description = self.description.clone();
        let loops = description.loops.iter().map(|closing| self.compile_loop(closing));
        let joints = description.joints.iter().map(|(_, joint)| joint);
        let mimics = joints.filter_map(|joint| Some((&joint.name, joint.mimic.as_ref()?)));
        loops.chain(mimics.map(|(name, mimic)| self.compile_mimic(name, mimic))).collect()
    }

    /// Returns a warning for each loop with more than one joint in which all joints have friction.
    pub(super) fn loops_with_friction(&self) -> Vec<ModelWarning> {
        let closures = self.closures.iter().filter_map(|closure| match &closure.constraint {
            Constraint::Frames { frames: [a, b], .. } => Some((&closure.name, a.body, b.body)),
            Constraint::Mimic { .. } => None,
        });
        let warning = |(name, a, b): (&String, usize, usize)| {
            let joints = self.joints_between(a, b);
            let all = joints.iter().all(|&joint| self.joints[joint].friction > 0.0);
            let names = || joints.iter().map(|&joint| self.joints[joint].name.clone()).collect();
            (all && joints.len() > 1)
                .then(|| ModelWarning::LoopFriction { name: name.clone(), joints: names() })
        };
        closures.filter_map(warning).collect()
    }

    /// Returns the indices of the joints on the path between two bodies of the tree, in ascending order.
    fn joints_between(&self, mut a: usize, mut b: usize) -> Vec<usize> {
        let mut joints = Vec::new();
        while a != b {
            let later = if a > b { &mut a } else { &mut b };
            joints.push(*later - 1);
            *later = self.nodes[*later].parent;
        }
        joints.sort_unstable();
        joints
    }

    fn compile_loop(&self, closing: &Loop) -> Result<Closure, ModelError> {
        let Loop { name, kind, frames, poses, length, project } = closing;
        let [a, b] = [0, 1].map(|side| self.place(&frames[side], &poses[side]));
        let compiled = [a?, b?];
        if compiled[0].body == compiled[1].body {
            return Err(ModelError::LoopWithinBody { name: name.clone(), frames: frames.clone() });
        }
        let length = match (kind, length) {
            (LoopKind::Distance, Some(length)) => *length,
            (LoopKind::Distance, None) => self.distance_at_zero(name, &compiled)?,
            _ => 0.0,
        };
        let constraint = Constraint::Frames { kind: *kind, frames: compiled, length };
        Ok(Closure { name: name.clone(), constraint, project: *project })
    }

    /// Returns a frame whose pose in the frame `name` is `pose`.
    fn place(&self, name: &str, pose: &Isometry3<f64>) -> Result<Frame, ModelError> {
        let Frame { body, rot_kf, pos_kf, .. } = &self.frames[self.frame(name)?];
        let rotation: Mat3<f64> = (*pose.rotation.to_rotation_matrix().matrix()).into();
        let offset: Vec3<f64> = pose.translation.vector.into();
        let (rot_kf, pos_kf) = (*rot_kf * rotation, *rot_kf * offset + *pos_kf);
        Ok(Frame { name: name.to_owned(), body: *body, rot_kf, pos_kf })
    }

    /// Returns the distance between the origins of two frames at zero joint positions, m, or an error that
    /// names the loop `name` if the distance is below [`SHORTEST`].
    fn distance_at_zero(&self, name: &str, frames: &[Frame; 2]) -> Result<f64, ModelError> {
        let [a, b] = [0, 1].map(|side| self.origin_at_zero(&frames[side]));
        let length = (b - a).norm();
        if length >= SHORTEST {
            return Ok(length);
        }
        let (what, expected) =
            ("the length", "at least 1e-6 m between the frames at zero joint positions, or a given length");
        Err(ModelError::OutOfRange { what, name: name.to_owned(), value: length, expected })
    }

    fn origin_at_zero(&self, frame: &Frame) -> Vec3<f64> {
        let (mut position, mut body) = (frame.pos_kf, frame.body);
        while body > 0 {
            let node = &self.nodes[body];
            (position, body) = (node.rot_pk * position + node.pos_pk, node.parent);
        }
        position
    }

    fn compile_mimic(&self, name: &str, mimic: &Mimic) -> Result<Closure, ModelError> {
        let joint = self.joint(name)?;
        let leader = self.joint(&mimic.leader).map_err(|_| ModelError::UnknownLeader {
            joint: name.to_owned(),
            leader: mimic.leader.clone(),
            is_fixed: self.description.joints.iter().any(|(_, joint)| joint.name == mimic.leader),
            candidates: self.joint_names().map(str::to_owned).collect(),
        })?;
        let (mut at, mut names) = (mimic, vec![name.to_owned()]);
        while let Some(next) = self.mimic_of(&at.leader) {
            names.push(at.leader.clone());
            if names.len() > self.joints.len() || at.leader == name {
                break;
            }
            at = next;
        }
        if at.leader == name {
            return Err(ModelError::MimicCircle { joints: names });
        }
        let constraint = Constraint::Mimic { joint, leader, ratio: mimic.ratio, offset: mimic.offset };
        Ok(Closure { name: name.to_owned(), constraint, project: false })
    }

    fn mimic_of(&self, joint: &str) -> Option<&Mimic> {
        let (_, joint) = self.description.joints.iter().find(|(_, other)| other.name == *joint)?;
        joint.mimic.as_ref()
    }
}
