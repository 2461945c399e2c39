//! Rigid impacts and contacts that last, against closed forms.
#![allow(clippy::unwrap_used)]

mod common;

use common::touch::{body, side};
use nalgebra::Vector3;
use onorbit_core::contact::{Contact, ContactError, ContactSide, ImpactLaw};
use onorbit_core::environment::{Effect, EnvironmentError, Scene, Wrench, Wrenches};
use onorbit_core::geometry::Shape;
use onorbit_core::simulation::{EventKind, Recording, Simulation, SimulationError};
use onorbit_core::spatial::Vec3;
use onorbit_core::world::System;
use std::sync::Arc;

const RADIUS: f64 = 0.1;
const MASS: f64 = 1.0;
/// Mass of bodies that do not move, kg, and their moment of inertia, kg m².
const FIXED: f64 = 1e15;
const SPHERE: Shape = Shape::Sphere { radius: RADIUS };

fn law(restitution: f64, friction: f64) -> ImpactLaw {
    ImpactLaw { restitution, friction }
}

fn contact(name: &str, sides: [ContactSide; 2], law: ImpactLaw) -> Contact {
    let sides = sides.map(|side| vec![side]);
    Contact { name: name.to_owned(), sides, law: None, impact: Some(law), may_start_overlapping: false }
}

fn ball(name: &str, x: f64, speed: f64) -> System {
    body(name, MASS, 0.4 * MASS * RADIUS * RADIUS, [x, 0.0, 0.0], speed)
}

/// Constant force on the light bodies in axes of W, N.
#[derive(Debug)]
struct Force(Vector3<f64>);

impl Effect for Force {
    fn name(&self) -> &str {
        "force"
    }

    fn add_wrenches(&self, scene: &Scene<'_>, out: &mut Wrenches) -> Result<(), EnvironmentError> {
        for (index, _) in scene.bodies.iter().filter(|(_, body)| body.mass < FIXED) {
            out.add(index, Wrench { force: self.0, torque: Vector3::zeros() })?;
        }
        Ok(())
    }
}

/// Returns a simulation of `thing` above or on a fixed plane through the origin, with the normal z.
fn above_plane(thing: System, shape: Shape, law: ImpactLaw, force: [f64; 3]) -> Simulation {
    let mut simulation = Simulation::of(vec![body("plane", FIXED, FIXED, [0.0; 3], 0.0), thing]);
    simulation.contacts = vec![contact("floor", [side(0, 0, Shape::HalfSpace), side(1, 0, shape)], law)];
    simulation.effects = vec![Arc::new(Force(Vector3::from(force)))];
    simulation
}

fn velocity(recording: &Recording, system: usize) -> [f64; 6] {
    recording.systems[system].v.chunks_exact(6).next_back().unwrap().try_into().unwrap()
}

fn row(recording: &Recording, contact: usize) -> [f64; 19] {
    let values = &recording.systems[0].contacts[contact].values;
    values.chunks_exact(19).next_back().unwrap().try_into().unwrap()
}

/// Oblique impact of a solid sphere: it sticks if `v_t/v_n ≤ 3.5 μ (1 + e)`, with `v_t' = 5/7 v_t`; it slips
/// otherwise, with `v_t' = v_t − μ (1 + e) v_n` and `ω' R = 2.5 μ (1 + e) v_n`.
#[test]
fn an_oblique_impact_of_a_sphere_sticks_or_slips() {
    let (mu, down) = (0.3, 0.2);
    for e in [0.0, 0.5, 1.0] {
        for share in [0.5, 0.999, 1.001, 3.0] {
            let along = share * 3.5 * mu * (1.0 + e) * down;
            let mut ball = ball("ball", 0.0, along);
            ball.q[2] = RADIUS + 0.05;
            ball.v[2] = -down;
            let recording = above_plane(ball, SPHERE, law(e, mu), [0.0; 3]).run(0.5).unwrap();
            let v = velocity(&recording, 1);
            let (vt, spin) = if share < 1.0 {
                (along * 5.0 / 7.0, along * 5.0 / 7.0)
            } else {
                (along - mu * (1.0 + e) * down, 2.5 * mu * (1.0 + e) * down)
            };
            // the velocity is in base axes; the ball has turned about y
            let q = &recording.systems[1].q[recording.systems[1].q.len() - 7..];
            let angle = 2.0 * q[4].atan2(q[6]);
            let x = v[0] * angle.cos() + v[2] * angle.sin();
            let z = -v[0] * angle.sin() + v[2] * angle.cos();
            let errors = [x - vt, v[4] * RADIUS - spin, z - e * down];
            assert!(errors.iter().all(|error| error.abs() < 1e-12), "{e} {share}: {errors:?}");
        }
    }
}

#[test]
fn touching_balls_share_an_elastic_impact_and_separate_balls_pass_it_on() {
    for (gap, expected) in [(0.0, [-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0]), (0.01, [0.0, 0.0, 1.0])] {
        let x = [0.0, 0.25, 0.25 + 2.0 * RADIUS + gap];
        let speeds = [1.0, 0.0, 0.0];
        let systems = (0..3).map(|i| ball(["a", "b", "c"][i], x[i], speeds[i])).collect();
        let mut simulation = Simulation::of(systems);
        let pair =
            |name: &str, a: usize| contact(name, [side(a, 0, SPHERE), side(a + 1, 0, SPHERE)], law(1.0, 0.0));
        simulation.contacts = vec![pair("first", 0), pair("second", 1)];
        let recording = simulation.run(0.3).unwrap();
        for (system, expected) in expected.iter().enumerate() {
            let found = velocity(&recording, system)[0];
            assert!((found - expected).abs() < 1e-14, "{gap} {system}: {:e}", found - expected);
        }
    }
}

#[test]
fn a_box_that_lands_flat_on_four_corners_does_not_turn() {
    let half_edges = [0.2, 0.3, 0.1];
    for e in [0.0, 0.5, 1.0] {
        let mut thing = body("box", 2.0, 0.05, [0.0, 0.0, 0.11], 0.0);
        thing.v[2] = -0.1;
        let shape = Shape::Box { half_edges };
        let recording = above_plane(thing, shape, law(e, 0.4), [0.0; 3]).run(0.3).unwrap();
        let v = velocity(&recording, 1);
        assert!((v[2] - e * 0.1).abs() < 1e-14, "{e}: {:e}", v[2] - e * 0.1);
        assert!(v.iter().enumerate().all(|(i, v)| i == 2 || v.abs() < 1e-14), "{v:?}");
        let lost = row(&recording, 0)[13];
        assert!((lost - 0.5 * 2.0 * 0.01 * (1.0 - e * e)).abs() < 1e-14);
    }
}

/// A ball that bounces with e = 0.5 under 1 m/s² comes to rest after finitely many bounces, and stays.
#[test]
fn bounces_end_and_the_ball_rests_without_creep() {
    let mut thing = ball("ball", 0.0, 0.0);
    thing.q[2] = RADIUS + 0.1;
    let mut simulation = above_plane(thing, SPHERE, law(0.5, 0.3), [0.0, 0.0, -MASS]);
    let recording = simulation.run(4.0).unwrap();
    // the rebound v0 e^k of the last impact is at most 1e-5 m/s
    let first = (2.0_f64 * 0.1).sqrt();
    let count = ((first / ImpactLaw::REST_SPEED).ln() / 2.0_f64.ln()).ceil();
    let end = row(&recording, 0);
    assert_eq!(end[17], count);
    assert!((end[3] - MASS).abs() < 1e-9, "{:e}", end[3] - MASS);
    assert!(end[0].abs() < 1e-12, "{:e}", end[0]);
    let [down, ups] = [EventKind::TouchDown, EventKind::LiftOff]
        .map(|kind| recording.events.iter().filter(|event| event.kind == kind).count());
    assert_eq!((down, ups), (count as usize, count as usize - 1));
    assert!(recording.events.iter().all(|event| event.peak_force.is_none()));
    let lost = end[13];
    assert!((lost - MASS * 0.1).abs() < 1e-9, "{:e}", lost - MASS * 0.1);
}

/// C4 with a rigid contact: rolls at 5/7 m/s after `2 v₀/(7 μ g)` and `12 v₀²/(49 μ g)`.
#[test]
fn sliding_turns_into_rolling() {
    let g = 9.81;
    let mut errors = Vec::new();
    for time_step in [1e-3, 0.5e-3] {
        let mut thing = ball("ball", 0.0, 1.0);
        thing.q[2] = RADIUS;
        let mut simulation = above_plane(thing, SPHERE, law(0.0, 0.3), [0.0, 0.0, -MASS * g]);
        simulation.time_step = time_step;
        let recording = simulation.run(0.2).unwrap();
        let k = recording.rows() - 1;
        let speed = recording.systems[1].momentum[6 * k] / MASS;
        assert!((speed - 5.0 / 7.0).abs() < 1e-9, "{:e}", speed - 5.0 / 7.0);
        let rolled = 0.2 - 2.0 / (7.0 * 0.3 * g);
        let x = recording.systems[1].q[7 * k] - rolled * 5.0 / 7.0;
        errors.push((x - 12.0 / (49.0 * 0.3 * g)).abs());
        assert!(row(&recording, 0)[0].abs() < 1e-10, "{:e}", row(&recording, 0)[0]);
    }
    eprintln!("{errors:?}");
    assert!(errors[0] < 1e-5 && errors[1] < 0.6 * errors[0], "{errors:?}");
}

/// A uniform rod that slides under pressure: `μ > (1 + 3 cos²θ)/(3 sin θ cos θ)` has no force.
#[test]
fn the_case_of_painleve_is_named() {
    let (mass, half) = (1.0, 0.5);
    let angle = 2.0_f64.atan();
    let (sin, cos) = angle.sin_cos();
    let radius = 1e-3;
    let limit = (1.0 + 3.0 * cos * cos) / (3.0 * sin * cos);
    assert!((limit - 4.0 / 3.0).abs() < 1e-12);
    for (mu, direction, is_named) in
        [(limit * (1.0 - 1e-9), 1.0, false), (limit * (1.0 + 1e-9), 1.0, true), (2.0 * limit, -1.0, false)]
    {
        // the tip, with a small sphere, is at the origin; the rod leans towards x
        let mut thing = body("rod", mass, mass * half * half / 3.0, [half * cos, 0.0, half * sin], 0.0);
        thing.v[0] = -direction * 0.5;
        let mut sphere = side(1, 0, Shape::Sphere { radius });
        sphere.pose.pos = Vec3::new(-half * cos, 0.0, -half * sin + radius);
        let mut simulation = above_plane(thing, SPHERE, law(0.0, mu), [0.0, 0.0, -1.0]);
        simulation.contacts[0].sides[1] = vec![sphere];
        match simulation.run(1e-3).map_err(|failure| failure.error) {
            Err(SimulationError::Contact {
                time,
                source: ContactError::Painleve { contact, limit: found, .. },
            }) => {
                assert!(is_named && time < 2e-3 && contact == "floor");
                assert!((found - limit).abs() < 1e-9, "{found}");
            }
            Ok(_) => assert!(!is_named, "{mu} {direction}"),
            other => panic!("{other:?}"),
        }
    }
}
