//! Farthest points of shapes in a direction.

use super::shape::Shape;
use crate::spatial::Vec3;

/// Returns the point of a shape that is farthest in the direction `d`, in the axes of the shape.
///
/// Returns `None` for a half-space, which is unbounded, and for a compound, which callers replace by its
/// pieces.
pub(super) fn support(shape: &Shape, d: Vec3<f64>) -> Option<Vec3<f64>> {
    match shape {
        Shape::Sphere { radius } => Some(ball(Vec3::zero(), *radius, d)),
        Shape::Capsule { radius, half_length } => Some(ball(end(*half_length, d), *radius, d)),
        Shape::Torus { major_radius, minor_radius } => {
            Some(ball(rim(*major_radius, 0.0, d), *minor_radius, d))
        }
        Shape::HalfSpace | Shape::Compound(_) => None,
        _ => core_support(shape, d),
    }
}

/// Returns the farthest point of the core of a shape in the direction `d`, in the axes of the shape. The core
/// of a sphere is its centre, that of a capsule its axis, and that of any other convex body the body itself;
/// `None` for a torus, a half-space and a compound.
pub(super) fn core_support(shape: &Shape, d: Vec3<f64>) -> Option<Vec3<f64>> {
    match shape {
        Shape::Sphere { .. } => Some(Vec3::zero()),
        Shape::Capsule { half_length, .. } => Some(end(*half_length, d)),
        Shape::Box { half_edges: [x, y, z] } => {
            Some(Vec3::new(x.copysign(d.x), y.copysign(d.y), z.copysign(d.z)))
        }
        Shape::Cylinder { radius, half_length } => Some(rim(*radius, half_length.copysign(d.z), d)),
        Shape::Cone { radius, half_length } => {
            let base = rim(*radius, -half_length, d);
            let apex = Vec3::new(0.0, 0.0, *half_length);
            Some(if base.dot(d) >= apex.dot(d) { base } else { apex })
        }
        Shape::Hull(hull) => Some(hull.farthest(d)),
        Shape::Torus { .. } | Shape::HalfSpace | Shape::Compound(_) => None,
    }
}

/// Returns the distance, m, by which a shape extends beyond its core: the radius of a sphere or a capsule,
/// and 0 for other shapes.
pub(super) fn rounding(shape: &Shape) -> f64 {
    match shape {
        Shape::Sphere { radius } | Shape::Capsule { radius, .. } => *radius,
        _ => 0.0,
    }
}

fn end(half_length: f64, d: Vec3<f64>) -> Vec3<f64> {
    Vec3::new(0.0, 0.0, half_length.copysign(d.z))
}

fn ball(center: Vec3<f64>, radius: f64, d: Vec3<f64>) -> Vec3<f64> {
    let length = d.norm();
    if length > 0.0 { d.scale_add(radius / length, center) } else { center }
}

/// Returns the farthest point of the circle about the z axis at the height `z` in the direction `d`; the
/// centre of the circle if `d` is parallel to z.
fn rim(radius: f64, z: f64, d: Vec3<f64>) -> Vec3<f64> {
    let across = (d.x * d.x + d.y * d.y).sqrt();
    let scale = if across > 0.0 { radius / across } else { 0.0 };
    Vec3::new(scale * d.x, scale * d.y, z)
}
