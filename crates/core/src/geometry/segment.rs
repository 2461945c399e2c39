//! Nearest points of two segments.

use crate::spatial::Vec3;

/// Sine of the angle below which segments count as parallel.
const PARALLEL: f64 = 1e-12;

/// Distance between two segments below which they count as intersecting, relative to the sum of their half
/// lengths and the distance between their centres.
const INTERSECTING: f64 = 1e-14;

/// Segment `center + s axis` with `|s| ≤ half_length`, m; `axis` is a unit vector.
#[derive(Clone, Copy)]
pub(super) struct Segment {
    pub(super) center: Vec3<f64>,
    pub(super) axis: Vec3<f64>,
    pub(super) half_length: f64,
}

impl Segment {
    pub(super) fn at(&self, s: f64) -> Vec3<f64> {
        self.axis.scale_add(s, self.center)
    }

    /// Returns the coordinate `s` of the point of the segment that is nearest to `p`, m.
    pub(super) fn nearest(&self, p: Vec3<f64>) -> f64 {
        (p - self.center).dot(self.axis).clamp(-self.half_length, self.half_length)
    }
}

/// Returns the nearest points of two segments and the unit normal from the first to the second. For parallel
/// segments with a common part, the points lie in its middle; for segments that intersect, the normal is
/// perpendicular to both.
pub(super) fn nearest(a: Segment, b: Segment) -> (Vec3<f64>, Vec3<f64>, Vec3<f64>) {
    let (on_a, on_b) = nearest_points(a, b);
    let (apart, cross) = (on_b - on_a, a.axis.cross(b.axis));
    let length = apart.norm();
    let scale = (b.center - a.center).norm() + a.half_length + b.half_length;
    if length > INTERSECTING * scale {
        return (on_a, on_b, apart * (1.0 / length));
    }
    let across = if cross.norm() > PARALLEL { cross } else { perpendicular(a.axis) };
    let sign = 1.0_f64.copysign(across.dot(b.center - a.center));
    (on_a, on_b, across * (sign / across.norm()))
}

fn nearest_points(a: Segment, b: Segment) -> (Vec3<f64>, Vec3<f64>) {
    let between = b.center - a.center;
    let cross = a.axis.cross(b.axis);
    let squared = cross.dot(cross);
    if squared <= PARALLEL * PARALLEL {
        // ends of the second segment, as coordinates along the first
        let (middle, sign) = (between.dot(a.axis), 1.0_f64.copysign(a.axis.dot(b.axis)));
        let low = (-a.half_length).max(middle - b.half_length);
        let high = a.half_length.min(middle + b.half_length);
        let s = (0.5 * (low + high)).clamp(-a.half_length, a.half_length);
        let t = (sign * (s - middle)).clamp(-b.half_length, b.half_length);
        return (a.at(s), b.at(t));
    }
    let s = between.cross(b.axis).dot(cross) / squared;
    let t = between.cross(a.axis).dot(cross) / squared;
    if s.abs() <= a.half_length && t.abs() <= b.half_length {
        return (a.at(s), b.at(t));
    }
    // otherwise one of the points is an end
    let mut best = (f64::INFINITY, a.center, b.center);
    for sign in [-1.0, 1.0] {
        let (end_a, end_b) = (a.at(sign * a.half_length), b.at(sign * b.half_length));
        for (p, q) in [(end_a, b.at(b.nearest(end_a))), (a.at(a.nearest(end_b)), end_b)] {
            let length = (q - p).norm();
            if length < best.0 {
                best = (length, p, q);
            }
        }
    }
    (best.1, best.2)
}

/// Returns a vector perpendicular to `u`.
pub(super) fn perpendicular(u: Vec3<f64>) -> Vec3<f64> {
    let axis = if u.x.abs() <= u.y.abs().min(u.z.abs()) {
        Vec3::new(1.0, 0.0, 0.0)
    } else if u.y.abs() <= u.z.abs() {
        Vec3::new(0.0, 1.0, 0.0)
    } else {
        Vec3::new(0.0, 0.0, 1.0)
    };
    u.cross(axis)
}
