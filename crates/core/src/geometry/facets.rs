//! Common part of two plane faces, as seen along the bisector of their normals, with the gradients of
//! depths and weights.

use super::contact_point::TILT;
use super::dual::Number;
use super::feature::{DISC_CORNERS, Feature};
use super::polygon::{Point, clip};
use crate::spatial::Vec3;
use std::f64::consts::TAU;

/// Fraction of the perimeter of a patch that is added to the distance between two corners to compute the
/// slope between them. Without it, the weight would jump where a corner splits into two.
const SPREAD: f64 = 0.01;

/// Largest angle, rad, between two edges that count as one line, and largest distance, relative to the
/// perimeter, of two corners that count as one.
const SAME: f64 = 1e-7;

/// Smallest factor by which the weight that follows from the angle of a corner is multiplied.
const LEAST: f64 = 0.1;

/// Vector of numbers with or without derivatives.
pub(super) type Vector<N> = [N; 3];

pub(super) fn dot<N: Number>(a: Vector<N>, b: Vector<N>) -> N {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn scaled<N: Number>(a: Vector<N>, s: N) -> Vector<N> {
    a.map(|x| x * s)
}

fn sum<N: Number>(a: Vector<N>, b: Vector<N>) -> Vector<N> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn less<N: Number>(a: Vector<N>, b: Vector<N>) -> Vector<N> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross<N: Number>(a: Vector<N>, b: Vector<N>) -> Vector<N> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit<N: Number>(a: Vector<N>) -> Option<Vector<N>> {
    let length = dot(a, a).sqrt();
    (length.value() > 0.0).then(|| scaled(a, N::of(1.0) / length))
}

/// Plane face of a body, or the surface of a half-space.
pub(super) struct Facet<N> {
    /// Corners counterclockwise about the normal; empty for a half-space.
    corners: Vec<Vector<N>>,
    /// Point of the plane.
    point: Vector<N>,
    /// Unit normal, away from the body.
    normal: Vector<N>,
}

impl<N: Number> Facet<N> {
    /// Returns the face of a feature; `None` for features without a face. `plane` is a point of the surface
    /// and the normal of a half-space. `place` and `turn` convert points and directions to vectors of
    /// numbers, and `other` is the normal of the other face.
    pub(super) fn of(
        feature: &Feature,
        plane: (Vec3<f64>, Vec3<f64>),
        place: impl Fn(Vec3<f64>) -> Vector<N>,
        turn: impl Fn(Vec3<f64>) -> Vector<N>,
        other: Vector<N>,
    ) -> Option<Self> {
        match feature {
            Feature::Plane => {
                Some(Self { corners: Vec::new(), point: place(plane.0), normal: turn(plane.1) })
            }
            Feature::Face { corners, normal, disc: None } => Some(Self {
                corners: corners.iter().map(|p| place(*p)).collect(),
                point: place(corners[0]),
                normal: turn(*normal),
            }),
            Feature::Face { corners, normal, disc: Some((center, radius)) } => {
                let (center, axis) = (place(*center), turn(*normal));
                let level = less(scaled(axis, dot(axis, other)), other);
                let away = if dot(level, level).value() > 1e-24 {
                    unit(level)?
                } else {
                    unit(less(place(corners[0]), center))?
                };
                let side = cross(axis, away);
                let corner = |k: u32| {
                    let (sine, cosine) = (TAU * f64::from(k) / f64::from(DISC_CORNERS)).sin_cos();
                    let out = sum(scaled(away, N::of(radius * cosine)), scaled(side, N::of(radius * sine)));
                    sum(center, out)
                };
                Some(Self { corners: (0..DISC_CORNERS).map(corner).collect(), point: center, normal: axis })
            }
            _ => None,
        }
    }
}

/// Corner of the common part of two faces.
pub(super) struct Corner<N> {
    /// Points of both faces at this corner.
    pub(super) points: [Vector<N>; 2],
    /// Depth of the overlap perpendicular to the faces, m.
    pub(super) depth: N,
    /// Weight; the weights of a patch sum to 1.
    pub(super) weight: N,
}

/// Common part of two faces.
pub(super) struct Patch<N> {
    /// Corners whose weight is positive.
    pub(super) corners: Vec<Corner<N>>,
    /// Area per perimeter, m: half of the width of a narrow patch.
    pub(super) width: N,
}

/// Returns the common part of two faces; `None` if there is none, if both are half-spaces, or if the angle
/// between their normals is less than about 11 degrees.
pub(super) fn patch<N: Number>(a: &Facet<N>, b: &Facet<N>) -> Option<Patch<N>> {
    let along = unit(less(a.normal, b.normal))?;
    let cosine = dot(along, a.normal);
    if cosine.value() < 0.1 {
        return None; // both faces point the same way
    }
    let values = along.map(|x| x.value().abs());
    let least = (0..3).fold(0, |least, i| if values[i] < values[least] { i } else { least });
    let axis = std::array::from_fn(|i| N::of(if i == least { 1.0 } else { 0.0 }));
    let x = unit(cross(along, axis))?;
    let y = cross(along, x);
    let project = |p: &Vector<N>| [dot(*p, x), dot(*p, y)];
    let first: Vec<_> = a.corners.iter().map(project).collect();
    let second: Vec<_> = b.corners.iter().rev().map(project).collect();
    let corners = match (first.is_empty(), second.is_empty()) {
        (false, false) => clip(&second, &first),
        (true, false) => second,
        (false, true) => first,
        (true, true) => return None,
    };
    let corners = simplified(corners);
    if corners.len() < 3 {
        return None;
    }
    let height =
        |facet: &Facet<N>, foot| dot(less(facet.point, foot), facet.normal) / dot(along, facet.normal);
    let feet: Vec<_> = corners.iter().map(|p| sum(scaled(x, p[0]), scaled(y, p[1]))).collect();
    let heights: Vec<_> = feet.iter().map(|foot| [height(a, *foot), height(b, *foot)]).collect();
    let depths: Vec<_> = heights.iter().map(|[a, b]| (*a - *b) * cosine).collect();
    let weights = tilted(&corners, &depths);
    let corner = |i: usize| Corner {
        points: heights[i].map(|height| sum(feet[i], scaled(along, height))),
        depth: depths[i],
        weight: weights[i],
    };
    let width = twice_area(&corners) * N::of(0.5) / perimeter(&corners);
    Some(Patch {
        corners: (0..corners.len()).filter(|i| weights[*i].value() > 0.0).map(corner).collect(),
        width,
    })
}

fn twice_area<N: Number>(corners: &[Point<N>]) -> N {
    let from = |p: Point<N>| [p[0] - corners[0][0], p[1] - corners[0][1]];
    (1..corners.len() - 1).fold(N::of(0.0), |sum, i| {
        let (p, q) = (from(corners[i]), from(corners[i + 1]));
        sum + p[0] * q[1] - p[1] * q[0]
    })
}

fn apart<N: Number>(p: Point<N>, q: Point<N>) -> N {
    let (x, y) = (q[0] - p[0], q[1] - p[1]);
    (x * x + y * y).sqrt()
}

/// Returns a polygon without repeated corners and without corners between two collinear edges; rounding
/// errors would determine the positions of such corners.
fn simplified<N: Number>(mut corners: Vec<Point<N>>) -> Vec<Point<N>> {
    let perimeter = perimeter(&corners).value();
    let is_same = |p: Point<N>, q: Point<N>| apart(p, q).value() <= SAME * perimeter;
    let mut i = 0;
    while i < corners.len() && corners.len() > 2 {
        let count = corners.len();
        let (before, after) = (corners[(i + count - 1) % count], corners[(i + 1) % count]);
        if is_same(corners[i], after) || angle(before, corners[i], after).value() <= SAME {
            corners.remove(i);
            i = i.saturating_sub(1);
        } else {
            i += 1;
        }
    }
    corners
}

fn perimeter<N: Number>(corners: &[Point<N>]) -> N {
    let count = corners.len();
    (0..count).fold(N::of(0.0), |sum, i| sum + apart(corners[i], corners[(i + 1) % count]))
}

/// Returns the angle, rad, by which the boundary of a polygon turns at the corner `p`.
fn angle<N: Number>(before: Point<N>, p: Point<N>, after: Point<N>) -> N {
    let (u, v) = ([p[0] - before[0], p[1] - before[1]], [after[0] - p[0], after[1] - p[1]]);
    let (sine, cosine) = (u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]);
    // d atan2(s, c) = (c ds − s dc)/(s² + c²)
    let (s, c) = (sine.value(), cosine.value());
    let square = s * s + c * c;
    if square == 0.0 {
        return N::of(0.0);
    }
    let change = (sine * N::of(c) - cosine * N::of(s)).function(0.0, 1.0 / square);
    change + N::of(s.atan2(c))
}

/// Returns the weights of the corners of a convex polygon. They sum to 1, and the weighted mean of the
/// corners is the centroid, unless the polygon is almost a line or a factor is raised to [`LEAST`].
///
/// They are `α_i/2π`, with the angle `α_i` by which the boundary turns at the corner `p_i`, times a factor
/// that is linear in the position, `1 + b (p_i − p̄)`, with the mean `p̄ = Σ p_i α_i/2π` and the vector
/// `b` that yields the centroid. If a corner splits into two, the two share its angle; a point on a
/// straight edge has the weight 0.
fn by_angle<N: Number>(corners: &[Point<N>]) -> Vec<N> {
    let count = corners.len();
    let around = |i: usize| [corners[(i + count - 1) % count], corners[i], corners[(i + 1) % count]];
    let angles: Vec<N> = (0..count)
        .map(|i| {
            let [before, p, after] = around(i);
            angle(before, p, after) * N::of(1.0 / TAU)
        })
        .collect();
    let zero = N::of(0.0);
    let total = |f: &dyn Fn(usize) -> N| (0..count).fold(zero, |sum, i| sum + f(i));
    let mean = [0, 1].map(|axis| total(&|i| angles[i] * corners[i][axis]));
    let from = |i: usize, axis: usize| corners[i][axis] - mean[axis];
    let area = |i: usize| {
        let j = (i + 1) % count;
        from(i, 0) * from(j, 1) - from(i, 1) * from(j, 0)
    };
    let twice_area = total(&area);
    let [xx, xy, yy] = [(0, 0), (0, 1), (1, 1)].map(|(k, l)| total(&|i| angles[i] * from(i, k) * from(i, l)));
    let determinant = xx * yy - xy * xy;
    let spread = (xx + yy).value();
    if determinant.value() <= 1e-14 * spread * spread || twice_area.value() <= 1e-14 * spread {
        return angles; // almost a line
    }
    let center = [0, 1].map(|axis| {
        let moment = |i: usize| area(i) * (from(i, axis) + from((i + 1) % count, axis));
        total(&moment) / (twice_area * N::of(3.0))
    });
    let factor =
        [(yy * center[0] - xy * center[1]) / determinant, (xx * center[1] - xy * center[0]) / determinant];
    let weight = |i: usize| {
        let own = N::of(1.0) + factor[0] * from(i, 0) + factor[1] * from(i, 1);
        angles[i] * if own.value() < LEAST { N::of(LEAST) } else { own }
    };
    normalized((0..count).map(weight).collect())
}

fn normalized<N: Number>(weights: Vec<N>) -> Vec<N> {
    let total = weights.iter().fold(N::of(0.0), |sum, weight| sum + *weight);
    weights.into_iter().map(|weight| weight / total).collect()
}

/// Returns the weights of the corners of a patch. They follow from the angles of the corners; a corner has no
/// weight if the slope from it to a deeper corner is [`TILT`] or more.
///
/// `w_i ∝ a_i g(s_i)` with the weight by angle `a_i`, `g(s) = (1 − s²)²` below `s = 1` and 0 above, and the
/// largest slope `s_i = max over j of (x_j − x_i)/(TILT (|p_i − p_j| + r))` between the corners `p` with the
/// depths `x`; `r` is [`SPREAD`] times the perimeter.
fn tilted<N: Number>(corners: &[Point<N>], depths: &[N]) -> Vec<N> {
    let base = by_angle(corners);
    let reach = perimeter(corners) * N::of(SPREAD);
    let weight = |i: usize| {
        let slope =
            |j: usize| (depths[j] - depths[i]) / ((apart(corners[i], corners[j]) + reach) * N::of(TILT));
        let others = (0..corners.len()).filter(|j| *j != i).map(slope);
        let largest = others.fold(N::of(0.0), |most, slope| if most.is_below(slope) { slope } else { most });
        if largest.value() >= 1.0 {
            return N::of(0.0);
        }
        let left = N::of(1.0) - largest * largest;
        base[i] * left * left
    };
    normalized((0..corners.len()).map(weight).collect())
}
