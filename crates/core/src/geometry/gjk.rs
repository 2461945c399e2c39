//! Nearest points of separated convex shapes by the algorithm of Gilbert, Johnson and Keerthi (GJK).

use super::pose::Pose;
use super::shape::Shape;
use super::simplex::{Corner, Simplex};
use super::support::core_support;
use crate::spatial::Vec3;

/// Largest number of steps.
const STEPS: usize = 200;

/// Number of steps without an improvement after which the iteration ends: in general, and for bounds whose
/// difference is below [`CLOSE`].
const PATIENCE: [usize; 2] = [40, 3];

/// Difference of the bounds below which further steps improve the result little, relative to the largest
/// coordinate.
const CLOSE: f64 = 1e-14;

/// Difference of the bounds at which the iteration ends, relative to the largest coordinate.
const CONVERGED: f64 = 4e-16;

/// Distance below which shapes count as touching, relative to the largest coordinate.
const TOUCHING: f64 = 1e-13;

/// Cores of two convex shapes ([`core_support`]), in the axes of the first.
#[derive(Clone, Copy)]
pub(super) struct Cores<'a> {
    pub(super) a: &'a Shape,
    pub(super) b: &'a Shape,
    /// Pose of the second shape in the axes of the first.
    pub(super) pose: Pose,
}

/// Nearest points of both shapes, m, and the unit normal from the first to the second, in the axes of the
/// first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    pub(super) on_a: Vec3<f64>,
    pub(super) on_b: Vec3<f64>,
    pub(super) normal: Vec3<f64>,
}

impl Cores<'_> {
    /// Returns the farthest point of the first shape along `d`, the farthest point of the second along `−d`,
    /// and their difference.
    pub(super) fn corner(&self, d: Vec3<f64>) -> Corner {
        let on_a = core_support(self.a, d).unwrap_or_else(Vec3::zero);
        let local = core_support(self.b, self.pose.rot.transpose_mul(-d)).unwrap_or_else(Vec3::zero);
        let on_b = self.pose.to_common(local);
        Corner { on_a, on_b, apart: on_a - on_b }
    }

    /// Returns the distance, m, between the supporting planes with the normal `n`: a lower bound of the
    /// signed distance.
    pub(super) fn separation(&self, n: Vec3<f64>) -> f64 {
        -self.corner(n).apart.dot(n)
    }

    /// Returns the same shapes with the second one translated by the vector `by`, m.
    pub(super) fn moved(&self, by: Vec3<f64>) -> Self {
        Self { pose: Pose { pos: self.pose.pos + by, ..self.pose }, ..*self }
    }

    /// Returns the nearest points of separated shapes; `None` if they touch or overlap. `start` is an
    /// approximate direction from the first shape to the second.
    ///
    /// The iteration ends when the supporting planes confirm the distance to within rounding errors, or
    /// when their separation no longer increases. The distance alone is not a sufficient criterion,
    /// because it no longer changes while the normal still turns by 1e-8 rad.
    pub(super) fn nearest(&self, start: Vec3<f64>) -> Option<Nearest> {
        let first = self.corner(start);
        let mut simplex = Simplex::new(first);
        let (mut scale, mut least, mut found) = (first.apart.norm(), f64::INFINITY, None);
        let mut waited = 0;
        for _ in 0..STEPS {
            let nearest = simplex.reduce()?;
            let length = nearest.norm();
            if length.is_nan() || length <= TOUCHING * scale {
                return None;
            }
            let normal = nearest * (-1.0 / length);
            let next = self.corner(normal);
            scale = scale.max(next.apart.norm());
            let gap = length + next.apart.dot(normal);
            if gap < least {
                let (on_a, on_b) = (simplex.mean(|p| p.on_a), simplex.mean(|p| p.on_b));
                (least, found, waited) = (gap, Some(Nearest { on_a, on_b, normal }), 0);
            } else {
                waited += 1;
            }
            let patience = PATIENCE[usize::from(least <= CLOSE * scale)];
            if gap <= CONVERGED * scale || waited >= patience || simplex.contains(&next) {
                break;
            }
            simplex.push(next);
        }
        found
    }
}
