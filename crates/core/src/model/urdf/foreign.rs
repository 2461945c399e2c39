//! XML elements that are not part of URDF: extensions of other tools and xacro tags.

use super::element::prefix;
use super::error::{UrdfError, UrdfProblem, list};
use crate::model::ModelWarning;
use roxmltree::{Document, Error as XmlError, Node, ParsingOptions};

/// Largest number of XML nodes (elements, text nodes, comments and others) in a file. The file of a large
/// robot contains about 10⁴ nodes.
const MAX_NODES: u32 = 1_000_000;
/// Names of children of `<robot>` that are ignored without a warning.
const KNOWN: &[&str] = &[
    "gazebo",
    "transmission",
    "sensor",
    "ros2_control",
    "mujoco",
    "plugin",
    "actuator",
    "group",
    "group_state",
    "loop_joint",
    "self_collision_checking",
    "disable_collisions",
    "simulated_controllers",
    "drake",
];

/// Parses a text that [`check`](super::precheck::check) has accepted.
pub(super) fn parse(xml: &str) -> Result<Document<'_>, XmlError> {
    Document::parse_with_options(xml, ParsingOptions { nodes_limit: MAX_NODES, ..ParsingOptions::default() })
}

/// XML elements of a robot description that are ignored.
pub(super) struct Ignored<'a> {
    /// Outermost xacro tags, anywhere in the file.
    xacro: Vec<Node<'a, 'a>>,
    /// Children of `<robot>` with a foreign namespace prefix.
    prefixed: Vec<Node<'a, 'a>>,
    /// Children of `<robot>` with names that URDF does not define.
    unknown: Vec<Node<'a, 'a>>,
}

impl<'a> Ignored<'a> {
    pub(super) fn new(robot: Node<'a, 'a>) -> Self {
        let mut last_ends = 0;
        let is_outermost = |node: &Node<'_, '_>| {
            let is_found = is_xacro(*node) && node.range().start >= last_ends;
            last_ends = if is_found { node.range().end } else { last_ends };
            is_found
        };
        let own = prefix(robot);
        let elements = || robot.children().filter(Node::is_element).filter(|node| !is_xacro(*node));
        let is_known = |node: &Node<'_, '_>| {
            let name = node.tag_name().name();
            matches!(name, "link" | "joint" | "material") || KNOWN.contains(&name)
        };
        Self {
            xacro: robot.descendants().filter(is_outermost).collect(),
            prefixed: elements().filter(|node| prefix(*node) != own).collect(),
            unknown: elements().filter(|node| prefix(*node) == own && !is_known(node)).collect(),
        }
    }

    /// Returns one warning per kind of ignored element.
    pub(super) fn warnings(&self) -> Vec<ModelWarning> {
        let mut notes = Vec::new();
        if let Some(first) = self.xacro.first() {
            let (line, more) = (line(*first), others(self.xacro.len() - 1));
            notes.push(format!(
                "line {line}: {} is an xacro tag and is ignored{more}; expand the file with xacro if parts of \
                 the robot are missing",
                tag(*first)
            ));
        }
        for (nodes, what, fix) in [
            (&self.prefixed, "has a prefix that URDF does not define", "remove the prefix"),
            (&self.unknown, "is not an element of URDF", "correct its name"),
        ] {
            let Some(first) = nodes.first() else { continue };
            let mut names: Vec<String> = nodes.iter().skip(1).map(|node| tag(*node)).collect();
            names.sort();
            names.dedup();
            names.retain(|name| *name != tag(*first));
            let more = if names.is_empty() { String::new() } else { format!(" (also: {})", list(&names)) };
            notes.push(format!(
                "line {}: {} {what} and is ignored{more}; {fix} if it describes the robot",
                line(*first),
                tag(*first)
            ));
        }
        notes.into_iter().map(ModelWarning::Note).collect()
    }

    /// Returns true if the file defines xacro macros without expanding any of them.
    fn is_macros(&self) -> bool {
        let defines = |name| matches!(name, "macro" | "property" | "arg" | "include");
        let mut names = self.xacro.iter().map(|node| node.tag_name().name());
        names.clone().all(defines) && names.any(|name| name == "macro")
    }

    /// Returns a more specific error if `error` means that the robot is incomplete and the file contains
    /// xacro tags, or links or joints with a prefix. Otherwise returns `error`.
    pub(super) fn explain(&self, error: UrdfError) -> UrdfError {
        let is_incomplete = matches!(
            *error.problem,
            UrdfProblem::NoLinks | UrdfProblem::UnknownLink { .. } | UrdfProblem::ManyRoots { .. }
        );
        let is_needed = |node: &&Node<'_, '_>| matches!(node.tag_name().name(), "link" | "joint");
        match (self.xacro.first(), self.prefixed.iter().find(is_needed)) {
            (Some(node), _) if *error.problem == UrdfProblem::NoLinks && self.is_macros() => {
                UrdfError::at(*node, UrdfProblem::OnlyMacros)
            }
            (Some(node), _) if is_incomplete => {
                UrdfError::at(*node, UrdfProblem::Xacro { found: tag(*node) })
            }
            (None, Some(node)) if is_incomplete => {
                let element = tag(*node).trim_matches(['<', '>']).to_owned();
                UrdfError::at(*node, UrdfProblem::ForeignElement { element })
            }
            _ => error,
        }
    }
}

fn is_xacro(node: Node<'_, '_>) -> bool {
    prefix(node) == Some("xacro")
}

/// Returns the tag of an element with its namespace prefix, such as `<xacro:macro>`.
fn tag(node: Node<'_, '_>) -> String {
    let name = node.tag_name().name();
    match prefix(node) {
        Some(prefix) => format!("<{prefix}:{name}>"),
        None => format!("<{name}>"),
    }
}

fn line(node: Node<'_, '_>) -> u32 {
    node.document().text_pos_at(node.range().start).row
}

fn others(count: usize) -> String {
    match count {
        0 => String::new(),
        1 => ", as is one more such element".to_owned(),
        n => format!(", as are {n} more such elements"),
    }
}
