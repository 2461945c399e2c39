//! Common robot of the benches: a 93 kg torso with one (nv = 13) or two (nv = 20) seven-joint arms.
#![allow(missing_docs, unreachable_pub, clippy::unwrap_used)] // a bench that fails to build its robot may panic

use nalgebra::{Isometry3, Matrix3, Vector3};
use onorbit_core::model::{Inertial, Joint, JointKind, Link, Model, ModelBuilder};

const MASS: [f64; 7] = [2.741, 2.425, 2.209, 0.877, 1.878, 0.409, 0.308];
const LENGTH: [f64; 7] = [0.28, 0.144, 0.0, 0.274, 0.265, 0.0, 0.0];

pub fn torso(arms: usize) -> Model {
    let body = |mass: f64, z: f64, moments: [f64; 3]| {
        let inertia = Matrix3::from_diagonal(&Vector3::from(moments));
        Some(Inertial { mass, com: Vector3::new(0.0, 0.0, z), inertia })
    };
    let base = Link::new("torso", body(93.0, 0.0, [18.6, 15.4, 4.1]));
    let mut builder = ModelBuilder::new("torso", base).unwrap();
    for arm in 0..arms {
        let (mut parent, mut origin) = ("torso".to_owned(), Vector3::new(0.0, 0.25 - 0.5 * arm as f64, 0.5));
        for i in 0..7 {
            let axis = if i % 2 == 0 { Vector3::z() } else { Vector3::y() };
            let name = format!("arm{arm}_link{i}");
            let joint = Joint::new(
                &format!("arm{arm}_joint{i}"),
                JointKind::Revolute(axis),
                Isometry3::translation(origin.x, origin.y, origin.z),
            );
            let link = Link::new(&name, body(MASS[i], LENGTH[i] / 2.0, [0.012, 0.011, 0.01]));
            builder.add(&parent, joint, link).unwrap();
            (parent, origin) = (name, Vector3::new(0.0, 0.0, LENGTH[i]));
        }
    }
    builder.build().unwrap()
}
