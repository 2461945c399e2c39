//! Convex hulls of points.

use super::bounding_sphere::BoundingSphere;
use super::error::GeometryError;
use super::polytope::Polytope;
use crate::spatial::Vec3;

/// Thickness of a set of points, relative to its extent, below which the points count as lying in a plane.
const FLAT: f64 = 1e-9;

/// Height of a point above a face, relative to the extent of the points, below which the point counts as part
/// of the face.
const COPLANAR: f64 = 1e-12;

/// Face of a convex hull.
#[derive(Clone, Debug)]
pub struct Face {
    /// Outward unit normal.
    pub normal: Vec3<f64>,
    /// Indices of the vertices, counterclockwise as seen from outside.
    pub corners: Vec<usize>,
}

/// Convex hull with its vertices and faces.
#[derive(Clone, Debug)]
pub struct Hull {
    vertices: Vec<Vec3<f64>>,
    faces: Vec<Face>,
    bounding_sphere: BoundingSphere,
}

impl Hull {
    /// Returns the convex hull of points, m.
    ///
    /// # Errors
    /// [`GeometryError::Hull`] for fewer than four points, if a coordinate is not finite or too large, or if
    /// the points lie in a plane or are too close to each other.
    pub fn new(points: &[Vec3<f64>]) -> Result<Self, GeometryError> {
        let failed = |cause| GeometryError::Hull { count: points.len(), cause };
        if points.iter().any(|p| !p.norm().is_finite()) {
            return Err(failed("a coordinate is infinite, NaN or too large"));
        }
        if points.len() < 4 {
            return Err(failed("fewer than four"));
        }
        let (first, extent) = spread(points).ok_or_else(|| failed("they lie in a plane"))?;
        let polytope = grown(points, first, COPLANAR * extent)
            .ok_or_else(|| failed("they are too close to each other"))?;
        Ok(Self::from_polytope(&polytope, COPLANAR * extent))
    }

    /// Returns the vertices, m.
    pub fn vertices(&self) -> &[Vec3<f64>] {
        &self.vertices
    }

    /// Returns the faces, with coplanar triangles merged.
    pub fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// Returns the volume, m³.
    pub fn volume(&self) -> f64 {
        let origin = self.vertices[0];
        let cone = |face: &Face| {
            let [first, rest @ ..] = &face.corners[..] else { return 0.0 };
            let part = |pair: &[usize]| {
                let [a, b, c] = [*first, pair[0], pair[1]].map(|corner| self.vertices[corner] - origin);
                a.dot(b.cross(c)) / 6.0
            };
            rest.windows(2).map(part).sum::<f64>()
        };
        self.faces.iter().map(cone).sum()
    }

    /// Returns the vertex, m, that is farthest in the direction `d`.
    pub(super) fn farthest(&self, d: Vec3<f64>) -> Vec3<f64> {
        let mut best = self.vertices[0];
        let mut height = best.dot(d);
        for vertex in &self.vertices[1..] {
            let other = vertex.dot(d);
            if other > height {
                (best, height) = (*vertex, other);
            }
        }
        best
    }

    pub(super) fn bounding_sphere(&self) -> BoundingSphere {
        self.bounding_sphere
    }

    /// Returns the smallest sphere that contains the vertices and has its centre at the centre of their
    /// axis-aligned bounding box.
    fn sphere_around(&self) -> BoundingSphere {
        let axes = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)];
        let middle = axes.map(|axis| 0.5 * (self.farthest(axis).dot(axis) + self.farthest(-axis).dot(axis)));
        let center = Vec3::from_slice(&middle);
        let radius = self.vertices.iter().map(|p| (*p - center).norm()).fold(0.0, f64::max);
        BoundingSphere { center, radius }
    }

    /// Creates the hull of a polytope: merges triangles in the same plane into faces, and omits points
    /// that are not vertices.
    fn from_polytope(polytope: &Polytope, tolerance: f64) -> Self {
        let mut is_taken: Vec<bool> =
            polytope.triangles.iter().map(|triangle| !triangle.is_alive || triangle.is_flat).collect();
        let mut index = vec![usize::MAX; polytope.points.len()];
        let bounding_sphere = BoundingSphere { center: Vec3::zero(), radius: 0.0 };
        let mut hull = Self { vertices: Vec::new(), faces: Vec::new(), bounding_sphere };
        for seed in 0..polytope.triangles.len() {
            if is_taken[seed] {
                continue;
            }
            let mut corners = coplanar(polytope, seed, 8.0 * tolerance, &mut is_taken);
            order(&mut corners, &polytope.points, polytope.triangles[seed].normal);
            for corner in &mut corners {
                if index[*corner] == usize::MAX {
                    index[*corner] = hull.vertices.len();
                    hull.vertices.push(polytope.points[*corner]);
                }
                *corner = index[*corner];
            }
            hull.faces.push(Face { normal: polytope.triangles[seed].normal, corners });
        }
        hull.bounding_sphere = hull.sphere_around();
        hull
    }
}

/// Returns the indices of four points that span a tetrahedron, and the extent of the points, m; `None` if the
/// points lie in a plane.
fn spread(points: &[Vec3<f64>]) -> Option<([usize; 4], f64)> {
    let farthest = |from: &dyn Fn(Vec3<f64>) -> f64| {
        (0..points.len()).max_by(|i, j| from(points[*i]).total_cmp(&from(points[*j])))
    };
    let a = farthest(&|p| (p - points[0]).norm())?;
    let b = farthest(&|p| (p - points[a]).norm())?;
    let axis = points[b] - points[a];
    let extent = axis.norm();
    let c = farthest(&|p| (p - points[a]).cross(axis).norm())?;
    let normal = axis.cross(points[c] - points[a]);
    let d = farthest(&|p| (p - points[a]).dot(normal).abs())?;
    let area = normal.norm();
    let thickness = (points[d] - points[a]).dot(normal).abs() / area;
    (area > FLAT * extent * extent && thickness > FLAT * extent).then_some(([a, b, c, d], extent))
}

/// Returns the polytope that results when the farthest points outside its faces are added to the
/// tetrahedron `first` until no point is more than `tolerance`, m, outside; `None` if rounding errors
/// prevent this.
fn grown(points: &[Vec3<f64>], first: [usize; 4], tolerance: f64) -> Option<Polytope> {
    let mut polytope = Polytope::default();
    if !polytope.start(first.map(|i| points[i])) {
        return None;
    }
    // points outside each triangle
    let mut outside: Vec<Vec<usize>> = Vec::new();
    let all: Vec<usize> = (0..points.len()).collect();
    assign(&polytope, points, all, 0, tolerance, &mut outside);
    let mut face = 0;
    while face < polytope.triangles.len() {
        let height = |i: &usize| polytope.height(face, points[*i]);
        let farthest = outside[face].iter().copied().max_by(|i, j| height(i).total_cmp(&height(j)));
        let (Some(point), true) = (farthest, polytope.triangles[face].is_alive) else {
            face += 1;
            continue;
        };
        let new = polytope.add(points[point], face, tolerance)?;
        let mut loose = Vec::new();
        for (triangle, list) in polytope.triangles.iter().zip(&mut outside) {
            if !triangle.is_alive {
                loose.append(list);
            }
        }
        loose.retain(|i| *i != point);
        assign(&polytope, points, loose, new, tolerance, &mut outside);
    }
    Some(polytope)
}

/// Assigns each of the points `loose` (indices) to the first triangle, from index `first` on, above whose
/// plane it lies by more than `tolerance`, m. Points without such a triangle are dropped.
fn assign(
    polytope: &Polytope,
    points: &[Vec3<f64>],
    loose: Vec<usize>,
    first: usize,
    tolerance: f64,
    outside: &mut Vec<Vec<usize>>,
) {
    outside.resize(polytope.triangles.len(), Vec::new());
    for point in loose {
        let sees = |i: &usize| polytope.height(*i, points[point]) > tolerance;
        if let Some(triangle) = (first..polytope.triangles.len()).find(sees) {
            outside[triangle].push(point);
        }
    }
}

/// Returns the indices of the corners of all triangles that are connected to `seed` and lie in its plane,
/// and marks these triangles in `is_taken`.
fn coplanar(polytope: &Polytope, seed: usize, tolerance: f64, is_taken: &mut [bool]) -> Vec<usize> {
    let mut group = vec![seed];
    let mut corners = polytope.triangles[seed].corners.to_vec();
    is_taken[seed] = true;
    let mut next = 0;
    while let Some(&triangle) = group.get(next) {
        next += 1;
        for neighbor in polytope.triangles[triangle].neighbors {
            let others = polytope.triangles[neighbor].corners;
            let is_level =
                others.iter().all(|i| polytope.height(seed, polytope.points[*i]).abs() <= tolerance);
            if !is_taken[neighbor] && is_level {
                is_taken[neighbor] = true;
                group.push(neighbor);
                corners.extend(others.iter().filter(|i| !corners.contains(i)).copied().collect::<Vec<_>>());
            }
        }
    }
    corners
}

/// Sorts the corners of a convex face counterclockwise about its normal.
fn order(corners: &mut [usize], points: &[Vec3<f64>], normal: Vec3<f64>) {
    let sum = corners.iter().fold(Vec3::zero(), |sum, i| sum + points[*i]);
    let center = sum * (1.0 / corners.len() as f64);
    let x = points[corners[0]] - center;
    let y = normal.cross(x);
    let angle = |i: usize| (points[i] - center).dot(y).atan2((points[i] - center).dot(x));
    corners.sort_by(|i, j| angle(*i).total_cmp(&angle(*j)));
}
