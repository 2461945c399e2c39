//! Robot descriptions that nobody here wrote (`../shared/models`; skipped where they are absent),
//! and the same files through `urdf-rs` own reading of text.

#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test
#![allow(clippy::print_stdout)] // says what was skipped

use onorbit_core::model::urdf::{UrdfError, UrdfProblem, from_file};
use onorbit_core::model::{Model, ModelError, ModelWarning};
use std::path::PathBuf;

fn shared(name: &str) -> Option<PathBuf> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models").join(name);
    if path.is_file() {
        return Some(path);
    }
    println!("skipped: {} is not here", path.display());
    None
}

fn load(name: &str) -> Option<Result<Model, UrdfError>> {
    shared(name).map(|path| from_file(&path, &[], &[]))
}

#[test]
fn real_robots_load() {
    // name, base, joints that move, frames, mass (kg: the sum by Python's ElementTree)
    let robots = [
        ("drake_kuka_iiwa14_benchmark.urdf", "iiwa_link_0", 7, 9, 30.61),
        ("rbdl_tiago_dual.urdf", "base_footprint", 33, 75, 96.277_054_882_24),
        ("rbdjl_atlas.urdf", "pelvis", 30, 70, 175.117_964),
        ("pinocchio_baxter_simple.urdf", "base", 19, 57, 137.332_610_44),
    ];
    for (name, base, joints, frames, mass) in robots {
        let Some(model) = load(name).map(Result::unwrap) else { continue };
        assert_eq!(model.body_names().next(), Some(base), "{name}");
        assert_eq!((model.joint_count(), model.frames().len()), (joints, frames), "{name}");
        assert!((model.mass() - mass).abs() < 1e-9 * mass, "{name}: {}", model.mass());
    }
}

#[test]
fn oddities_of_real_robots_are_told() {
    let warnings = |name| load(name).map(|m| m.unwrap().warnings().to_vec());
    if let Some(found) = warnings("rbdl_tiago_dual.urdf") {
        let breaks = |w: &ModelWarning| matches!(w, ModelWarning::TriangleInequality { link, .. } if link == "arm_left_1_link");
        let indefinite = |w: &ModelWarning| matches!(w, ModelWarning::IndefinitePart { link, .. } if link == "base_antenna_left_link");
        assert!(found.iter().any(breaks) && found.iter().any(indefinite), "{found:?}");
    }
    if let Some(found) = warnings("pinocchio_baxter_simple.urdf") {
        let texts: Vec<String> = found.iter().map(ToString::to_string).collect();
        assert!(texts.iter().any(|t| t.contains("'r_gripper_r_finger_joint' mimics")), "{texts:?}");
        assert!(texts.iter().any(|t| t.contains("package 'baxter_description'")), "{texts:?}");
    }
}

#[test]
fn files_that_are_no_robot_say_why_in_one_line() {
    let problem = |name| {
        load(name).map(|result| {
            let error = result.unwrap_err();
            let text = error.to_string();
            assert!(text.contains(name) && !text.contains('\n'), "{text}");
            *error.problem
        })
    };
    if let Some(found) = problem("drake_bad.urdf") {
        assert!(matches!(found, UrdfProblem::NotXml { .. }), "{found:?}");
    }
    if let Some(found) = problem("drake_tag_mismatch_1.urdf") {
        assert_eq!(found, UrdfProblem::ForeignElement { element: "drake:joint".to_owned() });
    }
    if let Some(found) = problem("drake_massless_robot.urdf") {
        assert_eq!(found, UrdfProblem::Model(ModelError::NoMass));
    }
    for name in ["ets_vii_onorbitros.xacro", "spaceros_SSRMS_Canadarm2.urdf.xacro"] {
        if let Some(found) = problem(name) {
            assert!(matches!(found, UrdfProblem::Xacro { .. }), "{found:?}");
        }
    }
    // its arms hang on a link `root` that the file never describes
    if let Some(found) = problem("k_sample.urdf") {
        assert!(matches!(&found, UrdfProblem::UnknownLink { link, .. } if link == "root"), "{found:?}");
        assert!(found.to_string().ends_with("did you mean 'root_body'?"), "{found}");
    }
}

/// Its types are ours, its XML is not: namespaces, repeated elements and numbers pass through other hands.
/// The independent reader is Pinocchio (`tests/oracles/test_pinocchio_urdf.py`).
#[test]
fn urdf_rs_own_xml_gives_the_same_joints() {
    for name in ["drake_kuka_iiwa14_benchmark.urdf", "rbdjl_atlas.urdf", "pinocchio_baxter_simple.urdf"] {
        let Some(path) = shared(name) else { continue };
        // it refuses elements that are given twice, sensors and plugins; where it reads, we agree
        let Ok(theirs) = urdf_rs::read_file(&path) else {
            println!("skipped: urdf-rs does not read {name}");
            continue;
        };
        let ours = from_file(&path, &[], &[]).unwrap();
        let mass: f64 = theirs.links.iter().map(|link| link.inertial.mass.value).sum();
        assert!((ours.mass() - mass).abs() < 1e-9, "{name}");
        for joint in ours.joints() {
            let other = theirs.joints.iter().find(|j| j.name == joint.name).unwrap();
            let [x, y, z] = *other.axis.xyz;
            let norm = (x * x + y * y + z * z).sqrt();
            for (a, b) in [(joint.axis.x, x), (joint.axis.y, y), (joint.axis.z, z)] {
                assert!((a - b / norm).abs() < 1e-15, "{name}: {}", joint.name);
            }
            assert_eq!(joint.damping, other.dynamics.as_ref().map_or(0.0, |d| d.damping), "{}", joint.name);
            assert_eq!(joint.friction, other.dynamics.as_ref().map_or(0.0, |d| d.friction), "{}", joint.name);
            if let Some((lower, upper)) = joint.limits.position {
                assert_eq!((lower, upper), (other.limit.lower, other.limit.upper), "{}", joint.name);
            }
        }
    }
}

/// Why urdf-rs is given a tree that is checked: each of these its own reading takes without a word, or refuses.
#[test]
fn what_urdf_rs_makes_of_careless_files() {
    const MASS: &str =
        "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>";
    let robot = |joint: &str| {
        format!(
            "<robot name='r' xmlns:drake='d'><link name='a'>{MASS}</link><link name='b'>{MASS}</link>{joint}</robot>"
        )
    };
    let ends = "<parent link='a'/><child link='b'/>";
    let ours = |xml: &str| onorbit_core::model::urdf::from_str(xml, None, &[], &[]);

    let comma = robot(&format!("<joint name='j' type='fixed'>{ends}<origin xyz='1,0 0 0 0'/></joint>"));
    assert_eq!(*urdf_rs::read_from_string(&comma).unwrap().joints[0].origin.xyz, [0.0; 3]);
    assert!(ours(&comma).is_err());

    let foreign = robot(&format!("<drake:joint name='j' type='fixed'>{ends}</drake:joint>"));
    assert_eq!(urdf_rs::read_from_string(&foreign).unwrap().joints.len(), 1);
    assert!(ours(&foreign).is_err());

    let no_velocity = robot(&format!("<joint name='j' type='revolute'>{ends}<limit effort='1'/></joint>"));
    assert!(urdf_rs::read_from_string(&no_velocity).is_err());
    assert!(ours(&no_velocity).is_ok());

    assert_eq!(
        urdf_rs::read_from_string("<robot name='r'><link name='a'/></robot>").unwrap().links[0]
            .inertial
            .mass
            .value,
        0.0
    );
}
