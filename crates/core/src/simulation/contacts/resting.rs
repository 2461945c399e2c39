//! Search for the points at which pieces with an impact law touch.

use super::responses::ContactAt;
use super::rigid::axes_of;
use super::side::SideMotion;
use super::touching::Touching;
use crate::contact::ContactError;
use crate::geometry::ContactPoint;
use crate::spatial::Vec3;

/// Gap, relative to the smaller reach of the two pieces, up to which points of the pieces count as touching.
const TOUCHING: f64 = 1e-9;
/// Gap, relative to the smaller reach, up to which points of pieces that rest on each other count as
/// touching; it is larger than [`TOUCHING`] because it must include integration errors. Also the depth,
/// relative to the smaller reach, at which a step of such pieces ends because other points have begun to
/// touch.
const RESTING: f64 = 1e-6;
/// Distance between two points, relative to the smaller reach, below which they count as the same point.
const SAME: f64 = 0.1;
/// Multiple of the rounding error of the distance that is added to the gap up to which points touch.
const ROUNDINGS: f64 = 1e3;

impl Touching {
    /// Returns true if the pieces rest on each other under an impact law.
    pub(super) fn is_resting(&self) -> bool {
        self.rigid.as_ref().is_some_and(|rigid| rigid.points.is_some())
    }

    /// Returns true if the pieces rest on each other at a point near `position`, which is relative to the
    /// frame of the first side, m.
    pub(super) fn rests_near(&self, position: Vec3<f64>) -> bool {
        let points = self.rigid.iter().flat_map(|rigid| &rigid.points).flatten();
        let limit = SAME * self.smaller_reach();
        points.into_iter().any(|point| (point.at - position).norm() < limit)
    }

    /// Returns the largest gap, m, at which points of the pieces count as touching.
    pub(super) fn touching_gap(&self, motions: &[SideMotion; 2]) -> f64 {
        let relative = if self.is_resting() { RESTING } else { TOUCHING };
        relative * self.smaller_reach() + ROUNDINGS * self.rounding(motions)
    }

    /// Returns the points at which the pieces touch, each with its gap, m. These are the contact points of
    /// the shapes and, unless it is near one of them, the midpoint of the witness points.
    pub(super) fn rigid_points(
        &self,
        motions: &[SideMotion; 2],
    ) -> Result<Vec<(ContactAt, f64)>, ContactError> {
        let (proximity, points) = self.geometry(self.mode.phase, motions)?;
        let within = self.touching_gap(motions);
        let axes = axes_of(proximity.normal);
        let places = [0, 1].map(|side: usize| self.sides[side].place);
        let touches = |point: &&ContactPoint| -point.depth <= within;
        let points = points.list(&proximity);
        let touching = points.iter().filter(touches).map(|point| {
            let at = (point.point_a + point.point_b) * 0.5;
            (ContactAt { places, at, axes }, -point.depth)
        });
        let mut found: Vec<_> = touching.collect();
        let (center, near) = (proximity.center(), SAME * self.smaller_reach());
        let is_known = found.iter().any(|(point, _): &(ContactAt, f64)| (point.at - center).norm() < near);
        if !is_known && proximity.distance <= within {
            found.push((ContactAt { places, at: center, axes }, proximity.distance));
        }
        Ok(found)
    }

    /// Returns the margin, m, of pieces with an impact law at the depth `depth`, m: their distance while they
    /// are apart, and the distance from the depth at which other points begin to touch while they rest on
    /// each other.
    pub(super) fn rigid_margin(&self, depth: f64) -> f64 {
        if self.is_resting() { RESTING * self.smaller_reach() - depth } else { -depth }
    }
}
