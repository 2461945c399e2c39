//! Compiled tree of bodies.

use super::description::{Description, Limits, Visual};
use super::error::ModelWarning;
use crate::spatial::{Mat3, Sym3, Vec3};
use std::sync::Arc;

/// Kind of a joint: motion about or along the *z axis of the body*.
///
/// The axes of a body are chosen so that z is the joint's axis; the axes of its link are kept as a [`Frame`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Rotation about z.
    Revolute,
    /// Translation along z.
    Prismatic,
}

/// Node of the tree: a body and the joint that connects it to its parent. Node 0 is the base, which has no
/// parent.
#[derive(Clone, Debug)]
pub struct Node {
    /// Index of the parent body; always smaller than the index of the body.
    pub parent: usize,
    /// True if the body has children other than the body with the next index.
    pub is_fork: bool,
    /// Index after the last body of the subtree; bodies are numbered depth first.
    pub end: usize,
    /// Kind of the joint (unused for the base).
    pub axis: Axis,
    /// Rotation from the axes of this body, at joint position zero, to those of the parent.
    pub rot_pk: Mat3<f64>,
    /// Origin of this body at joint position zero, in the parent's axes, m.
    pub pos_pk: Vec3<f64>,
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the body's axes, m.
    pub com: Vec3<f64>,
    /// Inertia about the centre of mass in the body's axes, kg m².
    pub about_com: Sym3<f64>,
    /// Rotor inertia seen at the joint, kg m² (kg for a prismatic joint).
    pub rotor_inertia: f64,
}

/// Named frame fixed to a body.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Name: that of a link, or of a frame that was added.
    pub name: String,
    /// Index of the body.
    pub body: usize,
    /// Rotation from frame axes to body axes.
    pub rot_kf: Mat3<f64>,
    /// Origin in body axes, m.
    pub pos_kf: Vec3<f64>,
}

/// Parameters of a joint other than its geometry. They are used by the simulation but not by the dynamics
/// kernels.
#[derive(Clone, Debug)]
pub struct JointProperties {
    /// Name.
    pub name: String,
    /// Viscous friction, N m s/rad (N s/m).
    pub damping: f64,
    /// Coulomb friction while the joint moves (kinetic), N m (N).
    pub friction: f64,
    /// Largest torque (force) that friction holds at rest, N m (N); at least `friction`.
    pub static_friction: f64,
    /// Position, velocity and effort limits, which are enforced only on request.
    pub limits: Limits,
    /// Unit axis in the child link's axes.
    pub axis: Vec3<f64>,
    /// Point on the axis in the child link's axes, m: its origin, unless the joint is traversed backwards.
    pub anchor: Vec3<f64>,
}

/// Model of a robot with a free base: joint `j` moves body `j + 1`, parents come before children.
///
/// `q = [p(3), quat_xyzw(4), joints]`, `v = [v_body(3), w_body(3), joint rates]`.
#[derive(Clone, Debug)]
pub struct Model {
    pub(super) name: String,
    pub(super) nodes: Vec<Node>,
    pub(super) joints: Vec<JointProperties>,
    pub(super) frames: Vec<Frame>,
    /// Index of the frame of each body's link.
    pub(super) body_frames: Vec<usize>,
    pub(super) visuals: Vec<(usize, Visual)>,
    pub(super) collisions: Vec<(usize, Visual)>,
    pub(super) warnings: Vec<ModelWarning>,
    pub(super) is_heavy_on_light: bool,
    pub(super) description: Arc<Description>,
}

impl Model {
    /// Returns the name of the robot.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the description that the model was compiled from.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// Returns the number of joints, `n`.
    #[inline(always)]
    pub fn joint_count(&self) -> usize {
        self.nodes.len() - 1
    }

    /// Returns the length of a configuration, `7 + n`.
    #[inline(always)]
    pub fn nq(&self) -> usize {
        self.nodes.len() + 6
    }

    /// Returns the length of a velocity, `6 + n`.
    #[inline(always)]
    pub fn nv(&self) -> usize {
        self.nodes.len() + 5
    }

    /// Returns the bodies, base first, with their joints.
    #[inline(always)]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Returns true if a joint has Coulomb friction.
    pub fn has_friction(&self) -> bool {
        self.joints.iter().any(|joint| joint.static_friction > 0.0)
    }

    /// Returns the joints in the order of `v`.
    pub fn joints(&self) -> &[JointProperties] {
        &self.joints
    }

    /// Returns all named frames.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// Returns the frame of a body's link.
    pub fn body_frame(&self, body: usize) -> &Frame {
        &self.frames[self.body_frames[body]]
    }

    /// Returns the visual shapes with the index of the frame that each is fixed to.
    pub fn visuals(&self) -> &[(usize, Visual)] {
        &self.visuals
    }

    /// Returns the collision shapes with the index of the frame that each is fixed to; meshes only if their
    /// file exists. They are drawn in place of missing visual shapes.
    pub fn collisions(&self) -> &[(usize, Visual)] {
        &self.collisions
    }

    /// Returns the warnings found when the model was built.
    pub fn warnings(&self) -> &[ModelWarning] {
        &self.warnings
    }

    /// Adds a warning.
    pub fn warn(&mut self, warning: ModelWarning) {
        self.warnings.push(warning);
    }

    /// Returns the pose of a frame of body `k` in the axes of the link of `k`.
    pub fn pose_in_link(&self, frame: &Frame) -> (Mat3<f64>, Vec3<f64>) {
        let link = self.body_frame(frame.body);
        let to_link = link.rot_kf.transpose();
        (to_link * frame.rot_kf, to_link * (frame.pos_kf - link.pos_kf))
    }

    /// Returns true if a body supports one of more than 10⁵ times its own inertia. The recursion of
    /// articulated inertias then loses digits, and forward dynamics uses the mass matrix.
    #[inline(always)]
    pub fn is_heavy_on_light(&self) -> bool {
        self.is_heavy_on_light
    }

    /// Returns the total mass, kg.
    pub fn mass(&self) -> f64 {
        self.nodes.iter().map(|node| node.mass).sum()
    }
}
