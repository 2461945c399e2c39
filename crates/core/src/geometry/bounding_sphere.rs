//! Bounding spheres.

use crate::spatial::Vec3;

/// Sphere that contains a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingSphere {
    /// Centre in the axes of the shape, m.
    pub center: Vec3<f64>,
    /// Radius, m; infinite for a half-space.
    pub radius: f64,
}
