//! Surface of one body.

use super::error::{SurfaceError, not_negative};
use super::face::Face;
use super::from_shapes::parts_of_body;
use super::optics::Optics;
use super::parts::Parts;
use super::sphere::Sphere;
use crate::model::{Frame, Model, Node};
use crate::number_text::choice;
use crate::spatial::Vec3;
use nalgebra::Vector3;

/// Surface of a body: its parts with their aerodynamic and optical coefficients.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    pub(super) parts: Parts,
    /// Drag coefficient `C_D`, relative to the area that faces the stream.
    pub(super) drag_coefficient: f64,
    pub(super) optics: Optics,
}

impl Surface {
    /// Creates a cannonball: a surface whose cross-section, m², and coefficients are equal in all directions.
    /// All forces act at the centre of mass.
    ///
    /// # Errors
    /// [`SurfaceError::Value`] for a negative or non-finite value, and for a reflectivity above 2.
    pub fn cannonball(area: f64, drag_coefficient: f64, reflectivity: f64) -> Result<Self, SurfaceError> {
        let area = not_negative("area", area)?;
        let drag_coefficient = not_negative("drag_coefficient", drag_coefficient)?;
        let value = not_negative("reflectivity", reflectivity)?;
        if value > 2.0 {
            let expected = "a number from 0 to 2 (2 is a flat mirror that faces the Sun)";
            return Err(SurfaceError::Value { name: "reflectivity", value, expected });
        }
        let spheres = vec![Sphere { area, centre: Vec3::zero(), reflectivity }];
        let parts = Parts { spheres, ..Parts::default() };
        Ok(Self { parts, drag_coefficient, optics: Optics::default() })
    }

    /// Derives the surface of a body from its visual shapes, which must be boxes, cylinders, capsules or
    /// spheres.
    ///
    /// # Errors
    /// [`SurfaceError::UnknownBody`] if `model` has no body with this index, [`SurfaceError::NoShape`] for a
    /// body without shapes, [`SurfaceError::Mesh`] and [`SurfaceError::Shape`] for other shapes, and
    /// [`SurfaceError::Value`] for an invalid drag coefficient.
    pub fn from_shapes(
        model: &Model,
        body: usize,
        drag_coefficient: f64,
        optics: Optics,
    ) -> Result<Self, SurfaceError> {
        node_of(model, body)?;
        let parts = parts_of_body(model, body, &optics)?;
        if parts.is_empty() {
            return Err(SurfaceError::NoShape {
                body: format!("the body '{}'", model.body_frame(body).name),
            });
        }
        let drag_coefficient = not_negative("drag_coefficient", drag_coefficient)?;
        Ok(Self { parts, drag_coefficient, optics })
    }

    /// Creates a surface from flat plates with areas, m², outward normals of any length, and centroids, m.
    /// Normals and centroids are in the axes of `frame`, centroids relative to its origin.
    ///
    /// # Errors
    /// [`SurfaceError::WrongLength`] if the numbers of areas, normals and centroids differ,
    /// [`SurfaceError::NoPlates`] for empty lists, [`SurfaceError::UnknownBody`] if `model` does not have
    /// the body of `frame`, [`SurfaceError::Normal`] for a normal that is zero or not finite, and
    /// [`SurfaceError::Value`] for an invalid area, centroid or drag coefficient.
    pub fn plates(
        model: &Model,
        frame: &Frame,
        areas: &[f64],
        normals: &[[f64; 3]],
        centroids: &[[f64; 3]],
        drag_coefficient: f64,
        optics: Optics,
    ) -> Result<Self, SurfaceError> {
        if areas.len() != normals.len() || areas.len() != centroids.len() {
            let (areas, normals, centroids) = (areas.len(), normals.len(), centroids.len());
            return Err(SurfaceError::WrongLength { areas, normals, centroids });
        }
        if areas.is_empty() {
            return Err(SurfaceError::NoPlates);
        }
        let com = node_of(model, frame.body)?.com;
        let face = |plate: usize| {
            let normal = Vec3::from(Vector3::from(normals[plate]));
            let length = normal.norm();
            if !(length > 0.0 && length.is_finite()) {
                return Err(SurfaceError::Normal { plate, normal: normals[plate] });
            }
            let centroid = Vec3::from(Vector3::from(centroids[plate]));
            not_negative("distance of a centroid", centroid.norm())?;
            let area = not_negative("area", areas[plate])?;
            let normal = frame.rot_kf * (normal * (1.0 / length));
            Ok(Face::new(area, normal, frame.rot_kf * centroid + frame.pos_kf - com))
        };
        let faces = (0..areas.len()).map(face).collect::<Result<_, _>>()?;
        let parts = Parts { faces, ..Parts::default() };
        let drag_coefficient = not_negative("drag_coefficient", drag_coefficient)?;
        Ok(Self { parts, drag_coefficient, optics })
    }
}

/// Returns the node of the body with index `body`, or an error if there is none.
fn node_of(model: &Model, body: usize) -> Result<&Node, SurfaceError> {
    let known = || format!("the robot has {}", choice(model.nodes().len(), "body"));
    model.nodes().get(body).ok_or_else(|| SurfaceError::UnknownBody { body: body.into(), known: known() })
}
