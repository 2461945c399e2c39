//! Distance of a torus from another shape: the distance of its middle circle from the shape, less its minor
//! radius.

use super::boundary::{BoundaryPoint, signed_distance};
use super::convex;
use super::pose::Pose;
use super::proximity::Proximity;
use super::shape::Shape;
use super::support::rounding;
use crate::spatial::Vec3;
use std::f64::consts::TAU;

/// Number of points of the circle from which the search for the nearest one starts.
const SAMPLES: u32 = 64;

/// Number of bisections of the interval between two neighbouring samples, after which the angle is
/// accurate to within rounding errors.
const HALVINGS: usize = 52;

/// Radius, relative to the size of a hull, of the sphere that replaces a point in the computation of the
/// distance between the point and the hull.
const POINT: f64 = 1e-3;

/// Point of the circle at an angle, rad, with the nearest boundary point of the other shape, their distance,
/// m, and the change of this distance per length along the circle.
#[derive(Clone, Copy)]
struct Sample {
    angle: f64,
    distance: f64,
    slope: f64,
    nearest: BoundaryPoint,
    on_circle: Vec3<f64>,
}

/// Returns the distance of shape `a` from a torus with this major and minor radius, m, and this pose in the
/// axes of `a`; `Ok(None)` if the middle circle of the torus intersects the core of `a` (the centre of a
/// sphere, the axis of a capsule, the middle circle of a torus, or the entire shape for other kinds), because the
/// shortest separating translation is then not determined by a single point.
///
/// The distance along the circle may have several minima. Each interval between neighbouring samples that
/// contains a minimum is bisected to find the angle at which the rate `nᵀ t` of the distance changes sign,
/// with the normal `n` and the unit tangent `t` of the circle.
///
/// # Errors
/// The difference between the bounds, m, of the distance of a hull that does not converge; NaN if no normal
/// was found.
pub(super) fn closest(a: &Shape, torus: (f64, f64), pose: &Pose) -> Result<Option<Proximity>, f64> {
    let (major_radius, minor_radius) = torus;
    let at = |angle: f64| sample(a, major_radius, pose, angle);
    let angle = |k: u32| TAU * f64::from(k) / f64::from(SAMPLES);
    let samples: Vec<Sample> = (0..=SAMPLES).map(|k| at(angle(k))).collect::<Result<_, _>>()?;
    let mut best =
        samples.iter().copied().fold(samples[0], |p, q| if q.distance < p.distance { q } else { p });
    for pair in samples.windows(2) {
        if pair[0].slope < 0.0 && pair[1].slope > 0.0 {
            let found = bisect(pair[0], pair[1], at)?;
            if found.distance < best.distance {
                best = found;
            }
        }
    }
    let core = match a {
        Shape::Torus { minor_radius, .. } => *minor_radius,
        _ => rounding(a),
    };
    Ok((best.distance > -core).then(|| {
        let normal = best.nearest.normal;
        Proximity {
            distance: best.distance - minor_radius,
            point_a: best.nearest.point,
            point_b: normal.scale_add(-minor_radius, best.on_circle),
            normal,
        }
    }))
}

fn bisect(mut low: Sample, mut high: Sample, at: impl Fn(f64) -> Result<Sample, f64>) -> Result<Sample, f64> {
    for _ in 0..HALVINGS {
        let middle = at(0.5 * (low.angle + high.angle))?;
        if middle.slope < 0.0 { low = middle } else { high = middle }
    }
    Ok(if low.distance < high.distance { low } else { high })
}

/// Returns the sample at an angle, rad, along the circle, in the axes of `a`. The error is that of
/// [`nearest_point`].
fn sample(a: &Shape, major_radius: f64, pose: &Pose, angle: f64) -> Result<Sample, f64> {
    let (sine, cosine) = angle.sin_cos();
    let on_circle = pose.to_common(Vec3::new(major_radius * cosine, major_radius * sine, 0.0));
    let along = pose.rot * Vec3::new(-sine, cosine, 0.0);
    let nearest = nearest_point(a, on_circle)?;
    let slope = nearest.normal.dot(along);
    Ok(Sample { angle, distance: nearest.distance, slope, nearest, on_circle })
}

/// Returns the nearest boundary point of a shape to a point in its axes. The error is the difference between
/// the bounds, m, of the distance of a hull that does not converge; NaN for a compound.
fn nearest_point(a: &Shape, p: Vec3<f64>) -> Result<BoundaryPoint, f64> {
    if let Shape::Hull(hull) = a {
        let radius = POINT * hull.bounding_sphere().radius;
        let found = convex::closest(&Shape::Sphere { radius }, a, &Pose::at(-p))?;
        let normal = -found.normal;
        return Ok(BoundaryPoint { distance: found.distance + radius, point: found.point_b + p, normal });
    }
    signed_distance(a, p).ok_or(f64::NAN)
}
