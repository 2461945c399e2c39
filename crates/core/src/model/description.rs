//! What a robot is described with: links, joints, shapes.

use nalgebra::{Isometry3, Matrix3, Vector3};

/// Links, joints and frames that a [`Model`](super::Model) is compiled from.
#[derive(Clone, Debug, Default)]
pub struct Description {
    /// Name of the robot.
    pub(super) name: String,
    /// All links; the root is first, parents precede children.
    pub(super) links: Vec<Link>,
    /// `joints[i]` connects link `i + 1` to its parent: index of the parent link, joint.
    pub(super) joints: Vec<(usize, Joint)>,
    /// Additional frames: name, index of the link, pose in the link's frame.
    pub(super) frames: Vec<(String, usize, Isometry3<f64>)>,
}

impl Description {
    /// Returns the description with `prefix` prepended to the names of all links, joints and frames.
    #[must_use]
    pub fn prefixed(mut self, prefix: &str) -> Self {
        let links = self.links.iter_mut().map(|link| &mut link.name);
        let joints = self.joints.iter_mut().map(|(_, joint)| &mut joint.name);
        let frames = self.frames.iter_mut().map(|(name, ..)| name);
        links.chain(joints).chain(frames).for_each(|name| name.insert_str(0, prefix));
        self
    }
}

/// Mass, centre of mass and inertia of a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Inertial {
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in link axes, m.
    pub com: Vector3<f64>,
    /// Inertia about the centre of mass in link axes, kg m² (matrix elements).
    pub inertia: Matrix3<f64>,
}

/// A link; without an [`Inertial`] it is massless.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Its name, unique in the robot.
    pub name: String,
    /// Mass and inertia, if any.
    pub inertial: Option<Inertial>,
    /// What it looks like.
    pub visuals: Vec<Visual>,
    /// Collision shapes; meshes only if their file exists. They are drawn if a visual cannot be.
    pub collisions: Vec<Visual>,
}

impl Link {
    /// A link that looks like nothing.
    pub fn new(name: &str, inertial: Option<Inertial>) -> Self {
        Self { name: name.to_owned(), inertial, visuals: Vec::new(), collisions: Vec::new() }
    }
}

/// A shape fixed to a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Visual {
    /// Pose in the link's frame.
    pub pose: Isometry3<f64>,
    /// Its shape.
    pub geometry: Geometry,
    /// Red, green, blue, opacity, 0 to 1.
    pub rgba: Option<[f64; 4]>,
}

/// Shapes that URDF knows; lengths in m.
#[derive(Clone, Debug, PartialEq)]
pub enum Geometry {
    /// Full edge lengths.
    Box([f64; 3]),
    /// Along z.
    Cylinder {
        /// Radius.
        radius: f64,
        /// Full length.
        length: f64,
    },
    /// Along z; the length is that between the centres of its caps.
    Capsule {
        /// Radius.
        radius: f64,
        /// Length of the straight part.
        length: f64,
    },
    /// A ball.
    Sphere {
        /// Radius.
        radius: f64,
    },
    /// A file.
    Mesh {
        /// Path with `package://` resolved where it could be.
        filename: String,
        /// Scale along each axis.
        scale: [f64; 3],
    },
}

/// A joint between a link that exists and a new one.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Its name, unique in the robot.
    pub name: String,
    /// How it moves.
    pub kind: JointKind,
    /// Pose of the child's frame at position zero in the parent link's frame.
    pub origin: Isometry3<f64>,
    /// Limits, if any.
    pub limits: Limits,
    /// Viscous friction, N m s/rad (N s/m).
    pub damping: f64,
    /// Coulomb friction while the joint moves (kinetic), N m (N).
    pub friction: f64,
    /// Largest torque (force) that friction holds at rest, N m (N); `None` where it equals `friction`.
    pub static_friction: Option<f64>,
    /// Rotor inertia seen at the joint (times gear ratio squared), kg m² (kg).
    pub rotor_inertia: f64,
}

impl Joint {
    /// A joint without friction, rotor or limits.
    pub fn new(name: &str, kind: JointKind, origin: Isometry3<f64>) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            origin,
            limits: Limits::default(),
            damping: 0.0,
            friction: 0.0,
            static_friction: None,
            rotor_inertia: 0.0,
        }
    }
}

/// How a joint moves; axes in the child's frame, of any length but zero.
#[derive(Clone, Debug, PartialEq)]
pub enum JointKind {
    /// Not at all.
    Fixed,
    /// Rotates about an axis (URDF's `revolute` and `continuous`).
    Revolute(Vector3<f64>),
    /// Slides along an axis.
    Prismatic(Vector3<f64>),
}

/// Bounds of a joint; `None` is unbounded.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Lowest and highest position, rad (m).
    pub position: Option<(f64, f64)>,
    /// Highest rate, rad/s (m/s).
    pub velocity: Option<f64>,
    /// Highest torque, N m (force, N).
    pub effort: Option<f64>,
}
