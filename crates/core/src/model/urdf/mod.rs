//! Robots from URDF files.
//!
//! roxmltree parses the text and knows its lines; text that it rejects but tinyxml2 accepts is rewritten first
//! (`tidy`). The types of urdf-rs are filled from that tree by serde (`from_tree`): the first of each element, with
//! attributes checked by one table (`schema`). `docs/design.md` says why urdf-rs does not read the text itself.
//!
//! Transmissions, sensors and the elements of other tools are ignored. Elements with a prefix, unknown elements and
//! leftover xacro tags are ignored with a warning. A prefix needs no declaration.

mod assemble;
mod element;
mod error;
mod first_look;
mod foreign;
mod from_tree;
mod joint;
mod link;
mod material;
mod mesh;
mod mesh_name;
mod mesh_near;
mod pose;
mod refusal;
mod rewrite;
mod schema;
mod several;
mod tidy;
mod tokens;

pub use error::{UrdfError, UrdfProblem};

use super::{LinkChange, Model, ModelWarning};
use assemble::{NamedLink, assemble};
use element::{Element, has_expression};
use foreign::{Ignored, parse};
use joint::{Hinge, read_hinge};
use link::Surroundings;
use material::Materials;
use mesh::Meshes;
use pose::quaternion_warning;
use roxmltree::{Error as XmlError, Node};
use std::path::{Path, PathBuf};
use tidy::tidy;

/// How a URDF is read.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options<'a> {
    /// Folders that hold ROS packages or are one, searched for `package://` meshes before the parents of the file.
    pub packages: &'a [PathBuf],
    /// Values that replace those of the file before the robot is checked.
    pub changes: &'a [LinkChange],
    /// Whether the robot is only to be attached to another: then it need not be able to float by itself.
    pub is_part: bool,
}

/// Loads a robot; its root link floats. A mesh that is not found keeps its name and leaves a warning.
///
/// # Errors
/// [`UrdfError`] with the file, the line and the link or joint.
pub fn from_file(path: &Path, options: &Options<'_>) -> Result<Model, UrdfError> {
    let folder = std::path::absolute(path).ok().and_then(|path| path.parent().map(Path::to_owned));
    first_look::read(path)
        .and_then(|(xml, note)| read(&xml, folder.as_deref(), options, note))
        .map_err(|error| error.in_file(path))
}

/// Loads a robot from the text of a URDF that lies, or would lie, in `folder`.
///
/// # Errors
/// [`UrdfError`] with the line and the link or joint.
pub fn from_str(xml: &str, folder: Option<&Path>, options: &Options<'_>) -> Result<Model, UrdfError> {
    read(xml, folder, options, None)
}

fn read(
    xml: &str,
    folder: Option<&Path>,
    options: &Options<'_>,
    note: Option<ModelWarning>,
) -> Result<Model, UrdfError> {
    first_look::check(xml)?;
    let mut notes = Vec::from_iter(note);
    let tidied: String;
    let document = match parse(xml) {
        Ok(document) => document,
        Err(_) => {
            let (text, note) = tidy(xml)?;
            notes.extend(note);
            tidied = text;
            parse(&tidied).map_err(not_xml)?
        }
    };
    let robot = document.root_element();
    check_root(robot)?;
    let ignored = Ignored::new(robot);
    let meshes = Meshes::new(folder, options.packages);
    notes.extend(ignored.warnings());
    read_robot(robot, meshes, options, notes).map_err(|error| ignored.explain(error))
}

fn read_robot(
    robot: Node<'_, '_>,
    meshes: Meshes<'_>,
    options: &Options<'_>,
    mut warnings: Vec<ModelWarning>,
) -> Result<Model, UrdfError> {
    // every error says whose fault it is: the names come first, and outlive the elements
    let names = |tag| owners(robot, tag);
    let (link_owners, joint_owners) = (names("link"), names("joint"));
    let robot = Element::new(robot, "the robot");
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
    warnings.extend(quaternion_warning(robot.node));
    warnings.extend(expression_warning(&links, &hinges));
    if links.is_empty() {
        return Err(robot.fail(UrdfProblem::NoLinks));
    }
    for change in options.changes {
        change
            .check_is_one_of(links.iter().map(|(name, _)| *name))
            .map_err(|error| UrdfError::new(None, UrdfProblem::Model(error)))?;
    }
    let mut around =
        Surroundings { materials: Materials::new(robot), meshes, changes: options.changes, warnings };
    let builder = assemble(robot.text("name").unwrap_or("robot"), &links, &hinges, &mut around)?;
    let built = if options.is_part { builder.build_part() } else { builder.build() };
    built.map_err(|error| UrdfError::new(None, UrdfProblem::Model(error)))
}

/// `link 'hand'` for every link, in order.
fn owners(robot: Node<'_, '_>, tag: &'static str) -> Vec<String> {
    Element::new(robot, "")
        .children(tag)
        .map(|element| format!("{tag} '{}'", element.text("name").unwrap_or_default()))
        .collect()
}

/// A remark on names that xacro would have replaced; they are names all the same.
fn expression_warning(links: &[NamedLink<'_>], hinges: &[Hinge<'_>]) -> Option<ModelWarning> {
    let mut names = links.iter().map(|(name, _)| *name).chain(hinges.iter().map(|hinge| hinge.name));
    let name = names.find(|name| has_expression(name))?;
    let note = format!("the name '{name}' is xacro, kept as it is; expand the file with xacro for another");
    Some(ModelWarning::Note(note))
}

/// Refuses a document of another kind.
fn check_root(robot: Node<'_, '_>) -> Result<(), UrdfError> {
    let root = robot.tag_name().name();
    if root == "robot" {
        return Ok(());
    }
    Err(UrdfError::at(robot, UrdfProblem::NotRobot { found: root.to_owned() }))
}

fn not_xml(error: XmlError) -> UrdfError {
    // the parser ends its message with the place, which we put in front
    let (reason, place) = (error.to_string(), format!(" at {}", error.pos()));
    let reason = reason.strip_suffix(&place).unwrap_or(&reason).to_owned();
    UrdfError::new(Some(error.pos().row), UrdfProblem::NotXml { reason })
}
