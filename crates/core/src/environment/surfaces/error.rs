//! Errors of surfaces.

use crate::environment::body_index::BodyIndex;
use crate::number_text::{count, exact, list};

/// Errors of surfaces.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// An area, distance, radius, flux or coefficient is outside its accepted range.
    #[error("{name} is {value}; expected {expected}", value = exact(*value))]
    Value {
        /// Name of the input.
        name: &'static str,
        /// Given value, in the unit that `expected` states.
        value: f64,
        /// Text that describes the accepted range.
        expected: &'static str,
    },
    /// A surface reflects more light than it receives.
    #[error(
        "the reflected fractions, specular {specular} and diffuse {diffuse}, add up to more than 1; reduce \
         one of them, so that their sum is at most 1",
        specular = exact(*specular), diffuse = exact(*diffuse)
    )]
    Reflection {
        /// Fraction of the light that is reflected specularly.
        specular: f64,
        /// Fraction of the light that is reflected diffusely.
        diffuse: f64,
    },
    /// No body has a surface.
    #[error(
        "no body has a surface, so the effect would exert no force; give a body a surface or remove the \
    effect"
    )]
    NoSurfaces,
    /// The list of plates of a body is empty.
    #[error(
        "no plates are given, so the effect would exert no force; give at least one plate or remove the body \
    from the surfaces"
    )]
    NoPlates,
    /// The normal of a plate is zero or not finite.
    #[error("the normal of plate {plate} is {normal}; give a finite vector that is not zero", normal = list(normal))]
    Normal {
        /// Index of the plate, counted from 0.
        plate: usize,
        /// Given normal, in the axes of the frame.
        normal: [f64; 3],
    },
    /// The numbers of areas, normals and centroids differ.
    #[error(
        "the plates have {areas}, {normals} and {centroids}; give one of each for every plate",
        areas = count(*areas, "area"), normals = count(*normals, "normal"),
        centroids = count(*centroids, "centroid")
    )]
    WrongLength {
        /// Number of areas.
        areas: usize,
        /// Number of normals.
        normals: usize,
        /// Number of centroids.
        centroids: usize,
    },
    /// A body has no visual geometry from which faces can be derived.
    #[error(
        "{body} has no visual geometry from which faces can be derived; give plates or a cannonball instead"
    )]
    NoShape {
        /// Body, such as `the body 'hand'`, or `the robot`.
        body: String,
    },
    /// The visual geometry of a link is a mesh.
    #[error(
        "the visual geometry of link '{link}' is the mesh '{filename}', from which no faces are derived; give the \
         link plates or a cannonball"
    )]
    Mesh {
        /// Name of the link.
        link: String,
        /// Path of the file.
        filename: String,
    },
    /// The visual geometry of a link is a cone, a torus, a half-space or a hull.
    #[error(
        "the visual geometry of link '{link}' is {kind}, from which no faces are derived; give the link \
         plates or a cannonball"
    )]
    Shape {
        /// Name of the link.
        link: String,
        /// Kind of the geometry with its article, such as `a cone`.
        kind: &'static str,
    },
    /// A body has more than one surface.
    #[error("{body} has two surfaces; give each body at most one surface")]
    Twice {
        /// Body with several surfaces.
        body: BodyIndex,
    },
    /// A surface is assigned to a body that does not exist.
    #[error("a surface is on {body}, but {known}")]
    UnknownBody {
        /// Given body.
        body: BodyIndex,
        /// Bodies that exist, as text with the suggested fix.
        known: String,
    },
}

/// Returns `value`, or an error if it is negative or not finite.
pub(in crate::environment) fn not_negative(name: &'static str, value: f64) -> Result<f64, SurfaceError> {
    if value.is_finite() && value >= 0.0 {
        return Ok(value);
    }
    let expected = match name {
        "area" => "a finite area of at least 0 m²",
        "flux" => "a finite flux of at least 0 W/m²",
        "distance of a centroid" => "a finite distance, m",
        _ => "a finite number of at least 0",
    };
    Err(SurfaceError::Value { name, value, expected })
}
