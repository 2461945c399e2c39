//! Contact points of two shapes.
//!
//! The surfaces that face each other along the normal `n` are reduced to features: a face, a line on a
//! round surface, or a point. Their common part is a polygon or a segment. Its corners are the contact
//! points, each with the depth `x_i` of the overlap there. With `g(s) = (1 − s²)²` below `s = 1` and 0
//! above, the weights of the common part of two faces are `w_i ∝ a_i g(s_i)`:
//!
//! - `a_i` follows from the angle at the corner, such that the weighted mean of the corners is the
//!   centroid. A box that lies on a plane has `a_i = 1/4`. If a corner splits into two, both share its
//!   weight; a point on an edge has none.
//! - `s_i` is the largest slope from the corner to a deeper one, relative to `TILT`. As the face tilts, its
//!   weight passes to its deepest edge and corner.
//!
//! The common part is seen along the bisector of the normals of both faces, and the depth of the deepest
//! corner is that of the shapes. Depths and weights are therefore functions of the pose without jumps where
//! `n` changes from one face to the other, and each point has their gradients. Jumps remain where a body
//! rolls from a face to a neighbour with almost the same normal, and where the direction of the least depth
//! changes by a large angle between two pairs of parallel faces.
//!
//! The contact points of a line on a round surface and a face are the ends of their common part, with weights
//! that depend on its slope. Those of two lines are the ends of their common part, with weights that decrease
//! with the angle between the lines and with their slope; the witness points receive the rest. All these
//! points are treated as fixed to the shapes: their gradients do not include their sliding.

use super::closest::{check, check_pose, nearest_pieces};
use super::contact_point::{ContactPoint, witness};
use super::error::GeometryError;
use super::feature::Feature;
use super::patch::contact_points;
use super::pose::Pose;
use super::proximity::Proximity;
use super::shape::Shape;
use std::borrow::Cow;

/// Contact points of two shapes.
#[derive(Clone, Debug, PartialEq)]
pub struct Manifold {
    /// Distance, witness points and normal of the shapes.
    pub proximity: Proximity,
    /// Contact points, at least one, with positive weights.
    pub points: Vec<ContactPoint>,
}

/// Returns the contact points of two shapes, in common axes; for a compound, those of its nearest piece.
///
/// # Errors
/// The errors of [`closest`](super::closest()).
pub fn manifold(a: &Shape, pose_a: &Pose, b: &Shape, pose_b: &Pose) -> Result<Manifold, GeometryError> {
    check(a, pose_a)?;
    check(b, pose_b)?;
    let (proximity, points) = touching_points(a, pose_a, b, pose_b)?;
    let points = match points {
        Points::Witness => vec![witness(&proximity, 1.0)],
        Points::Many(points) => points,
    };
    Ok(Manifold { proximity, points })
}

/// Contact points of a pair of shapes.
#[derive(Clone, Debug)]
pub(crate) enum Points {
    /// The pair of witness points, which is used if a shape is a sphere or if the shapes exert no force on each
    /// other.
    Witness,
    /// Contact points computed from the features of the shapes that face each other.
    Many(Vec<ContactPoint>),
}

impl Points {
    /// Returns the list of points. For [`Points::Witness`], it consists of the pair of witness points in
    /// `proximity`.
    pub(crate) fn list(&self, proximity: &Proximity) -> Cow<'_, [ContactPoint]> {
        match self {
            Self::Witness => Cow::Owned(vec![witness(proximity, 1.0)]),
            Self::Many(points) => Cow::Borrowed(points),
        }
    }

    /// Returns the same points with the gradients of points that are fixed to both shapes and have
    /// constant weights.
    pub(crate) fn fixed(mut self, proximity: &Proximity) -> Self {
        if let Self::Many(points) = &mut self {
            for point in points {
                *point =
                    ContactPoint::new(proximity, [point.point_a, point.point_b], point.depth, point.weight);
            }
        }
        self
    }
}

/// Returns the distance and the contact points of two shapes whose dimensions have been checked.
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
        return Ok((proximity, Points::Witness));
    }
    let feature_a = Feature::of(a, &pose_a, proximity.point_a, proximity.normal);
    let feature_b = Feature::of(b, &pose_b, proximity.point_b, -proximity.normal);
    Ok((proximity, Points::Many(contact_points(&proximity, &feature_a, &feature_b))))
}
