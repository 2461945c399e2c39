//! Contact point of two shapes, with the gradients of its depth and weight.

use super::proximity::Proximity;
use crate::spatial::{Force, Vec3};

/// Slope between two surfaces at or above which the shallow side of a patch has no weight. A larger value
/// widens the transition: the lever arms that result from changing weights then stay closer to the patch, but
/// small tilts make a contact softer.
pub(super) const TILT: f64 = 0.02;

/// Pair of opposite points at which two shapes touch, with the gradients of its depth and weight, all in
/// common axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// Point of the first shape, m.
    pub point_a: Vec3<f64>,
    /// Point of the second shape, m: `point_a − depth normal`.
    pub point_b: Vec3<f64>,
    /// Depth of the overlap at this point, m; negative where the shapes are apart.
    pub depth: f64,
    /// Fraction of the stiffness of the contact that acts at this point; the weights of a contact sum to
    /// 1.
    pub weight: f64,
    /// Change of the depth for a displacement of the second shape: m per m of translation and m per rad of
    /// rotation about the middle of the witness points.
    pub depth_gradient: Force<f64>,
    /// Change of the weight for the same displacements, per m of translation and per rad of rotation.
    pub weight_gradient: Force<f64>,
}

impl ContactPoint {
    /// Returns a contact point whose gradients are those of points fixed to their shapes and of a constant
    /// weight.
    pub(super) fn new(
        proximity: &Proximity,
        [point_a, point_b]: [Vec3<f64>; 2],
        depth: f64,
        weight: f64,
    ) -> Self {
        let arm = (point_a + point_b) * 0.5 - proximity.center();
        let depth_gradient = Force::new(-proximity.normal, -arm.cross(proximity.normal));
        Self { point_a, point_b, depth, weight, depth_gradient, weight_gradient: Force::zero() }
    }
}

/// Returns the pair of witness points as a contact point with the given weight.
pub(super) fn witness(proximity: &Proximity, weight: f64) -> ContactPoint {
    let Proximity { distance, point_a, point_b, .. } = *proximity;
    ContactPoint::new(proximity, [point_a, point_b], -distance, weight)
}
