//! Random robots and states; a failing test prints the seed.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used)] // each test binary uses its own part

pub mod dual;
pub mod humanoid;
pub mod light;
pub mod slider;
pub mod spacecraft;
pub mod stepper;
pub mod stepping;
pub mod stream;
pub mod touch;

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};
use onorbit_core::model::{Inertial, Joint, JointKind, Link, Model, ModelBuilder};

/// A small generator (splitmix64), so that a seed always gives the same robot.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Returns a number uniform in -1..1.
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self) -> Vector3<f64> {
        Vector3::new(self.unit(), self.unit(), self.unit())
    }

    pub fn numbers(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.unit()).collect()
    }

    pub fn index(&mut self, n: usize) -> usize {
        (((self.unit() + 1.0) / 2.0 * n as f64) as usize).min(n - 1)
    }

    pub fn pose(&mut self) -> Isometry3<f64> {
        let turn = UnitQuaternion::from_scaled_axis(self.vector() * 2.0);
        Isometry3::from_parts(Translation3::from(self.vector() * 0.5), turn)
    }

    pub fn inertial(&mut self) -> Inertial {
        // three orthogonal extents give moments that satisfy the triangle inequality
        let mass = 1.0 + 2.0 * self.unit().abs();
        let e: Vec<f64> = (0..3).map(|_| 0.02 + 0.1 * self.unit().abs()).collect();
        let moments = Vector3::new(e[1] + e[2], e[0] + e[2], e[0] + e[1]) * mass;
        let r = Rotation3::from_scaled_axis(self.vector() * 2.0).into_inner();
        let inertia = r * Matrix3::from_diagonal(&moments) * r.transpose();
        Inertial { mass, com: self.vector() * 0.2, inertia: (inertia + inertia.transpose()) * 0.5 }
    }
}

/// Returns a tree of `links` links: branches, skew axes, every joint type, rotors, a frame on the last link.
pub fn random_model(seed: u64, links: usize) -> Model {
    let mut random = Random::new(seed);
    let base = Link::new("link0", Some(random.inertial()));
    let mut builder = ModelBuilder::new(&format!("random{seed}"), base).unwrap();
    for i in 1..links {
        let parent = format!("link{}", random.index(i));
        let kind = match random.index(5) {
            0 => JointKind::Fixed,
            1 | 2 => JointKind::Revolute(random.vector()),
            3 => JointKind::Revolute([Vector3::x(), Vector3::y(), Vector3::z()][random.index(3)]),
            _ => JointKind::Prismatic(random.vector()),
        };
        let mut joint = Joint::new(&format!("joint{i}"), kind, random.pose());
        joint.rotor_inertia = if random.index(2) == 0 { 0.0 } else { 0.05 };
        builder.add(&parent, joint, Link::new(&format!("link{i}"), Some(random.inertial()))).unwrap();
    }
    builder.add_frame("tool", &format!("link{}", links - 1), random.pose()).unwrap();
    builder.build().unwrap()
}

/// Returns a configuration and a velocity, `(nq,)` and `(nv,)`.
pub fn random_state(model: &Model, random: &mut Random) -> (Vec<f64>, Vec<f64>) {
    let mut q = random.numbers(model.nq());
    let norm = q[3..7].iter().map(|x| x * x).sum::<f64>().sqrt();
    q[3..7].iter_mut().for_each(|x| *x /= norm);
    (q, random.numbers(model.nv()))
}

/// Returns the largest difference, relative to the largest entry (or one).
pub fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let scale = b.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    a.iter().zip(b).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs())) / scale
}
