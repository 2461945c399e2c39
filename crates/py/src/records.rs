//! What a robot is made of, as plain records.

use onorbit_core::model::{Axis, Frame, Geometry, Model, Visual};
use onorbit_core::spatial::{Mat3, Vec3};
use pyo3::prelude::*;

type Matrix3 = [[f64; 3]; 3];
type Matrix4 = [[f64; 4]; 4];

/// A moving joint; positions in rad, or m where it slides.
#[pyclass(name = "Joint", frozen, get_all, module = "onorbit_rs")]
pub(crate) struct PyJoint {
    /// Its name.
    name: String,
    /// ``revolute`` or ``prismatic``; a continuous joint is revolute without ``lower`` and ``upper``.
    kind: &'static str,
    /// Name of the body it hangs on.
    parent: String,
    /// Name of the body it carries.
    child: String,
    /// Pose of the child's link at position zero in the parent's link: (4, 4), m.
    pose: Matrix4,
    /// Unit axis in the child's link: (3,).
    axis: [f64; 3],
    /// Lowest position, or None.
    lower: Option<f64>,
    /// Highest position, or None.
    upper: Option<f64>,
    /// Highest rate, rad/s or m/s, or None.
    velocity: Option<f64>,
    /// Highest torque, N m, or force, N, or None.
    effort: Option<f64>,
    /// Viscous friction, N m s/rad or N s/m.
    damping: f64,
    /// Coulomb friction while it moves, N m or N.
    friction: f64,
    /// Largest friction at rest, N m or N.
    static_friction: f64,
    /// Rotor inertia seen at the joint, kg m² or kg.
    rotor_inertia: f64,
}

/// A body: a link with what is fixed to it.
#[pyclass(name = "Body", frozen, get_all, module = "onorbit_rs")]
pub(crate) struct PyBody {
    /// Its name, which is its first link's.
    name: String,
    /// Mass, kg.
    mass: f64,
    /// Centre of mass in the link's axes: (3,), m.
    com: [f64; 3],
    /// Inertia about the centre of mass in the link's axes: (3, 3), kg m².
    inertia: Matrix3,
}

/// A named frame fixed to a body.
#[pyclass(name = "Frame", frozen, get_all, module = "onorbit_rs")]
pub(crate) struct PyFrame {
    /// Its name.
    name: String,
    /// Name of the body it is fixed to.
    body: String,
    /// Pose in the body's link: (4, 4), m.
    pose: Matrix4,
}

/// A shape fixed to a frame.
#[pyclass(name = "Visual", frozen, get_all, module = "onorbit_rs")]
pub(crate) struct PyVisual {
    /// Name of the frame it is fixed to.
    link: String,
    /// Pose in that frame as rows of a (4, 4) matrix, m.
    pose: [[f64; 4]; 4],
    /// ``box``, ``cylinder``, ``capsule``, ``sphere`` or ``mesh``.
    kind: &'static str,
    /// Box: edge lengths; cylinder, capsule: radius and length; sphere: radius; m.
    size: Vec<f64>,
    /// Path of a mesh.
    filename: Option<String>,
    /// Scale of a mesh.
    scale: [f64; 3],
    /// Red, green, blue, opacity, 0 to 1.
    rgba: Option<[f64; 4]>,
}

impl PyVisual {
    fn new(link: &str, visual: &Visual) -> Self {
        let m = visual.pose.to_homogeneous();
        let pose = std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)]));
        let (kind, size, filename, scale) = match &visual.geometry {
            Geometry::Box(edges) => ("box", edges.to_vec(), None, [1.0; 3]),
            Geometry::Cylinder { radius, length } => ("cylinder", vec![*radius, *length], None, [1.0; 3]),
            Geometry::Capsule { radius, length } => ("capsule", vec![*radius, *length], None, [1.0; 3]),
            Geometry::Sphere { radius } => ("sphere", vec![*radius], None, [1.0; 3]),
            Geometry::Mesh { filename, scale } => ("mesh", Vec::new(), Some(filename.clone()), *scale),
        };
        Self { link: link.to_owned(), pose, kind, size, filename, scale, rgba: visual.rgba }
    }
}

/// Of a model's visuals or collision shapes.
pub(crate) fn shapes(model: &Model, shapes: &[(usize, Visual)]) -> Vec<PyVisual> {
    let frame = |index: usize| &model.frames()[index].name;
    shapes.iter().map(|(index, shape)| PyVisual::new(frame(*index), shape)).collect()
}

pub(crate) fn joints(model: &Model) -> Vec<PyJoint> {
    let body = |k: usize| model.body_frame(k).name.clone();
    let bound = |value: f64| Some(value).filter(|value| value.is_finite());
    let joint = |(j, joint): (usize, &onorbit_core::model::JointProperties)| {
        let node = &model.nodes()[j + 1];
        let kind = match node.axis {
            Axis::Revolute => "revolute",
            Axis::Prismatic => "prismatic",
        };
        let (parent, child) = (model.body_frame(node.parent), model.body_frame(j + 1));
        // the child's link at zero, in the parent's axes: X_pk X_kf
        let at_zero = Frame {
            name: String::new(),
            body: node.parent,
            rot_kf: node.rot_pk * child.rot_kf,
            pos_kf: node.rot_pk * child.pos_kf + node.pos_pk,
        };
        let (rot, pos) = model.pose_in_link(&at_zero);
        let limits = &joint.limits;
        PyJoint {
            name: joint.name.clone(),
            kind,
            parent: parent.name.clone(),
            child: body(j + 1),
            pose: pose(&rot, pos),
            axis: joint.axis.to_nalgebra().into(),
            lower: limits.position.and_then(|(lower, _)| bound(lower)),
            upper: limits.position.and_then(|(_, upper)| bound(upper)),
            velocity: limits.velocity,
            effort: limits.effort,
            damping: joint.damping,
            friction: joint.friction,
            static_friction: joint.static_friction,
            rotor_inertia: node.rotor_inertia,
        }
    };
    model.joints().iter().enumerate().map(joint).collect()
}

pub(crate) fn bodies(model: &Model) -> Vec<PyBody> {
    let body = |(k, node): (usize, &onorbit_core::model::Node)| {
        let link = model.body_frame(k);
        let rot = link.rot_kf.to_nalgebra();
        let com = rot.transpose() * (node.com - link.pos_kf).to_nalgebra();
        let inertia = rot.transpose() * node.about_com.to_nalgebra() * rot;
        let inertia = std::array::from_fn(|i| std::array::from_fn(|j| inertia[(i, j)]));
        PyBody { name: link.name.clone(), mass: node.mass, com: com.into(), inertia }
    };
    model.nodes().iter().enumerate().map(body).collect()
}

pub(crate) fn frames(model: &Model) -> Vec<PyFrame> {
    let frame = |frame: &Frame| {
        let (rot, pos) = model.pose_in_link(frame);
        let body = model.body_frame(frame.body).name.clone();
        PyFrame { name: frame.name.clone(), body, pose: pose(&rot, pos) }
    };
    model.frames().iter().map(frame).collect()
}

/// `[[R, p], [0, 1]]` in rows.
fn pose(rot: &Mat3<f64>, pos: Vec3<f64>) -> Matrix4 {
    let (rot, pos) = (rot.to_nalgebra(), pos.to_nalgebra());
    std::array::from_fn(|i| {
        std::array::from_fn(|j| match (i, j) {
            (3, 3) => 1.0,
            (3, _) => 0.0,
            (_, 3) => pos[i],
            _ => rot[(i, j)],
        })
    })
}
