//! Triangle meshes, and defects that a convex hull hides.

use crate::spatial::Vec3;
use std::collections::HashMap;

/// Surface that consists of triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertices, m.
    pub vertices: Vec<Vec3<f64>>,
    /// Indices of the corners of each triangle, counterclockwise as seen from outside.
    pub triangles: Vec<[usize; 3]>,
}

/// Defect of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshDefect {
    /// Open or inconsistently oriented surface: some edges do not join exactly two triangles of the same
    /// orientation.
    Open {
        /// Number of edges that do not join exactly two triangles of the same orientation.
        edges: usize,
    },
    /// The normals point inwards.
    InsideOut,
}

impl std::fmt::Display for MeshDefect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Open { edges: 1 } => f.write_str("is open or inconsistently oriented at 1 edge"),
            Self::Open { edges } => write!(f, "is open or inconsistently oriented at {edges} edges"),
            Self::InsideOut => f.write_str("is inside out (its normals point inwards)"),
        }
    }
}

impl Mesh {
    /// Returns the mesh with vertices of equal coordinates joined, without the triangles that thereby lose a
    /// corner.
    #[must_use]
    pub fn joined(&self) -> Self {
        let (index, vertices) = self.joined_vertices();
        let triangles = self.triangles.iter().map(|triangle| triangle.map(|corner| index[corner]));
        let triangles = triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect();
        Self { vertices, triangles }
    }

    /// Returns, for each vertex of the mesh, its index in the list of vertices without repetition, and this
    /// list.
    fn joined_vertices(&self) -> (Vec<usize>, Vec<Vec3<f64>>) {
        let (mut known, mut vertices) = (HashMap::new(), Vec::new());
        let key = |p: &Vec3<f64>| [p.x, p.y, p.z].map(|x| (x + 0.0).to_bits()); // −0 is 0
        let number = |p: &Vec3<f64>| {
            *known.entry(key(p)).or_insert_with(|| {
                vertices.push(*p);
                vertices.len() - 1
            })
        };
        (self.vertices.iter().map(number).collect(), vertices)
    }

    /// Returns the defect of the mesh, or `None` if it has none. Vertices with equal coordinates count as one
    /// vertex.
    pub fn defect(&self) -> Option<MeshDefect> {
        let (index, _) = self.joined_vertices();
        // each edge counted in the sense from its lower to its higher vertex, and in total
        let mut edges: HashMap<(usize, usize), (i64, usize)> = HashMap::new();
        for triangle in &self.triangles {
            for k in 0..3 {
                let (from, to) = (index[triangle[k]], index[triangle[(k + 1) % 3]]);
                if from != to {
                    let (sense, count) = edges.entry((from.min(to), from.max(to))).or_default();
                    *sense += if from < to { 1 } else { -1 };
                    *count += 1;
                }
            }
        }
        let open = edges.values().filter(|edge| **edge != (0, 2)).count();
        if open > 0 {
            return Some(MeshDefect::Open { edges: open });
        }
        (self.volume() < 0.0).then_some(MeshDefect::InsideOut)
    }

    /// Returns the signed volume, m³, which is negative if the normals point inwards.
    pub fn volume(&self) -> f64 {
        let origin = self.vertices.first().copied().unwrap_or_else(Vec3::zero);
        let part = |triangle: &[usize; 3]| {
            let [a, b, c] = triangle.map(|i| self.vertices[i] - origin);
            a.dot(b.cross(c)) / 6.0
        };
        self.triangles.iter().map(part).sum()
    }
}
