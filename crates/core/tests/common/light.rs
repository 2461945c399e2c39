//! Two thin links that are far lighter than the base.

use nalgebra::{Isometry3, Matrix3, Vector3};
use onorbit_core::model::{Inertial, Joint, JointKind, Link, Model, ModelBuilder};

/// Returns a base of 100 kg with two links of `mass`, kg, and 0.2 m each, that rotate about y and about z.
pub fn light_links(mass: f64) -> Model {
    let part = |mass: f64, moment: f64, x: f64| {
        Some(Inertial { mass, com: Vector3::x() * x, inertia: Matrix3::identity() * moment })
    };
    let mut builder = ModelBuilder::new("light", Link::new("base", part(100.0, 10.0, 0.0))).unwrap();
    let links = [("base", "upper", Vector3::y(), 0.5), ("upper", "lower", Vector3::z(), 0.2)];
    for (carrier, name, axis, at) in links {
        let joint = Joint::new(name, JointKind::Revolute(axis), Isometry3::translation(at, 0.0, 0.0));
        let link = Link::new(name, part(mass, mass * 0.2 * 0.2 / 12.0, 0.1));
        builder.add(carrier, joint, link).unwrap();
    }
    builder.build().unwrap()
}
