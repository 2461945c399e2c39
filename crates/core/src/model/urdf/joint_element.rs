//! Name, type and links of a `<joint>`. They are sufficient to check that the robot is a tree.

use super::element::Element;
use super::error::UrdfError;

/// `<joint>` element with its name, its type and the links that it connects.
pub(super) struct JointElement<'a> {
    pub(super) element: Element<'a>,
    pub(super) name: &'a str,
    pub(super) kind: &'a str,
    pub(super) parent: &'a str,
    pub(super) child: &'a str,
}

/// Reads the type of the joint `name` and the names of the links that it connects.
pub(super) fn read_joint_element<'a>(
    element: Element<'a>,
    name: &'a str,
) -> Result<JointElement<'a>, UrdfError> {
    let link = |end| element.required_child(end)?.required_text("link");
    let (parent, child) = (link("parent")?, link("child")?);
    Ok(JointElement { element, name, kind: element.required_text("type")?, parent, child })
}
