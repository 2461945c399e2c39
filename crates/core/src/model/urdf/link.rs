//! `<link>`: mass, inertia, looks.

use super::element::Element;
use super::error::{UrdfError, UrdfProblem};
use super::material::Materials;
use super::mesh::Meshes;
use crate::model::{Geometry, Inertial, Link, ModelWarning, Visual};
use nalgebra::Matrix3;

/// What reading a link takes from the rest of the file, and what it leaves to tell.
pub(super) struct Surroundings<'a> {
    pub(super) materials: Materials<'a>,
    pub(super) meshes: Meshes<'a>,
    pub(super) warnings: Vec<ModelWarning>,
}

pub(super) fn read_link(
    link: Element<'_>,
    name: &str,
    around: &mut Surroundings<'_>,
) -> Result<Link, UrdfError> {
    let mut result = Link::new(name, None);
    if let Some(inertial) = link.child("inertial") {
        result.inertial = Some(read_inertial(inertial, around)?);
    }
    for visual in link.children("visual") {
        // looks are no physics: a shape that cannot be read is left out, and said so
        match read_visual(visual, around) {
            Ok(visual) => result.visuals.push(visual),
            Err(error) => {
                let note = format!("a visual shape of {} is left out: {error}", link.owner);
                around.warnings.push(ModelWarning::Note(note));
            }
        }
    }
    // those only stand in for a mesh that cannot be drawn: what is odd in them is nobody's business
    for collision in link.children("collision") {
        let mesh = collision.child("geometry").and_then(|geometry| geometry.child("mesh"));
        let file = mesh.map(|mesh| mesh.text("filename").unwrap_or_default());
        if file.is_none_or(|name| around.meshes.find(name).is_some()) {
            result.collisions.extend(read_visual(collision, around).ok());
        }
    }
    Ok(result)
}

fn read_inertial(inertial: Element<'_>, around: &mut Surroundings<'_>) -> Result<Inertial, UrdfError> {
    let origin = inertial.origin()?;
    let mass = inertial.required_child("mass")?.required_number("value")?;
    let mut inertia = Matrix3::zeros();
    if let Some(element) = inertial.child("inertia") {
        let product = |name| Ok::<_, UrdfError>(element.number(name)?.unwrap_or(0.0));
        let (xx, yy, zz) = (
            element.required_number("ixx")?,
            element.required_number("iyy")?,
            element.required_number("izz")?,
        );
        let (xy, xz, yz) = (product("ixy")?, product("ixz")?, product("iyz")?);
        inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    } else if mass != 0.0 {
        let note = format!("{} has a mass but no <inertia>: read as a point mass", inertial.owner);
        around.warnings.push(ModelWarning::Note(note));
    }
    // given in the axes of <origin>; wanted in the link's: I = R I' Rᵀ
    let rot = origin.rotation.to_rotation_matrix().into_inner();
    Ok(Inertial { mass, com: origin.translation.vector, inertia: rotated(&rot, &inertia) })
}

/// `R I Rᵀ`, symmetric to the last bit.
fn rotated(rot: &Matrix3<f64>, inertia: &Matrix3<f64>) -> Matrix3<f64> {
    let result = rot * inertia * rot.transpose();
    (result + result.transpose()) * 0.5
}

fn read_visual(visual: Element<'_>, around: &mut Surroundings<'_>) -> Result<Visual, UrdfError> {
    let geometry = visual.required_child("geometry")?;
    let rgba = visual.child("material").map(|material| around.materials.rgba(material)).transpose()?;
    Ok(Visual { pose: visual.origin()?, geometry: read_geometry(geometry, around)?, rgba: rgba.flatten() })
}

fn read_geometry(geometry: Element<'_>, around: &mut Surroundings<'_>) -> Result<Geometry, UrdfError> {
    if let Some(shape) = geometry.child("box") {
        shape.required_text("size")?;
        let edges: [f64; 3] = shape.numbers("size")?.expect("the attribute is there");
        for edge in edges {
            shape.positive("size", edge)?;
        }
        Ok(Geometry::Box(edges))
    } else if let Some(shape) = geometry.child("sphere") {
        Ok(Geometry::Sphere { radius: shape.required_size("radius")? })
    } else if let Some(shape) = geometry.child("cylinder") {
        let (radius, length) = (shape.required_size("radius")?, shape.required_size("length")?);
        Ok(Geometry::Cylinder { radius, length })
    } else if let Some(shape) = geometry.child("capsule") {
        let (radius, length) = (shape.required_size("radius")?, shape.required_size("length")?);
        Ok(Geometry::Capsule { radius, length })
    } else if let Some(shape) = geometry.child("mesh") {
        let filename = around.meshes.resolve(shape.required_text("filename")?);
        Ok(Geometry::Mesh { filename, scale: shape.numbers("scale")?.unwrap_or([1.0; 3]) })
    } else {
        let element = "box, sphere, cylinder, capsule or mesh";
        Err(geometry.fail(UrdfProblem::MissingElement { owner: geometry.owner.to_owned(), element }))
    }
}
