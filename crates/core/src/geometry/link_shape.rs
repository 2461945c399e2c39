//! Creation of the collision shape of a link from its `<collision>` elements.

use super::error::GeometryError;
use super::hull::Hull;
use super::mesh_file::read_mesh;
use super::pose::Pose;
use super::shape::Shape;
use crate::model::{Geometry, Model, Visual};
use crate::spatial::Vec3;
use std::path::Path;
use std::sync::Arc;

/// Collision shape of a link.
#[derive(Clone, Debug)]
pub struct LinkShape {
    /// Shape in link axes: a compound with one piece for each `<collision>` element.
    pub shape: Shape,
    /// Warnings about defects of meshes, one line each; the convex hulls of these meshes are used
    /// nevertheless.
    pub warnings: Vec<String>,
}

/// Returns the collision shape of a link, given the index of its frame. Meshes are replaced by their convex
/// hulls.
///
/// # Errors
/// [`GeometryError`] if the link has no collision shape, or if one of its collision shapes cannot be read or
/// is invalid.
pub fn link_shape(model: &Model, frame: usize) -> Result<LinkShape, GeometryError> {
    let link = &model.frames()[frame].name;
    let invalid = |cause: String| GeometryError::Collision { link: link.clone(), cause };
    if let Some(cause) = model.skipped_collisions(frame).first() {
        return Err(invalid(cause.clone()));
    }
    let mut warnings = Vec::new();
    let mut pieces = Vec::new();
    for (_, visual) in model.collisions().iter().filter(|(index, _)| *index == frame) {
        let shape = shape_of(&visual.geometry, &format!("the link '{link}'"), &mut warnings);
        pieces.push((shape.map_err(invalid)?, pose(visual)));
    }
    if pieces.is_empty() {
        return Err(GeometryError::NoCollision { link: link.clone(), with: links_with_shapes(model) });
    }
    let shape = Shape::Compound(pieces.into());
    shape.check().map_err(|error| invalid(error.to_string()))?;
    Ok(LinkShape { shape, warnings })
}

/// Returns the names of the links that have collision shapes.
fn links_with_shapes(model: &Model) -> Vec<String> {
    let mut frames: Vec<usize> = model.collisions().iter().map(|(frame, _)| *frame).collect();
    frames.dedup();
    frames.into_iter().map(|frame| model.frames()[frame].name.clone()).collect()
}

fn pose(visual: &Visual) -> Pose {
    Pose {
        rot: visual.pose.rotation.to_rotation_matrix().into_inner().into(),
        pos: visual.pose.translation.vector.into(),
    }
}

/// Returns the collision shape for a geometry that belongs to `owner`, such as `the link 'hand'`. Adds a
/// warning to `warnings` if a mesh has a defect.
///
/// # Errors
/// The reason, as text, why a mesh or the points of a hull cannot be used.
pub fn shape_of(geometry: &Geometry, owner: &str, warnings: &mut Vec<String>) -> Result<Shape, String> {
    Ok(match geometry {
        Geometry::Box(edges) => Shape::Box { half_edges: edges.map(|edge| 0.5 * edge) },
        Geometry::Cylinder { radius, length } => {
            Shape::Cylinder { radius: *radius, half_length: 0.5 * length }
        }
        Geometry::Capsule { radius, length } => Shape::Capsule { radius: *radius, half_length: 0.5 * length },
        Geometry::Sphere { radius } => Shape::Sphere { radius: *radius },
        Geometry::Cone { radius, length } => Shape::Cone { radius: *radius, half_length: 0.5 * length },
        Geometry::Torus { major_radius, minor_radius } => {
            Shape::Torus { major_radius: *major_radius, minor_radius: *minor_radius }
        }
        Geometry::HalfSpace => Shape::HalfSpace,
        Geometry::Hull { points } => {
            let points: Vec<_> = points.iter().map(|p| Vec3::from_slice(p)).collect();
            Shape::hull(&points).map_err(|error| error.to_string())?
        }
        Geometry::Mesh { filename, scale: [x, y, z] } => {
            let mesh = read_mesh(Path::new(filename)).map_err(|cause| format!("{filename}: {cause}"))?;
            if let Some(defect) = mesh.defect() {
                warnings.push(format!(
                    "the collision mesh {filename} of {owner} {defect}; its convex hull is used"
                ));
            }
            let points: Vec<_> = mesh.vertices.iter().map(|p| Vec3::new(x * p.x, y * p.y, z * p.z)).collect();
            let hull = Hull::new(&points).map_err(|error| format!("{filename}: {error}"))?;
            Shape::Hull(Arc::new(hull))
        }
    })
}
