//! A base with a straight arm of many joints.

use nalgebra::{Isometry3, Matrix3, Vector3};
use onorbit_core::model::{Inertial, Joint, JointKind, Link, Model, ModelBuilder};

pub fn chain(joints: usize) -> Model {
    let body = |mass: f64| {
        Some(Inertial { mass, com: Vector3::new(0.0, 0.01, 0.1), inertia: Matrix3::identity() * 0.01 })
    };
    let mut builder = ModelBuilder::new("chain", Link::new("link0", body(100.0))).unwrap();
    for k in 1..=joints {
        let axis = if k % 2 == 0 { Vector3::z() } else { Vector3::y() };
        let origin = Isometry3::translation(0.0, 0.0, 0.2);
        let joint = Joint::new(&format!("joint{k}"), JointKind::Revolute(axis), origin);
        builder.add(&format!("link{}", k - 1), joint, Link::new(&format!("link{k}"), body(1.0))).unwrap();
    }
    builder.build().unwrap()
}
