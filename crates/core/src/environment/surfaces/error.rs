//! What can be wrong with a surface.

use crate::number_text::short;

/// Surfaces that cannot be; each error carries the offending value.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// An area, a length or a coefficient is negative, infinite or not a number.
    #[error("{name} is {value}, {expected} is needed", value = short(*value))]
    Value {
        /// Which input.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is accepted.
        expected: &'static str,
    },
    /// More light leaves a surface than meets it.
    #[error(
        "specular {specular} and diffuse {diffuse} add up to more than 1: what is left is absorbed",
        specular = short(*specular), diffuse = short(*diffuse)
    )]
    Reflection {
        /// Share reflected as by a mirror.
        specular: f64,
        /// Share scattered.
        diffuse: f64,
    },
    /// Nothing is covered.
    #[error("no body shows a surface, so that there would be no force: cover one, or leave the effect out")]
    Nothing,
    /// There are no plates.
    #[error("no plates are given, so that there would be no force: give at least one, or leave the body out")]
    NoPlates,
    /// A normal has no direction.
    #[error("normal of plate {plate} is zero or not finite, a direction is needed")]
    Normal {
        /// Index of the plate.
        plate: usize,
    },
    /// Normals, areas and centroids do not come in equal numbers.
    #[error(
        "{areas} areas, {normals} normals and {centroids} centroids are given, one of each per plate is needed"
    )]
    WrongLength {
        /// Number of areas.
        areas: usize,
        /// Number of normals.
        normals: usize,
        /// Number of centroids.
        centroids: usize,
    },
    /// A body has no shape from which faces could be taken.
    #[error(
        "{body} has no visual geometry to take faces from: give it plates or a cannonball, or leave it out"
    )]
    NoShape {
        /// Name of the body, or `the robot`.
        body: String,
    },
    /// A shape is a file.
    #[error(
        "link '{link}' looks like the mesh '{filename}', whose faces are not read: give the link plates or a \
         cannonball"
    )]
    Mesh {
        /// The link.
        link: String,
        /// The file.
        filename: String,
    },
    /// A body is given two surfaces.
    #[error("body {body} is covered twice, one surface per body is needed")]
    Twice {
        /// Index of the body.
        body: usize,
    },
    /// A body that the robot does not have.
    #[error("a surface is on body {body}, the robot has bodies 0 to {last}", last = count.saturating_sub(1))]
    UnknownBody {
        /// Index given.
        body: usize,
        /// Number of bodies.
        count: usize,
    },
}

/// `value` if it is at least zero and finite.
pub(in crate::environment) fn not_negative(name: &'static str, value: f64) -> Result<f64, SurfaceError> {
    if value.is_finite() && value >= 0.0 {
        return Ok(value);
    }
    Err(SurfaceError::Value { name, value, expected: "a finite number of at least 0" })
}
