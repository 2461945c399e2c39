//! What can be wrong with a robot.

use crate::number_text::{list, short, unlike};
use std::fmt;
use thiserror::Error;

/// A robot that cannot be simulated.
#[derive(Clone, Debug, PartialEq, Error)]
#[allow(missing_docs)] // the fields are what the messages say
pub enum ModelError {
    #[error("link '{link}' has a mass of {mass} kg, it must be positive", mass = short(*mass))]
    MassNotPositive { link: String, mass: f64 },
    #[error(
        "the inertia of link '{link}' is not positive definite: its principal moments are {moments} kg m2",
        moments = list(moments)
    )]
    IndefiniteInertia { link: String, moments: [f64; 3] },
    #[error(
        "the inertia of link '{link}' is not symmetric: entries differ by {difference} kg m2",
        difference = short(*difference)
    )]
    AsymmetricInertia { link: String, difference: f64 },
    #[error("{what} of '{name}' is not finite")]
    NotFinite { what: &'static str, name: String },
    #[error("{what} of '{name}' is {value}, {expected} are accepted; check the units", value = short(*value))]
    OutOfRange { what: &'static str, name: String, value: f64, expected: &'static str },
    #[error(
        "the robot has more than {most} moving joints: matrices over all of them would take too much memory; make \
         joints that do not move fixed"
    )]
    TooManyJoints { most: usize },
    #[error(
        "the robot has no mass: a floating base needs some; give a link an inertial, or a mass by 'links'"
    )]
    NoMass,
    #[error(
        "nothing resists the motion of joint '{joint}': link '{link}' and what hangs on it have no inertia about \
         its axis; give one of them an inertial, or make the joint fixed"
    )]
    MasslessSubtree { joint: String, link: String },
    #[error("the base '{link}' can be moved without resistance: {}", base_advice(.joints))]
    SingularBase { link: String, joints: Vec<String> },
    #[error("the {what} name '{name}' is used twice")]
    DuplicateName { what: &'static str, name: String },
    #[error("both robots have a {what} '{name}': give the one that is attached a prefix, such as 'left_'")]
    NameOfBoth { what: &'static str, name: String },
    #[error(
        "with the prefix '{prefix}' the robot that is attached has a {what} '{name}', as the other has; take another \
         prefix"
    )]
    PrefixTaken { what: &'static str, name: String, prefix: String },
    #[error(
        "joints move the frame '{name}': a robot is attached by a frame that is fixed to its base: {}",
        .candidates.join(", ")
    )]
    FrameMoves { name: String, candidates: Vec<String> },
    #[error("link '{link}' has no mass; give it one with its centre of mass or inertia")]
    ChangeWithoutMass { link: String },
    #[error("a {what} has an empty name")]
    EmptyName { what: &'static str },
    #[error("there is no {what} '{name}'{}", nearest(.candidates, .name))]
    UnknownName { what: &'static str, name: String, candidates: Vec<String> },
    #[error("joint '{joint}' has an axis of length zero")]
    ZeroAxis { joint: String },
    #[error("joint '{joint}': {what} is {value}, it must not be negative", value = short(*value))]
    Negative { joint: String, what: &'static str, value: f64 },
    #[error(
        "joint '{joint}': its static friction {at_rest} is below its kinetic friction {moving}; give at least \
         {moving}, or leave it out",
        at_rest = unlike(*at_rest, &[*moving]), moving = short(*moving)
    )]
    StaticBelowKinetic { joint: String, at_rest: f64, moving: f64 },
    #[error(
        "joint '{joint}': lower limit {lower} is above upper limit {upper}",
        lower = unlike(*lower, &[*upper]), upper = short(*upper)
    )]
    LimitsReversed { joint: String, lower: f64, upper: f64 },
}

/// Something odd that the model lives with.
#[derive(Clone, Debug, PartialEq)]
pub enum ModelWarning {
    /// Principal moments that no body of positive density has.
    TriangleInequality {
        /// The link.
        link: String,
        /// Its principal moments, kg m², ascending.
        moments: [f64; 3],
    },
    /// A link that no body can be, fixed to others with which it makes one that can.
    IndefinitePart {
        /// The link.
        link: String,
        /// Its principal moments, kg m², ascending.
        moments: [f64; 3],
    },
    /// Principal moments that are negative by less than rounding; they are read as zero.
    RoundedInertia {
        /// The link.
        link: String,
        /// Its principal moments as given, kg m², ascending.
        moments: [f64; 3],
    },
    /// A link without mass but with a rotational inertia, which is added to that of its body.
    InertiaWithoutMass {
        /// The link.
        link: String,
    },
    /// Anything else a reader of a file met.
    Note(String),
}

impl fmt::Display for ModelWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TriangleInequality { link, moments: [a, b, c] } => write!(
                f,
                "the inertia of link '{link}' breaks the triangle inequality: {} + {} < {} kg m2; no real body has such \
                 principal moments (used as it is)",
                short(a.max(0.0)), // a negative moment is rounding here
                short(b.max(0.0)),
                unlike(*c, &[a + b])
            ),
            Self::IndefinitePart { link, moments } => write!(
                f,
                "the inertia of link '{link}' is not positive definite: principal moments {} kg m2 (used as it \
                 is: with the links it is fixed to, the sum is)",
                list(moments)
            ),
            Self::RoundedInertia { link, moments } => write!(
                f,
                "the inertia of link '{link}' is negative by rounding: principal moments {} kg m2 (those below zero \
                 are read as zero)",
                list(moments)
            ),
            Self::InertiaWithoutMass { link } => write!(
                f,
                "link '{link}' has no mass but a rotational inertia, which is added to that of the body that it is part of"
            ),
            Self::Note(text) => f.write_str(text),
        }
    }
}

impl ModelError {
    /// The name that was probably meant, for a name that does not exist.
    pub fn suggestion(&self) -> Option<&str> {
        match self {
            Self::UnknownName { name, candidates, .. } => closest(candidates, name),
            _ => None,
        }
    }

    /// Converts a duplicate name to the error for attached robots, which suggests a prefix.
    pub(super) fn suggest_prefix(self, prefix: &str) -> Self {
        match self {
            Self::DuplicateName { what, name } if prefix.is_empty() => Self::NameOfBoth { what, name },
            Self::DuplicateName { what, name } => Self::PrefixTaken { what, name, prefix: prefix.to_owned() },
            other => other,
        }
    }
}

/// Returns advice for a singular base; `joints` are those of the chain between the base and the first mass.
fn base_advice(joints: &[String]) -> String {
    let names: Vec<String> = joints.iter().map(|joint| format!("'{joint}'")).collect();
    match joints.len() {
        0 => "the robot's inertia is singular about some axis; give the base an inertial, or fix what hangs on it"
            .to_owned(),
        1 => format!("give it an inertial, or remove the joint {}: the base floats anyway", names[0]),
        _ => format!("give it an inertial, or remove the joints {}: the base floats anyway", names.join(", ")),
    }
}

/// `; did you mean 'x'?` for the closest candidate, or the list when there are few.
pub(super) fn nearest(candidates: &[String], name: &str) -> String {
    match closest(candidates, name) {
        Some(meant) => format!("; did you mean '{meant}'?"),
        None if (1..=12).contains(&candidates.len()) => format!("; there are: {}", candidates.join(", ")),
        None => String::new(),
    }
}

/// The candidate a few letters away, or else one that contains the name.
pub(super) fn closest<'a>(candidates: &'a [String], name: &str) -> Option<&'a str> {
    const LONGEST: usize = 100; // comparing takes the product of the lengths
    let is_name = |c: &&String| c.len() <= LONGEST && name.len() <= LONGEST;
    let best = candidates.iter().filter(is_name).min_by_key(|c| distance(c, name));
    let near = best.filter(|c| distance(c, name) <= 2 + name.len() / 3);
    let part = || candidates.iter().find(|c| name.len() > 2 && c.contains(name));
    near.or_else(part).map(String::as_str)
}

/// Levenshtein distance, case ignored.
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
