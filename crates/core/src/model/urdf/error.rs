//! Errors of URDF files, with their location.

use crate::model::error::{ModelError, closest, nearest};
use crate::number_text::short;
use roxmltree::Node;
use std::fmt;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Reason why a URDF cannot be loaded, with its location.
#[derive(Clone, Debug, PartialEq)]
pub struct UrdfError {
    /// Path of the file; `None` if the URDF was given as text.
    pub file: Option<PathBuf>,
    /// Line of the problem, counted from 1; `None` if the line is unknown.
    pub line: Option<u32>,
    /// Description of the problem.
    pub problem: Box<UrdfProblem>,
}

impl fmt::Display for UrdfError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.file, self.line) {
            (Some(file), Some(line)) => write!(f, "{}:{line}: {}", file.display(), self.problem),
            (Some(file), None) => write!(f, "{}: {}", file.display(), self.problem),
            (None, Some(line)) => write!(f, "line {line}: {}", self.problem),
            (None, None) => self.problem.fmt(f),
        }
    }
}

impl std::error::Error for UrdfError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &*self.problem {
            UrdfProblem::Model(error) => Some(error),
            _ => None,
        }
    }
}

impl UrdfError {
    pub(super) fn new(line: Option<u32>, problem: UrdfProblem) -> Self {
        Self { file: None, line, problem: Box::new(problem) }
    }

    /// Creates the error for a problem at the XML element `node`.
    pub(super) fn at(node: Node<'_, '_>, problem: UrdfProblem) -> Self {
        let line = node.document().text_pos_at(node.range().start).row;
        Self::new(Some(line), problem)
    }

    pub(super) fn in_file(self, file: &Path) -> Self {
        Self { file: Some(file.to_owned()), ..self }
    }
}

/// Problem of a URDF. `owner` is a phrase such as `link 'hand'`.
#[derive(Clone, Debug, PartialEq, Error)]
#[allow(missing_docs)] // the fields are what the messages say
pub enum UrdfProblem {
    #[error("there is no such file; check the path")]
    NotFound,
    #[error("the path is a folder; give the path of a URDF file")]
    IsFolder,
    #[error("the file cannot be read: {reason}")]
    Unreadable { reason: String },
    #[error("<{element}> of {owner} cannot be read ({reason}); correct this element")]
    InvalidElement { owner: String, element: String, reason: String },
    #[error("the URDF is empty; expected a <robot> element")]
    Empty,
    #[error(
        "the URDF is larger than {limit} bytes, the limit for robot descriptions; remove data that does not \
         describe the robot"
    )]
    TooLarge { limit: usize },
    #[error(
        "XML elements are nested deeper than {limit} levels, the limit for robot descriptions; reduce the nesting"
    )]
    TooDeep { limit: usize },
    #[error(
        "an XML tag has more than {limit} attributes, the limit for robot descriptions; remove attributes \
         that URDF does not define"
    )]
    TooManyAttributes { limit: usize },
    #[error("the file is not UTF-8 text (the byte at offset {at} is invalid); save it as UTF-8")]
    NotUtf8 { at: usize },
    #[error("the text is not XML ({reason}); correct the text at this line")]
    NotXml { reason: String },
    #[error(
        "entity '&{name};' is not supported; replace the entity by the text that <!DOCTYPE> defines for it"
    )]
    Entity { name: String },
    #[error("the outermost element is <{found}>; expected <robot>{}", other_format(.found))]
    NotRobot { found: String },
    #[error(
        "{found} is xacro and must be expanded to URDF: xacro FILE.xacro > FILE.urdf (Model.from_urdf in \
         Python expands files named *.xacro, and any file with xacro=True; the command line has --xacro)"
    )]
    Xacro { found: String },
    #[error(
        "<{element}> is ignored because URDF does not define its prefix, so the robot is incomplete; remove the prefix"
    )]
    ForeignElement { element: String },
    #[error("the robot has no links; add at least one link")]
    NoLinks,
    #[error("the file defines xacro macros but no robot; expand the file that uses the macros")]
    OnlyMacros,
    #[error("{owner} has no <{element}> element; add one")]
    MissingElement { owner: String, element: &'static str },
    #[error("<{element}> of {owner} has no attribute '{attribute}'; add the attribute")]
    MissingAttribute { owner: String, element: String, attribute: &'static str },
    #[error(
        "{owner}: {attribute}=\"{text}\" of <{element}> is not {}",
        amount_of_numbers(.expected)
    )]
    BadNumber { owner: String, element: String, attribute: &'static str, text: String, expected: usize },
    #[error("{owner}: {attribute} of <{element}> is {value} m; it must be positive", value = short(*value))]
    NotPositive { owner: String, element: String, attribute: &'static str, value: f64 },
    #[error("{owner}: <origin> has both rpy and quat_xyzw; remove one of them")]
    TwoOrientations { owner: String },
    #[error("{owner}: the quaternion '{text}' has norm zero; give a unit quaternion")]
    ZeroQuaternion { owner: String, text: String },
    #[error(
        "joint '{joint}' has the unknown type '{kind}'; expected revolute, continuous, prismatic, fixed, planar, \
         ball or floating{}",
        way_out(.kind)
    )]
    JointType { joint: String, kind: String },
    #[error("joint '{joint}': there is no link '{link}'{}", nearest(.candidates, .link))]
    UnknownLink { joint: String, link: String, candidates: Vec<String> },
    #[error(
        "link '{link}' is the child of two joints, '{}' and '{}', but a URDF describes a tree; remove one of the \
         joints and, if the robot has both, close the loop with 'loops' in the scenario (in Python: \
         Model.with_loops)",
        .joints[0], .joints[1]
    )]
    TwoParents { link: String, joints: [String; 2] },
    #[error("{}", loop_text(.links))]
    Loop { links: Vec<String> },
    #[error(
        "{} links are not the child of any joint: {}; connect all of them except the root by joints",
        .roots.len(), list(.roots)
    )]
    ManyRoots { roots: Vec<String> },
    #[error(transparent)]
    Model(#[from] ModelError),
}

/// Returns the message about links that form a closed loop, or about a link that is its own parent.
fn loop_text(links: &[String]) -> String {
    match links {
        [link] => {
            format!("link '{link}' is both parent and child of a joint; give the joint two different links")
        }
        _ => format!(
            "the links {} form a closed loop; remove a joint, so that all links descend from one root link, and \
             close the loop with 'loops' in the scenario (in Python: Model.with_loops)",
            list(links)
        ),
    }
}

fn other_format(found: &str) -> &'static str {
    match found {
        "sdf" => "; this looks like SDFormat, which must be converted to URDF",
        "mujoco" => "; this looks like MuJoCo's MJCF, which must be converted to URDF",
        "COLLADA" => "; this looks like a mesh; give the URDF that refers to it",
        "launch" => "; this looks like a ROS launch file; give the URDF that it loads",
        _ => "",
    }
}

fn amount_of_numbers(expected: &usize) -> String {
    match expected {
        1 => "a finite number".to_owned(),
        n => format!("{n} finite numbers separated by spaces"),
    }
}

fn way_out(kind: &str) -> String {
    let advice = match kind.to_lowercase().as_str() {
        "revolute" | "continuous" | "prismatic" | "fixed" | "planar" | "spherical" | "ball" | "floating" => {
            "; write it in lower case"
        }
        "universal" => "; use two revolute joints with intersecting axes instead",
        "screw" | "helical" | "cylindrical" => {
            "; use a prismatic and a revolute joint on one axis instead (their motions are not coupled)"
        }
        "rotational" | "hinge" => "; write revolute",
        "slide" | "slider" | "translational" => "; write prismatic",
        "weld" => "; write fixed",
        other => {
            let kinds = ["revolute", "continuous", "prismatic", "fixed", "planar", "ball", "floating"];
            let kinds = kinds.map(str::to_owned);
            return closest(&kinds, other.trim())
                .map_or_else(String::new, |k| format!("; did you mean '{k}'?"));
        }
    };
    advice.to_owned()
}

/// Returns the first five names in quotation marks, separated by commas, and an ellipsis if there are more.
pub(super) fn list(names: &[String]) -> String {
    const SHOWN: usize = 5;
    let shown: Vec<String> = names.iter().take(SHOWN).map(|name| format!("'{name}'")).collect();
    let more = if names.len() > SHOWN { ", …" } else { "" };
    shown.join(", ") + more
}
