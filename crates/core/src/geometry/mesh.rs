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
    /// Open surface: some edges do not belong to exactly two triangles of opposite orientation.
    Open {
        /// Number of such edges.
        edges: usize,
    },
    /// The normals point inwards.
    InsideOut,
}

impl std::fmt::Display for MeshDefect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Open { edges: 1 } => f.write_str("is open (1 edge does not join two triangles)"),
            Self::Open { edges } => write!(f, "is open ({edges} edges do not join two triangles)"),
            Self::InsideOut => f.write_str("is inside out (its normals point to the inside)"),
        }
    }
}

impl Mesh {
    /// Returns the defect of the mesh, if it has one. Vertices with equal coordinates are one vertex.
    pub fn defect(&self) -> Option<MeshDefect> {
        let mut index = HashMap::new();
        let key = |p: &Vec3<f64>| [p.x, p.y, p.z].map(|x| (x + 0.0).to_bits()); // −0 is 0
        let merged: Vec<usize> = self
            .vertices
            .iter()
            .map(|p| {
                let next = index.len();
                *index.entry(key(p)).or_insert(next)
            })
            .collect();
        // each edge counted in the sense from its lower to its higher vertex, and in total
        let mut edges: HashMap<(usize, usize), (i64, usize)> = HashMap::new();
        for triangle in &self.triangles {
            for k in 0..3 {
                let (from, to) = (merged[triangle[k]], merged[triangle[(k + 1) % 3]]);
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
    fn volume(&self) -> f64 {
        let origin = self.vertices.first().copied().unwrap_or_else(Vec3::zero);
        let part = |triangle: &[usize; 3]| {
            let [a, b, c] = triangle.map(|i| self.vertices[i] - origin);
            a.dot(b.cross(c)) / 6.0
        };
        self.triangles.iter().map(part).sum()
    }
}
