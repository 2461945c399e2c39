//! Contact points of two shapes.
//!
//! The surfaces that face each other along the normal `n` are reduced to features: a face, a line on a round
//! surface, or a point. Their common part, as seen along `n`, is a polygon or a segment. Its corners are the
//! contact points, each with the depth `x_i` of the overlap there. With `g(s) = (1 − s²)²` below `s = 1` and
//! 0 above, and slopes relative to `TILT`, the weights are `w = f a + (1 − f) e`:
//!
//! - `a_i` by area: `Σ a_i x_i` is the mean depth of the patch ([`weights`](super::polygon::weights)). These
//!   weights are continuous where the patch gains or loses a corner. A box that lies on a plane has `a_i =
//!   1/4`.
//! - `f = g(slope of the patch)`: the face loses its weight to its deepest edges and corner as the face
//!   tilts.
//! - `e_i` by edges: an edge of length `l` gives `½ l h` to each of its ends, and the sum is scaled to the
//!   largest `h` of all edges; the deepest corner has the rest. `h = g(slope of the edge) g(s)`, with the
//!   height `s` of the edge above the deepest corner, relative to `TILT` times the extent of the patch.
//!
//! The weights sum to 1 and are continuous in the pose where the normal is, except where a body rolls from a
//! face to a neighbour with almost the same normal. The contact points of two lines are the ends of their
//! common part, with weights that decrease with the angle between the lines and their slope; the witness
//! points, where the lines cross, receive the rest.

use super::closest::{check, check_pose, nearest_pieces};
use super::error::GeometryError;
use super::feature::Feature;
use super::patch::{ContactPoint, contact_points, witness};
use super::pose::Pose;
use super::proximity::Proximity;
use super::shape::Shape;

/// Contact points of two shapes.
#[derive(Clone, Debug, PartialEq)]
pub struct Manifold {
    /// Distance, witness points and normal of the shapes.
    pub proximity: Proximity,
    /// Contact points with positive weights: 1 to 8 for the usual shapes, more between faces with many corners.
    pub points: Vec<ContactPoint>,
}

/// Returns the contact points of two shapes, in common axes; for a compound, the contact points of its
/// nearest piece.
///
/// # Errors
/// The errors of [`closest`](super::closest()).
pub fn manifold(a: &Shape, pose_a: &Pose, b: &Shape, pose_b: &Pose) -> Result<Manifold, GeometryError> {
    check(a, pose_a)?;
    check(b, pose_b)?;
    let (proximity, points) = touching_points(a, pose_a, b, pose_b)?;
    Ok(Manifold { proximity, points: points.as_slice().to_vec() })
}

/// Contact points of a pair of shapes. A sphere has a single one.
#[derive(Clone, Debug)]
pub(crate) enum Points {
    /// Single contact point, formed by the witness points.
    One([ContactPoint; 1]),
    /// Corners of the common part of two features.
    Many(Vec<ContactPoint>),
}

impl Points {
    pub(crate) fn as_slice(&self) -> &[ContactPoint] {
        match self {
            Self::One(points) => points,
            Self::Many(points) => points,
        }
    }
}

/// Returns the distance and the contact points of two shapes whose dimensions have been checked, without
/// allocating memory for the single point of a sphere.
///
/// # Errors
/// The errors of [`closest`](super::closest()), except those for dimensions.
#[inline]
pub(crate) fn touching_points(
    a: &Shape,
    pose_a: &Pose,
    b: &Shape,
    pose_b: &Pose,
) -> Result<(Proximity, Points), GeometryError> {
    check_pose(a, pose_a)?;
    check_pose(b, pose_b)?;
    let (proximity, [(a, pose_a), (b, pose_b)]) = nearest_pieces(a, pose_a, b, pose_b)?;
    if matches!((a, b), (Shape::Sphere { .. }, _) | (_, Shape::Sphere { .. })) {
        return Ok((proximity, Points::One([witness(&proximity, 1.0)])));
    }
    let feature_a = Feature::of(a, &pose_a, proximity.point_a, proximity.normal);
    let feature_b = Feature::of(b, &pose_b, proximity.point_b, -proximity.normal);
    Ok((proximity, Points::Many(contact_points(&proximity, &feature_a, &feature_b))))
}
