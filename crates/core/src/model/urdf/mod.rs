//! Robots from URDF files.
//!
//! One reader on an XML tree, not `urdf-rs`: that crate skips what is not a number inside a vector
//! (`1,0 0 0 0` reads as zeros), takes a missing inertial for zero mass and `<drake:joint>` for a
//! joint, refuses files that repeat an element or lack `velocity`, and its errors name neither
//! link nor line. It serves as an oracle in the tests instead.
//!
//! Collision shapes, transmissions, sensors and the elements of other tools are left alone.

mod assemble;
mod element;
mod error;
mod first_look;
mod joint;
mod link;
mod material;
mod mesh;
mod several;

pub use error::{UrdfError, UrdfProblem};

use super::Model;
use assemble::assemble;
use element::Element;
use joint::read_hinge;
use link::Surroundings;
use material::Materials;
use mesh::Meshes;
use roxmltree::{Document, Error as XmlError, Node, ParsingOptions};
use std::path::{Path, PathBuf};

/// Tags, texts and comments of a file; a large robot has 10⁴.
const MAX_NODES: u32 = 1_000_000;

/// Loads a robot; its root link floats.
///
/// `packages`: folders that hold ROS packages or are one, searched for `package://` meshes before
/// the parents of the file. A mesh that is not found keeps its name and leaves a warning.
///
/// # Errors
/// [`UrdfError`] with the file, the line and the link or joint.
pub fn from_file(path: &Path, packages: &[PathBuf]) -> Result<Model, UrdfError> {
    let folder = std::path::absolute(path).ok().and_then(|path| path.parent().map(Path::to_owned));
    first_look::read(path)
        .and_then(|xml| from_str(&xml, folder.as_deref(), packages))
        .map_err(|error| error.in_file(path))
}

/// Loads a robot from the text of a URDF that lies, or would lie, in `folder`.
///
/// # Errors
/// [`UrdfError`] with the line and the link or joint.
pub fn from_str(xml: &str, folder: Option<&Path>, packages: &[PathBuf]) -> Result<Model, UrdfError> {
    first_look::check(xml)?;
    let options = ParsingOptions { nodes_limit: MAX_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(xml, options).map_err(not_xml)?;
    let robot = document.root_element();
    check_vocabulary(robot)?;
    // every error says whose fault it is: the names come first, and outlive the elements
    let names = |tag| owners(robot, tag);
    let (link_owners, joint_owners) = (names("link"), names("joint"));
    let robot = Element { node: robot, owner: "the robot" };
    let links = robot
        .children("link")
        .zip(&link_owners)
        .map(|(link, owner)| Ok((link.required_text("name")?, Element { owner, ..link })))
        .collect::<Result<Vec<_>, UrdfError>>()?;
    let hinges = robot
        .children("joint")
        .zip(&joint_owners)
        .map(|(joint, owner)| read_hinge(Element { owner, ..joint }, joint.required_text("name")?))
        .collect::<Result<Vec<_>, UrdfError>>()?;
    if links.is_empty() {
        return Err(robot.fail(UrdfProblem::NoLinks));
    }
    let mut around = Surroundings {
        materials: Materials::new(robot),
        meshes: Meshes::new(folder, packages),
        warnings: Vec::new(),
    };
    assemble(robot.text("name").unwrap_or("robot"), &links, &hinges, &mut around)
}

/// `link 'hand'` for every link, in order.
fn owners(robot: Node<'_, '_>, tag: &'static str) -> Vec<String> {
    Element { node: robot, owner: "" }
        .children(tag)
        .map(|element| format!("{tag} '{}'", element.text("name").unwrap_or_default()))
        .collect()
}

/// A robot, nothing left of xacro, and no link or joint that we would pass over.
fn check_vocabulary(robot: Node<'_, '_>) -> Result<(), UrdfError> {
    let is_xacro = |node: &Node<'_, '_>| node.tag_name().namespace().is_some_and(|uri| uri.contains("xacro"));
    if let Some(node) = robot.descendants().find(is_xacro) {
        let found = format!("<xacro:{}>", node.tag_name().name());
        return Err(UrdfError::at(node, UrdfProblem::Xacro { found }));
    }
    let root = robot.tag_name();
    if root.name() != "robot" {
        return Err(UrdfError::at(robot, UrdfProblem::NotRobot { found: root.name().to_owned() }));
    }
    let is_foreign = |node: &Node<'_, '_>| {
        matches!(node.tag_name().name(), "link" | "joint") && node.tag_name().namespace() != root.namespace()
    };
    if let Some(node) = robot.children().find(is_foreign) {
        let prefix = node.tag_name().namespace().and_then(|uri| node.lookup_prefix(uri)).unwrap_or("?");
        let element = format!("{prefix}:{}", node.tag_name().name());
        return Err(UrdfError::at(node, UrdfProblem::ForeignElement { element }));
    }
    Ok(())
}

fn not_xml(error: XmlError) -> UrdfError {
    let problem = match &error {
        XmlError::UnknownNamespace(prefix, _) if prefix == "xacro" => {
            UrdfProblem::Xacro { found: "<xacro:…>".to_owned() }
        }
        XmlError::DtdDetected => UrdfProblem::DocumentType,
        other => {
            // the parser ends its message with the place, which we put in front
            let (reason, place) = (other.to_string(), format!(" at {}", other.pos()));
            UrdfProblem::NotXml { reason: reason.strip_suffix(&place).unwrap_or(&reason).to_owned() }
        }
    };
    UrdfError::new(Some(error.pos().row), problem)
}
