//! Descriptions of joints, bodies, frames and shapes of a robot.

use onorbit_core::model::{Axis, Constraint, Frame, Geometry, JointSpring, Model, Visual};
use onorbit_core::spatial::{Mat3, Vec3};
use pyo3::prelude::*;

type Matrix3 = [[f64; 3]; 3];
type Matrix4 = [[f64; 4]; 4];

/// Moving joint of a model. Positions are in rad, or in m for a prismatic joint.
#[pyclass(name = "Joint", frozen, get_all, module = "onorbit_rs")]
pub(super) struct PyJoint {
    /// Name of the joint.
    name: String,
    /// Type of the joint, ``revolute`` or ``prismatic``; a continuous joint is revolute without ``lower`` and
    /// ``upper``.
    kind: &'static str,
    /// Name of the parent body.
    parent: String,
    /// Name of the child body.
    child: String,
    /// Pose of the child link relative to the parent link at joint position zero: (4, 4), m.
    pose: Matrix4,
    /// Unit vector along the axis, in the child link's axes: (3,).
    axis: [f64; 3],
    /// Point on the axis, relative to the child link's origin in the child link's axes, m: (3,). It is zero
    /// unless ``Model.rerooted`` or ``attach`` reversed the joint.
    anchor: [f64; 3],
    /// Lower position limit, rad or m; None without a lower limit.
    lower: Option<f64>,
    /// Upper position limit, rad or m; None without an upper limit.
    upper: Option<f64>,
    /// Largest rate, rad/s or m/s; None without a limit.
    velocity: Option<f64>,
    /// Largest torque or force of the joint, N m or N; None without a limit.
    effort: Option<f64>,
    /// Coefficient of viscous friction, N m s/rad or N s/m.
    damping: f64,
    /// Kinetic Coulomb friction, which acts while the joint moves, N m or N.
    friction: f64,
    /// Largest torque or force that static friction can hold, N m or N.
    static_friction: f64,
    /// Rotor inertia reflected to the joint, kg m² or kg.
    rotor_inertia: f64,
    /// Stiffness of the spring at its rest position, N m/rad or N/m; 0 without a spring.
    stiffness: f64,
    /// Cubic stiffness of the spring, N m/rad³ or N/m³; 0 for a linear spring and without a spring.
    cubic_stiffness: f64,
    /// Joint position at which the spring exerts no torque or force, rad or m; 0 without a spring.
    rest_position: f64,
    /// Leading joint, ratio and offset (rad or m) of a mimic joint; None for other joints. The position of a
    /// mimic joint is the ratio times the position of its leader, plus the offset.
    mimic: Option<(String, f64, f64)>,
}

/// Body of a model: a link together with all links that are fixed to it.
#[pyclass(name = "Body", frozen, get_all, module = "onorbit_rs")]
pub(super) struct PyBody {
    /// Name of the body, which is the name of its first link.
    name: String,
    /// Mass, kg.
    mass: f64,
    /// Centre of mass in the axes of the body's first link: (3,), m.
    com: [f64; 3],
    /// Inertia about the centre of mass in the axes of the body's first link: (3, 3), kg m².
    inertia: Matrix3,
}

/// Named frame that is fixed to a body.
#[pyclass(name = "Frame", frozen, get_all, module = "onorbit_rs")]
pub(super) struct PyFrame {
    /// Name of the frame.
    name: String,
    /// Name of the body to which the frame is fixed.
    body: String,
    /// Pose relative to the body's first link, a homogeneous transform: (4, 4), m.
    pose: Matrix4,
}

/// Visual or collision shape that is fixed to a frame.
#[pyclass(name = "Visual", frozen, get_all, module = "onorbit_rs")]
pub(super) struct PyVisual {
    /// Name of the frame to which the shape is fixed.
    link: String,
    /// Pose of the shape in that frame, a homogeneous transform: (4, 4), m.
    pose: [[f64; 4]; 4],
    /// Type of the shape: ``box``, ``cylinder``, ``capsule``, ``sphere`` or ``mesh``; collision shapes may
    /// also be a ``cone``, ``torus``, ``half_space`` or ``hull`` (a convex piece of a mesh).
    kind: &'static str,
    /// Dimensions, m: edge lengths of a box; radius and length of a cylinder, capsule or cone; radii of the
    /// circle and of the tube of a torus; radius of a sphere. Empty for a mesh, a hull and a half-space.
    size: Vec<f64>,
    /// Positions of the ``k`` corners of a hull: (k, 3), m; empty for other shapes.
    points: Vec<[f64; 3]>,
    /// Path of the file of a mesh; None for other shapes.
    filename: Option<String>,
    /// Scale factors of a mesh along its axes: (3,), dimensionless.
    scale: [f64; 3],
    /// Red, green, blue and opacity, each from 0 to 1; None without a colour.
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
            Geometry::Cone { radius, length } => ("cone", vec![*radius, *length], None, [1.0; 3]),
            Geometry::Torus { major_radius, minor_radius } => {
                ("torus", vec![*major_radius, *minor_radius], None, [1.0; 3])
            }
            Geometry::HalfSpace => ("half_space", Vec::new(), None, [1.0; 3]),
            Geometry::Hull { .. } => ("hull", Vec::new(), None, [1.0; 3]),
            Geometry::Mesh { filename, scale } => ("mesh", Vec::new(), Some(filename.clone()), *scale),
        };
        let points = match &visual.geometry {
            Geometry::Hull { points } => points.to_vec(),
            _ => Vec::new(),
        };
        Self { link: link.to_owned(), pose, kind, size, points, filename, scale, rgba: visual.rgba }
    }
}

/// Returns the descriptions of visual or collision shapes, each of which is given with the index of its
/// frame.
pub(super) fn shapes(model: &Model, shapes: &[(usize, Visual)]) -> Vec<PyVisual> {
    let frame = |index: usize| &model.frames()[index].name;
    shapes.iter().map(|(index, shape)| PyVisual::new(frame(*index), shape)).collect()
}

/// Returns the descriptions of the moving joints, in the order of `v`.
pub(super) fn joints(model: &Model) -> Vec<PyJoint> {
    let body = |k: usize| model.body_frame(k).name.clone();
    let bound = |value: f64| Some(value).filter(|value| value.is_finite());
    let joint = |(j, joint): (usize, &onorbit_core::model::JointProperties)| {
        let node = &model.nodes()[j + 1];
        let kind = match node.axis {
            Axis::Revolute => "revolute",
            Axis::Prismatic => "prismatic",
        };
        let (parent, child) = (model.body_frame(node.parent), model.body_frame(j + 1));
        // pose of the child link in the parent body at position zero: X_pk X_kf
        let at_zero = Frame {
            name: String::new(),
            body: node.parent,
            rot_kf: node.rot_pk * child.rot_kf,
            pos_kf: node.rot_pk * child.pos_kf + node.pos_pk,
        };
        let (rot, pos) = model.pose_in_link(&at_zero);
        let limits = &joint.limits;
        let of_spring = |get: fn(&JointSpring) -> f64| joint.spring.as_ref().map_or(0.0, get);
        PyJoint {
            name: joint.name.clone(),
            kind,
            parent: parent.name.clone(),
            child: body(j + 1),
            pose: pose(&rot, pos),
            axis: joint.axis.to_nalgebra().into(),
            anchor: joint.anchor.to_nalgebra().into(),
            lower: limits.position.and_then(|(lower, _)| bound(lower)),
            upper: limits.position.and_then(|(_, upper)| bound(upper)),
            velocity: limits.velocity,
            effort: limits.effort,
            damping: joint.damping,
            friction: joint.friction,
            static_friction: joint.static_friction,
            rotor_inertia: node.rotor_inertia,
            stiffness: of_spring(|spring| spring.stiffness),
            cubic_stiffness: of_spring(|spring| spring.cubic_stiffness),
            rest_position: of_spring(|spring| spring.rest_position),
            mimic: mimic(model, j),
        }
    };
    model.joints().iter().enumerate().map(joint).collect()
}

/// Returns leading joint, ratio and offset (rad or m) of the joint with this index; `None` unless it is a
/// mimic joint.
fn mimic(model: &Model, joint: usize) -> Option<(String, f64, f64)> {
    model.closures().iter().find_map(|closure| match closure.constraint {
        Constraint::Mimic { joint: own, leader, ratio, offset } if own == joint => {
            Some((model.joints()[leader].name.clone(), ratio, offset))
        }
        _ => None,
    })
}

/// Returns the descriptions of the bodies, base first.
pub(super) fn bodies(model: &Model) -> Vec<PyBody> {
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

/// Returns the descriptions of the frames.
pub(super) fn frames(model: &Model) -> Vec<PyFrame> {
    let frame = |frame: &Frame| {
        let (rot, pos) = model.pose_in_link(frame);
        let body = model.body_frame(frame.body).name.clone();
        PyFrame { name: frame.name.clone(), body, pose: pose(&rot, pos) }
    };
    model.frames().iter().map(frame).collect()
}

/// Returns the rows of the homogeneous transform `[[R, p], [0, 1]]` with rotation `R` and position `p`, m.
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
