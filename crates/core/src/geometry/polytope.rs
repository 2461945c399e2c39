//! Convex polytope with triangular faces that grows by one vertex at a time.

use crate::spatial::Vec3;

/// Triangle of a polytope, counterclockwise as seen from outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    /// Indices of the vertices.
    pub(super) corners: [usize; 3],
    /// For each edge, from corner `i` to corner `i + 1`, the index of the triangle on its other side.
    pub(super) neighbors: [usize; 3],
    /// Outward unit normal.
    pub(super) normal: Vec3<f64>,
    /// Distance of the plane from the origin along the normal, m.
    pub(super) offset: f64,
    /// False once the triangle has been replaced.
    pub(super) is_alive: bool,
    /// True if the corners are collinear to within rounding errors; the normal is then set to zero.
    pub(super) is_flat: bool,
}

/// Convex polytope with triangular faces. The list of triangles includes those that were replaced.
#[derive(Default)]
pub(super) struct Polytope {
    pub(super) points: Vec<Vec3<f64>>,
    pub(super) triangles: Vec<Triangle>,
    visible: Vec<usize>,
}

/// Sine of the angle between the two shorter edges of a triangle at or below which its normal is
/// undefined.
const FLAT: f64 = 1e-14;

impl Polytope {
    /// Starts the polytope with the tetrahedron of four points; returns false if they lie in a plane.
    pub(super) fn start(&mut self, points: [Vec3<f64>; 4]) -> bool {
        let [a, b, c, d] = points;
        let volume = (b - a).cross(c - a).dot(d - a);
        if volume == 0.0 || volume.is_nan() {
            return false;
        }
        self.points.clear();
        self.triangles.clear();
        self.points.extend(if volume < 0.0 { [a, b, c, d] } else { [a, c, b, d] });
        self.push([0, 1, 2], [1, 2, 3]);
        self.push([1, 0, 3], [0, 3, 2]);
        self.push([2, 1, 3], [0, 1, 3]);
        self.push([0, 2, 3], [0, 2, 1]);
        true
    }

    /// Returns the height of a point above the plane of a triangle, m.
    pub(super) fn height(&self, triangle: usize, point: Vec3<f64>) -> f64 {
        let face = &self.triangles[triangle];
        face.normal.dot(point - self.points[face.corners[0]])
    }

    /// Adds a point that is outside the triangle `seed`. This triangle and all triangles connected to it
    /// are replaced if the point is more than `tolerance`, m, above their planes, or if they are flat.
    /// Returns the index of the first new triangle, or `None` if rounding has made the boundary of the
    /// replaced triangles ambiguous.
    pub(super) fn add(&mut self, point: Vec3<f64>, seed: usize, tolerance: f64) -> Option<usize> {
        let apex = self.points.len();
        self.points.push(point);
        let first = self.triangles.len();
        self.visible.clear();
        self.visible.push(seed);
        self.triangles[seed].is_alive = false;
        let mut next = 0;
        while let Some(&triangle) = self.visible.get(next) {
            next += 1;
            for neighbor in self.triangles[triangle].neighbors {
                if !self.triangles[neighbor].is_alive {
                    continue;
                }
                if self.triangles[neighbor].is_flat || self.height(neighbor, point) > tolerance {
                    self.triangles[neighbor].is_alive = false;
                    self.visible.push(neighbor);
                }
            }
        }
        for index in 0..self.visible.len() {
            let Triangle { corners, neighbors, .. } = self.triangles[self.visible[index]];
            for edge in 0..3 {
                let neighbor = neighbors[edge];
                if self.triangles[neighbor].is_alive {
                    let new = self.triangles.len();
                    let (from, to) = (corners[edge], corners[(edge + 1) % 3]);
                    self.push([from, to, apex], [neighbor, usize::MAX, usize::MAX]);
                    let there = (0..3).find(|i| self.triangles[neighbor].corners[*i] == to)?;
                    self.triangles[neighbor].neighbors[there] = new;
                }
            }
        }
        self.join(first)?;
        Some(first)
    }

    /// Connects the new triangles, from `first` on, around their common vertex. Returns `None` if their
    /// order is ambiguous or there are fewer than three.
    fn join(&mut self, first: usize) -> Option<()> {
        for index in first..self.triangles.len() {
            let to = self.triangles[index].corners[1];
            let mut following = (first..self.triangles.len()).filter(|i| self.triangles[*i].corners[0] == to);
            let next = following.next()?;
            if following.next().is_some() {
                return None;
            }
            self.triangles[index].neighbors[1] = next;
            self.triangles[next].neighbors[2] = index;
        }
        (first + 2 < self.triangles.len()).then_some(())
    }

    fn push(&mut self, corners: [usize; 3], neighbors: [usize; 3]) {
        let [a, b, c] = corners.map(|i| self.points[i]);
        let edges = [b - a, c - b, a - c];
        // the cross product of the two shortest edges has the smallest rounding error
        let longest = (0..3).fold(0, |l, i| if edges[i].norm() > edges[l].norm() { i } else { l });
        let (u, v) = (edges[(longest + 1) % 3], edges[(longest + 2) % 3]);
        let normal = u.cross(v);
        let length = normal.norm();
        let is_flat = length <= FLAT * u.norm() * v.norm();
        let normal = if is_flat { Vec3::zero() } else { normal * (1.0 / length) };
        let offset = normal.dot(a);
        self.triangles.push(Triangle { corners, neighbors, normal, offset, is_alive: true, is_flat });
    }
}
