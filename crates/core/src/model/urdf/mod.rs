//! Reader of robots from URDF files.
//!
//! roxmltree parses the text and provides line numbers; text that it rejects but tinyxml2 accepts is
//! rewritten first (`repair`). Serde fills the types of urdf-rs from the parsed tree (`from_tree`), using the
//! first element of each name and checking attributes against one table (`schema`). `docs/design.md` explains
//! why the parser of urdf-rs is not used.
//!
//! Transmissions, sensors and known extensions of other tools are ignored. Elements with a foreign prefix,
//! unknown elements and xacro tags are ignored with a warning. Prefixes do not have to be declared.

mod assemble;
mod element;
mod error;
mod foreign;
mod from_tree;
mod joint;
mod joint_element;
mod link;
mod material;
mod mesh;
mod mesh_name;
mod mesh_near;
mod multi_dof;
mod pose;
mod precheck;
mod refusal;
mod repair;
mod rewrite;
mod schema;
mod tokens;

pub use error::{UrdfError, UrdfProblem};

use super::{LinkChange, Model, ModelWarning};
use assemble::{NamedLink, assemble};
use element::{Element, has_expression};
use foreign::{Ignored, parse};
use joint_element::{JointElement, read_joint_element};
use link::ReadContext;
use material::Materials;
use mesh::Meshes;
use pose::quaternion_warning;
use repair::repair;
use roxmltree::{Error as XmlError, Node};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Options for reading a URDF.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options<'a> {
    /// Folders that are ROS packages or contain ROS packages. They are searched for `package://` meshes
    /// before the folder of the URDF and its parents.
    pub packages: &'a [PathBuf],
    /// Inertial values that replace those in the file before the robot is checked.
    pub changes: &'a [LinkChange],
    /// True if the robot will be attached to another one; its dynamics on its own may then be singular.
    pub is_part: bool,
}

/// Loads a robot with a floating root link from the URDF file `path`.
///
/// If the mesh file of a visual shape is not found, its name is kept and a warning is added. A collision
/// shape whose mesh file is not found is skipped without a warning ([`Model::skipped_collisions`]).
///
/// # Errors
/// [`UrdfError`] with the file and, as far as they are known, the line and the name of the link or joint.
pub fn from_file(path: &Path, options: &Options<'_>) -> Result<Model, UrdfError> {
    let folder = std::path::absolute(path).ok().and_then(|path| path.parent().map(Path::to_owned));
    precheck::read(path)
        .and_then(|(xml, note)| read(&xml, folder.as_deref(), options, note))
        .map(|model| with_file_in_reasons(model, path))
        .map_err(|error| error.in_file(path))
}

/// Inserts the path of the URDF file before each reason why a collision shape was skipped.
fn with_file_in_reasons(mut model: Model, path: &Path) -> Model {
    if model.description.links.iter().any(|link| !link.skipped_collisions.is_empty()) {
        for link in &mut Arc::make_mut(&mut model.description).links {
            for reason in &mut link.skipped_collisions {
                *reason = format!("{}, {reason}", path.display());
            }
        }
    }
    model
}

/// Loads a robot from the text of a URDF. Relative names of mesh files refer to `folder`, if it is given.
///
/// # Errors
/// [`UrdfError`] with the line and the name of the link or joint, as far as they are known.
pub fn from_str(xml: &str, folder: Option<&Path>, options: &Options<'_>) -> Result<Model, UrdfError> {
    read(xml, folder, options, None)
}

fn read(
    xml: &str,
    folder: Option<&Path>,
    options: &Options<'_>,
    note: Option<ModelWarning>,
) -> Result<Model, UrdfError> {
    precheck::check(xml)?;
    let mut notes = Vec::from_iter(note);
    let repaired: String;
    let document = match parse(xml) {
        Ok(document) => document,
        Err(_) => {
            let (text, note) = repair(xml)?;
            notes.extend(note);
            repaired = text;
            parse(&repaired).map_err(not_xml)?
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
    // names of links and joints for error messages; the elements borrow them
    let names = |tag| owners(robot, tag);
    let (link_owners, joint_owners) = (names("link"), names("joint"));
    let robot = Element::new(robot, "the robot");
    let links = robot
        .children("link")
        .zip(&link_owners)
        .map(|(link, owner)| Ok((link.required_text("name")?, Element { owner, ..link })))
        .collect::<Result<Vec<_>, UrdfError>>()?;
    let joints = robot
        .children("joint")
        .zip(&joint_owners)
        .map(|(joint, owner)| read_joint_element(Element { owner, ..joint }, joint.required_text("name")?))
        .collect::<Result<Vec<_>, UrdfError>>()?;
    warnings.extend(quaternion_warning(robot.node));
    warnings.extend(expression_warning(&links, &joints));
    if links.is_empty() {
        return Err(robot.fail(UrdfProblem::NoLinks));
    }
    for change in options.changes {
        change
            .check_is_one_of(links.iter().map(|(name, _)| *name))
            .map_err(|error| UrdfError::new(None, UrdfProblem::Model(error)))?;
    }
    let mut context =
        ReadContext { materials: Materials::new(robot), meshes, changes: options.changes, warnings };
    let builder = assemble(robot.text("name").unwrap_or("robot"), &links, &joints, &mut context)?;
    let built = if options.is_part { builder.build_part() } else { builder.build() };
    built.map_err(|error| UrdfError::new(None, UrdfProblem::Model(error)))
}

/// Returns the phrase for each link or joint in error messages, such as `link 'hand'`, in the order of the
/// file. `tag` is `link` or `joint`.
fn owners(robot: Node<'_, '_>, tag: &'static str) -> Vec<String> {
    Element::new(robot, "")
        .children(tag)
        .map(|element| format!("{tag} '{}'", element.text("name").unwrap_or_default()))
        .collect()
}

/// Returns a warning if names contain xacro expressions, which are not evaluated.
fn expression_warning(links: &[NamedLink<'_>], joints: &[JointElement<'_>]) -> Option<ModelWarning> {
    let mut names = links.iter().map(|(name, _)| *name).chain(joints.iter().map(|joint| joint.name));
    let name = names.find(|name| has_expression(name))?;
    let note = format!(
        "the name '{name}' contains an xacro expression, which is not evaluated; expand the \
    file with xacro to replace it"
    );
    Some(ModelWarning::Note(note))
}

/// Checks that the root element of the document is `<robot>`.
fn check_root(robot: Node<'_, '_>) -> Result<(), UrdfError> {
    let root = robot.tag_name().name();
    if root == "robot" {
        return Ok(());
    }
    Err(UrdfError::at(robot, UrdfProblem::NotRobot { found: root.to_owned() }))
}

fn not_xml(error: XmlError) -> UrdfError {
    // the parser's message ends with the location, but error messages of this crate begin with the location
    let (reason, place) = (error.to_string(), format!(" at {}", error.pos()));
    let reason = reason.strip_suffix(&place).unwrap_or(&reason).to_owned();
    UrdfError::new(Some(error.pos().row), UrdfProblem::NotXml { reason })
}
