//! Errors and warnings of robot models.

use crate::number_text::{exact, list, short, unlike};
use std::fmt;
use thiserror::Error;

/// Reason why the model of a robot cannot be built, or why a request to a model fails.
#[derive(Clone, Debug, PartialEq, Error)]
#[allow(missing_docs)] // the fields are what the messages say
pub enum ModelError {
    #[error("link '{link}' has a mass of {mass} kg; it must be positive", mass = short(*mass))]
    MassNotPositive { link: String, mass: f64 },
    #[error(
        "the inertia of link '{link}' is indefinite: its principal moments are {moments} kg m2, but \
         none may be negative; correct its entries, such as the signs of the products of inertia",
        moments = list(moments)
    )]
    IndefiniteInertia { link: String, moments: [f64; 3] },
    #[error(
        "the inertia of link '{link}' is not symmetric: mirrored entries differ by {difference} kg m2; make both \
         entries equal",
        difference = short(*difference)
    )]
    AsymmetricInertia { link: String, difference: f64 },
    #[error("{what} of '{name}' contains infinity or NaN; specify finite numbers")]
    NotFinite { what: &'static str, name: String },
    #[error("{what} of joint '{joint}' is NaN; specify a number, or infinity for no limit")]
    LimitIsNan { joint: String, what: &'static str },
    #[error("{what} of '{name}' is {value}; expected {expected} (check the units)", value = exact(*value))]
    OutOfRange { what: &'static str, name: String, value: f64, expected: &'static str },
    #[error(
        "the robot has more than {most} moving joints, and matrices over all of them would require too much \
         memory; declare joints that do not move as fixed"
    )]
    TooManyJoints { most: usize },
    #[error(
        "the robot has no mass, but a floating base requires mass; give a link inertial properties, or pass its \
         mass in the argument 'links'"
    )]
    NoMass,
    #[error(
        "nothing resists the motion of joint '{joint}': link '{link}' and its descendants have no inertia \
         in the direction of this motion; add inertial properties to one of these links, or make the joint fixed"
    )]
    MasslessSubtree { joint: String, link: String },
    #[error("nothing resists the motion of the base '{link}'; {}", base_advice(.joints))]
    SingularBase { link: String, joints: Vec<String> },
    #[error("the {what} name '{name}' is used twice; give each {what} a different name")]
    DuplicateName { what: &'static str, name: String },
    #[error("both robots have a {what} '{name}'; give the attached robot a prefix, such as 'left_'")]
    NameOfBoth { what: &'static str, name: String },
    #[error("with the prefix '{prefix}', both robots have a {what} '{name}'; choose a different prefix")]
    PrefixTaken { what: &'static str, name: String, prefix: String },
    #[error("link '{link}' has no mass; give it a mass together with its centre of mass or inertia")]
    ChangeWithoutMass { link: String },
    #[error("a {what} has an empty name; give it a name")]
    EmptyName { what: &'static str },
    #[error("there is no {what} '{name}'{}", nearest(.candidates, .name))]
    UnknownName { what: &'static str, name: String, candidates: Vec<String> },
    #[error("loop '{name}' connects frame '{frame}' with itself; give the frames of two different bodies")]
    LoopWithItself { name: String, frame: String },
    #[error(
        "loop '{name}' connects the frames '{a}' and '{b}', which belong to the same body, so they cannot move \
         relative to each other; give frames of two different bodies", a = frames[0], b = frames[1]
    )]
    LoopWithinBody { name: String, frames: [String; 2] },
    #[error(
        "joint '{joint}' mimics joint '{leader}', which {reason}",
        reason = leader_fault(*is_fixed, candidates, leader)
    )]
    UnknownLeader { joint: String, leader: String, is_fixed: bool, candidates: Vec<String> },
    #[error("{}", circle(joints))]
    MimicCircle { joints: Vec<String> },
    #[error("joint '{joint}' has an axis of length zero; specify a nonzero vector")]
    ZeroAxis { joint: String },
    #[error("joint '{joint}': {what} is {value} {unit}; it must not be negative", value = short(*value))]
    Negative { joint: String, what: &'static str, value: f64, unit: &'static str },
    #[error(
        "joint '{joint}' is fixed and cannot have {what}; make the joint revolute, continuous or prismatic"
    )]
    FixedJoint { joint: String, what: &'static str },
    #[error(
        "joint '{joint}': the spring has a rest position but no stiffness; give a stiffness, or omit the rest position"
    )]
    NoStiffness { joint: String },
    #[error(
        "joint '{joint}': the cubic stiffness of the spring is {cubic_stiffness} {unit} without a stiffness, so the \
         spring pushes the joint away from its rest position; give a positive stiffness, or a cubic stiffness of at \
         least 0",
        cubic_stiffness = short(*cubic_stiffness)
    )]
    RepellingSpring { joint: String, cubic_stiffness: f64, unit: &'static str },
    #[error(
        "joint '{joint}': the static friction, {at_rest} {unit}, is below the kinetic friction, {moving} {unit}; give a \
         static friction of at least {moving} {unit}, or omit the static friction",
        at_rest = unlike(*at_rest, &[*moving]), moving = short(*moving)
    )]
    StaticBelowKinetic { joint: String, at_rest: f64, moving: f64, unit: &'static str },
    #[error(
        "joint '{joint}': the lower limit, {lower} {unit}, is above the upper limit, {upper} {unit}; exchange the two \
         limits",
        lower = unlike(*lower, &[*upper]), upper = short(*upper)
    )]
    LimitsReversed { joint: String, lower: f64, upper: f64, unit: &'static str },
}

/// Problem of a model that does not prevent a simulation.
#[derive(Clone, Debug, PartialEq)]
pub enum ModelWarning {
    /// The principal moments of a link violate the triangle inequality.
    TriangleInequality {
        /// Name of the link.
        link: String,
        /// Principal moments of the link, kg m², ascending.
        moments: [f64; 3],
    },
    /// The inertia of a link has a negative principal moment, but that of the whole body to which the link
    /// belongs has none.
    IndefinitePart {
        /// Name of the link.
        link: String,
        /// Principal moments of the link, kg m², ascending.
        moments: [f64; 3],
    },
    /// Some principal moments of a link are negative by less than the rounding tolerance and are set to zero.
    RoundedInertia {
        /// Name of the link.
        link: String,
        /// Principal moments of the link before the correction, kg m², ascending.
        moments: [f64; 3],
    },
    /// A link has a rotational inertia but no mass. The inertia is added to that of the link's body.
    InertiaWithoutMass {
        /// Name of the link.
        link: String,
    },
    /// The tangent stiffness of a spring is negative at some deflections within the position limits of its
    /// joint.
    SofteningSpring {
        /// Name of the joint.
        joint: String,
        /// Deflection from the rest position above which the tangent stiffness is negative, rad (m).
        deflection: f64,
        /// Unit of the deflection.
        unit: &'static str,
    },
    /// All joints of a closed loop have friction, so that the friction torques at rest are not unique.
    LoopFriction {
        /// Name of the loop.
        name: String,
        /// Names of the joints on the path through the tree between the two bodies that the loop connects.
        joints: Vec<String>,
    },
    /// Text about another problem, which was found while reading a file.
    Note(String),
}

impl fmt::Display for ModelWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TriangleInequality { link, moments: [a, b, c] } => write!(
                f,
                "the inertia of link '{link}' violates the triangle inequality: {} + {} < {} kg m2; no rigid \
                 body has such principal moments (it is used unchanged); check its entries",
                short(a.max(0.0)), // a moment below zero is within the rounding tolerance here
                short(b.max(0.0)),
                unlike(*c, &[a + b])
            ),
            Self::IndefinitePart { link, moments } => write!(
                f,
                "the inertia of link '{link}' is not positive definite: its principal moments are {} kg m2 (it is \
                 used unchanged, since the inertia of the whole body, with the links fixed to it, is positive \
                 definite); check its entries",
                list(moments)
            ),
            Self::RoundedInertia { link, moments } => write!(
                f,
                "the principal moments of inertia of link '{link}' are {} kg m2; the negative ones are within \
                 the rounding error and are set to zero",
                list(moments)
            ),
            Self::InertiaWithoutMass { link } => write!(
                f,
                "link '{link}' has no mass but a rotational inertia, which is added to that of the body to which the link \
                 belongs; give the link a mass if it should have one"
            ),
            Self::SofteningSpring { joint, deflection, unit } => write!(
                f,
                "joint '{joint}': the tangent stiffness of its spring is negative at deflections above {} {unit}, \
                 where the spring may snap through; give the joint position limits within this deflection, or a \
                 larger cubic stiffness",
                short(*deflection)
            ),
            Self::LoopFriction { name, joints } => write!(
                f,
                "all joints of the loop '{name}' have friction ({}); the friction torques that hold the \
                 loop at rest are therefore not unique, and the computed ones, like the forces in the \
                 loop, depend on the order of the joints; give friction to at most as many joints as the \
                 loop has degrees of freedom",
                joints.join(", ")
            ),
            Self::Note(text) => f.write_str(text),
        }
    }
}

impl ModelError {
    /// Returns the existing name that is most similar to the unknown name of a [`ModelError::UnknownName`].
    /// Returns `None` if no name is similar, and for all other errors.
    pub fn suggestion(&self) -> Option<&str> {
        match self {
            Self::UnknownName { name, candidates, .. } => closest(candidates, name),
            _ => None,
        }
    }

    /// Converts the error for a duplicate name to the error for a name that two robots to be joined both
    /// have, which suggests a prefix. Other errors are returned unchanged.
    pub(super) fn suggest_prefix(self, prefix: &str) -> Self {
        match self {
            Self::DuplicateName { what, name } if prefix.is_empty() => Self::NameOfBoth { what, name },
            Self::DuplicateName { what, name } => Self::PrefixTaken { what, name, prefix: prefix.to_owned() },
            other => other,
        }
    }
}

/// Returns the reason why a joint cannot be the leader of a mimic joint, with advice.
fn leader_fault(is_fixed: bool, candidates: &[String], leader: &str) -> String {
    match is_fixed {
        true => "is fixed; make the mimic joint fixed too, or remove its mimic".to_owned(),
        false => format!("does not exist{}", nearest(candidates, leader)),
    }
}

/// Returns names in quotation marks, separated by commas.
fn names(names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("'{name}'")).collect();
    quoted.join(", ")
}

/// Returns advice for a base whose motion no inertia resists; `joints` are the joints between the base and
/// the first link with inertia.
fn base_advice(joints: &[String]) -> String {
    let names: Vec<String> = joints.iter().map(|joint| format!("'{joint}'")).collect();
    match joints.len() {
        0 => {
            "the robot's inertia is singular about some axis; give the base inertial properties, or make its \
        joints fixed"
                .to_owned()
        }
        1 => format!(
            "give it inertial properties, or remove both it and the joint {}; the robot floats even without them",
            names[0]
        ),
        _ => format!(
            "give it inertial properties, or remove the joints {} and the massless links above them; the robot floats \
             without them",
            names.join(", ")
        ),
    }
}

/// Returns the message about joints that mimic each other in a circle, or about a joint that mimics itself.
/// `joints` ends with the joint with which it begins.
fn circle(joints: &[String]) -> String {
    match joints {
        [joint] | [joint, _] => {
            format!("joint '{joint}' mimics itself; remove its mimic, or give another leader")
        }
        _ => format!(
            "the joints {} mimic each other in a circle; remove the mimic of one of them",
            names(joints)
        ),
    }
}

/// Returns `; did you mean 'x'?` with the candidate `x` that is most similar to `name`. If no candidate is
/// similar, returns a list of the candidates or, if there are more than twelve, their number and the first
/// three.
pub(crate) fn nearest(candidates: &[String], name: &str) -> String {
    match (closest(candidates, name), candidates) {
        (Some(meant), _) => format!("; did you mean '{meant}'?"),
        (None, []) => "; there are no known names".to_owned(),
        (None, [only]) => format!("; the only known name is '{only}'"),
        (None, known) if known.len() <= 12 => format!("; the known names are: {}", known.join(", ")),
        (None, known) => {
            format!("; there are {} known names, such as {}", known.len(), known[..3].join(", "))
        }
    }
}

/// Returns the candidate with the smallest edit distance to `name` if the distance is small, or else the
/// first candidate that contains `name`, which must then have at least three bytes. Returns `None` if there
/// is neither.
pub(crate) fn closest<'a>(candidates: &'a [String], name: &str) -> Option<&'a str> {
    const LONGEST: usize = 100; // the computing time grows with the product of the lengths
    let is_name = |c: &&String| c.len() <= LONGEST && name.len() <= LONGEST;
    let best = candidates.iter().filter(is_name).min_by_key(|c| distance(c, name));
    let near = best.filter(|c| distance(c, name) <= 2 + name.len() / 3);
    let part = || candidates.iter().find(|c| name.len() > 2 && c.contains(name));
    near.or_else(part).map(String::as_str)
}

/// Returns the Levenshtein distance between two names, ignoring case.
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) =
        (a.to_lowercase().chars().collect(), b.to_lowercase().chars().collect());
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cb) in b.iter().enumerate() {
            let substitute = diagonal + usize::from(ca != cb);
            diagonal = row[j + 1];
            row[j + 1] = substitute.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
