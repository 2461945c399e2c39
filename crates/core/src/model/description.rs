//! Description of a robot by links, joints, frames and shapes.

use super::closed_loop::{Loop, Mimic};
use super::joint_spring::JointSpring;
use nalgebra::{Isometry3, Matrix3, Vector3};
use std::sync::Arc;

/// Description of a robot: links, joints, frames and loops from which a [`Model`](super::Model) is compiled.
#[derive(Clone, Debug, Default)]
pub struct Description {
    /// Name of the robot.
    pub(super) name: String,
    /// All links; the root is first, and parents precede their children.
    pub(super) links: Vec<Link>,
    /// For each link `i + 1`, `joints[i]` holds the index of its parent link and the joint that connects the
    /// two.
    pub(super) joints: Vec<(usize, Joint)>,
    /// Additional frames, each with its name, the index of its link and its pose in link axes.
    pub(super) frames: Vec<(String, usize, Isometry3<f64>)>,
    /// Closed loops, which are compiled into constraints of the model.
    pub(super) loops: Vec<Loop>,
}

impl Description {
    /// Returns the closed loops, which are compiled into constraints of the model.
    pub fn loops(&self) -> &[Loop] {
        &self.loops
    }

    /// Returns the description with `prefix` before the names of all links, joints, frames and loops.
    #[must_use]
    pub fn prefixed(mut self, prefix: &str) -> Self {
        let links = self.links.iter_mut().map(|link| &mut link.name);
        let (joints, leaders): (Vec<_>, Vec<_>) =
            self.joints.iter_mut().map(|(_, joint)| (&mut joint.name, &mut joint.mimic)).unzip();
        let frames = self.frames.iter_mut().map(|(name, ..)| name);
        let leaders = leaders.into_iter().flatten().map(|mimic| &mut mimic.leader);
        let loops =
            self.loops.iter_mut().flat_map(|closing| closing.frames.iter_mut().chain([&mut closing.name]));
        let names = links.chain(joints).chain(leaders).chain(frames).chain(loops);
        names.for_each(|name| name.insert_str(0, prefix));
        self
    }
}

/// Mass, centre of mass and rotational inertia of a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Inertial {
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in link axes, m.
    pub com: Vector3<f64>,
    /// Inertia matrix about the centre of mass in link axes, kg m². Its off-diagonal elements are the
    /// negative products of inertia, as in URDF: `Ixy = −∫ x y dm`.
    pub inertia: Matrix3<f64>,
}

/// Link of a robot. A link without an [`Inertial`] is massless.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Name of the link, which is unique in the robot.
    pub name: String,
    /// Mass and inertia; `None` for a massless link.
    pub inertial: Option<Inertial>,
    /// Visual shapes. If the list is empty, the collision shapes are drawn.
    pub visuals: Vec<Visual>,
    /// Collision shapes, without those that were not read. They are drawn if the link has no visual shapes.
    pub collisions: Vec<Visual>,
    /// Reasons why collision shapes were not read, such as a mesh file that does not exist; one reason
    /// for each shape that was not read.
    pub skipped_collisions: Vec<String>,
}

impl Link {
    /// Creates a link without shapes.
    pub fn new(name: &str, inertial: Option<Inertial>) -> Self {
        Self {
            name: name.to_owned(),
            inertial,
            visuals: Vec::new(),
            collisions: Vec::new(),
            skipped_collisions: Vec::new(),
        }
    }
}

/// Shape fixed to a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Visual {
    /// Pose in link axes.
    pub pose: Isometry3<f64>,
    /// Geometry of the shape.
    pub geometry: Geometry,
    /// Colour: red, green, blue and opacity, each from 0 to 1; `None` if no colour is given.
    pub rgba: Option<[f64; 4]>,
}

/// Geometry of a shape as in URDF; lengths in m.
#[derive(Clone, Debug, PartialEq)]
pub enum Geometry {
    /// Box centred at the origin, with its full edge lengths along x, y and z, m.
    Box([f64; 3]),
    /// Cylinder along z, centred at the origin.
    Cylinder {
        /// Radius, m.
        radius: f64,
        /// Full length, m.
        length: f64,
    },
    /// Capsule along z, centred at the origin.
    Capsule {
        /// Radius, m.
        radius: f64,
        /// Length of the straight part, which is the distance between the centres of the caps, m.
        length: f64,
    },
    /// Sphere about the origin.
    Sphere {
        /// Radius, m.
        radius: f64,
    },
    /// Cone along z, with its base at `−length/2` and its apex at `length/2`; a collision shape only.
    Cone {
        /// Radius of the base, m.
        radius: f64,
        /// Height, m.
        length: f64,
    },
    /// Torus about z with its centre at the origin; a collision shape only.
    Torus {
        /// Radius of the circle in the middle of the tube, m.
        major_radius: f64,
        /// Radius of the tube, m.
        minor_radius: f64,
    },
    /// All points with `z ≤ 0`; a collision shape only.
    HalfSpace,
    /// Convex hull of points, such as a convex piece of a mesh; a collision shape only.
    Hull {
        /// Coordinates of the points, m.
        points: Arc<[[f64; 3]]>,
    },
    /// Triangle mesh in a file.
    Mesh {
        /// Path of the file; if the file was not found, the name given in the URDF.
        filename: String,
        /// Factor by which the mesh is scaled along each axis.
        scale: [f64; 3],
    },
}

/// Joint that connects a link to its parent link.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Name of the joint, which is unique in the robot.
    pub name: String,
    /// Kind of motion that the joint permits, with its axis.
    pub kind: JointKind,
    /// Pose of the joint's frame in the axes of the parent link, at joint position zero.
    pub origin: Isometry3<f64>,
    /// Pose of the child link in the joint's frame, which moves with the child. It is the identity, unless
    /// the joint is traversed from its declared child to its declared parent
    /// ([`Model::rerooted`](super::Model::rerooted)).
    pub child_pose: Isometry3<f64>,
    /// Limits of position, velocity and effort.
    pub limits: Limits,
    /// Coefficient of viscous friction, N m s/rad (N s/m).
    pub damping: f64,
    /// Kinetic Coulomb friction, which acts while the joint moves, N m (N).
    pub friction: f64,
    /// Largest torque (force) that static friction can hold, N m (N); `None` means the value of `friction`.
    pub static_friction: Option<f64>,
    /// Rotor inertia reflected to the joint (multiplied by the gear ratio squared), kg m² (kg).
    pub rotor_inertia: f64,
    /// Spring that acts between the two links; `None` if there is none.
    pub spring: Option<JointSpring>,
    /// Coupling to another joint; `None` for a joint without such a coupling.
    pub mimic: Option<Mimic>,
}

impl Joint {
    /// Creates a joint without limits, damping, friction, rotor inertia, spring or coupling to another joint.
    pub fn new(name: &str, kind: JointKind, origin: Isometry3<f64>) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            origin,
            child_pose: Isometry3::identity(),
            limits: Limits::default(),
            damping: 0.0,
            friction: 0.0,
            static_friction: None,
            rotor_inertia: 0.0,
            spring: None,
            mimic: None,
        }
    }
}

/// Kind of motion of a joint. Axes are vectors in the joint's frame with any nonzero length.
#[derive(Clone, Debug, PartialEq)]
pub enum JointKind {
    /// No motion.
    Fixed,
    /// Rotation about an axis (URDF's `revolute` and `continuous`).
    Revolute(Vector3<f64>),
    /// Translation along an axis.
    Prismatic(Vector3<f64>),
}

/// Limits of a joint; `None` means unlimited.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Lowest and highest position, rad (m); either of them may be infinite.
    pub position: Option<(f64, f64)>,
    /// Highest rate, rad/s (m/s).
    pub velocity: Option<f64>,
    /// Highest torque, N m (force, N).
    pub effort: Option<f64>,
}
