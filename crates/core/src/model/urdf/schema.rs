//! Schema of the URDF elements that are read: their child elements, their attributes and the kinds of values
//! of these attributes.

use super::element::Element;
use super::error::{UrdfError, UrdfProblem};

/// Kind of value of an attribute.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    /// A name that the file defines, which may be any text.
    Name,
    /// Text that is interpreted, such as a path or a type; xacro expressions are rejected.
    Text,
    /// A given number of finite numbers.
    Numbers(usize),
    /// A given number of positive, finite numbers, such as edge lengths or a radius.
    Sizes(usize),
    /// A finite number, or `inf` or `-inf` for no limit.
    Limit,
}
use Kind::{Limit, Name, Numbers, Sizes, Text};

/// Attribute: name, kind, and the text that is used if the file omits the attribute. If there is no such
/// text, the default of urdf-rs applies; if urdf-rs has no default, the attribute is required.
pub(super) type Attribute = (&'static str, Kind, Option<&'static str>);

/// Returns the attributes of the elements with the name `tag` that are read into types of urdf-rs.
/// Extensions, such as `quat_xyzw`, are not among them.
pub(super) fn attributes(tag: &str) -> &'static [Attribute] {
    match tag {
        "joint" => &[("name", Name, None), ("type", Text, None)],
        "parent" | "child" => &[("link", Name, None)],
        "origin" => &[("xyz", Numbers(3), None), ("rpy", Numbers(3), None)],
        "axis" => &[("xyz", Numbers(3), Some("1 0 0"))],
        "limit" => &[
            ("lower", Limit, None),
            ("upper", Limit, None),
            ("velocity", Limit, Some("inf")),
            ("effort", Limit, Some("inf")),
        ],
        "dynamics" => &[("damping", Numbers(1), None), ("friction", Numbers(1), None)],
        "mimic" => &[("joint", Name, None), ("multiplier", Numbers(1), None), ("offset", Numbers(1), None)],
        "mass" => &[("value", Numbers(1), None)],
        "inertia" => &[
            ("ixx", Numbers(1), None),
            ("iyy", Numbers(1), None),
            ("izz", Numbers(1), None),
            ("ixy", Numbers(1), Some("0")),
            ("ixz", Numbers(1), Some("0")),
            ("iyz", Numbers(1), Some("0")),
        ],
        "box" => &[("size", Sizes(3), None)],
        "sphere" => &[("radius", Sizes(1), None)],
        "cylinder" | "capsule" => &[("radius", Sizes(1), None), ("length", Sizes(1), None)],
        "mesh" => &[("filename", Text, None), ("scale", Numbers(3), None)],
        "material" => &[("name", Text, Some(""))],
        "color" => &[("rgba", Numbers(4), None)],
        _ => &[],
    }
}

/// Returns the names of the child elements that are read in elements with the name `tag`. Only the first
/// child of each name is used.
pub(super) fn elements(tag: &str) -> &'static [&'static str] {
    match tag {
        "joint" => &["parent", "child", "origin", "axis", "limit", "dynamics", "mimic"],
        "inertial" => &["origin", "mass", "inertia"],
        // in some files, collisions have a material
        "visual" | "collision" => &["origin", "geometry", "material"],
        "material" => &["color"],
        _ => &[],
    }
}

/// Checks that the text of an attribute has the kind that the schema specifies. Without this check, urdf-rs
/// would read `1,0 0 0 0` as three zeros.
pub(super) fn check(element: &Element<'_>, attribute: Attribute, text: &str) -> Result<(), UrdfError> {
    let (name, kind, _) = attribute;
    let (count, is_size) = match kind {
        Name => return Ok(()),
        Text => return element.refuse_xacro(text),
        Limit if is_infinite(text) => return Ok(()),
        Limit => (1, false),
        Numbers(count) => (count, false),
        Sizes(count) => (count, true),
    };
    let values = element.numbers(name, text, count)?;
    match values[..count].iter().find(|&&value| is_size && value <= 0.0) {
        None => Ok(()),
        Some(&value) => {
            let (owner, tag) = (element.owner.to_owned(), element.tag().to_owned());
            Err(element.fail(UrdfProblem::NotPositive { owner, element: tag, attribute: name, value }))
        }
    }
}

/// Returns true for spellings of infinity such as `inf`, but false for digits that overflow to infinity.
fn is_infinite(text: &str) -> bool {
    text.trim().parse().is_ok_and(f64::is_infinite) && !text.contains(|c: char| c.is_ascii_digit())
}
