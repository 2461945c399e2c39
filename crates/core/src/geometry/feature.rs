//! Part of the surface of a shape that faces a direction: a point, a segment, a face, or an unbounded plane.

use super::hull::{Face, Hull};
use super::pose::Pose;
use super::shape::Shape;
use crate::spatial::Vec3;
use std::f64::consts::TAU;

/// Number of corners of the polygon that replaces a disc.
pub(super) const DISC_CORNERS: u32 = 8;

/// Largest distance, relative to the size of the hull, between a face and a point that counts as part of the
/// face.
const ON_FACE: f64 = 1e-9;

/// Part of the surface of a shape that faces a given direction.
#[derive(Clone, Debug)]
pub(super) enum Feature {
    /// Single point, such as the nearest point of a sphere.
    Point,
    /// Line on a round surface.
    Segment {
        /// End points of the line, m.
        ends: [Vec3<f64>; 2],
        /// Radius of curvature of the surface across the line, m; half the base radius for a cone.
        radius: f64,
    },
    /// Face bounded by a convex polygon.
    Face {
        /// Corners in order around the polygon, m.
        corners: Vec<Vec3<f64>>,
        /// Outward unit normal.
        normal: Vec3<f64>,
        /// Centre, m, and radius, m, of the disc that the polygon approximates; `None` for a face that is a
        /// polygon.
        disc: Option<(Vec3<f64>, f64)>,
    },
    /// Boundary plane of a half-space.
    Plane,
}

impl Feature {
    /// Returns the feature of a shape, in common axes, that faces the direction `d` (unit vector) and, for a
    /// hull, contains the point `witness`; both arguments are in common axes.
    pub(super) fn of(shape: &Shape, pose: &Pose, witness: Vec3<f64>, d: Vec3<f64>) -> Self {
        match local(shape, pose.to_shape(witness), pose.rot.transpose_mul(d)) {
            Self::Segment { ends, radius } => Self::Segment { ends: ends.map(|p| pose.to_common(p)), radius },
            Self::Face { corners, normal, disc } => Self::Face {
                corners: corners.into_iter().map(|p| pose.to_common(p)).collect(),
                normal: pose.rot * normal,
                disc: disc.map(|(center, radius)| (pose.to_common(center), radius)),
            },
            other => other,
        }
    }
}

fn local(shape: &Shape, witness: Vec3<f64>, d: Vec3<f64>) -> Feature {
    let across = (d.x * d.x + d.y * d.y).sqrt();
    let away =
        if across > 0.0 { Vec3::new(d.x / across, d.y / across, 0.0) } else { Vec3::new(1.0, 0.0, 0.0) };
    let at = |rho: f64, z: f64| away.scale_add(rho, Vec3::new(0.0, 0.0, z));
    match shape {
        Shape::HalfSpace => Feature::Plane,
        Shape::Capsule { radius, half_length } if *half_length > 0.0 => {
            let end = |z: f64| d.scale_add(*radius, Vec3::new(0.0, 0.0, z));
            Feature::Segment { ends: [end(-half_length), end(*half_length)], radius: *radius }
        }
        Shape::Box { half_edges } => box_face(*half_edges, [d.x, d.y, d.z]),
        Shape::Cylinder { radius, half_length } if d.z.abs() >= across => {
            disc(*radius, half_length.copysign(d.z), away, 1.0_f64.copysign(d.z))
        }
        Shape::Cylinder { radius, half_length } => {
            Feature::Segment { ends: [at(*radius, -half_length), at(*radius, *half_length)], radius: *radius }
        }
        Shape::Cone { radius, half_length } => {
            // the normal of the side is (2 half_length, radius) over its length in the half plane (ρ, z)
            let side = (across * 2.0 * half_length + d.z * radius) / radius.hypot(2.0 * half_length);
            if -d.z >= side {
                disc(*radius, -half_length, away, -1.0)
            } else {
                let ends = [at(*radius, -half_length), at(0.0, *half_length)];
                Feature::Segment { ends, radius: 0.5 * radius }
            }
        }
        Shape::Hull(hull) => hull_face(hull, witness, d),
        Shape::Sphere { .. } | Shape::Capsule { .. } | Shape::Torus { .. } | Shape::Compound(_) => {
            Feature::Point
        }
    }
}

/// Returns the face of a box whose normal is nearest to `d`.
fn box_face(half_edges: [f64; 3], d: [f64; 3]) -> Feature {
    let x = (1..3).fold(0, |best, i| if d[i].abs() > d[best].abs() { i } else { best });
    let (y, z) = ((x + 1) % 3, (x + 2) % 3);
    let sign = 1.0_f64.copysign(d[x]);
    let mut normal = [0.0; 3];
    normal[x] = sign;
    let corner = |(side_y, side_z): (f64, f64)| {
        let mut corner = [0.0; 3];
        corner[x] = sign * half_edges[x];
        corner[y] = side_y * half_edges[y];
        corner[z] = sign * side_z * half_edges[z]; // counterclockwise about the normal
        Vec3::from_slice(&corner)
    };
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(corner).to_vec();
    Feature::Face { corners, normal: Vec3::from_slice(&normal), disc: None }
}

/// Returns a regular polygon in the disc about the z axis with this radius and height `z`, m. Its normal is
/// `sign` times the z axis. Its first corner lies in the direction `away` and is the nearest to the other
/// shape.
fn disc(radius: f64, z: f64, away: Vec3<f64>, sign: f64) -> Feature {
    let side = Vec3::new(-away.y, away.x, 0.0);
    let corner = |k: u32| {
        let (sine, cosine) = (sign * TAU * f64::from(k) / f64::from(DISC_CORNERS)).sin_cos();
        Vec3::new(0.0, 0.0, z) + away * (radius * cosine) + side * (radius * sine)
    };
    Feature::Face {
        corners: (0..DISC_CORNERS).map(corner).collect(),
        normal: Vec3::new(0.0, 0.0, sign),
        disc: Some((Vec3::new(0.0, 0.0, z), radius)),
    }
}

/// Returns the face with the normal nearest to `d` among those that contain `witness`, or a point if none
/// does.
fn hull_face(hull: &Hull, witness: Vec3<f64>, d: Vec3<f64>) -> Feature {
    let tolerance = ON_FACE * hull.bounding_sphere().radius;
    let vertices = hull.vertices();
    let contains = |face: &&Face| face.normal.dot(witness - vertices[face.corners[0]]).abs() <= tolerance;
    let nearest =
        hull.faces().iter().filter(contains).max_by(|f, g| f.normal.dot(d).total_cmp(&g.normal.dot(d)));
    nearest.map_or(Feature::Point, |face| Feature::Face {
        corners: face.corners.iter().map(|i| vertices[*i]).collect(),
        normal: face.normal,
        disc: None,
    })
}
