//! Collision shapes.

use super::bounding_sphere::BoundingSphere;
use super::error::GeometryError;
use super::hull::Hull;
use super::pose::Pose;
use crate::spatial::Vec3;
use std::sync::Arc;

/// Collision shape in its own axes; lengths are in m. Shapes of revolution have their axis along z.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Sphere about the origin.
    Sphere {
        /// Radius, m.
        radius: f64,
    },
    /// Points within `radius` of the segment from `(0, 0, −half_length)` to `(0, 0, half_length)`.
    Capsule {
        /// Radius, m.
        radius: f64,
        /// Half the distance between the centres of the caps, m; may be zero.
        half_length: f64,
    },
    /// Box with its centre at the origin and its edges along the axes.
    Box {
        /// Half of each edge length, along x, y and z, m.
        half_edges: [f64; 3],
    },
    /// Cylinder between the planes `z = ±half_length`.
    Cylinder {
        /// Radius, m.
        radius: f64,
        /// Half the length, m.
        half_length: f64,
    },
    /// Cone with its base in the plane `z = −half_length` and its apex at `z = half_length`.
    Cone {
        /// Radius of the base, m.
        radius: f64,
        /// Half the height, m.
        half_length: f64,
    },
    /// Points within `minor_radius` of the circle of radius `major_radius` in the plane `z = 0`; not convex.
    Torus {
        /// Radius of the circle, m.
        major_radius: f64,
        /// Radius of the cross section, m, less than `major_radius`.
        minor_radius: f64,
    },
    /// All points with `z ≤ 0`.
    HalfSpace,
    /// Convex hull of points.
    Hull(Arc<Hull>),
    /// Union of shapes, each with its pose in the axes of the compound.
    Compound(Arc<[(Shape, Pose)]>),
}

impl Shape {
    /// Returns the convex hull of points, m.
    ///
    /// # Errors
    /// [`GeometryError::Hull`] for fewer than four points, if a coordinate is not finite or too large, or if
    /// the points lie in a plane or are too close to each other.
    pub fn hull(points: &[Vec3<f64>]) -> Result<Self, GeometryError> {
        Hull::new(points).map(|hull| Self::Hull(Arc::new(hull)))
    }

    /// Returns the name of the kind of shape with its article, such as `a box`.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Sphere { .. } => "a sphere",
            Self::Capsule { .. } => "a capsule",
            Self::Box { .. } => "a box",
            Self::Cylinder { .. } => "a cylinder",
            Self::Cone { .. } => "a cone",
            Self::Torus { .. } => "a torus",
            Self::HalfSpace => "a half-space",
            Self::Hull(_) => "a convex hull",
            Self::Compound(_) => "a compound",
        }
    }

    /// Checks the dimensions of the shape.
    ///
    /// # Errors
    /// [`GeometryError`] if a length is not finite or not positive (the half length of a capsule may be
    /// zero), if the minor radius of a torus is not less than its major radius, if a compound has no pieces,
    /// or if the pose of a piece is not finite.
    pub fn check(&self) -> Result<(), GeometryError> {
        let lengths: &[(&'static str, f64)] = match self {
            Self::Sphere { radius } => &[("radius", *radius)],
            Self::Capsule { radius, half_length }
            | Self::Cylinder { radius, half_length }
            | Self::Cone { radius, half_length } => &[("radius", *radius), ("half length", *half_length)],
            Self::Box { half_edges: [x, y, z] } => {
                &[("half edge along x", *x), ("half edge along y", *y), ("half edge along z", *z)]
            }
            Self::Torus { major_radius, minor_radius } => &[
                ("minor radius", *minor_radius),
                ("difference of the major and the minor radius", major_radius - minor_radius),
            ],
            Self::HalfSpace | Self::Hull(_) => &[],
            Self::Compound(pieces) => {
                for (piece, pose) in pieces.iter() {
                    piece.check()?;
                    if !pose.is_finite() {
                        return Err(GeometryError::Pose { name: piece.name() });
                    }
                }
                return if pieces.is_empty() { Err(GeometryError::EmptyCompound) } else { Ok(()) };
            }
        };
        for &(name, got) in lengths {
            let may_be_zero = name == "half length" && matches!(self, Self::Capsule { .. });
            if !got.is_finite() || got < 0.0 || got == 0.0 && !may_be_zero {
                return Err(GeometryError::Length { shape: self.name(), name, got, may_be_zero });
            }
        }
        Ok(())
    }

    /// Returns true if all surfaces of the shape are plane.
    pub(crate) fn is_polyhedral(&self) -> bool {
        match self {
            Self::HalfSpace | Self::Box { .. } | Self::Hull(_) => true,
            Self::Compound(pieces) => pieces.iter().all(|(piece, _)| piece.is_polyhedral()),
            _ => false,
        }
    }

    /// Returns true if the shape is convex and bounded.
    pub fn is_convex_body(&self) -> bool {
        !matches!(self, Self::Torus { .. } | Self::HalfSpace | Self::Compound(_))
    }

    /// Returns a sphere that contains the shape.
    pub fn bounding_sphere(&self) -> BoundingSphere {
        let about_origin = |radius| BoundingSphere { center: Vec3::zero(), radius };
        match self {
            Self::Sphere { radius } => about_origin(*radius),
            Self::Capsule { radius, half_length } => about_origin(radius + half_length),
            Self::Box { half_edges: [x, y, z] } => about_origin(Vec3::new(*x, *y, *z).norm()),
            Self::Cylinder { radius, half_length } | Self::Cone { radius, half_length } => {
                about_origin(radius.hypot(*half_length))
            }
            Self::Torus { major_radius, minor_radius } => about_origin(major_radius + minor_radius),
            Self::HalfSpace => about_origin(f64::INFINITY),
            Self::Hull(hull) => hull.bounding_sphere(),
            Self::Compound(pieces) => around(pieces),
        }
    }
}

/// Returns a sphere that contains all pieces, centred at the mean of the centres of their bounding spheres.
fn around(pieces: &[(Shape, Pose)]) -> BoundingSphere {
    let spheres: Vec<_> = pieces
        .iter()
        .map(|(shape, pose)| {
            let sphere = shape.bounding_sphere();
            (pose.to_common(sphere.center), sphere.radius)
        })
        .collect();
    let sum = spheres.iter().fold(Vec3::zero(), |sum, (center, _)| sum + *center);
    let center = sum * (1.0 / spheres.len().max(1) as f64);
    let radius = spheres.iter().map(|(at, radius)| (*at - center).norm() + radius).fold(0.0, f64::max);
    BoundingSphere { center, radius }
}
