//! Reader of `<origin>`, the pose of an element.

use super::element::Element;
use super::error::{UrdfError, UrdfProblem};
use crate::model::ModelWarning;
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use roxmltree::Node;

/// Returns the pose given by the `<origin>` of `element`. `read` holds `xyz`, m, and `rpy`, rad, about the fixed axes
/// x, y, z in turn. URDF versions after 1.0 may give `quat_xyzw` instead of `rpy`; urdf-rs does not store it, so it is
/// read from `element`.
pub(super) fn pose(element: Element<'_>, read: &urdf_rs::Pose) -> Result<Isometry3<f64>, UrdfError> {
    let [roll, pitch, yaw] = *read.rpy;
    let rotation = match element.child("origin").map(quaternion).transpose()?.flatten() {
        Some(quaternion) => quaternion,
        None => UnitQuaternion::from_euler_angles(roll, pitch, yaw),
    };
    Ok(Isometry3::from_parts(Translation3::from(Vector3::from(*read.xyz)), rotation))
}

fn quaternion(origin: Element<'_>) -> Result<Option<UnitQuaternion<f64>>, UrdfError> {
    let Some(text) = origin.text("quat_xyzw") else { return Ok(None) };
    if !knows_quaternions(origin.node.document().root_element()) {
        return Ok(None);
    }
    let [x, y, z, w] = origin.numbers("quat_xyzw", text, 4)?;
    let owner = origin.owner.to_owned();
    if origin.text("rpy").is_some() {
        return Err(origin.fail(UrdfProblem::TwoOrientations { owner }));
    }
    let unit = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), f64::MIN_POSITIVE);
    let zero = UrdfProblem::ZeroQuaternion { owner, text: text.to_owned() };
    unit.ok_or_else(|| origin.fail(zero)).map(Some)
}

/// Returns true if the URDF version of the file supports quaternions, which all versions after 1.0 (the default) do.
fn knows_quaternions(robot: Node<'_, '_>) -> bool {
    robot.attribute("version").is_some_and(|version| !matches!(version.trim(), "1.0" | "1"))
}

/// Returns a warning if the file contains quaternions that are ignored because of its version.
pub(super) fn quaternion_warning(robot: Node<'_, '_>) -> Option<ModelWarning> {
    if knows_quaternions(robot) || !robot.document().input_text().contains("quat_xyzw") {
        return None;
    }
    let is_origin = |node: &Node<'_, '_>| node.has_tag_name("origin") && node.has_attribute("quat_xyzw");
    let origin = robot.descendants().find(is_origin)?;
    let line = origin.document().text_pos_at(origin.range().start).row;
    let note =
        format!("line {line}: quat_xyzw is ignored in version 1.0; write <robot version=\"1.1\"> or use rpy");
    Some(ModelWarning::Note(note))
}
