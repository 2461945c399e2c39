//! Contact of faces: boxes that rest on a plane and on each other.
#![allow(clippy::unwrap_used)]

mod common;

use common::touch::{body, contact, side};
use nalgebra::Vector3;
use onorbit_core::contact::{ContactLaw, Friction, NormalLaw};
use onorbit_core::environment::{Effect, EnvironmentError, Scene, Wrench, Wrenches};
use onorbit_core::geometry::Shape;
use onorbit_core::simulation::{Recording, Simulation};
use std::sync::Arc;

const EDGES: [f64; 3] = [0.1, 0.08, 0.05];
const WEIGHT: f64 = 20.0;

/// Constant weight of the light bodies along −z, N.
#[derive(Debug)]
struct Weight;

impl Effect for Weight {
    fn name(&self) -> &str {
        "weight"
    }

    fn add_wrenches(&self, scene: &Scene<'_>, out: &mut Wrenches) -> Result<(), EnvironmentError> {
        for (index, _) in scene.bodies.iter().filter(|(_, body)| body.mass < 1e12) {
            let force = Vector3::new(0.0, 0.0, -WEIGHT);
            out.add(index, Wrench { force, torque: Vector3::zeros() })?;
        }
        Ok(())
    }
}

/// Drops a box with these first attitude angles, rad, on a fixed plane or box.
fn drop_on(floor: Shape, tilt: [f64; 2], height: f64, duration: f64) -> Recording {
    let ground = body(
        "ground",
        1e12,
        1e12,
        [0.0, 0.0, if matches!(floor, Shape::HalfSpace) { 0.0 } else { -0.5 }],
        0.0,
    );
    let mut falling = body("box", 2.0, 0.01, [0.0, 0.0, EDGES[2] + height], 0.0);
    let turn = nalgebra::UnitQuaternion::from_euler_angles(tilt[0], tilt[1], 0.0);
    falling.q[3..].copy_from_slice(&[turn.i, turn.j, turn.k, turn.w]);
    let mut simulation = Simulation::of(vec![ground, falling]);
    let normal = NormalLaw::HuntCrossley { stiffness: 2e5, exponent: 1.0, dissipation: 3.0 };
    let friction = Friction {
        static_coefficient: 0.5,
        kinetic_coefficient: 0.5,
        stiffness: 1e5,
        damping: None,
        torsional: 0.03,
    };
    let law = ContactLaw { normal, friction: Some(friction) };
    let sides = [side(0, 0, floor), side(1, 0, Shape::Box { half_edges: EDGES })];
    simulation.contacts = vec![contact("floor", sides, law)];
    simulation.effects = vec![Arc::new(Weight)];
    simulation.run(duration).unwrap()
}

/// A box at rest has the depth `W/k`, and all of its motion has been dissipated.
#[test]
fn a_box_comes_to_rest_on_a_face() {
    for floor in [Shape::HalfSpace, Shape::Box { half_edges: [0.5; 3] }] {
        for tilt in [[0.0, 0.0], [0.02, -0.03], [0.3, 0.1]] {
            let recording = drop_on(floor.clone(), tilt, 0.02, 3.0);
            let trace = &recording.systems[1];
            let last = trace.rows() - 1;
            let (q, v) = (&trace.q[7 * last..], &trace.v[6 * last..]);
            let rest = EDGES[2] - WEIGHT / 2e5;
            assert!((q[2] - rest).abs() < 1e-9, "{tilt:?}: {:e} m", q[2] - rest);
            assert!(q[3..5].iter().all(|x| x.abs() < 1e-10), "{tilt:?}: {:?}", &q[3..5]);
            assert!(v.iter().all(|x| x.abs() < 1e-9), "{tilt:?}: {v:?}");
        }
    }
}
