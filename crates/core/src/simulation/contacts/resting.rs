//! Points at which pieces with an impact law touch.

use super::responses::ContactAt;
use super::rigid::axes_of;
use super::side::SideMotion;
use super::touching::Touching;
use crate::contact::ContactError;
use crate::geometry::ContactPoint;
use crate::spatial::Vec3;

/// Gap, relative to the smaller reach of the pieces, within which their points touch.
const TOUCHING: f64 = 1e-9;
/// The same for pieces that rest on each other, whose gap has errors of the order of the step; also the depth
/// at which a step of such pieces ends, because other points of them touch.
const RESTING: f64 = 1e-6;
/// Distance, relative to the smaller reach, within which two points count as the same.
const SAME: f64 = 0.1;
/// Rounding errors of the distance within which points touch.
const ROUNDINGS: f64 = 1e3;

impl Touching {
    /// Returns true if the pieces rest on each other under an impact law.
    pub(super) fn is_resting(&self) -> bool {
        self.rigid.as_ref().is_some_and(|rigid| rigid.points.is_some())
    }

    /// Returns true if the pieces have rested on each other near a position, m, in the axes of the first side.
    pub(super) fn rests_near(&self, position: Vec3<f64>) -> bool {
        let points = self.rigid.iter().flat_map(|rigid| &rigid.points).flatten();
        let limit = SAME * self.smaller_reach();
        points.into_iter().any(|point| (point.at - position).norm() < limit)
    }

    /// Returns the gap within which points of the pieces touch, m.
    pub(super) fn touching_gap(&self, motions: &[SideMotion; 2]) -> f64 {
        let relative = if self.is_resting() { RESTING } else { TOUCHING };
        relative * self.smaller_reach() + ROUNDINGS * self.rounding(motions)
    }

    /// Returns the points of the pieces that touch, with their gaps, m: contact points and, if it is not
    /// near any of these, the middle of the witness points.
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

    /// Returns the margin, m, of pieces with an impact law at this depth, m: to their touch-down while they
    /// are apart, and to the overlap of other points while they rest on each other.
    pub(super) fn rigid_margin(&self, depth: f64) -> f64 {
        if self.is_resting() { RESTING * self.smaller_reach() - depth } else { -depth }
    }
}
