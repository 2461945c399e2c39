//! What is read of a URDF: elements, what stands inside them, what their attributes hold.

use super::element::Element;
use super::error::{UrdfError, UrdfProblem};

/// What an attribute holds.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    /// A name of the file's own choice.
    Name,
    /// A path, a name that means something.
    Text,
    /// As many finite numbers.
    Numbers(usize),
    /// As many finite numbers above zero: edges, a radius.
    Sizes(usize),
    /// A finite number, or `inf` where there is no limit.
    Limit,
}
use Kind::{Limit, Name, Numbers, Sizes, Text};

/// An attribute, what it holds, and what stands for it where the file does not give it. One without
/// such a text has urdf-rs' default, or must be given.
pub(super) type Attribute = (&'static str, Kind, Option<&'static str>);

/// The attributes that are read of an element.
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

/// The elements that are read inside an element, the first of each name.
pub(super) fn elements(tag: &str) -> &'static [&'static str] {
    match tag {
        "joint" => &["parent", "child", "origin", "axis", "limit", "dynamics"],
        "inertial" => &["origin", "mass", "inertia"],
        // real files colour collisions too
        "visual" | "collision" => &["origin", "geometry", "material"],
        "material" => &["color"],
        _ => &[],
    }
}

/// Refuses a text that is not what its attribute holds. urdf-rs would read `1,0 0 0 0` as three zeros.
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

/// Whether a text says that there is no limit; a number too large to be one does not.
fn is_infinite(text: &str) -> bool {
    text.trim().parse().is_ok_and(f64::is_infinite) && !text.contains(|c: char| c.is_ascii_digit())
}
