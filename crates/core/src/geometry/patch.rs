//! Common part of two features, as seen along the normal, and its contact points.

use super::contact_point::{ContactPoint, TILT, witness};
use super::feature::Feature;
use super::gradient::face_points;
use super::polygon::{Point, clip, weights};
use super::projection::Projection;
use super::proximity::Proximity;
use crate::spatial::Vec3;

/// Returns the contact points of two features. If a feature is a point or the features have no common
/// part, these are the witness points.
pub(super) fn contact_points(proximity: &Proximity, a: &Feature, b: &Feature) -> Vec<ContactPoint> {
    let is_plane = |feature: &Feature| matches!(feature, Feature::Face { .. } | Feature::Plane);
    if is_plane(a) && is_plane(b) {
        return face_points(proximity, a, b).unwrap_or_else(|| vec![witness(proximity, 1.0)]);
    }
    let plane = Projection::new(proximity);
    let found = match (a, b) {
        (Feature::Segment { ends: p, radius: r }, Feature::Segment { ends: q, radius: s })
            if !plane.is_steep(*p) && !plane.is_steep(*q) =>
        {
            lines(&plane, proximity, *p, *q, r + s)
        }
        (Feature::Segment { .. }, Feature::Segment { .. }) => None,
        _ => overlap(&plane, proximity, a, b),
    };
    found.unwrap_or_else(|| vec![witness(proximity, 1.0)])
}

/// Returns `(1 − s²)²` for `s < 1`, and 0 otherwise.
fn taper(s: f64) -> f64 {
    let left = (1.0 - s * s).max(0.0);
    if s < 1.0 { left * left } else { 0.0 }
}

/// Returns the contact points of a line and a face or a plane; `None` if they have no common part.
fn overlap(plane: &Projection, proximity: &Proximity, a: &Feature, b: &Feature) -> Option<Vec<ContactPoint>> {
    let corners = match (plane.corners(a), plane.corners(b)) {
        (Some(a), Some(b)) if b.len() > 2 => clip(&a, &b),
        (Some(a), Some(b)) => clip(&b, &a),
        (Some(corners), None) if matches!(b, Feature::Plane) => corners,
        (None, Some(corners)) if matches!(a, Feature::Plane) => corners,
        _ => return None,
    };
    if corners.is_empty() {
        return None;
    }
    let height_a: Vec<f64> = corners.iter().map(|p| plane.height(a, *p, 0.0)).collect();
    let height_b: Vec<f64> = corners.iter().map(|p| plane.height(b, *p, plane.distance)).collect();
    let depths: Vec<f64> = height_a.iter().zip(&height_b).map(|(a, b)| a - b).collect();
    let weights = tilted_weights(&corners, &depths);
    let deepest = depths.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // below 1 where the patch does not reach the witness points, as next to the rim of a disc
    let short = (-proximity.distance - deepest).max(0.0);
    let size = (0..corners.len()).map(|i| length(&corners, i)).sum::<f64>();
    let reached = if size > 0.0 { taper(short / (TILT * size)) } else { 0.0 };
    let mut points = Vec::with_capacity(corners.len() + 1);
    for i in (0..corners.len()).filter(|i| reached * weights[*i] > 0.0) {
        let ends = [height_a[i], height_b[i]].map(|height| plane.lift(corners[i], height));
        points.push(ContactPoint::new(proximity, ends, depths[i], reached * weights[i]));
    }
    if reached < 1.0 {
        points.push(witness(proximity, 1.0 - reached));
    }
    Some(points)
}

/// Returns the length, m, of the edge of a polygon from corner `i` to the next corner.
fn length(corners: &[Point], i: usize) -> f64 {
    let (p, q) = (corners[i], corners[(i + 1) % corners.len()]);
    (q[0] - p[0]).hypot(q[1] - p[1])
}

/// Returns the weights of the corners of the common part of a line and a face from the depths at the
/// corners, m. The weights sum to 1. If the depths are equal, the weights are those of [`weights`]; as the
/// slope approaches [`TILT`], the weight passes to the deepest edge and corner.
fn tilted_weights(corners: &[Point], depths: &[f64]) -> Vec<f64> {
    let extent = extent(corners, |i| depths[i]);
    let band = TILT * extent;
    let by_area = weights(corners);
    if extent == 0.0 {
        return by_area;
    }
    let deepest = (0..depths.len()).fold(0, |best, i| if depths[i] > depths[best] { i } else { best });
    let lowest = depths.iter().copied().fold(f64::INFINITY, f64::min);
    let flat = taper((depths[deepest] - lowest) / band);
    let (mut by_edge, mut total, mut most) = (vec![0.0; corners.len()], 0.0, 0.0_f64);
    for i in 0..corners.len() {
        let j = (i + 1) % corners.len();
        let (length, step) = (length(corners, i), (depths[i] - depths[j]).abs());
        let level = if length > 0.0 { taper(step / (TILT * length)) } else { 0.0 };
        let level = level * taper((depths[deepest] - depths[i].max(depths[j])) / band);
        let mass = length * level;
        by_edge[i] += 0.5 * mass;
        by_edge[j] += 0.5 * mass;
        (total, most) = (total + mass, most.max(level));
    }
    by_edge.iter_mut().for_each(|weight| *weight *= if total > 0.0 { most / total } else { 0.0 });
    by_edge[deepest] += if total > 0.0 { 1.0 - most } else { 1.0 };
    let blend = |(area, edge): (&f64, &f64)| flat * area + (1.0 - flat) * edge;
    by_area.iter().zip(&by_edge).map(blend).collect()
}

/// Returns the length of a patch, m, in the direction in which the depth changes most; 0 if the depth is
/// constant. The depth is assumed to be a linear function of the position.
fn extent(corners: &[Point], depth: impl Fn(usize) -> f64) -> f64 {
    // the gradient from the moments of the corners about their mean
    let count = corners.len() as f64;
    let mean = |of: &dyn Fn(usize) -> f64| (0..corners.len()).map(of).sum::<f64>() / count;
    let (x, y, d) = (mean(&|i| corners[i][0]), mean(&|i| corners[i][1]), mean(&depth));
    let moment = |f: &dyn Fn(usize) -> f64, g: &dyn Fn(usize) -> f64| mean(&|i| f(i) * g(i));
    let (dx, dy, dd) = (|i: usize| corners[i][0] - x, |i: usize| corners[i][1] - y, |i: usize| depth(i) - d);
    let (xx, xy, yy) = (moment(&dx, &dx), moment(&dx, &dy), moment(&dy, &dy));
    let (xd, yd) = (moment(&dx, &dd), moment(&dy, &dd));
    let determinant = xx * yy - xy * xy;
    let gradient = if determinant > 1e-14 * (xx + yy) * (xx + yy) {
        [(yy * xd - xy * yd) / determinant, (xx * yd - xy * xd) / determinant]
    } else {
        [xd, yd] // a line: its direction
    };
    let slope = gradient[0].hypot(gradient[1]);
    if slope == 0.0 {
        return 0.0;
    }
    let along = |p: &Point| (p[0] * gradient[0] + p[1] * gradient[1]) / slope;
    let (low, high) = corners
        .iter()
        .map(along)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), s| (low.min(s), high.max(s)));
    high - low
}

/// Returns the contact points of two lines on round surfaces whose radii have the sum `radius`, m: the
/// ends of their common part along the mean direction of both, and the witness points, which receive the
/// remaining weight; `None` if the lines have no common part.
fn lines(
    plane: &Projection,
    proximity: &Proximity,
    a: [Vec3<f64>; 2],
    mut b: [Vec3<f64>; 2],
    radius: f64,
) -> Option<Vec<ContactPoint>> {
    if (a[1] - a[0]).dot(b[1] - b[0]) < 0.0 {
        b.swap(0, 1);
    }
    let level = |line: [Vec3<f64>; 2]| {
        let along = line[1] - line[0];
        let along = proximity.normal.scale_add(-along.dot(proximity.normal), along);
        along * (1.0 / along.norm())
    };
    let sum = level(a) + level(b);
    let axis = sum * (1.0 / sum.norm());
    let ends = |line: [Vec3<f64>; 2]| line.map(|p| (p - plane.origin).dot(axis));
    let ([low_a, high_a], [low_b, high_b]) = (ends(a), ends(b));
    let (low, high) = (low_a.max(low_b), high_a.min(high_b));
    if low.is_nan() || high.is_nan() || low >= high {
        return None;
    }
    let on = |line: [Vec3<f64>; 2], [from, to]: [f64; 2], s: f64| {
        (line[1] - line[0]).scale_add((s - from) / (to - from), line[0])
    };
    let mut points = Vec::with_capacity(3);
    let band = TILT * (high - low);
    let mut lost = 1.0;
    for s in [low, high] {
        let (point_a, point_b) = (on(a, [low_a, high_a], s), on(b, [low_b, high_b], s));
        let apart = point_a - point_b;
        let height = apart.dot(proximity.normal);
        let aside = proximity.normal.scale_add(-height, apart).norm();
        let depth = height - 0.5 * aside * aside / radius;
        let weight = 0.5 * taper(aside / band) * taper((-proximity.distance - depth).max(0.0) / band);
        lost -= weight;
        if weight > 0.0 {
            let ends = [point_a, proximity.normal.scale_add(-depth, point_a)];
            points.push(ContactPoint::new(proximity, ends, depth, weight));
        }
    }
    if lost > 0.0 {
        points.push(witness(proximity, lost));
    }
    Some(points)
}
