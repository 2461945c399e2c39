//! Joints of several degrees of freedom, as joints of one that follow each other.

use super::joint::Hinge;
use crate::model::{Joint, JointKind, ModelWarning, rotation_to_axis};
use nalgebra::{Isometry3, Vector3};

/// What the file asks for.
pub(super) enum Several {
    /// Slides in the plane with this normal and turns about it.
    Planar(Vector3<f64>),
    /// Turns about any axis.
    Ball,
}

/// The joints in turn from the parent outward; their names are the joint's with an ending.
///
/// A plane: along its two axes, then about its normal. A ball: about z, y, x, which are the yaw,
/// pitch and roll of the child in the parent, as in URDF's own `rpy`.
pub(super) fn in_turn(
    hinge: &Hinge<'_>,
    several: Several,
    mut origin: Isometry3<f64>,
    warnings: &mut Vec<ModelWarning>,
) -> Vec<Joint> {
    let name = hinge.name;
    let (parts, remark) = match several {
        // an axis of length zero is refused where the joint is built
        Several::Planar(normal) if normal.norm() == 0.0 => (vec![("", JointKind::Revolute(normal))], ""),
        Several::Planar(normal) => {
            let axes = rotation_to_axis(&normal);
            let along = |k: usize| JointKind::Prismatic(axes.column(k).into_owned());
            let parts = vec![("_x", along(0)), ("_y", along(1)), ("_yaw", JointKind::Revolute(normal))];
            (parts, "is planar: two that slide and one that turns stand for it")
        }
        Several::Ball => {
            let about = |axis: Vector3<f64>| JointKind::Revolute(axis);
            let parts = vec![
                ("_yaw", about(Vector3::z())),
                ("_pitch", about(Vector3::y())),
                ("_roll", about(Vector3::x())),
            ];
            (parts, "is a ball joint: three that turn stand for it, singular where the pitch is ±90°")
        }
    };
    let dropped = ["limit", "dynamics", "mimic"].into_iter().filter(|tag| hinge.element.child(tag).is_some());
    let dropped: Vec<String> = dropped.map(|tag| format!("<{tag}>")).collect();
    let lost =
        if dropped.is_empty() { String::new() } else { format!("; its {} is not read", dropped.join(", ")) };
    let names: Vec<String> = parts.iter().map(|(ending, _)| format!("'{name}{ending}'")).collect();
    if names.len() > 1 {
        let note = format!("joint '{name}' {remark}, {}{lost}", names.join(", "));
        warnings.push(ModelWarning::Note(note));
    }
    let joint = |(ending, kind): (&str, JointKind)| {
        let placed = std::mem::replace(&mut origin, Isometry3::identity());
        Joint::new(&format!("{name}{ending}"), kind, placed)
    };
    parts.into_iter().map(joint).collect()
}
