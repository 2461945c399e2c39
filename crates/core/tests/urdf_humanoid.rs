//! Checks the bundled humanoid robots.

#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test

use onorbit_core::dynamics::{Data, center_of_mass, frame_pose, mass_matrix, positions};
use onorbit_core::model::urdf::from_file;
use onorbit_core::model::{Model, neutral};
use onorbit_core::spatial::Vec3;
use std::path::PathBuf;

/// Initial configuration of the bundled scenario.
const START: [f64; 7] = [0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974];

fn load(name: &str) -> Model {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../python/onorbit_rs/robots");
    from_file(&folder.join(name), &Default::default()).unwrap()
}

fn frame(model: &Model, q: &[f64], name: &str) -> (nalgebra::Matrix3<f64>, Vec3<f64>) {
    let mut data = Data::new(model);
    positions(model, &mut data, q);
    let pose = frame_pose(model, &data, q, model.frame(name).unwrap());
    (pose.rot_wf.to_nalgebra(), pose.pos_w)
}

#[test]
fn the_tool_starts_at_the_published_pose() {
    let model = load("humanoid_torso.urdf");
    assert_eq!((model.name(), model.joint_count(), model.warnings().len()), ("humanoid_torso", 7, 0));
    assert!((model.mass() - (93.0 + 2.741 + 2.425 + 2.209 + 0.877 + 1.878 + 0.409 + 0.308)).abs() < 1e-12);
    let mut q = neutral(&model);
    q[7..].copy_from_slice(&START);
    let (_, p) = frame(&model, &q, "tool");
    for (got, want) in [(p.x, -0.12678), (p.y, -0.22187), (p.z, 0.55367)] {
        assert!((got - want).abs() < 1e-5, "{p:?}"); // printed to five digits
    }
}

#[test]
fn equal_joint_values_are_mirror_images() {
    let model = load("humanoid_dual_arm.urdf");
    assert_eq!((model.joint_count(), model.warnings().len()), (14, 0));
    let mut q = neutral(&model);
    q[7..14].copy_from_slice(&START);
    q[14..].copy_from_slice(&START);
    let ((rot_r, p_r), (rot_l, p_l)) = (frame(&model, &q, "right_tool"), frame(&model, &q, "left_tool"));
    let mirror = nalgebra::Matrix3::from_diagonal(&nalgebra::Vector3::new(1.0, -1.0, 1.0));
    assert!((mirror * rot_r * mirror - rot_l).norm() < 1e-14);
    assert!((p_r.x - p_l.x).abs() + (p_r.y + p_l.y).abs() + (p_r.z - p_l.z).abs() < 1e-14);
    // also the masses: every inertia of one arm is mirrored in the other
    let (nv, mut data) = (model.nv(), Data::new(&model));
    let mut m = vec![0.0; nv * nv];
    mass_matrix(&model, &mut data, &q, &mut m);
    for j in 0..7 {
        for k in 0..7 {
            let (right, left) = (m[(6 + j) * nv + 6 + k], m[(13 + j) * nv + 13 + k]);
            assert!((right - left).abs() < 1e-14, "{j} {k}: {right} {left}");
        }
    }
    assert!(center_of_mass(&data, &q).y.abs() < 1e-15);
}

#[test]
fn one_arm_is_the_right_arm_of_two() {
    let (one, two) = (load("humanoid_torso.urdf"), load("humanoid_dual_arm.urdf"));
    for (a, b) in one.nodes().iter().zip(two.nodes()) {
        assert_eq!(
            (a.mass, a.com, a.about_com, a.pos_pk, a.rot_pk),
            (b.mass, b.com, b.about_com, b.pos_pk, b.rot_pk)
        );
    }
}

#[test]
fn the_torso_stands_0_843_m_tall() {
    use onorbit_core::model::Geometry;
    let model = load("humanoid_torso.urdf");
    let torso = model.frame("torso").unwrap();
    let (mut low, mut high) = (f64::MAX, f64::MIN);
    for (_, visual) in model.visuals().iter().filter(|(frame, _)| *frame == torso) {
        let half = match visual.geometry {
            Geometry::Box([_, _, height]) => height / 2.0,
            Geometry::Cylinder { length, .. } => length / 2.0,
            Geometry::Sphere { radius } => radius,
            _ => 0.0,
        };
        low = low.min(visual.pose.translation.z - half);
        high = high.max(visual.pose.translation.z + half);
    }
    assert!((high - low - 0.843).abs() < 1e-9, "{low} {high}");
}
