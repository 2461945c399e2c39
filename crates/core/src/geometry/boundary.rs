//! Signed distance from a point to a shape.

use super::profile;
use super::shape::Shape;
use crate::spatial::Vec3;

/// Point of the boundary of a shape that is nearest to a given point, in the axes of the shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundaryPoint {
    /// Distance from the given point to the boundary, m; negative inside the shape.
    pub distance: f64,
    /// Closest point of the boundary, m.
    pub point: Vec3<f64>,
    /// Outward unit normal at this point, which is the gradient of the distance.
    pub normal: Vec3<f64>,
}

/// Returns the signed distance from the point `p` to a shape, with the nearest boundary point and its normal,
/// or `None` for a hull or a compound. Points are in the axes of the shape, m.
///
/// Where several boundary points are equally near, as on the axis of a cylinder, the choice is always the
/// same.
pub fn signed_distance(shape: &Shape, p: Vec3<f64>) -> Option<BoundaryPoint> {
    match shape {
        Shape::Sphere { radius } => Some(about(Vec3::zero(), *radius, p)),
        Shape::Capsule { radius, half_length } => {
            Some(about(Vec3::new(0.0, 0.0, p.z.clamp(-half_length, *half_length)), *radius, p))
        }
        Shape::Box { half_edges } => Some(cuboid(*half_edges, p)),
        Shape::Cylinder { radius, half_length: h } => {
            Some(revolved(&[[0.0, -h], [*radius, -h], [*radius, *h], [0.0, *h]], p))
        }
        Shape::Cone { radius, half_length: h } => Some(revolved(&[[0.0, -h], [*radius, -h], [0.0, *h]], p)),
        Shape::Torus { major_radius, minor_radius } => {
            Some(about(radial(p) * *major_radius, *minor_radius, p))
        }
        Shape::HalfSpace => {
            let (point, normal) = (Vec3::new(p.x, p.y, 0.0), Vec3::new(0.0, 0.0, 1.0));
            Some(BoundaryPoint { distance: p.z, point, normal })
        }
        Shape::Hull(_) | Shape::Compound(_) => None,
    }
}

/// Returns the point nearest to `p` on the sphere with this radius, m, about `center`.
fn about(center: Vec3<f64>, radius: f64, p: Vec3<f64>) -> BoundaryPoint {
    let apart = p - center;
    let length = apart.norm();
    let normal = if length > 0.0 { apart * (1.0 / length) } else { Vec3::new(1.0, 0.0, 0.0) };
    BoundaryPoint { distance: length - radius, point: normal.scale_add(radius, center), normal }
}

/// Returns the unit vector that points from the z axis to `p`, perpendicular to the axis; the x direction if
/// `p` lies on the axis.
fn radial(p: Vec3<f64>) -> Vec3<f64> {
    let length = p.x.hypot(p.y);
    if length > 0.0 { Vec3::new(p.x / length, p.y / length, 0.0) } else { Vec3::new(1.0, 0.0, 0.0) }
}

fn cuboid(half: [f64; 3], p: Vec3<f64>) -> BoundaryPoint {
    let p = [p.x, p.y, p.z];
    let beyond: [f64; 3] = std::array::from_fn(|i| p[i].abs() - half[i]);
    let sign: [f64; 3] = std::array::from_fn(|i| if p[i] < 0.0 { -1.0 } else { 1.0 });
    if beyond.iter().any(|x| *x > 0.0) {
        let point: [f64; 3] = std::array::from_fn(|i| p[i].clamp(-half[i], half[i]));
        let point = Vec3::new(point[0], point[1], point[2]);
        let apart = Vec3::new(p[0], p[1], p[2]) - point;
        let distance = apart.norm();
        return BoundaryPoint { distance, point, normal: apart * (1.0 / distance) };
    }
    let face = (1..3).fold(0, |best, i| if beyond[i] > beyond[best] { i } else { best });
    let mut point = p;
    point[face] = sign[face] * half[face];
    let normal: [f64; 3] = std::array::from_fn(|i| if i == face { sign[i] } else { 0.0 });
    let vector = |x: [f64; 3]| Vec3::new(x[0], x[1], x[2]);
    BoundaryPoint { distance: beyond[face], point: vector(point), normal: vector(normal) }
}

/// Returns the point nearest to `p` on the boundary of the solid that the profile `corners`, m, sweeps about
/// the z axis.
fn revolved(corners: &[[f64; 2]], p: Vec3<f64>) -> BoundaryPoint {
    let away = radial(p);
    let (distance, [rho, z], [n_rho, n_z]) = profile::nearest(corners, [p.x.hypot(p.y), p.z]);
    let lift = |rho: f64, z: f64| Vec3::new(away.x * rho, away.y * rho, z);
    BoundaryPoint { distance, point: lift(rho, z), normal: lift(n_rho, n_z) }
}
