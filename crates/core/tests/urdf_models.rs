//! Robot descriptions that nobody here wrote (`../shared/models`; skipped where they are absent).

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
    shared(name).map(|path| from_file(&path, &[]))
}

#[test]
fn show() {
    for name in [
        "drake_kuka_iiwa14_benchmark.urdf",
        "rbdl_tiago_dual.urdf",
        "rbdjl_atlas.urdf",
        "pinocchio_baxter_simple.urdf",
        "k_sample.urdf",
        "drake_bad.urdf",
        "drake_tag_mismatch_1.urdf",
        "drake_massless_robot.urdf",
        "ets_vii_onorbitros.xacro",
        "spaceros_SSRMS_Canadarm2.urdf.xacro",
    ] {
        match load(name) {
            None => {}
            Some(Ok(m)) => {
                println!(
                    "{name}: {} n={} mass={} frames={} visuals={} base={}",
                    m.name(),
                    m.joint_count(),
                    m.mass(),
                    m.frames().len(),
                    m.visuals().len(),
                    m.body_names().next().unwrap()
                );
                for w in m.warnings() {
                    println!("    {w}");
                }
            }
            Some(Err(e)) => println!("{name}: ERR {e}"),
        }
    }
}
