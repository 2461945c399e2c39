//! Events of contacts: touch-down and lift-off with their instants, points, impulses, losses and peak forces.
#![allow(clippy::unwrap_used)]

mod common;

use common::touch::{body, contact, side};
use nalgebra::Vector3;
use onorbit_core::contact::{Contact, ContactLaw, ContactSide, ContactSteps, Friction, NormalLaw};
use onorbit_core::geometry::{Pose, Shape};
use onorbit_core::simulation::{EventKind, EventRecord, Recording, Simulation};
use onorbit_core::spatial::Vec3;
use onorbit_core::world::System;

const RADIUS: f64 = 0.1;
const SPHERE: Shape = Shape::Sphere { radius: RADIUS };
const ELASTIC: NormalLaw = NormalLaw::HuntCrossley { stiffness: 1e7, exponent: 1.5, dissipation: 0.0 };
const LOSSY: NormalLaw = NormalLaw::HuntCrossley { stiffness: 1e6, exponent: 1.5, dissipation: 1.0 };
const ROUGH: Friction = Friction {
    static_coefficient: 0.4,
    kinetic_coefficient: 0.3,
    stiffness: 1e6,
    damping: None,
    torsional: 0.01,
};

fn sphere(name: &str, mass: f64, position: [f64; 3], speed: f64) -> System {
    body(name, mass, 0.4 * mass * RADIUS * RADIUS, position, speed)
}

fn simulation(systems: Vec<System>, normal: NormalLaw, friction: Option<Friction>) -> Simulation {
    let mut simulation = Simulation::of(systems);
    simulation.contacts =
        vec![contact("touch", [side(0, 0, SPHERE), side(1, 0, SPHERE)], ContactLaw { normal, friction })];
    simulation
}

/// Returns the linear momentum of a system, and its angular momentum about `point` in W, in row `k`.
fn momentum(recording: &Recording, system: usize, k: usize, point: Vector3<f64>) -> [Vector3<f64>; 2] {
    let trace = &recording.systems[system];
    let [linear, own] = [0, 3].map(|i| Vector3::from_column_slice(&trace.momentum[6 * k + i..6 * k + i + 3]));
    let center = Vector3::from_column_slice(&trace.center_of_mass[3 * k..3 * k + 3]);
    [linear, own + (center - point).cross(&linear)]
}

fn parts(record: &EventRecord) -> [Vector3<f64>; 3] {
    let [linear, angular] = [0, 3].map(|i| Vector3::from_column_slice(&record.impulse[i..i + 3]));
    [linear, angular, Vector3::from_column_slice(&record.point)]
}

/// Two rotating spheres that collide obliquely, with friction against sliding and turning.
fn oblique() -> Simulation {
    let mut b = sphere("b", 3.0, [0.25, 0.07, 0.05], -0.1);
    b.v[3..].copy_from_slice(&[1.0, -0.5, 2.0]);
    simulation(vec![sphere("a", 2.0, [0.0; 3], 0.3), b], LOSSY, Some(ROUGH))
}

#[test]
fn the_impulse_is_the_change_of_momentum_to_rounding() {
    let recording = oblique().run(0.5).unwrap();
    let [down, up] = &recording.events[..] else { panic!("{:?}", recording.events) };
    assert_eq!((down.kind, up.kind), (EventKind::TouchDown, EventKind::LiftOff));
    assert_eq!((down.impulse, down.energy_lost, down.peak_force), ([0.0; 6], 0.0, None));
    let [linear, angular, point] = parts(up);
    let end = recording.systems[0].time.len() - 1;
    for (system, sign) in [(0, -1.0), (1, 1.0)] {
        let [before, after] = [0, end].map(|k| momentum(&recording, system, k, point));
        let error = (after[0] - before[0] - sign * linear).norm();
        assert!(error < 1e-12 * linear.norm(), "{system}: {error:e}");
        let error = (after[1] - before[1] - sign * angular).norm();
        assert!(error < 1e-12 * linear.norm() * RADIUS, "{system}: {error:e}");
    }
    // friction turns the spheres about the normal and moves the point while it acts
    assert!(angular.norm() > 1e-5 * linear.norm() * RADIUS);
    // negative control: the moment of the impulse is not that about the origin of W
    let [[_, before], [_, after]] = [0, end].map(|k| momentum(&recording, 1, k, Vector3::zeros()));
    assert!((after - before - angular).norm() > 0.1 * linear.norm() * RADIUS);
}

#[test]
fn the_energy_lost_is_that_of_the_motion() {
    let recording = oblique().run(0.5).unwrap();
    let energy = |k: usize| recording.systems.iter().map(|trace| trace.kinetic_energy[k]).sum::<f64>();
    let lost = energy(0) - energy(recording.systems[0].time.len() - 1);
    assert!((recording.events[1].energy_lost / lost - 1.0).abs() < 1e-8);
}

#[test]
fn the_instants_and_the_point_are_located() {
    let speed = 0.1;
    let systems = vec![sphere("a", 2.0, [0.0; 3], speed), sphere("b", 2.0, [0.21, 0.0, 0.0], 0.0)];
    let recording = simulation(systems, ELASTIC, None).run(0.3).unwrap();
    let [down, up] = &recording.events[..] else { panic!("{:?}", recording.events) };
    assert!((down.time / (0.01 / speed) - 1.0).abs() < 1e-12, "{}", down.time);
    assert!((down.point[0] - 0.11).abs() < 1e-14 && down.point[1].abs() < 1e-15);
    // Hertz: T = 2.9432 x_max/v
    let depth = (5.0 * speed * speed / 4e7_f64).powf(0.4);
    assert!(((up.time - down.time) / (2.943275 * depth / speed) - 1.0).abs() < 1e-6);
    assert_eq!((down.name.as_str(), down.systems, up.systems), ("touch", [0, 1], [0, 1]));
    assert!(down.checks().is_empty() && up.passed());
}

/// Effective mass of 1 kg, 0.1 m/s, `K = 1e7 N/m^1.5`: `F_max = K x_max^1.5` with `x_max = (5 m v₀²/(4 K))^(2/5)`.
#[test]
fn the_peak_force_is_that_of_hertz() {
    for gap in [1e-4, 2.3e-4, 1e-3] {
        let systems = vec![sphere("a", 2.0, [0.0; 3], 0.1), sphere("b", 2.0, [0.2 + gap, 0.0, 0.0], 0.0)];
        let mut simulation = simulation(systems, ELASTIC, None);
        simulation.record_every = 1000;
        let recording = simulation.run(0.05).unwrap();
        let peak = recording.events[1].peak_force.unwrap();
        assert!((peak / 45.514105076 - 1.0).abs() < 1e-6, "{gap}: {:e}", peak / 45.514105076 - 1.0);
        let row = recording.systems[0].contacts[0].values.chunks_exact(19).next_back().unwrap();
        assert_eq!(row[17..], [1.0, peak]);
        assert!((row[14] / 0.2 - 1.0).abs() < 1e-9 && row[15] == 0.0);
    }
}

/// Returns a piece of a link at a place in its frame.
fn piece(system: usize, shape: Shape, x: f64, y: f64) -> ContactSide {
    let pose = Pose { pos: Vec3::new(x, y, 0.0), ..Pose::identity() };
    ContactSide { pose, ..side(system, 0, shape) }
}

/// A body with two feet that turns while it falls on a large sphere: the feet touch one after the other.
#[test]
fn the_pieces_of_a_contact_have_one_record() {
    let mut b = body("b", 2.0, 0.05, [0.0, 0.0, 0.0], -0.2);
    b.v[5] = 0.02;
    let wall = body("wall", 50.0, 5.0, [-1.11, 0.0, 0.0], 0.0);
    let mut simulation = Simulation::of(vec![wall, b]);
    let feet = [-0.01, 0.01].map(|y| piece(1, Shape::Sphere { radius: 0.09 }, 0.0, y));
    simulation.contacts = vec![Contact {
        sides: [vec![side(0, 0, Shape::Sphere { radius: 1.0 })], feet.to_vec()],
        ..contact(
            "feet",
            [side(0, 0, SPHERE), side(1, 0, SPHERE)],
            ContactLaw { normal: LOSSY, friction: None },
        )
    }];
    let recording = simulation.run(0.4).unwrap();
    let kinds: Vec<_> = recording.events.iter().map(|record| record.kind).collect();
    assert_eq!(kinds, [EventKind::TouchDown, EventKind::LiftOff]);
    let [linear, angular, point] = parts(&recording.events[1]);
    let end = recording.systems[0].time.len() - 1;
    let [before, after] = [0, end].map(|k| momentum(&recording, 1, k, point));
    assert!((after[0] - before[0] - linear).norm() < 1e-12 * linear.norm());
    assert!((after[1] - before[1] - angular).norm() < 1e-12 * linear.norm() * RADIUS);
    let forces = recording.systems[0].contacts[0].values.chunks_exact(19).map(|row| row[1]);
    let largest = forces.fold(0.0, f64::max);
    assert!((recording.events[1].peak_force.unwrap() / largest - 1.0).abs() < 1e-2);
}

/// A ball bounces without loss between two walls, more than a thousand times: the list of events is bounded,
/// and the trace has the totals of all touches.
#[test]
fn later_touches_are_only_counted() {
    let (walls, ball) = (body("walls", 100.0, 1.0, [0.0; 3], 0.0), body("ball", 1e-3, 1e-6, [0.0; 3], 1.0));
    let mut simulation = Simulation::of(vec![walls, ball]);
    let sides = [-0.11, 0.11].map(|x| piece(0, SPHERE, x, 0.0)).to_vec();
    let ball = Shape::Sphere { radius: 5e-3 };
    simulation.contacts = vec![Contact {
        sides: [sides, vec![side(1, 0, ball.clone())]],
        ..contact(
            "walls",
            [side(0, 0, SPHERE), side(1, 0, ball)],
            ContactLaw { normal: ELASTIC, friction: None },
        )
    }];
    simulation.contact_steps = ContactSteps { count: 8, is_graded: false, ..ContactSteps::default() };
    simulation.record_every = 100;
    let recording = simulation.run(11.5).unwrap();
    let row = recording.systems[0].contacts[0].values.chunks_exact(19).next_back().unwrap().to_vec();
    assert!(row[17] > 1050.0, "{}", row[17]);
    assert_eq!(recording.events.len(), 2000);
    let pairs = recording.events.chunks(2);
    assert!(
        pairs.clone().all(|pair| pair[0].kind == EventKind::TouchDown && pair[1].kind == EventKind::LiftOff)
    );
    assert!(recording.events.is_sorted_by(|a, b| a.time <= b.time));
    let sum: f64 = pairs.map(|pair| pair[1].impulse[0].abs()).sum();
    assert!((sum / 1000.0 / 2e-3 - 1.0).abs() < 0.05, "{sum}");
    // the impulses of both walls cancel, apart from the last
    assert!(row[14].abs() < 3e-3);
}

/// Spheres that rest beside each other touch and separate at random, at the level of rounding errors.
#[test]
fn touches_at_the_level_of_rounding_errors_are_not_recorded() {
    for normal in [ELASTIC, NormalLaw::SpringDashpot { stiffness: 1e6, damping: 10.0 }] {
        let mut systems = vec![sphere("a", 2.0, [0.3; 3], 0.2), sphere("b", 2.0, [0.5, 0.3, 0.3], 0.2)];
        systems.iter_mut().for_each(|system| system.v[3..].copy_from_slice(&[0.1, 0.2, 0.3]));
        let mut simulation = simulation(systems, normal, None);
        simulation.time_step = 1e-3;
        let recording = simulation.run(1.0).unwrap();
        assert_eq!(recording.events, []);
    }
}

/// A touch that goes on at the end of the run has no lift-off yet.
#[test]
fn an_open_touch_has_no_lift_off() {
    let systems = vec![sphere("a", 2.0, [0.0; 3], 0.1), sphere("b", 2.0, [0.2001, 0.0, 0.0], 0.0)];
    let recording = simulation(systems, ELASTIC, None).run(1.5e-3).unwrap();
    assert_eq!(recording.events.len(), 1);
    let row = recording.systems[0].contacts[0].values.chunks_exact(19).next_back().unwrap();
    assert!(row[17] == 1.0 && row[18] == row[1] && row[14] > 0.0);
}
