//! The humanoid torso of the OnOrbitROS paper with one arm of seven joints.

use nalgebra::{Isometry3, Matrix3, Vector3};
use onorbit_core::model::{Inertial, Joint, JointKind, Link, Loop, LoopKind, Mimic, Model, ModelBuilder};

/// Mass, kg, and inertia Ixx, Iyy, Izz, Ixy, Ixz, Iyz, kg m². Source: the paper, Table 1.
const BODY: (f64, [f64; 6]) = (93.0, [18.6, 15.4, 4.1, -0.008, -0.027, 0.058]);
const LINKS: [(f64, [f64; 6]); 7] = [
    (2.741, [0.0124, 0.0042, 0.0136, 3.6e-05, 7.1e-05, -0.0002]),
    (2.425, [0.013, 0.0138, 0.0049, 1.2e-05, -0.0032, -0.0001]),
    (2.209, [0.007, 0.0069, 0.0039, -0.0001, 0.0007, 0.0004]),
    (0.877, [0.0025, 0.0027, 0.0012, 0.0001, -0.0003, 0.0004]),
    (1.878, [0.0035, 0.0044, 0.0023, 1.3e-05, 1.03e-05, -9.7e-05]),
    (0.409, [0.0001, 0.00014, 0.00015, -8.9e-08, -4.4e-08, 4.2e-07]),
    (0.308, [0.0003, 0.0002, 0.00017, -1.6e-06, 1.7e-06, -1.2e-05]),
];

/// Joint origins, axes and centres of mass, m. Source: issue 2, part 10.
const ORIGINS: [[f64; 3]; 7] = [
    [0.0, -0.1575, 0.232],
    [0.0049, -0.1365, 0.0467],
    [0.0, 0.0, 0.0],
    [0.02, 0.0, -0.273],
    [-0.02, 0.0, -0.2643],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
];
const AXES: [char; 7] = ['z', 'x', 'z', 'y', 'z', 'x', 'y'];
const CENTERS: [[f64; 3]; 7] = [
    [-0.0003, -0.1006, 0.0444],
    [0.0144, -0.0009, -0.0868],
    [0.0136, -0.0124, -0.2499],
    [-0.0074, 0.0214, -0.0331],
    [-0.0001, -0.0033, 0.0796],
    [0.0, 0.002, -0.0006],
    [0.0075, -0.0014, -0.0246],
];

/// Joints at the start of the reach, rad. Source: issue 2, part 11.
pub const START: [f64; 7] = [0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974];

fn inertial((mass, i): (f64, [f64; 6]), com: [f64; 3]) -> Option<Inertial> {
    let inertia = Matrix3::new(i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2]);
    Some(Inertial { mass, com: Vector3::from(com), inertia })
}

/// Returns the robot with base `torso`, joints `arm_1` to `arm_7` and frame `tool`; `change` may alter each
/// joint.
pub fn humanoid_with(change: impl Fn(&mut Joint)) -> Model {
    builder(change).build().unwrap()
}

/// Returns the robot with an eighth joint that no law drives and whose link of 1e-12 kg is negligible, so
/// that laws on the arm are laws on a group of joints.
pub fn humanoid_with_idle_joint(change: impl Fn(&mut Joint)) -> Model {
    let mut builder = builder(change);
    let idle = Joint::new("idle", JointKind::Revolute(Vector3::z()), Isometry3::identity());
    let link = Inertial { mass: 1e-12, com: Vector3::zeros(), inertia: Matrix3::identity() * 1e-12 };
    builder.add("torso", idle, Link::new("idle_link", Some(link))).unwrap();
    builder.build().unwrap()
}

/// Returns the robot with two gripping parts at its tool: a four-bar linkage that the loop `closing` closes, and
/// two jaws, the second of which mimics the first.
pub fn humanoid_with_grippers() -> Model {
    let mut builder = builder(|_| {});
    let revolute = |name: &str, x: f64| {
        Joint::new(name, JointKind::Revolute(Vector3::z()), Isometry3::translation(x, 0.0, -0.1))
    };
    let slider = |name: &str, y: f64| {
        Joint::new(name, JointKind::Prismatic(Vector3::y()), Isometry3::translation(0.0, y, -0.15))
    };
    let rod =
        |name: &str| Link::new(name, inertial((0.1, [1e-5, 1e-4, 1e-4, 0.0, 0.0, 0.0]), [0.03, 0.0, 0.0]));
    let knee = Joint::new("knee", JointKind::Revolute(Vector3::z()), Isometry3::translation(0.05, 0.0, 0.0));
    builder.add("arm_link_7", revolute("left_crank", 0.0), rod("left_rod")).unwrap();
    builder.add("left_rod", knee, rod("coupler")).unwrap();
    builder.add("arm_link_7", revolute("right_crank", 0.1), rod("right_rod")).unwrap();
    builder.add("arm_link_7", slider("left_jaw", 0.02), rod("left_pad")).unwrap();
    let mut follower = slider("right_jaw", -0.02);
    follower.mimic = Some(Mimic { leader: "left_jaw".to_owned(), ratio: -1.0, offset: 0.0 });
    builder.add("arm_link_7", follower, rod("right_pad")).unwrap();
    let tip = |x: f64| Isometry3::translation(x, 0.0, 0.0);
    builder
        .close(Loop {
            name: "closing".to_owned(),
            kind: LoopKind::Revolute,
            frames: ["coupler".to_owned(), "right_rod".to_owned()],
            poses: [tip(0.1), tip(0.08)],
            length: None,
            project: true,
        })
        .unwrap();
    builder.build().unwrap()
}

fn builder(change: impl Fn(&mut Joint)) -> ModelBuilder {
    let mut builder = ModelBuilder::new("humanoid", Link::new("torso", inertial(BODY, [0.0; 3]))).unwrap();
    let mut parent = "torso".to_owned();
    for i in 0..7 {
        let axis = match AXES[i] {
            'x' => Vector3::x(),
            'y' => Vector3::y(),
            _ => Vector3::z(),
        };
        let [x, y, z] = ORIGINS[i];
        let mut joint =
            Joint::new(&format!("arm_{}", i + 1), JointKind::Revolute(axis), Isometry3::translation(x, y, z));
        change(&mut joint);
        let name = format!("arm_link_{}", i + 1);
        builder.add(&parent, joint, Link::new(&name, inertial(LINKS[i], CENTERS[i]))).unwrap();
        parent = name;
    }
    builder.add_frame("tool", &parent, Isometry3::translation(0.0, 0.0, -0.1)).unwrap();
    builder
}

/// The robot of the paper.
pub fn humanoid() -> Model {
    humanoid_with(|_| {})
}

/// Returns the state at the origin, unrotated, with the arm at [`START`].
pub fn start(model: &Model) -> Vec<f64> {
    let mut q = onorbit_core::model::neutral(model);
    q[7..14].copy_from_slice(&START);
    q
}
