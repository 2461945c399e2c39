//! Projection of features along the normal of a contact.

use super::feature::Feature;
use super::polygon::Point;
use super::proximity::Proximity;
use super::segment::perpendicular;
use crate::spatial::Vec3;

/// Number at or below which a feature is not part of a contact: the cosine of the angle between the normal
/// of a face and the normal of the contact, or the sine of the angle between a line and this normal.
const STEEP: f64 = 0.1;

/// Plane through the first witness point and perpendicular to the normal.
pub(super) struct Projection {
    /// First witness point, the origin of the plane's coordinates, m.
    pub(super) origin: Vec3<f64>,
    /// Distance between the shapes, m.
    pub(super) distance: f64,
    x: Vec3<f64>,
    y: Vec3<f64>,
    normal: Vec3<f64>,
}

impl Projection {
    pub(super) fn new(proximity: &Proximity) -> Self {
        let Proximity { normal, point_a: origin, distance, .. } = *proximity;
        let across = perpendicular(normal);
        let x = across * (1.0 / across.norm());
        Self { origin, distance, x, y: normal.cross(x), normal }
    }

    fn project(&self, p: Vec3<f64>) -> Point {
        [(p - self.origin).dot(self.x), (p - self.origin).dot(self.y)]
    }

    /// Returns the point at `height`, m, along the normal above the point `p` of the plane.
    pub(super) fn lift(&self, p: Point, height: f64) -> Vec3<f64> {
        self.normal.scale_add(height, self.x.scale_add(p[0], self.y.scale_add(p[1], self.origin)))
    }

    /// Returns true if a line is nearly parallel to the normal.
    pub(super) fn is_steep(&self, [from, to]: [Vec3<f64>; 2]) -> bool {
        let along = to - from;
        self.normal.cross(along).norm() <= STEEP * along.norm()
    }

    /// Returns the projections, m, of the ends of a segment or, counterclockwise about the normal, of the
    /// corners of a face; `None` for a point, a half-space, a segment that is nearly parallel to the normal
    /// and a face that is nearly perpendicular to the plane.
    pub(super) fn corners(&self, feature: &Feature) -> Option<Vec<Point>> {
        match feature {
            Feature::Segment { ends, .. } if !self.is_steep(*ends) => {
                Some(ends.iter().map(|p| self.project(*p)).collect())
            }
            Feature::Face { corners, normal, .. } if normal.dot(self.normal).abs() > STEEP => {
                let mut corners: Vec<_> = corners.iter().map(|p| self.project(*p)).collect();
                if normal.dot(self.normal) < 0.0 {
                    corners.reverse();
                }
                Some(corners)
            }
            _ => None,
        }
    }

    /// Returns the height, m, along the normal, of a feature above the point `p` of the plane. For a point
    /// or a half-space, returns `other`.
    pub(super) fn height(&self, feature: &Feature, p: Point, other: f64) -> f64 {
        let foot = self.lift(p, 0.0);
        match feature {
            Feature::Face { corners, normal, .. } => {
                (corners[0] - foot).dot(*normal) / self.normal.dot(*normal)
            }
            Feature::Segment { ends: [from, to], .. } => {
                let along = *to - *from;
                let level = self.normal.scale_add(-along.dot(self.normal), along);
                let t = (foot - *from).dot(level) / level.dot(level);
                (along.scale_add(t, *from) - self.origin).dot(self.normal)
            }
            Feature::Point | Feature::Plane => other,
        }
    }
}
