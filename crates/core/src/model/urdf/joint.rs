//! Reader of the element `<joint>`: kind, axis, limits, damping, friction, rotor inertia, spring and mimic
//! coupling of a joint.

use super::element::Element;
use super::error::UrdfError;
use super::joint_element::JointElement;
use super::multi_dof::{MultiDof, split};
use super::pose::pose;
use crate::model::{Joint, JointKind, JointSpring, Limits, Mimic, ModelWarning};
use crate::number_text::{short, unlike};
use nalgebra::Vector3;
use urdf_rs::{JointLimit, JointType, Mimic as MimicOf};

/// Reads the origin, axis, limits, damping, friction, rotor inertia, spring and mimic coupling of a joint, as
/// far as they apply to its type.
///
/// A joint with several degrees of freedom is replaced by a chain of joints with one degree of freedom each,
/// and a warning is added. `is_taken` returns true for names that already occur in the file.
pub(super) fn read_joints(
    joint: &JointElement<'_>,
    is_taken: impl Fn(&str) -> bool,
    warnings: &mut Vec<ModelWarning>,
) -> Result<Vec<Joint>, UrdfError> {
    let element = Element { unread: unread(joint.kind), ..joint.element };
    let read: urdf_rs::Joint = element.read()?;
    let (axis, origin) = (Vector3::from(*read.axis.xyz), pose(element, &read.origin)?);
    let replaced = |kind, warnings| Ok(split(joint, kind, origin, is_taken, warnings));
    let kind = match read.joint_type {
        JointType::Revolute | JointType::Continuous => JointKind::Revolute(axis),
        JointType::Prismatic => JointKind::Prismatic(axis),
        JointType::Fixed => {
            let spring = spring(element)?; // the model builder rejects it
            return Ok(vec![Joint { spring, ..Joint::new(joint.name, JointKind::Fixed, origin) }]);
        }
        JointType::Planar => return replaced(MultiDof::Planar(axis), warnings),
        JointType::Spherical => return replaced(MultiDof::Ball, warnings),
        JointType::Floating => return replaced(MultiDof::Floating, warnings),
    };
    let mut result = Joint::new(joint.name, kind, origin);
    if let Some(limit) = element.child("limit") {
        let is_bounded = read.joint_type != JointType::Continuous;
        result.limits = limits(joint.name, &read.limit, is_bounded.then_some(limit), warnings);
    }
    if let (Some(given), Some(dynamics)) = (read.dynamics, element.child("dynamics")) {
        (result.damping, result.friction) = (given.damping, given.friction);
        // extension of URDF, which has only one friction coefficient
        result.static_friction = dynamics.number("static_friction")?;
        // extension of URDF: the rotor inertia reflected to the joint, named `armature` (as in MuJoCo) or
        // `rotor_inertia`
        result.rotor_inertia = match dynamics.number("armature")? {
            Some(armature) => armature,
            None => dynamics.number("rotor_inertia")?.unwrap_or(0.0),
        };
    }
    result.spring = spring(element)?;
    result.mimic = read.mimic.map(|MimicOf { joint: leader, multiplier, offset }| Mimic {
        leader,
        ratio: multiplier.unwrap_or(1.0),
        offset: offset.unwrap_or(0.0),
    });
    Ok(vec![result])
}

/// Reads the element `<spring>` of a joint, an extension of URDF with the attributes `stiffness`,
/// `cubic_stiffness` and `rest_position`. At least one stiffness must be given; omitted values are zero.
fn spring(joint: Element<'_>) -> Result<Option<JointSpring>, UrdfError> {
    let Some(element) = joint.child("spring") else { return Ok(None) };
    let [stiffness, cubic] = [element.number("stiffness")?, element.number("cubic_stiffness")?];
    if stiffness.is_none() && cubic.is_none() {
        return Err(element.lacks_attribute("stiffness"));
    }
    let rest_position = element.number("rest_position")?.unwrap_or(0.0);
    Ok(JointSpring::new(stiffness.unwrap_or(0.0), cubic.unwrap_or(0.0), rest_position))
}

/// Returns the child elements and attributes that are ignored because they do not apply to a kind of joint.
fn unread(kind: &str) -> &'static [&'static str] {
    match kind {
        "continuous" => &["lower", "upper"],
        "planar" => &["limit", "dynamics"],
        "fixed" | "ball" | "spherical" | "floating" => &["axis", "limit", "dynamics"],
        _ => &[],
    }
}

/// Converts limits of urdf-rs, in which infinity means no limit. `bounds` is the `<limit>` element, or `None`
/// if the joint has no position limits. If one position limit is missing, its value is 0, as URDF specifies;
/// if both are missing, the position is unlimited. Position limits in reversed order and negative velocity
/// and effort limits are ignored, with a warning.
fn limits(
    name: &str,
    read: &JointLimit,
    bounds: Option<Element<'_>>,
    warnings: &mut Vec<ModelWarning>,
) -> Limits {
    let is_given = |end| bounds.is_some_and(|limit| limit.text(end).is_some());
    let position = (is_given("lower") || is_given("upper")).then(|| {
        // an infinite number means that there is no bound, whatever its sign
        let bound = |value: f64, none: f64| if value.is_finite() { value } else { none };
        (bound(read.lower, f64::NEG_INFINITY), bound(read.upper, f64::INFINITY))
    });
    let mut note = |text: String| warnings.push(ModelWarning::Note(format!("joint '{name}': {text}")));
    let position = position.filter(|&(low, high)| {
        if low > high {
            note(format!(
                "the lower limit {} is above the upper limit {} (rad or m), so both are ignored; exchange them",
                unlike(low, &[high]),
                short(high)
            ));
        }
        low <= high && (low > f64::NEG_INFINITY || high < f64::INFINITY)
    });
    let mut largest = |what: &str, value: f64, unit: &str| {
        // Gazebo writes -1 for "no limit"
        if value.is_finite() && value < 0.0 {
            note(format!(
                "its {what} limit is negative ({} {unit}) and is ignored; give a limit of at least 0, or omit it",
                short(value)
            ));
        }
        (value.is_finite() && value >= 0.0).then_some(value)
    };
    let velocity = largest("velocity", read.velocity, "rad/s or m/s");
    Limits { position, velocity, effort: largest("effort", read.effort, "N m or N") }
}
