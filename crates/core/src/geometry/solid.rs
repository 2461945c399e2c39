//! Solids bounded by meshes, which may be divided into convex pieces.

use super::hull::Hull;
use super::mesh::{Mesh, MeshDefect};
use super::mesh_file::read_mesh;
use crate::model::Geometry;
use crate::spatial::Vec3;
use std::path::Path;

/// Largest difference between the volumes of a mesh and of its convex hull, relative to the volume of the
/// hull, for which the mesh counts as convex.
const CONVEX: f64 = 1e-6;

/// Solid bounded by a closed mesh.
#[derive(Clone, Debug)]
pub struct Solid {
    /// Scaled mesh, m, with equal vertices joined and with normals that point outwards.
    pub mesh: Mesh,
    /// Convex hull of the mesh.
    pub hull: Hull,
    /// Text of a warning if the normals in the file point inwards; otherwise `None`.
    pub warning: Option<String>,
}

impl Solid {
    /// Reads a mesh file and scales the mesh along its axes by the factors `x`, `y` and `z`.
    ///
    /// # Errors
    /// The reason, as text, why the file does not describe a solid: it cannot be read, its surface is open
    /// or inconsistently oriented, or it has no volume.
    pub fn read(filename: &str, [x, y, z]: [f64; 3]) -> Result<Self, String> {
        let mut mesh =
            read_mesh(Path::new(filename)).map_err(|cause| format!("{filename}: {cause}"))?.joined();
        let defect = mesh.defect();
        if let Some(open @ MeshDefect::Open { .. }) = defect {
            return Err(format!(
                "the collision mesh {filename} {open}, so it has no inside that convex pieces could fill; \
                 repair the mesh, or omit 'pieces' to use its convex hull"
            ));
        }
        mesh.vertices.iter_mut().for_each(|p| *p = Vec3::new(x * p.x, y * p.y, z * p.z));
        let hull = Hull::new(&mesh.vertices).map_err(|error| format!("{filename}: {error}"))?;
        if mesh.volume() < 0.0 {
            mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        let warning = defect.map(|defect| {
            format!(
                "the collision mesh {filename} {defect}; its triangles are reversed before it is divided into convex pieces"
            )
        });
        Ok(Self { mesh, hull, warning })
    }

    /// Returns true if the volume of the solid is smaller than that of its convex hull by at most a fraction
    /// of 1e-6.
    pub fn is_convex(&self) -> bool {
        self.mesh.volume() >= (1.0 - CONVEX) * self.hull.volume()
    }

    /// Returns the total volume of convex pieces less the volume of the solid, relative to the latter.
    pub fn excess(&self, pieces: &[Hull]) -> f64 {
        pieces.iter().map(Hull::volume).sum::<f64>() / self.mesh.volume() - 1.0
    }
}

impl Hull {
    /// Returns the hull as the geometry of a collision shape.
    pub fn geometry(&self) -> Geometry {
        Geometry::Hull { points: self.vertices().iter().map(|p| [p.x, p.y, p.z]).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::Solid;
    use std::fs;

    #[test]
    fn a_mirrored_scale_keeps_the_normals_outwards() {
        let file = std::env::temp_dir().join(format!("onorbit_solid_{}.obj", std::process::id()));
        let tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
        fs::write(&file, tetrahedron).expect("a temporary file can be written");
        let name = file.to_str().expect("the name is UTF-8");
        for scale in [[1.0, 1.0, 1.0], [1.0, -2.0, 3.0], [-1.0, -2.0, 3.0]] {
            let solid = Solid::read(name, scale).expect("the mesh is closed");
            let volume = scale.iter().product::<f64>().abs() / 6.0;
            assert!((solid.mesh.volume() - volume).abs() < 1e-15 && solid.warning.is_none());
            assert!((solid.hull.volume() - volume).abs() < 1e-15 && solid.is_convex());
            assert!(solid.excess(std::slice::from_ref(&solid.hull)).abs() < 1e-15);
        }
        fs::remove_file(file).expect("the temporary file can be removed");
    }
}
