//! State of a pair of pieces with an impact law: the points at which the pieces rest on each other, and the
//! forces that prevent an overlap.

use super::pressure::{Pressure, Resultant};
use super::side::SideMotion;
use crate::contact::ImpactLaw;
use crate::geometry::ContactPoint;
use crate::spatial::Vec3;
use serde::{Deserialize, Serialize};

/// Law and state of a pair of pieces with an impact law.
#[derive(Clone, Debug)]
pub(super) struct Rigid {
    pub(super) law: ImpactLaw,
    /// Points at which the pieces rest on each other; `None` while they are apart.
    pub(super) points: Option<Vec<RestingPoint>>,
}

/// Point at which two pieces rest on each other, in the axes of the first side.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::simulation) struct RestingPoint {
    /// Position relative to the origin of the frame of the first side, m.
    pub(super) at: Vec3<f64>,
    /// Unit vectors: the normal from the first side to the second, and two tangents.
    pub(super) axes: [Vec3<f64>; 3],
    /// Components of the force on the second side along the axes, N; constant during a step.
    pub(super) force: [f64; 3],
    /// Gap at the start of the step, m.
    pub(super) gap: f64,
}

impl RestingPoint {
    /// Returns the force on the second side in the axes of the first side, N.
    fn total(&self) -> Vec3<f64> {
        let [n, s, t] = self.axes;
        n * self.force[0] + s * self.force[1] + t * self.force[2]
    }

    /// Returns the position, in W, m, of the contact point in `found` that is closest to this resting point,
    /// or of the resting point itself if `found` is empty. `a` is the motion of the first side.
    pub(super) fn present(&self, found: &[ContactPoint], a: &SideMotion) -> Vec3<f64> {
        let moved = a.frame.to_common(self.at);
        let place = |own: &ContactPoint| (own.point_a + own.point_b) * 0.5;
        let distance = |at: &Vec3<f64>| (*at - moved).norm();
        let nearest = found.iter().map(place).min_by(|x, y| distance(x).total_cmp(&distance(y)));
        nearest.unwrap_or(moved)
    }
}

impl Rigid {
    /// Returns the resultant of the forces between pieces that rest on each other; `None` if no point exerts
    /// a normal force. Each force acts at the contact point in `found` that is closest to its resting point.
    pub(super) fn resultant(&self, found: &[ContactPoint], [a, b]: &[SideMotion; 2]) -> Option<Resultant> {
        let points = self.points.as_ref()?;
        let force: f64 = points.iter().map(|point| point.force[0]).sum();
        if force <= 0.0 {
            return None;
        }
        let (mut on_b, mut center) = (Vec3::zero(), Vec3::zero());
        for point in points {
            on_b += a.frame.rot * point.total();
            center += point.present(found, a) * (point.force[0] / force);
        }
        let (mut moment, mut power) = (Vec3::zero(), 0.0);
        for point in points {
            let (own, at) = (a.frame.rot * point.total(), point.present(found, a));
            moment += (at - center).cross(own);
            power -= own.dot(b.velocity_at(at) - a.velocity_at(at));
        }
        let pressure = Pressure { force, power, loss: 0.0, elastic: 0.0 };
        Some(Resultant { pressure, point: center, on_b, moment })
    }
}

/// Returns three orthonormal vectors: `normal`, which must have unit length, and two tangents.
pub(super) fn axes_of(normal: Vec3<f64>) -> [Vec3<f64>; 3] {
    let other = if normal.x.abs() < 0.7 { Vec3::new(1.0, 0.0, 0.0) } else { Vec3::new(0.0, 1.0, 0.0) };
    let across = normal.cross(other);
    let first = across * (1.0 / across.norm());
    [normal, first, normal.cross(first)]
}
