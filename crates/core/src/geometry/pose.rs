//! Position and attitude of a shape.

use crate::spatial::{Mat3, Vec3};

/// Pose of a shape in common axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Rotation from the axes of the shape to common axes.
    pub rot: Mat3<f64>,
    /// Origin of the shape in common axes, m.
    pub pos: Vec3<f64>,
}

impl Pose {
    /// Returns the pose of a shape whose axes are the common axes.
    pub fn identity() -> Self {
        Self::at(Vec3::zero())
    }

    /// Returns the pose with the axes parallel to common axes and the origin at `pos`, m.
    pub fn at(pos: Vec3<f64>) -> Self {
        Self { rot: Mat3::identity(), pos }
    }

    /// Returns the coordinates, m, in common axes of a point that is given in the axes of the shape.
    pub fn to_common(&self, point: Vec3<f64>) -> Vec3<f64> {
        self.rot * point + self.pos
    }

    /// Returns the coordinates, m, in the axes of the shape of a point that is given in common axes.
    pub fn to_shape(&self, point: Vec3<f64>) -> Vec3<f64> {
        self.rot.transpose_mul(point - self.pos)
    }

    /// Returns the pose in common axes of a shape with the pose `inner` in the axes of this shape.
    #[must_use]
    pub fn compose(&self, inner: &Self) -> Self {
        Self { rot: self.rot * inner.rot, pos: self.to_common(inner.pos) }
    }

    /// Returns the pose of `other`, given in common axes, in the axes of this shape.
    #[must_use]
    pub fn relative(&self, other: &Self) -> Self {
        Self { rot: self.rot.transpose() * other.rot, pos: self.to_shape(other.pos) }
    }

    /// Returns true if all numbers are finite.
    pub fn is_finite(&self) -> bool {
        // a number that is not finite makes the sum so
        let sum = self.rot * Vec3::new(1.0, 1.0, 1.0) + self.pos;
        (sum.x + sum.y + sum.z).is_finite()
    }
}
