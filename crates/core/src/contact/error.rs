//! Errors of contacts.

use crate::geometry::GeometryError;
use crate::number_text::{count, exact, short, unlike};

/// Error in the declaration of a contact, or in its evaluation during a run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ContactError {
    /// A parameter is outside its range.
    #[error(
        "the {name} of a contact is {got}{unit}; it must be {range}{unit}",
        got = exact(*got), unit = with_space(unit)
    )]
    Parameter {
        /// Name of the parameter.
        name: &'static str,
        /// Given value, in `unit`.
        got: f64,
        /// Accepted range, as text without the unit.
        range: String,
        /// Unit; empty for a dimensionless parameter.
        unit: &'static str,
    },
    /// No link matches a pattern.
    #[error("contact '{contact}': no link matches '{pattern}'{remedy}")]
    NoLink {
        /// Name of the contact.
        contact: String,
        /// Pattern `SYSTEM/LINK`, in which `*` stands for any text.
        pattern: String,
        /// Rest of the message, which suggests similar links; may be empty.
        remedy: String,
    },
    /// No link that matches a pattern has a collision shape.
    #[error(
        "contact '{contact}': link '{link}' of system '{system}' has no collision shape; add a <collision> element to the \
         link in its URDF"
    )]
    NoShape {
        /// Name of the contact.
        contact: String,
        /// Name of the system.
        system: String,
        /// Name of the last link that matches.
        link: String,
    },
    /// A side of a contact has no pieces.
    #[error(
        "contact '{contact}': one of its sides has no collision shapes; give each side at least one link with a \
         collision shape"
    )]
    NoPieces {
        /// Name of the contact.
        contact: String,
    },
    /// Both sides of a contact are the same link.
    #[error(
        "contact '{contact}': both sides are the same link, which cannot touch itself; give two different links"
    )]
    SameLink {
        /// Name of the contact.
        contact: String,
    },
    /// Two contacts have the same name.
    #[error("two contacts are named '{name}'; give each contact a different name")]
    DuplicateName {
        /// Name that both contacts have.
        name: String,
    },
    /// The bodies overlap at the start of a run.
    #[error(
        "contact '{contact}': at the start, the links {links} overlap by {depth} m; move them apart{remedy}",
        depth = short(*depth), remedy = or_permit(*may_be_permitted)
    )]
    Overlap {
        /// Name of the contact.
        contact: String,
        /// Text with the paths `SYSTEM/LINK` of both links.
        links: String,
        /// Depth of the overlap, m.
        depth: f64,
        /// False for a contact with an impact law, whose bodies cannot overlap.
        may_be_permitted: bool,
    },
    /// A contact has an impact law and a setting that cannot be combined with it.
    #[error("contact '{contact}': an impact law cannot be combined with {what}")]
    ImpactLaw {
        /// Name of the contact.
        contact: String,
        /// Setting that is excluded, and the suggested fix.
        what: &'static str,
    },
    /// Painlevé's paradox: no force of a sliding rigid contact satisfies both the contact conditions and
    /// Coulomb's law of friction.
    #[error(
        "contact '{contact}': no force of a rigid contact with Coulomb friction keeps the sliding links {links} from \
         overlapping: the friction coefficient {friction} is not below {limit}, at which friction pushes the \
         links into each other as fast as the normal force separates them (Painlevé's paradox); use a compliant \
         normal force, such as HuntCrossley, or a smaller friction coefficient",
        friction = unlike(*friction, &[*limit]), limit = short(*limit)
    )]
    Painleve {
        /// Name of the contact.
        contact: String,
        /// Names of both links, as text.
        links: String,
        /// Coefficient of friction of the contact.
        friction: f64,
        /// Coefficient of friction at or above which no contact force exists.
        limit: f64,
    },
    /// The iteration for the impulses or forces of rigid contacts did not converge.
    #[error(
        "{contacts}: the impulses at {points} did not converge, because the last of {sweeps} sweeps \
         still changed a velocity by {change} m/s (rad/s at the stop of a revolute joint); use a compliant \
         normal force, such as HuntCrossley, for the contacts within long rows or stacks of bodies",
        points = count(*points, "rigid point"), change = short(*change)
    )]
    Unsolved {
        /// Names of the contacts with the noun, such as `contact 'hull'`.
        contacts: String,
        /// Number of points of contact.
        points: usize,
        /// Number of sweeps over all points.
        sweeps: usize,
        /// Largest change of a velocity in the last sweep, m/s (rad/s at the stop of a revolute joint).
        change: f64,
    },
    /// A shape is invalid, or the distance between two shapes could not be computed.
    #[error("contact '{contact}': {source}")]
    Geometry {
        /// Name of the contact.
        contact: String,
        /// Error of the shape or of the computation of the distance.
        source: GeometryError,
    },
}

/// Returns the second remedy for an overlap at the start; empty if the overlap cannot be permitted.
fn or_permit(may_be_permitted: bool) -> &'static str {
    if may_be_permitted { ", or permit the overlap with start_overlapping" } else { "" }
}

fn with_space(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" {unit}") }
}

/// Returns an error unless a parameter is positive and finite.
pub(super) fn positive(name: &'static str, got: f64, unit: &'static str) -> Result<(), ContactError> {
    if got > 0.0 && got.is_finite() {
        return Ok(());
    }
    Err(ContactError::Parameter { name, got, range: "finite and more than 0".to_owned(), unit })
}

/// Returns an error unless a parameter is finite and at least `least`.
pub(super) fn at_least(
    name: &'static str,
    got: f64,
    least: f64,
    unit: &'static str,
) -> Result<(), ContactError> {
    if got >= least && got.is_finite() {
        return Ok(());
    }
    Err(ContactError::Parameter { name, got, range: format!("finite and at least {}", exact(least)), unit })
}
