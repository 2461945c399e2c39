//! Reader of `<link>`: mass, inertia, visual and collision shapes.

use super::element::Element;
use super::error::{UrdfError, UrdfProblem};
use super::material::Materials;
use super::mesh::Meshes;
use super::pose::pose;
use crate::model::{Geometry, Inertial, Link, LinkChange, ModelWarning, Visual};
use nalgebra::Matrix3;

/// Data from other parts of the file that are needed to read links, and the warnings found so far.
pub(super) struct ReadContext<'a> {
    pub(super) materials: Materials<'a>,
    pub(super) meshes: Meshes<'a>,
    /// Values that replace those in the file.
    pub(super) changes: &'a [LinkChange],
    pub(super) warnings: Vec<ModelWarning>,
}

pub(super) fn read_link(
    link: Element<'_>,
    name: &str,
    context: &mut ReadContext<'_>,
) -> Result<Link, UrdfError> {
    let mut result = Link::new(name, None);
    if let Some(inertial) = link.child("inertial") {
        result.inertial = read_inertial(inertial, context)?;
    }
    for change in context.changes {
        change.apply(&mut result).map_err(|error| link.fail(UrdfProblem::Model(error)))?;
    }
    for visual in link.children("visual") {
        // visual shapes do not affect the dynamics, so an unreadable shape is omitted with a warning
        match read_visual(visual, context) {
            Ok(visual) => result.visuals.push(visual),
            Err(error) => {
                let note = format!("a visual shape is skipped: {}", error.problem);
                context.warnings.push(ModelWarning::Note(note));
            }
        }
    }
    // without warnings: most runs only draw collision shapes, as substitutes for missing visual shapes
    for collision in link.children("collision") {
        let mesh = collision.child("geometry").and_then(|geometry| geometry.child("mesh"));
        let file = mesh.and_then(|mesh| mesh.text("filename"));
        match file.filter(|name| context.meshes.find(name).is_none()) {
            Some(name) => result.skipped_collisions.push(format!(
                "there is no mesh file '{name}'; correct its name, or give the folder of its package"
            )),
            None => match read_visual(collision, context) {
                Ok(shape) => result.collisions.push(shape),
                Err(error) => result.skipped_collisions.push(error.to_string()),
            },
        }
    }
    Ok(result)
}

/// Reads the mass, centre of mass and inertia from `<inertial>`. Returns `None` if there is no `<mass>`, as
/// urdfdom does.
fn read_inertial(element: Element<'_>, context: &mut ReadContext<'_>) -> Result<Option<Inertial>, UrdfError> {
    let owner = element.owner;
    let mut note = |text: String| context.warnings.push(ModelWarning::Note(text));
    if element.child("mass").is_none() {
        note(format!("the <inertial> of {owner} is ignored, because {owner} has no <mass>; add one"));
        return Ok(None);
    }
    let urdf_rs::Inertial { origin, mass, inertia: given } = element.read()?;
    match element.child("inertia") {
        None if mass.value != 0.0 => {
            note(format!(
                "{owner} has a mass but no <inertia> and is read as a point mass; add an <inertia> if the link is not a point"
            ));
        }
        None => {}
        Some(inertia) => {
            let is_missing = |product: &&str| inertia.text(product).is_none();
            let missing: Vec<&str> = ["ixy", "ixz", "iyz"].into_iter().filter(is_missing).collect();
            if !missing.is_empty() {
                let (verb, what) = if missing.len() == 1 { ("is", "it") } else { ("are", "them") };
                note(format!(
                    "the <inertia> of {owner} has no {}, which {verb} read as 0; add {what} unless 0 is meant",
                    missing.join(", ")
                ));
            }
        }
    }
    let inertia = Matrix3::new(
        given.ixx, given.ixy, given.ixz, //
        given.ixy, given.iyy, given.iyz, //
        given.ixz, given.iyz, given.izz,
    );
    // rotate from the axes of <origin> to link axes: I = R I' Rᵀ
    let origin = pose(element, &origin)?;
    let rot = origin.rotation.to_rotation_matrix().into_inner();
    let (com, inertia) = (origin.translation.vector, rotated(&rot, &inertia));
    Ok(Some(Inertial { mass: mass.value, com, inertia }))
}

/// Returns `R I Rᵀ`, made exactly symmetric.
fn rotated(rot: &Matrix3<f64>, inertia: &Matrix3<f64>) -> Matrix3<f64> {
    let result = rot * inertia * rot.transpose();
    (result + result.transpose()) * 0.5
}

fn read_visual(element: Element<'_>, context: &mut ReadContext<'_>) -> Result<Visual, UrdfError> {
    let urdf_rs::Visual { origin, geometry, material, .. } = element.read()?;
    let rgba = material.map(|material| context.materials.rgba(material)).transpose()?.flatten();
    Ok(Visual { pose: pose(element, &origin)?, geometry: shape(geometry, &mut context.meshes), rgba })
}

fn shape(read: urdf_rs::Geometry, meshes: &mut Meshes<'_>) -> Geometry {
    use urdf_rs::Geometry as Read;
    match read {
        Read::Box { size } => Geometry::Box(*size),
        Read::Cylinder { radius, length } => Geometry::Cylinder { radius, length },
        Read::Capsule { radius, length } => Geometry::Capsule { radius, length },
        Read::Sphere { radius } => Geometry::Sphere { radius },
        Read::Mesh { filename, scale } => {
            let scale = scale.map_or([1.0; 3], |scale| *scale);
            Geometry::Mesh { filename: meshes.resolve(&filename), scale }
        }
    }
}
