//! Errors of shapes and of the distances between them.

use super::pose::Pose;
use crate::number_text::{self, list, short};

/// Names of the kinds of two shapes, and the poses of the shapes.
#[derive(Clone, Debug, PartialEq)]
pub struct PosedPair {
    /// Kind of the first shape with its article, such as `a box`.
    pub a: &'static str,
    /// Pose of the first shape.
    pub pose_a: Pose,
    /// Kind of the second shape with its article.
    pub b: &'static str,
    /// Pose of the second shape.
    pub pose_b: Pose,
}

/// Error of a shape or of the computation of a distance.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// A length of a shape is infinite or NaN, negative, or zero where it must be positive.
    #[error(
        "the {name} of {shape} is {got} m; it must be {expected}",
        got = short(*got), expected = if *may_be_zero { "finite and at least 0" } else { "positive and finite" }
    )]
    Length {
        /// Kind of the shape with its article, such as `a box`.
        shape: &'static str,
        /// Name of the length.
        name: &'static str,
        /// Given value, m.
        got: f64,
        /// True if the length may be zero.
        may_be_zero: bool,
    },
    /// Points have no convex hull with a volume.
    #[error(
        "a convex hull with a volume cannot be formed from {points} ({cause}); give at least four points \
         with finite coordinates that are not in a plane",
        points = number_text::count(*count, "point")
    )]
    Hull {
        /// Number of given points.
        count: usize,
        /// Reason why there is no hull, as text.
        cause: &'static str,
    },
    /// A compound has no pieces.
    #[error("a compound has no pieces; give at least one shape")]
    EmptyCompound,
    /// The pose of a shape has a number that is not finite.
    #[error("the pose of {name} contains infinity or NaN; give a finite position and rotation")]
    Pose {
        /// Kind of the shape with its article, such as `a box`.
        name: &'static str,
    },
    /// A link has no collision shape.
    #[error(
        "the link '{link}' has no collision shape; give it a <collision> element{}", links_with(.with)
    )]
    NoCollision {
        /// Name of the link.
        link: String,
        /// Links that have collision shapes.
        with: Vec<String>,
    },
    /// A collision shape of a link cannot be used.
    #[error("a collision shape of the link '{link}' cannot be used: {cause}")]
    Collision {
        /// Name of the link.
        link: String,
        /// Reason, as text, with the suggested fix if there is one.
        cause: String,
    },
    /// The distance between two shapes is not available: both are half-spaces, or the middle circle of a
    /// torus intersects the other shape (for a capsule, its axis; for a torus, its middle circle).
    #[error("the distance between {} and {} is not available, because {}", .0.a, .0.b, unavailable(.0))]
    Unavailable(Box<PosedPair>),
    /// The distance between two shapes was not found.
    #[error(
        "the distance between {a} at {at_a} m and {b} at {at_b} m was not found{gap}; change one of the \
         shapes slightly, and report the failure with both shapes and poses",
        a = pair.a, b = pair.b, at_a = position(&pair.pose_a), at_b = position(&pair.pose_b), gap = gap_text(*gap)
    )]
    NotConverged {
        /// Kinds and poses of the two shapes.
        pair: Box<PosedPair>,
        /// Difference between the lower and the upper bound, m; NaN if no normal was found.
        gap: f64,
    },
}

/// Returns the reason why the distance between two shapes is not available, with the suggested fix.
fn unavailable(pair: &PosedPair) -> &'static str {
    match (pair.a, pair.b) {
        ("a half-space", "a half-space") => "both are unbounded; replace one of them by a box",
        _ => "the centre line of the tube of the torus intersects the other shape; move the shapes apart",
    }
}

/// Returns the part of a message that states the difference between the bounds, m, of a distance that did not
/// converge, or that there is no such difference.
fn gap_text(gap: f64) -> String {
    match gap.is_nan() {
        true => ", because the computation found no normal between them".to_owned(),
        false => format!(": its lower and upper bounds still differ by {} m", short(gap)),
    }
}

/// Returns the position of the origin of a shape, m, as text.
fn position(pose: &Pose) -> String {
    list(&[pose.pos.x, pose.pos.y, pose.pos.z])
}

/// Returns the part of a message that lists the links with collision shapes.
fn links_with(links: &[String]) -> String {
    match links.len() {
        0 => "; no link of the robot has one".to_owned(),
        1..=12 => format!(", or use one of the links that have one: {}", links.join(", ")),
        count => format!(", or use one of the {count} links that have one"),
    }
}
