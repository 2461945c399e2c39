//! Signed distance between two convex shapes: GJK on their cores, and EPA where the cores overlap.

use super::epa::least_support;
use super::gjk::{Cores, Nearest};
use super::pose::Pose;
use super::proximity::Proximity;
use super::shape::Shape;
use super::support::rounding;
use crate::spatial::Vec3;

/// Distance, relative to the size of the smaller shape, to which the second shape is moved along the normal
/// to find the nearest points of shapes that are close or overlap.
const MARGIN: f64 = 0.1;

/// Largest number of corrections of the normal.
const CORRECTIONS: usize = 30;

/// Change of the normal, rad, at which the iteration ends.
const FINAL: f64 = 1e-12;

/// Change of the normal, rad, below which the iteration ends as soon as the change no longer decreases.
const RESOLUTION: f64 = 1e-7;

/// Largest accepted difference between the bounds of the distance, which are the distance between the witness
/// points and that between the supporting planes, relative to the sum of the radii of the bounding spheres
/// and the distance between their centres.
const RESOLVED: f64 = 1e-9;

/// Returns the distance between two convex shapes, given the pose of the second in the axes of the first, or,
/// if the iteration does not converge, the difference of the bounds of the distance, m, which is NaN if no
/// normal was found.
pub(super) fn closest(a: &Shape, b: &Shape, pose: &Pose) -> Result<Proximity, f64> {
    let cores = Cores { a, b, pose: *pose };
    let (sphere_a, sphere_b) = (a.bounding_sphere(), b.bounding_sphere());
    let size = sphere_a.radius.min(sphere_b.radius);
    let between = pose.to_common(sphere_b.center) - sphere_a.center;
    let start = if between.norm() > 0.0 { between } else { Vec3::new(1.0, 0.0, 0.0) };
    let found = match cores.nearest(start) {
        Some(found) if (found.on_b - found.on_a).norm() > MARGIN * size => found,
        Some(found) => corrected(&cores, found.normal, MARGIN * size).unwrap_or(found),
        None => {
            let normal = least_support(|d| cores.corner(d).apart).ok_or(f64::NAN)?;
            corrected(&cores, normal, MARGIN * size).ok_or(f64::NAN)?
        }
    };
    let Nearest { on_a, on_b, normal } = found;
    let apart = cores.separation(normal);
    let gap = ((on_b - on_a).dot(normal) - apart).abs();
    if gap.is_nan() || gap > RESOLVED * (sphere_a.radius + sphere_b.radius + between.norm()) {
        return Err(gap);
    }
    let (radius_a, radius_b) = (rounding(a), rounding(b));
    Ok(Proximity {
        distance: apart - radius_a - radius_b,
        point_a: normal.scale_add(radius_a, on_a),
        point_b: normal.scale_add(-radius_b, on_b),
        normal,
    })
}

/// Returns the nearest points and the normal of shapes that are close or overlap, from an approximate normal;
/// `None` if the shapes overlap even after the second one was moved along this normal.
///
/// The signed distance is the largest separation of supporting planes, `max over n of s(n)`. The second shape
/// is moved along `n` until it is at the distance `m`, where the normal of the nearest points is the next
/// `n`. The separation never decreases, and the error of the normal shrinks by `(depth + m)/(R + m)`, with
/// the radius of curvature `R` of the difference of the shapes; for polytopes, a single step suffices.
fn corrected(cores: &Cores<'_>, mut normal: Vec3<f64>, margin: f64) -> Option<Nearest> {
    let mut separation = cores.separation(normal);
    let (mut found, mut last) = (None, f64::INFINITY);
    for _ in 0..CORRECTIONS {
        let shift = normal * (margin - separation);
        let nearest = cores.moved(shift).nearest(normal)?;
        let (change, next) = ((nearest.normal - normal).norm(), cores.separation(nearest.normal));
        found = Some(Nearest { on_b: nearest.on_b - shift, ..nearest });
        (normal, separation) = (nearest.normal, next);
        // between round shapes, the change ends at the resolution of the nearest points, about 1e-8
        if change <= FINAL || (change <= RESOLUTION && change > 0.5 * last) {
            break;
        }
        last = change;
    }
    found
}
