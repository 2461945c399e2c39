//! Direction of the least translation that separates overlapping convex shapes, by the expanding polytope
//! algorithm (EPA).

use super::polytope::Polytope;
use crate::spatial::Vec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Difference between the upper and lower bounds of the depth at which the iteration ends, relative to the
/// size of the set.
const CONVERGED: f64 = 1e-10;

/// Height of a point above a triangle below which the triangle is not visible from the point, relative to the
/// size of the set.
const LEVEL: f64 = 1e-14;

/// Largest number of steps, after which the best direction so far is returned. This occurs if the depth is
/// nearly the same in many directions.
const STEPS: usize = 400;

/// Distance of a triangle from the origin, and the index of the triangle. The nearest triangle is the
/// greatest entry.
#[derive(PartialEq)]
struct Entry(f64, usize);

impl Eq for Entry {}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        other.0.total_cmp(&self.0).then(other.1.cmp(&self.1))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Returns the unit vector `n` for which the support function `s(n)ᵀ n` of a convex set is least; `None` if
/// the set is flat or a coordinate is not finite. `farthest` returns `s(d)`, the farthest point of the set in
/// the direction `d`. The iteration ends when the bounds of the minimum agree within [`CONVERGED`], or
/// earlier with the best direction found so far, because of rounding or after [`STEPS`] steps.
///
/// The polytope inside the set is extended at the triangle whose plane has the least signed distance from the
/// origin. This distance is a lower bound of the minimum; the support function in the direction of the normal
/// of the triangle is an upper bound.
pub(super) fn least_support(farthest: impl Fn(Vec3<f64>) -> Vec3<f64>) -> Option<Vec3<f64>> {
    let mut polytope = Polytope::default();
    if !polytope.start(spread(&farthest)?) {
        return None;
    }
    let scale = polytope.points.iter().map(|p| p.norm()).fold(0.0, f64::max);
    let mut queue = BinaryHeap::new();
    let (mut best, mut new) = ((f64::INFINITY, None), 0);
    for _ in 0..STEPS {
        for (index, triangle) in polytope.triangles.iter().enumerate().skip(new) {
            if !triangle.is_flat {
                queue.push(Entry(triangle.offset, index));
            }
        }
        while queue.peek().is_some_and(|entry| !polytope.triangles[entry.1].is_alive) {
            queue.pop();
        }
        let Some(&Entry(below, nearest)) = queue.peek() else { break };
        let normal = polytope.triangles[nearest].normal;
        let point = farthest(normal);
        let above = point.dot(normal);
        if above < best.0 {
            best = (above, Some(normal));
        }
        if best.0 - below <= CONVERGED * scale || polytope.height(nearest, point) <= LEVEL * scale {
            break;
        }
        match polytope.add(point, nearest, LEVEL * scale) {
            Some(first) => new = first,
            None => break,
        }
    }
    best.1
}

/// Returns four points of the set that span a tetrahedron, which is flat if the set is; `None` if a
/// coordinate is not finite.
fn spread(farthest: &impl Fn(Vec3<f64>) -> Vec3<f64>) -> Option<[Vec3<f64>; 4]> {
    let x = Vec3::new(1.0, 0.0, 0.0);
    let (a, b) = (farthest(x), farthest(-x));
    let axis = b - a;
    // the coordinate axis that is most nearly perpendicular to the edge
    let across =
        if axis.y.abs() <= axis.z.abs() { Vec3::new(0.0, 1.0, 0.0) } else { Vec3::new(0.0, 0.0, 1.0) };
    let c = farther(farthest, axis.cross(across), a);
    let d = farther(farthest, axis.cross(c - a), a);
    let is_finite = [a, b, c, d].iter().all(|p| p.norm().is_finite());
    is_finite.then_some([a, b, c, d])
}

/// Returns the farthest point along `d` or along `−d`: the one that is farther from `from`, measured along
/// `d`.
fn farther(farthest: &impl Fn(Vec3<f64>) -> Vec3<f64>, d: Vec3<f64>, from: Vec3<f64>) -> Vec3<f64> {
    let (p, q) = (farthest(d), farthest(-d));
    if (p - from).dot(d) >= (from - q).dot(d) { p } else { q }
}
