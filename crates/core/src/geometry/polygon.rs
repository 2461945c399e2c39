//! Convex polygons in a plane: intersection, and weights of the corners by area.

use super::dual::Number;

/// Coordinates of a point of the plane, m.
pub(super) type Point<N = f64> = [N; 2];

fn cross<N: Number>(o: Point<N>, a: Point<N>, b: Point<N>) -> N {
    (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])
}

fn between<N: Number>(a: Point<N>, b: Point<N>, t: N) -> Point<N> {
    [t * (b[0] - a[0]) + a[0], t * (b[1] - a[1]) + a[1]]
}

/// Returns the intersection of a convex polygon, or of a segment of two corners, with a convex polygon.
/// The corners of both are in counterclockwise order.
///
/// Source: Sutherland and Hodgman, Communications of the ACM 17(1), 1974.
pub(super) fn clip<N: Number>(subject: &[Point<N>], window: &[Point<N>]) -> Vec<Point<N>> {
    let is_closed = subject.len() > 2;
    let mut corners = subject.to_vec();
    for (k, from) in window.iter().enumerate() {
        let to = window[(k + 1) % window.len()];
        let height: Vec<N> = corners.iter().map(|p| cross(*from, to, *p)).collect();
        let is_inside = |i: usize| height[i].value() >= 0.0;
        let mut kept = Vec::with_capacity(corners.len() + 1);
        for i in 0..corners.len() {
            if is_inside(i) {
                kept.push(corners[i]);
            }
            let next = (i + 1) % corners.len();
            if (next > i || is_closed) && is_inside(i) != is_inside(next) {
                kept.push(between(corners[i], corners[next], height[i] / (height[i] - height[next])));
            }
        }
        corners = kept;
    }
    corners
}

/// Returns the weights of the corners of a convex polygon or a segment. They sum to 1, and the weighted
/// mean of the corners is the centroid.
///
/// The polygon is divided into triangles with the centroid as a common corner. With the area `A_i` of the
/// triangle from corner `i` to `i + 1` and the total area `A`, the weight is `w_i = (A_{i−1} + A_i)/2A`. For
/// any function that is linear on the polygon, `Σ w_i f_i` is its mean. If a corner splits into two, both
/// share its weight, so that the weights are continuous while a patch changes its shape.
pub(super) fn weights(corners: &[Point]) -> Vec<f64> {
    let count = corners.len();
    let next = |i: usize| corners[(i + 1) % count];
    let first = corners[0];
    let (mut twice_area, mut moment) = (0.0, [0.0; 2]);
    for i in 1..count.max(1) {
        let area = cross(first, corners[i], next(i));
        twice_area += area;
        for axis in 0..2 {
            moment[axis] += area * (corners[i][axis] + next(i)[axis] - 2.0 * first[axis]) / 3.0;
        }
    }
    let length = |i: usize| (next(i)[0] - corners[i][0]).hypot(next(i)[1] - corners[i][1]);
    let perimeter: f64 = (0..count).map(length).sum();
    // a line has no area: each edge then gives half of its length to each of its ends
    let is_line = twice_area <= 1e-14 * perimeter * perimeter;
    let center = [first[0] + moment[0] / twice_area, first[1] + moment[1] / twice_area];
    let part = |i: usize| if is_line { length(i) } else { cross(center, corners[i], next(i)).max(0.0) };
    let parts: Vec<f64> = (0..count).map(part).collect();
    let total: f64 = parts.iter().sum();
    if total <= 0.0 {
        return vec![1.0 / count as f64; count];
    }
    (0..count).map(|i| 0.5 * (parts[(i + count - 1) % count] + parts[i]) / total).collect()
}
