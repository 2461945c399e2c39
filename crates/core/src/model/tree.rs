//! Compiled tree of bodies.

use super::closure::Closure;
use super::description::{Description, Limits, Visual};
use super::error::ModelWarning;
use super::frame::Frame;
use super::joint_spring::JointSpring;
use crate::spatial::{Mat3, Sym3, Vec3};
use std::sync::Arc;

/// Kind of a joint, which moves its body about or along the *z axis of the body*.
///
/// The axes of a body are chosen such that z is the joint axis; the axes of the body's link are kept as a
/// [`Frame`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Rotation about z.
    Revolute,
    /// Translation along z.
    Prismatic,
}

/// Node of the tree: a body and the joint that connects it to its parent. Node 0 is the base, which has no
/// parent and no joint.
#[derive(Clone, Debug)]
pub struct Node {
    /// Index of the parent body, which is smaller than the index of the body; 0 for the base.
    pub parent: usize,
    /// True if the body has children other than the body with the next index.
    pub is_fork: bool,
    /// One more than the index of the last body of the subtree; bodies are numbered depth first.
    pub end: usize,
    /// Kind of the joint; has no meaning for the base.
    pub axis: Axis,
    /// Rotation from the axes of this body, at joint position zero, to the axes of the parent.
    pub rot_pk: Mat3<f64>,
    /// Origin of this body at joint position zero, in the parent's axes, m.
    pub pos_pk: Vec3<f64>,
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the body's axes, m.
    pub com: Vec3<f64>,
    /// Inertia about the centre of mass in the body's axes, kg m².
    pub about_com: Sym3<f64>,
    /// Rotor inertia reflected to the joint, kg m² (kg for a prismatic joint).
    pub rotor_inertia: f64,
}

/// Name, damping, friction, limits and spring of a joint, and its axis in the axes of the child link. The
/// simulation and the controls use these properties; the dynamics algorithms use [`Node`] instead.
#[derive(Clone, Debug)]
pub struct JointProperties {
    /// Name of the joint.
    pub name: String,
    /// Viscous friction, N m s/rad (N s/m).
    pub damping: f64,
    /// Kinetic Coulomb friction, which acts while the joint moves, N m (N).
    pub friction: f64,
    /// Largest torque (force) that static friction can hold, N m (N); at least `friction`.
    pub static_friction: f64,
    /// Position, velocity and effort limits, which are enforced only on request.
    pub limits: Limits,
    /// Spring that acts between the two links; `None` if there is none.
    pub spring: Option<JointSpring>,
    /// Unit vector along the joint axis, in the axes of the child link.
    pub axis: Vec3<f64>,
    /// Point on the axis in the child link's axes, m. It is the origin of the link, unless the joint is
    /// traversed backwards.
    pub anchor: Vec3<f64>,
}

/// Model of a robot with a free-floating base. Joint `j` moves body `j + 1`; parents precede their children.
///
/// `q = [p(3), quat_xyzw(4), joints]`, `v = [v_body(3), w_body(3), joint rates]`.
#[derive(Clone, Debug)]
pub struct Model {
    pub(super) name: String,
    pub(super) nodes: Vec<Node>,
    pub(super) joints: Vec<JointProperties>,
    pub(super) frames: Vec<Frame>,
    /// For each body, the index of the frame of the link whose name the body has.
    pub(super) body_frames: Vec<usize>,
    pub(super) visuals: Vec<(usize, Visual)>,
    pub(super) collisions: Vec<(usize, Visual)>,
    pub(super) warnings: Vec<ModelWarning>,
    pub(super) is_heavy_on_light: bool,
    pub(super) closures: Vec<Closure>,
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

    /// Returns the number of moving joints, `n`.
    #[inline(always)]
    pub fn joint_count(&self) -> usize {
        self.nodes.len() - 1
    }

    /// Returns the length of a configuration vector `q`, `7 + n`.
    #[inline(always)]
    pub fn nq(&self) -> usize {
        self.nodes.len() + 6
    }

    /// Returns the length of a velocity vector `v`, `6 + n`.
    #[inline(always)]
    pub fn nv(&self) -> usize {
        self.nodes.len() + 5
    }

    /// Returns the bodies, base first, each with the joint that connects it to its parent.
    #[inline(always)]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Returns true if at least one joint has Coulomb friction, whether static or kinetic.
    pub fn has_friction(&self) -> bool {
        self.joints.iter().any(|joint| joint.static_friction > 0.0)
    }

    /// Returns the indices of the joints with springs, in the order of `v`, each with its spring.
    pub fn springs(&self) -> impl Iterator<Item = (usize, &JointSpring)> {
        self.joints.iter().enumerate().filter_map(|(j, joint)| Some((j, joint.spring.as_ref()?)))
    }

    /// Returns the properties of the moving joints in the order of `v`.
    pub fn joints(&self) -> &[JointProperties] {
        &self.joints
    }

    /// Returns all frames: those of the links, followed by the frames that were added to links.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// Returns the frame of the link that gives the body with the index `body` its name.
    pub fn body_frame(&self, body: usize) -> &Frame {
        &self.frames[self.body_frames[body]]
    }

    /// Returns the visual shapes, each with the index of the frame to which it is fixed.
    pub fn visuals(&self) -> &[(usize, Visual)] {
        &self.visuals
    }

    /// Returns the collision shapes, each with the index of the frame to which it is fixed. Meshes are
    /// included only if their file exists. Collision shapes are drawn for links without visual shapes.
    pub fn collisions(&self) -> &[(usize, Visual)] {
        &self.collisions
    }

    /// Returns the reasons why collision shapes of a link were not read; `frame` is the index of the frame of
    /// that link. The list is empty for a frame that is not that of a link.
    pub fn skipped_collisions(&self, frame: usize) -> &[String] {
        let name = &self.frames[frame].name;
        let link = self.description.links.iter().find(|link| link.name == *name);
        link.map_or(&[], |link| &link.skipped_collisions)
    }

    /// Returns the warnings about problems that were found when the model was built.
    pub fn warnings(&self) -> &[ModelWarning] {
        &self.warnings
    }

    /// Adds a warning to those returned by [`warnings`](Model::warnings).
    pub fn warn(&mut self, warning: ModelWarning) {
        self.warnings.push(warning);
    }

    /// Returns the pose of a frame in the axes of the link of its body: the rotation from frame axes to link
    /// axes, and the origin of the frame, m.
    pub fn pose_in_link(&self, frame: &Frame) -> (Mat3<f64>, Vec3<f64>) {
        let link = self.body_frame(frame.body);
        let to_link = link.rot_kf.transpose();
        (to_link * frame.rot_kf, to_link * (frame.pos_kf - link.pos_kf))
    }

    /// Returns true if a body has less than 10⁻⁵ of the inertia of a body that it supports. Articulated-body
    /// inertias then lose digits, and forward dynamics uses the mass matrix instead.
    #[inline(always)]
    pub fn is_heavy_on_light(&self) -> bool {
        self.is_heavy_on_light
    }

    /// Returns the constraints of the robot: first its closed loops in the order of their declaration, then
    /// its mimic joints.
    pub fn closures(&self) -> &[Closure] {
        &self.closures
    }

    /// Returns the total mass, kg.
    pub fn mass(&self) -> f64 {
        self.nodes.iter().map(|node| node.mass).sum()
    }
}
