//! The compiled tree that the kernels run on.

use super::description::{Description, Limits, Visual};
use super::error::ModelWarning;
use crate::spatial::{Mat3, Sym3, Vec3};
use std::sync::Arc;

/// How a joint moves its body: about or along the *z axis of the body's own axes*.
///
/// Bodies are given axes whose z is the joint's axis when the model is built, so one path serves
/// every direction; the link's own axes are kept as its [`Frame`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Rotates about z.
    Revolute,
    /// Slides along z.
    Prismatic,
}

/// One body and the joint that carries it. Node 0 is the base, which nothing carries.
#[derive(Clone, Debug)]
pub struct Node {
    /// Index of the body it hangs on; always smaller than its own.
    pub parent: usize,
    /// Whether bodies beside the next one hang on it.
    pub is_fork: bool,
    /// One past the last body of its subtree: bodies are numbered depth first.
    pub end: usize,
    /// What its joint does (of no meaning for the base).
    pub axis: Axis,
    /// Axes of this body at joint position zero, in the parent's axes.
    pub rot_pk: Mat3<f64>,
    /// Origin of this body at joint position zero, in the parent's axes, m.
    pub pos_pk: Vec3<f64>,
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the body's axes, m.
    pub com: Vec3<f64>,
    /// Inertia about the centre of mass in the body's axes, kg m².
    pub about_com: Sym3<f64>,
    /// Rotor inertia seen at the joint, kg m² (kg for a slider).
    pub rotor_inertia: f64,
}

/// A named frame fixed to a body.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Its name: a link's, or one the user gave.
    pub name: String,
    /// Index of the body it is fixed to.
    pub body: usize,
    /// Takes frame components to the body's.
    pub rot_kf: Mat3<f64>,
    /// Origin in the body's axes, m.
    pub pos_kf: Vec3<f64>,
}

/// What a joint has besides its geometry. Torques of the simulated plant, not of the kernels.
#[derive(Clone, Debug)]
pub struct JointProperties {
    /// Its name.
    pub name: String,
    /// Viscous friction, N m s/rad (N s/m).
    pub damping: f64,
    /// Coulomb friction while the joint moves (kinetic), N m (N).
    pub friction: f64,
    /// Largest torque (force) that friction holds at rest, N m (N); at least `friction`.
    pub static_friction: f64,
    /// Position, velocity and effort limits; stored, enforced only on request.
    pub limits: Limits,
    /// Unit axis in the link's axes, for display.
    pub axis: Vec3<f64>,
}

/// A robot with a free base: joint `j` moves body `j + 1`, parents come before children.
///
/// `q = [p(3), quat_xyzw(4), joints]`, `v = [v_body(3), w_body(3), joint rates]`.
#[derive(Clone, Debug)]
pub struct Model {
    pub(super) name: String,
    pub(super) nodes: Vec<Node>,
    pub(super) joints: Vec<JointProperties>,
    pub(super) frames: Vec<Frame>,
    /// Frame of each body's link.
    pub(super) body_frames: Vec<usize>,
    pub(super) visuals: Vec<(usize, Visual)>,
    pub(super) collisions: Vec<(usize, Visual)>,
    pub(super) warnings: Vec<ModelWarning>,
    pub(super) is_heavy_on_light: bool,
    pub(super) description: Arc<Description>,
}

impl Model {
    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The description it was compiled from.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// Number of joints, `n`.
    #[inline(always)]
    pub fn joint_count(&self) -> usize {
        self.nodes.len() - 1
    }

    /// Length of a configuration, `7 + n`.
    #[inline(always)]
    pub fn nq(&self) -> usize {
        self.nodes.len() + 6
    }

    /// Length of a velocity, `6 + n`.
    #[inline(always)]
    pub fn nv(&self) -> usize {
        self.nodes.len() + 5
    }

    /// Bodies, base first, with the joints that carry them.
    #[inline(always)]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Whether any joint has Coulomb friction.
    pub fn has_friction(&self) -> bool {
        self.joints.iter().any(|joint| joint.static_friction > 0.0)
    }

    /// Joints in the order of `v`.
    pub fn joints(&self) -> &[JointProperties] {
        &self.joints
    }

    /// All named frames.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// The frame of each body's link.
    pub fn body_frame(&self, body: usize) -> &Frame {
        &self.frames[self.body_frames[body]]
    }

    /// Visual shapes with the frame (index) each is fixed to.
    pub fn visuals(&self) -> &[(usize, Visual)] {
        &self.visuals
    }

    /// Collision shapes, likewise, with meshes whose file exists. They are drawn if a visual cannot be.
    pub fn collisions(&self) -> &[(usize, Visual)] {
        &self.collisions
    }

    /// What was odd in the description.
    pub fn warnings(&self) -> &[ModelWarning] {
        &self.warnings
    }

    /// Keeps a remark for the reader of the model.
    pub fn warn(&mut self, warning: ModelWarning) {
        self.warnings.push(warning);
    }

    /// Pose of a frame of body `k` in the axes of `k`'s link: where the user knows it.
    pub fn pose_in_link(&self, frame: &Frame) -> (Mat3<f64>, Vec3<f64>) {
        let link = self.body_frame(frame.body);
        let to_link = link.rot_kf.transpose();
        (to_link * frame.rot_kf, to_link * (frame.pos_kf - link.pos_kf))
    }

    /// Whether some body carries one of more than 10⁵ times its own inertia: articulated inertias cancel there, and forward
    /// dynamics uses the mass matrix.
    #[inline(always)]
    pub fn is_heavy_on_light(&self) -> bool {
        self.is_heavy_on_light
    }

    /// Total mass, kg.
    pub fn mass(&self) -> f64 {
        self.nodes.iter().map(|node| node.mass).sum()
    }
}
