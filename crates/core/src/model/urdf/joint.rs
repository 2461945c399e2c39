//! `<joint>`: how a link hangs on another.

use super::element::Element;
use super::error::{UrdfError, UrdfProblem};
use super::several::{Several, in_turn};
use crate::model::{Joint, JointKind, Limits, ModelWarning};
use nalgebra::Vector3;

/// A joint and the links it joins.
pub(super) struct Hinge<'a> {
    pub(super) element: Element<'a>,
    pub(super) name: &'a str,
    pub(super) kind: &'a str,
    pub(super) parent: &'a str,
    pub(super) child: &'a str,
}

/// Names alone: enough to see whether the robot is a tree.
pub(super) fn read_hinge<'a>(element: Element<'a>, name: &'a str) -> Result<Hinge<'a>, UrdfError> {
    let link = |end| element.required_child(end)?.required_text("link");
    let (parent, child) = (link("parent")?, link("child")?);
    Ok(Hinge { element, name, kind: element.required_text("type")?, parent, child })
}

/// The rest of the joint: one, or those of one degree of freedom that make it, in turn.
pub(super) fn read_joints(
    hinge: &Hinge<'_>,
    warnings: &mut Vec<ModelWarning>,
) -> Result<Vec<Joint>, UrdfError> {
    let element = hinge.element;
    // URDF: the axis is x where none is given
    let axis = || {
        let xyz = element.child("axis").map_or(Ok(None), |axis| axis.numbers::<3>("xyz"))?;
        Ok::<_, UrdfError>(xyz.map_or(Vector3::x(), Vector3::from))
    };
    let kind = match hinge.kind {
        "revolute" | "continuous" => JointKind::Revolute(axis()?),
        "prismatic" => JointKind::Prismatic(axis()?),
        "fixed" => JointKind::Fixed,
        "planar" => return in_turn(hinge, Several::Planar(axis()?), warnings),
        "ball" | "spherical" => return in_turn(hinge, Several::Ball, warnings),
        other => {
            let (joint, kind) = (hinge.name.to_owned(), other.to_owned());
            return Err(element.fail(UrdfProblem::JointType { joint, kind }));
        }
    };
    let mut joint = Joint::new(hinge.name, kind, element.origin()?);
    if joint.kind == JointKind::Fixed {
        return Ok(vec![joint]);
    }
    joint.limits = read_limits(element, hinge.kind == "continuous")?;
    // Gazebo writes -1 where a bound does not hold
    let Limits { velocity, effort, .. } = &mut joint.limits;
    for (what, limit) in [("velocity", velocity), ("effort", effort)] {
        if limit.is_some_and(|value| value < 0.0) {
            let note =
                format!("joint '{}': its {what} limit is below zero, which is read as none", hinge.name);
            warnings.push(ModelWarning::Note(note));
            *limit = None;
        }
    }
    if let Some(dynamics) = element.child("dynamics") {
        let amount = |name| Ok::<_, UrdfError>(dynamics.number(name)?.unwrap_or(0.0));
        joint.damping = amount("damping")?;
        joint.friction = amount("friction")?;
        // no standard either: URDF has one friction
        joint.static_friction = dynamics.number("static_friction")?;
        // no standard: MuJoCo's name for the rotor inertia seen at the joint, and the plain one
        joint.rotor_inertia = match dynamics.number("armature")? {
            Some(armature) => armature,
            None => amount("rotor_inertia")?,
        };
    }
    if let Some(mimic) = element.child("mimic") {
        warnings.push(ModelWarning::Note(mimic_note(hinge.name, mimic)));
    }
    Ok(vec![joint])
}

/// What the file wanted, and what it gets.
fn mimic_note(name: &str, mimic: Element<'_>) -> String {
    let leader = mimic.text("joint").unwrap_or("?");
    let factor = mimic.text("multiplier").unwrap_or("1");
    let offset = mimic.text("offset").unwrap_or("0");
    format!(
        "joint '{name}' mimics joint '{leader}' ({name} = {factor} {leader} + {offset}): nothing couples them here, \
         it is loaded as a joint of its own; start both where they fit and drive both, or make it fixed"
    )
}

/// `<limit>`. One of the two position bounds alone leaves the other at 0, URDF's default; where
/// neither is given there is none, as there is none for a continuous joint.
fn read_limits(element: Element<'_>, is_continuous: bool) -> Result<Limits, UrdfError> {
    let Some(limit) = element.child("limit") else { return Ok(Limits::default()) };
    let position = match (limit.text("lower"), limit.text("upper")) {
        _ if is_continuous => None,
        (None, None) => None,
        (lower, upper) => {
            let (low, high) = (limit.limit("lower")?, limit.limit("upper")?);
            let low = low.unwrap_or(if lower.is_some() { f64::NEG_INFINITY } else { 0.0 });
            let high = high.unwrap_or(if upper.is_some() { f64::INFINITY } else { 0.0 });
            (low > f64::NEG_INFINITY || high < f64::INFINITY).then_some((low, high))
        }
    };
    Ok(Limits { position, velocity: limit.limit("velocity")?, effort: limit.limit("effort")? })
}
