//! Random shapes and poses, and their support functions, which share no code with the engine.
#![allow(dead_code)] // no test file uses all of it

use onorbit_core::geometry::{Pose, Shape};
use onorbit_core::spatial::{Vec3, exp_so3};

/// Kinds of convex shapes that [`Random::shape`] makes.
pub(crate) const KINDS: [&str; 6] = ["sphere", "capsule", "box", "cylinder", "cone", "hull"];

/// Linear congruential generator.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub(crate) fn vector(&mut self, size: f64) -> Vec3<f64> {
        Vec3::new(self.within(-size, size), self.within(-size, size), self.within(-size, size))
    }

    pub(crate) fn direction(&mut self) -> Vec3<f64> {
        loop {
            let v = self.vector(1.0);
            if (0.1..1.0).contains(&v.norm()) {
                return v * (1.0 / v.norm());
            }
        }
    }

    /// Returns a shape of about 1 m: its kind is an index of [`KINDS`].
    pub(crate) fn shape(&mut self, kind: usize) -> Shape {
        let (radius, half_length) = (self.within(0.1, 1.0), self.within(0.1, 1.0));
        match kind {
            0 => Shape::Sphere { radius },
            1 => Shape::Capsule { radius, half_length },
            2 => Shape::Box { half_edges: [radius, half_length, self.within(0.1, 1.0)] },
            3 => Shape::Cylinder { radius, half_length },
            4 => Shape::Cone { radius, half_length },
            _ => Shape::hull(&(0..20).map(|_| self.vector(1.0)).collect::<Vec<_>>()).unwrap(),
        }
    }

    pub(crate) fn pose(&mut self, apart: f64) -> Pose {
        Pose { rot: exp_so3(self.vector(3.0)).matrix(), pos: self.vector(apart) }
    }
}

/// Returns the largest coordinate of a convex shape along `d`.
pub(crate) fn height(shape: &Shape, pose: &Pose, d: Vec3<f64>) -> f64 {
    let local = pose.rot.transpose_mul(d);
    let across = local.x.hypot(local.y);
    let own = match shape {
        Shape::Sphere { radius } => radius * d.norm(),
        Shape::Capsule { radius, half_length } => radius * d.norm() + half_length * local.z.abs(),
        Shape::Box { half_edges: [x, y, z] } => x * local.x.abs() + y * local.y.abs() + z * local.z.abs(),
        Shape::Cylinder { radius, half_length } => radius * across + half_length * local.z.abs(),
        Shape::Cone { radius, half_length } => {
            (radius * across - half_length * local.z).max(half_length * local.z)
        }
        Shape::Hull(hull) => hull.vertices().iter().map(|p| p.dot(local)).fold(f64::NEG_INFINITY, f64::max),
        Shape::Torus { .. } | Shape::HalfSpace | Shape::Compound(_) => unreachable!("not a convex body"),
    };
    own + pose.pos.dot(d)
}

/// Returns the distance between the supporting planes with the normal `n`, from the first shape to the second.
pub(crate) fn separation((a, at_a): (&Shape, &Pose), (b, at_b): (&Shape, &Pose), n: Vec3<f64>) -> f64 {
    -height(b, at_b, -n) - height(a, at_a, n)
}
