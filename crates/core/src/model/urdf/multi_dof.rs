//! Replacement of joints with several degrees of freedom by chains of joints with one degree of freedom.

use super::joint_element::JointElement;
use crate::model::{Joint, JointKind, ModelWarning, rotation_to_axis};
use nalgebra::{Isometry3, Vector3};

/// Joint with several degrees of freedom.
pub(super) enum MultiDof {
    /// Translation in the plane with this normal and rotation about the normal.
    Planar(Vector3<f64>),
    /// Rotation about any axis.
    Ball,
    /// Translation and rotation in all directions.
    Floating,
}

/// Returns the chain of joints, in order from the parent, that replaces a joint. Their names consist of the
/// name of the joint, a suffix and, if the file already contains this name, a number.
///
/// A planar joint becomes two prismatic joints along the axes of the plane and a revolute joint about its
/// normal. A ball joint becomes revolute joints about z, y and x, whose positions are the yaw, pitch and roll
/// of the child relative to the parent, as in URDF's `rpy`. A floating joint becomes prismatic joints along
/// x, y and z, followed by the joints of a ball joint.
pub(super) fn split(
    joint: &JointElement<'_>,
    kind: MultiDof,
    mut origin: Isometry3<f64>,
    is_taken: impl Fn(&str) -> bool,
    warnings: &mut Vec<ModelWarning>,
) -> Vec<Joint> {
    let name = joint.name;
    let about = |axis: Vector3<f64>| JointKind::Revolute(axis);
    let revolute =
        [("_yaw", about(Vector3::z())), ("_pitch", about(Vector3::y())), ("_roll", about(Vector3::x()))];
    let (parts, remark) = match kind {
        // the model builder rejects an axis of length zero
        MultiDof::Planar(normal) if normal.norm() == 0.0 => (vec![("", about(normal))], ""),
        MultiDof::Planar(normal) => {
            let axes = rotation_to_axis(&normal);
            let along = |k: usize| JointKind::Prismatic(axes.column(k).into_owned());
            let parts = vec![("_x", along(0)), ("_y", along(1)), ("_yaw", about(normal))];
            (parts, "is planar and is replaced by two prismatic joints and a revolute one")
        }
        MultiDof::Ball => {
            let remark = "is a ball joint and is replaced by three revolute joints (singular at a pitch of \
            ±90°)";
            (revolute.to_vec(), remark)
        }
        MultiDof::Floating => {
            let along = |axis: Vector3<f64>| JointKind::Prismatic(axis);
            let prismatic =
                [("_x", along(Vector3::x())), ("_y", along(Vector3::y())), ("_z", along(Vector3::z()))];
            let remark = "is floating and is replaced by three prismatic and three revolute joints \
            (singular at a pitch of ±90°)";
            ([prismatic, revolute].concat(), remark)
        }
    };
    let dropped =
        ["limit", "dynamics", "spring", "mimic"].into_iter().filter(|tag| joint.element.child(tag).is_some());
    let dropped: Vec<String> = dropped.map(|tag| format!("<{tag}>")).collect();
    let suffix = match dropped.as_slice() {
        [] => String::new(),
        [tag] => format!("; its {tag} is ignored"),
        tags => format!("; its {} are ignored", tags.join(" and ")),
    };
    let mut placed = || std::mem::replace(&mut origin, Isometry3::identity());
    let joint = |(ending, kind)| Joint::new(&free(format!("{name}{ending}"), &is_taken), kind, placed());
    let joints: Vec<Joint> = parts.into_iter().map(joint).collect();
    if joints.len() > 1 {
        let names: Vec<String> = joints.iter().map(|joint| format!("'{}'", joint.name)).collect();
        let note = format!("joint '{name}' {remark}: {}{suffix}", names.join(", "));
        warnings.push(ModelWarning::Note(note));
    }
    joints
}

/// Returns the name, or the first of `NAME_2`, `NAME_3`, … that is not in use.
fn free(name: String, is_taken: impl Fn(&str) -> bool) -> String {
    if !is_taken(&name) {
        return name;
    }
    let mut numbered = (2..).map(|number: u32| format!("{name}_{number}"));
    numbered.find(|name| !is_taken(name)).expect("a file has fewer names than there are numbers")
}
