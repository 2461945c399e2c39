//! Normal force of a contact, from all of its points.

use super::side::SideMotion;
use crate::contact::NormalLaw;
use crate::geometry::ContactPoint;
use crate::spatial::Vec3;

/// Resultant of the normal forces at the points of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pressure {
    /// Point at which the resultant acts, m, in W.
    pub(super) point: Vec3<f64>,
    /// Magnitude of the resultant, N.
    pub(super) force: f64,
    /// Power taken from the motion, W.
    pub(super) power: f64,
    /// Elastic energy of all points, J.
    pub(super) elastic: f64,
}

impl Pressure {
    /// Computes the resultant `N = Σ w_i F(x_i, ẋ_i)` of the forces at points with the weights `w_i`. It acts
    /// at `Σ w_i F_i p_i/N`, about which the forces have no moment, since all are parallel to the normal.
    ///
    /// A single point may pull: its force is continued beyond lift-off, which ends the step. Pieces that
    /// separate without force (`is_pressing` false) and points that would pull dissipate their elastic energy.
    pub(super) fn of(
        law: &NormalLaw,
        points: &[ContactPoint],
        normal: Vec3<f64>,
        [a, b]: &[SideMotion; 2],
        is_pressing: bool,
    ) -> Self {
        let middle = |point: &ContactPoint| (point.point_a + point.point_b) * 0.5;
        let mut sum = Self { point: Vec3::zero(), force: 0.0, power: 0.0, elastic: 0.0 };
        for point in points {
            let (at, depth) = (middle(point), point.depth);
            let rate = -normal.dot(b.velocity_at(at) - a.velocity_at(at));
            let force = match points {
                _ if !is_pressing => 0.0,
                [_] => law.force(depth, rate),
                _ if depth > 0.0 => law.force(depth, rate).max(0.0),
                _ => 0.0,
            };
            let share = point.weight * force;
            sum.force += share;
            sum.point += at * share;
            sum.power += share * rate;
            sum.elastic += point.weight * law.elastic_energy(depth);
        }
        sum.point = match points {
            [only] => middle(only),
            _ if sum.force > 0.0 => sum.point * (1.0 / sum.force),
            _ => points.iter().fold(Vec3::zero(), |all, point| all + middle(point) * point.weight),
        };
        sum
    }
}
