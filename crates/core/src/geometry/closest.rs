//! Distance between two shapes of any kind, computed by a method that depends on the pair.

use super::boundary::signed_distance;
use super::convex;
use super::error::{GeometryError, PosedPair};
use super::pose::Pose;
use super::proximity::Proximity;
use super::segment::{self, Segment};
use super::shape::Shape;
use super::support::support;
use super::torus;
use crate::spatial::Vec3;

/// Returns the signed distance between two shapes, its witness points and its normal, in common axes.
///
/// Spheres (except with a hull), pairs of capsules, and half-spaces have closed forms. For a torus and
/// another shape, the middle circle of the torus (the centre line of its tube) is searched for the nearest
/// point. Other pairs of convex shapes use GJK and EPA. The distance of a compound is that of its nearest or
/// most deeply overlapping piece. The result depends only on the arguments: nothing is stored between calls.
///
/// # Errors
/// [`GeometryError`] if a length or a pose is invalid, or a compound has no pieces; if no method covers the
/// pair, such as two half-spaces or a torus whose middle circle intersects the other shape; and if the bounds
/// of the distance do not converge.
pub fn closest(a: &Shape, pose_a: &Pose, b: &Shape, pose_b: &Pose) -> Result<Proximity, GeometryError> {
    check(a, pose_a)?;
    check(b, pose_b)?;
    nearest_pieces(a, pose_a, b, pose_b).map(|(proximity, _)| proximity)
}

/// Computes the distance between two shapes as [`closest`] does, but without a check of their dimensions, which
/// the caller must have checked.
///
/// # Errors
/// The errors of [`closest`], except those for dimensions.
pub(crate) fn closest_of_valid(
    a: &Shape,
    pose_a: &Pose,
    b: &Shape,
    pose_b: &Pose,
) -> Result<Proximity, GeometryError> {
    check_pose(a, pose_a)?;
    check_pose(b, pose_b)?;
    nearest_pieces(a, pose_a, b, pose_b).map(|(proximity, _)| proximity)
}

/// Checks the dimensions of a shape and its pose.
pub(super) fn check(shape: &Shape, pose: &Pose) -> Result<(), GeometryError> {
    shape.check()?;
    check_pose(shape, pose)
}

/// Checks that the pose of a shape is finite.
pub(super) fn check_pose(shape: &Shape, pose: &Pose) -> Result<(), GeometryError> {
    if pose.is_finite() { Ok(()) } else { Err(GeometryError::Pose { name: shape.name() }) }
}

/// Shape that is not a compound, with its pose in common axes.
pub(super) type Piece<'a> = (&'a Shape, Pose);

/// Returns the least distance, m, over all pairs of pieces of the two shapes, and the nearest pair.
pub(super) fn nearest_pieces<'a>(
    a: &'a Shape,
    pose_a: &Pose,
    b: &'a Shape,
    pose_b: &Pose,
) -> Result<(Proximity, [Piece<'a>; 2]), GeometryError> {
    let mut best: Option<(Proximity, [Piece<'a>; 2])> = None;
    let mut keep = |found: (Proximity, [Piece<'a>; 2])| {
        if best.as_ref().is_none_or(|(least, _)| found.0.distance < least.distance) {
            best = Some(found);
        }
    };
    match (a, b) {
        (Shape::Compound(pieces), _) => {
            for (piece, pose) in pieces.iter() {
                keep(nearest_pieces(piece, &pose_a.compose(pose), b, pose_b)?);
            }
        }
        (_, Shape::Compound(pieces)) => {
            for (piece, pose) in pieces.iter() {
                keep(nearest_pieces(a, pose_a, piece, &pose_b.compose(pose))?);
            }
        }
        _ => return Ok((single(a, pose_a, b, pose_b)?, [(a, *pose_a), (b, *pose_b)])),
    }
    best.ok_or(GeometryError::EmptyCompound)
}

/// Returns the distance between two shapes that are not compounds. The kind that comes first in [`rank`] is the
/// first shape of every method, so that exchanging the shapes exchanges the result.
fn single(a: &Shape, pose_a: &Pose, b: &Shape, pose_b: &Pose) -> Result<Proximity, GeometryError> {
    if rank(a) > rank(b) {
        return Ok(single(b, pose_b, a, pose_a)?.exchanged());
    }
    let pair = || Box::new(PosedPair { a: a.name(), pose_a: *pose_a, b: b.name(), pose_b: *pose_b });
    // in the axes of the first shape, coordinates keep their digits far from the common origin
    let pose = pose_a.relative(pose_b);
    let failed = |gap| GeometryError::NotConverged { pair: pair(), gap };
    let found = match (a, b) {
        (Shape::Sphere { radius }, _) if !matches!(b, Shape::Hull(_)) => sphere(*radius, b, &pose),
        (Shape::Capsule { .. }, Shape::Capsule { .. }) => capsules(a, b, &pose),
        (_, Shape::HalfSpace) => half_space(a, &pose),
        (_, Shape::Torus { major_radius, minor_radius }) => {
            torus::closest(a, (*major_radius, *minor_radius), &pose).map_err(failed)?
        }
        _ if a.is_convex_body() && b.is_convex_body() => Some(convex::closest(a, b, &pose).map_err(failed)?),
        _ => None,
    };
    found.map(|proximity| proximity.in_common(pose_a)).ok_or_else(|| GeometryError::Unavailable(pair()))
}

/// Returns the rank of a kind of shape. The first argument of every method is the shape of lower rank.
fn rank(shape: &Shape) -> usize {
    match shape {
        Shape::Sphere { .. } => 0,
        Shape::Capsule { .. } => 1,
        Shape::Box { .. } => 2,
        Shape::Cylinder { .. } => 3,
        Shape::Cone { .. } => 4,
        Shape::Hull(_) => 5,
        Shape::Torus { .. } => 6,
        Shape::HalfSpace => 7,
        Shape::Compound(_) => 8,
    }
}

/// Returns the distance between a sphere about the origin and `b`: the distance from the centre of the
/// sphere to `b`, less the radius; `None` if `b` is a hull or a compound.
fn sphere(radius: f64, b: &Shape, pose: &Pose) -> Option<Proximity> {
    let nearest = signed_distance(b, pose.to_shape(Vec3::zero()))?;
    let normal = pose.rot * -nearest.normal;
    Some(Proximity {
        distance: nearest.distance - radius,
        point_a: normal * radius,
        point_b: pose.to_common(nearest.point),
        normal,
    })
}

/// Returns the distance between two capsules, which is the distance between their axes less both radii; `None`
/// for other shapes.
fn capsules(a: &Shape, b: &Shape, pose: &Pose) -> Option<Proximity> {
    let (Shape::Capsule { radius: radius_a, half_length }, Shape::Capsule { radius: radius_b, .. }) = (a, b)
    else {
        return None;
    };
    let axis_a = Segment { center: Vec3::zero(), axis: Vec3::new(0.0, 0.0, 1.0), half_length: *half_length };
    let Shape::Capsule { half_length, .. } = b else { return None };
    let axis_b = Segment { center: pose.pos, axis: pose.rot.z, half_length: *half_length };
    let (on_a, on_b, normal) = segment::nearest(axis_a, axis_b);
    Some(Proximity {
        distance: (on_b - on_a).dot(normal) - radius_a - radius_b,
        point_a: normal.scale_add(*radius_a, on_a),
        point_b: normal.scale_add(-radius_b, on_b),
        normal,
    })
}

/// Returns the distance between `a` and a half-space, attained at the point of `a` that lies farthest towards
/// the half-space; `None` if `a` is a half-space too.
fn half_space(a: &Shape, pose: &Pose) -> Option<Proximity> {
    let normal = -pose.rot.z;
    let lowest = support(a, normal)?;
    let distance = (pose.pos - lowest).dot(normal);
    Some(Proximity { distance, point_a: lowest, point_b: normal.scale_add(distance, lowest), normal })
}
