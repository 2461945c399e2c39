//! Distance between two shapes, and the points at which it is attained.

use super::pose::Pose;
use crate::spatial::Vec3;

/// Signed distance between two shapes, with witness points and normal in common axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proximity {
    /// Distance, m. If the shapes overlap, it is minus the length of the shortest translation that separates
    /// them.
    pub distance: f64,
    /// Point on the surface of the first shape, m.
    pub point_a: Vec3<f64>,
    /// Point on the surface of the second shape, m: `point_a + distance normal`.
    pub point_b: Vec3<f64>,
    /// Unit normal from the first shape to the second. A translation of the second shape along the normal
    /// increases the distance.
    pub normal: Vec3<f64>,
}

impl Proximity {
    /// Returns the same distance with the shapes exchanged.
    #[must_use]
    pub fn exchanged(self) -> Self {
        Self { point_a: self.point_b, point_b: self.point_a, normal: -self.normal, ..self }
    }

    /// Returns the midpoint between the witness points, m.
    pub(crate) fn center(&self) -> Vec3<f64> {
        (self.point_a + self.point_b) * 0.5
    }

    /// Returns the same distance with the points and the normal converted from axes with the pose `axes`
    /// to common axes.
    #[must_use]
    pub(super) fn in_common(self, axes: &Pose) -> Self {
        Self {
            distance: self.distance,
            point_a: axes.to_common(self.point_a),
            point_b: axes.to_common(self.point_b),
            normal: axes.rot * self.normal,
        }
    }
}
