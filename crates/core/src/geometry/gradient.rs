//! Contact points of two plane faces, with the gradients of depths and weights.

use super::contact_point::{ContactPoint, witness};
use super::dual::{Dual, Number};
use super::facets::{Corner, Facet, Patch, Vector, patch};
use super::feature::Feature;
use super::proximity::Proximity;
use crate::spatial::{Force, Vec3};

/// Difference in height between a corner and a witness point, relative to their distance, below which both
/// count as equally deep.
const LEVEL: f64 = 1e-10;

/// Sine of the angle between two normals below which they count as equal.
const PARALLEL: f64 = 1e-9;

/// Returns the contact points of two plane faces, discs or half-spaces; `None` for other features and for
/// faces without a common part. The depth of the deepest corner is that of the shapes, and the differences
/// between the depths are those between the faces. If the common part is narrower than the depth, the
/// witness points are added. If it has a single corner or no width, the result is the witness points alone.
pub(super) fn face_points(proximity: &Proximity, a: &Feature, b: &Feature) -> Option<Vec<ContactPoint>> {
    let flat = common::<f64>(proximity, a, b)?;
    let depth = -proximity.distance;
    if flat.corners.len() == 1 || part(flat.width, depth) == 0.0 {
        return Some(vec![witness(proximity, 1.0)]);
    }
    let Patch { corners, width } = common::<Dual>(proximity, a, b)?;
    let deepest = corners
        .iter()
        .fold(&corners[0], |best, corner| if best.depth.is_below(corner.depth) { corner } else { best });
    let depth = depth_at(proximity, [a, b], deepest);
    let part = part(width, depth);
    let point = |corner: &Corner<Dual>| {
        let depth = depth - (deepest.depth - corner.depth);
        let weight = part * corner.weight;
        let [p, q] = corner.points.map(values);
        let middle = proximity.center() + (p + q) * 0.5;
        ContactPoint {
            point_a: proximity.normal.scale_add(0.5 * depth.value, middle),
            point_b: proximity.normal.scale_add(-0.5 * depth.value, middle),
            depth: depth.value,
            weight: weight.value,
            depth_gradient: Force::from_slice(&depth.slopes),
            weight_gradient: Force::from_slice(&weight.slopes),
        }
    };
    let mut points: Vec<_> = corners.iter().map(point).collect();
    if part.value < 1.0 {
        let rest = witness(proximity, 1.0 - part.value);
        let weight_gradient = Force::from_slice(&part.slopes.map(|slope| -slope));
        points.push(ContactPoint {
            depth_gradient: Force::from_slice(&depth.slopes),
            weight_gradient,
            ..rest
        });
    }
    Some(points)
}

/// Returns the part of the weight that a patch receives: 1 if its `width`, m, is at least the `depth`, m, or
/// if the shapes are apart; otherwise `x² (3 − 2x)` with the ratio `x` of width to depth.
///
/// The edges of a narrow patch are as deep as the patch is wide. Seen along the bisector of the faces, such a
/// patch may vanish while the shapes still overlap; only the witness points then remain.
fn part<N: Number>(width: N, depth: N) -> N {
    if depth.value() <= 0.0 || width.value() >= depth.value() {
        return N::of(1.0);
    }
    let x = width / depth;
    x * x * (N::of(3.0) - x * N::of(2.0))
}

fn values(p: Vector<Dual>) -> Vec3<f64> {
    Vec3::new(p[0].value, p[1].value, p[2].value)
}

/// Returns the common part of two faces, relative to the middle of the witness points, with derivatives
/// with respect to displacements of the second shape; `None` for other features and for faces without a
/// common part.
fn common<N: Number>(proximity: &Proximity, a: &Feature, b: &Feature) -> Option<Patch<N>> {
    let normal = proximity.normal;
    let place_a = |p: Vec3<f64>| fixed(p - proximity.center());
    let place_b = |p: Vec3<f64>| moving(p - proximity.center(), true);
    let turn_b = |d: Vec3<f64>| moving(d, false);
    let (plane_a, plane_b) = ((proximity.point_a, normal), (proximity.point_b, -normal));
    let (normal_a, normal_b) = (fixed(face_normal(a, normal)), turn_b(face_normal(b, -normal)));
    let a = Facet::of(a, plane_a, place_a, fixed, normal_b)?;
    let b = Facet::of(b, plane_b, place_b, turn_b, normal_a)?;
    patch(&a, &b)
}

fn face_normal(feature: &Feature, other: Vec3<f64>) -> Vec3<f64> {
    match feature {
        Feature::Face { normal, .. } => *normal,
        _ => other,
    }
}

fn fixed<N: Number>(v: Vec3<f64>) -> Vector<N> {
    [v.x, v.y, v.z].map(N::of)
}

/// Returns a vector of the second shape with its derivatives with respect to displacements of this shape:
/// translations, if it is a point, and rotations about the origin.
fn moving<N: Number>(v: Vec3<f64>, is_point: bool) -> Vector<N> {
    let shift = f64::from(u8::from(is_point));
    [
        N::new(v.x, [shift, 0.0, 0.0, 0.0, v.z, -v.y]),
        N::new(v.y, [0.0, shift, 0.0, -v.z, 0.0, v.x]),
        N::new(v.z, [0.0, 0.0, shift, v.y, -v.x, 0.0]),
    ]
}

/// Returns the depth of the shapes, m, with its derivatives, which are those of the distance between the
/// supporting planes at the witness points with the opposite sign.
///
/// On a face, the `deepest` corner replaces the witness point, because any point of an edge that lies flat on
/// the face may be the witness point.
fn depth_at(proximity: &Proximity, [a, b]: [&Feature; 2], deepest: &Corner<Dual>) -> Dual {
    let Proximity { distance, normal, .. } = *proximity;
    let is_on = |feature, side: f64| normal.cross(face_normal(feature, normal * side)).norm() < PARALLEL;
    let [p, q] = deepest.points.map(values);
    let (apart_a, apart_b) =
        (proximity.point_a - proximity.center() - p, proximity.point_b - proximity.center() - q);
    let level = LEVEL * (p.norm() + q.norm());
    let arm = if is_on(a, 1.0) && normal.dot(apart_b) >= -level {
        q
    } else if is_on(b, -1.0) && normal.dot(apart_a) <= level {
        p
    } else {
        Vec3::zero()
    };
    let turning = normal.cross(arm);
    let slopes = [-normal.x, -normal.y, -normal.z, turning.x, turning.y, turning.z];
    Dual { value: -distance, slopes }
}
