//! Reader of `<origin>`, the pose of an element.

use super::element::Element;
use super::error::{UrdfError, UrdfProblem};
use crate::model::ModelWarning;
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use roxmltree::Node;

/// Returns the pose given by the `<origin>` of `element`. `read` holds `xyz`, m, and `rpy`, the angles in rad
/// about the fixed axes x, y and z, applied in this order. URDF versions after 1.0 allow `quat_xyzw` instead
/// of `rpy`; because urdf-rs does not store the quaternion, it is read from `element`.
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

/// Returns true if the URDF version of the file, which is 1.0 by default, is later than 1.0 and thus allows
/// quaternions.
fn knows_quaternions(robot: Node<'_, '_>) -> bool {
    robot.attribute("version").is_some_and(|version| !matches!(version.trim(), "1.0" | "1"))
}

/// Returns a warning if the file contains quaternions that are ignored because its version does not allow
/// them.
pub(super) fn quaternion_warning(robot: Node<'_, '_>) -> Option<ModelWarning> {
    if knows_quaternions(robot) || !robot.document().input_text().contains("quat_xyzw") {
        return None;
    }
    let is_origin = |node: &Node<'_, '_>| node.has_tag_name("origin") && node.has_attribute("quat_xyzw");
    let origin = robot.descendants().find(is_origin)?;
    let line = origin.document().text_pos_at(origin.range().start).row;
    let note = format!(
        "line {line}: quat_xyzw is ignored in URDF version 1.0; write <robot version=\"1.1\"> or use rpy"
    );
    Some(ModelWarning::Note(note))
}
