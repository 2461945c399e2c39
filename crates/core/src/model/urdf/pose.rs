//! `<origin>`: a pose.

use super::element::Element;
use super::error::{UrdfError, UrdfProblem};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};

/// Pose of what `element` describes: as urdf-rs read its origin (`xyz` in m, `rpy` in rad about the
/// fixed axes x, y, z in turn), or with the `quat_xyzw` of URDF 1.1, which urdf-rs does not keep.
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
    let [x, y, z, w] = origin.numbers("quat_xyzw", text, 4)?;
    let owner = origin.owner.to_owned();
    if origin.text("rpy").is_some() {
        return Err(origin.fail(UrdfProblem::TwoOrientations { owner }));
    }
    let unit = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), f64::MIN_POSITIVE);
    let zero = UrdfProblem::ZeroQuaternion { owner, text: text.to_owned() };
    unit.ok_or_else(|| origin.fail(zero)).map(Some)
}
