//! Momentum and energy of random trees that collide.
#![allow(clippy::unwrap_used)]

mod common;

use common::touch::side;
use common::{Random, random_model, random_state};
use nalgebra::Vector3;
use onorbit_core::contact::{Contact, ContactLaw, ContactSide, ContactSteps, Friction, NormalLaw};
use onorbit_core::geometry::Shape;
use onorbit_core::model::Model;
use onorbit_core::simulation::{Recording, Simulation};
use onorbit_core::spatial::Vec3;
use onorbit_core::world::System;
use std::sync::Arc;

/// Kinds of random shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Spheres,
    Polyhedra,
    Boxes,
}

/// Returns a convex body about the origin of a frame.
fn shape(kind: Kind, random: &mut Random) -> Shape {
    if kind == Kind::Spheres {
        return Shape::Sphere { radius: 0.15 + 0.1 * random.unit().abs() };
    }
    if kind == Kind::Boxes {
        let half = |random: &mut Random| 0.1 + 0.1 * random.unit().abs();
        return Shape::Box { half_edges: [half(random), half(random), half(random)] };
    }
    let corner = |random: &mut Random| {
        let v = random.vector().normalize() * (0.2 + 0.1 * random.unit().abs());
        Vec3::new(v.x, v.y, v.z)
    };
    let points: Vec<_> = (0..24).map(|_| corner(random)).collect();
    Shape::hull(&points).unwrap()
}

fn sides(system: usize, model: &Model, kind: Kind, random: &mut Random) -> Vec<ContactSide> {
    let links = (0..model.frames().len()).filter(|frame| model.frames()[*frame].name.starts_with("link"));
    links.map(|frame| side(system, frame, shape(kind, random))).collect()
}

/// Throws two random trees at each other, with the given shapes, rule for the steps and dissipation, s/m.
fn collide(
    seed: u64,
    (kind, steps, dissipation): (Kind, ContactSteps, f64),
    friction: Option<Friction>,
) -> (Vec<Arc<Model>>, Recording) {
    let mut random = Random::new(seed);
    let models: Vec<_> = (0..2).map(|i| Arc::new(random_model(2 * seed + i, 4))).collect();
    let mut systems = Vec::new();
    for (i, model) in models.iter().enumerate() {
        let (mut q, mut v) = random_state(model, &mut random);
        let away = Vector3::new(if i == 0 { -2.5 } else { 2.5 }, 0.0, 0.0);
        q[..3].copy_from_slice(away.as_slice());
        v.iter_mut().for_each(|v| *v *= 0.3);
        v[..3].copy_from_slice(&[0.0; 3]);
        let rot = nalgebra::UnitQuaternion::new_normalize(nalgebra::Quaternion::new(q[6], q[3], q[4], q[5]));
        let speed = rot.inverse() * Vector3::new(if i == 0 { 1.0 } else { -1.0 }, 0.05 * random.unit(), 0.0);
        v[..3].copy_from_slice(speed.as_slice());
        systems.push(System::new(if i == 0 { "a" } else { "b" }, Arc::clone(model), q, v));
    }
    let sides = [sides(0, &models[0], kind, &mut random), sides(1, &models[1], kind, &mut random)];
    let mut simulation = Simulation::of(systems);
    simulation.time_step = 1e-3;
    simulation.contact_steps = steps;
    let normal = NormalLaw::HuntCrossley { stiffness: 2e5, exponent: 1.5, dissipation };
    simulation.contacts = vec![Contact {
        name: "bodies".to_owned(),
        sides,
        law: Some(ContactLaw { normal, friction }),
        impact: None,
        may_start_overlapping: true,
    }];
    (models, simulation.run(5.0).unwrap())
}

struct Totals {
    linear: Vector3<f64>,
    angular: Vector3<f64>,
    energy: f64,
}

/// Returns momentum, its angular part about the origin of W, and energy of both systems in row `k`.
fn totals(models: &[Arc<Model>], recording: &Recording, k: usize) -> Totals {
    let (mut linear, mut angular, mut energy) = (Vector3::zeros(), Vector3::zeros(), 0.0);
    for (_, trace) in models.iter().zip(&recording.systems) {
        let h = &trace.momentum[6 * k..];
        let p = Vector3::new(h[0], h[1], h[2]);
        let c = Vector3::from_column_slice(&trace.center_of_mass[3 * k..3 * k + 3]);
        linear += p;
        angular += Vector3::new(h[3], h[4], h[5]) + c.cross(&p);
        energy += trace.kinetic_energy[k];
    }
    let contact = &recording.systems[0].contacts[0].values[19 * k..];
    Totals { linear, angular, energy: energy + contact[12] + contact[13] }
}

/// Returns the change of the energy during a run, J.
fn open_energy(models: &[Arc<Model>], recording: &Recording) -> f64 {
    let [first, end] = [0, recording.rows() - 1].map(|k| totals(models, recording, k).energy);
    (end - first).abs()
}

/// Returns the energy dissipated during a run, J.
fn dissipated(recording: &Recording) -> f64 {
    recording.systems[0].contacts[0].values[19 * (recording.rows() - 1) + 13]
}

fn check(seed: u64, kind: Kind, friction: Option<Friction>, energy: f64) {
    let (models, recording) = collide(seed, (kind, ContactSteps::default(), 0.5), friction);
    let (first, end) = (totals(&models, &recording, 0), totals(&models, &recording, recording.rows() - 1));
    let contact = &recording.systems[0].contacts[0].values;
    let lost = dissipated(&recording);
    assert!(contact.chunks_exact(19).any(|row| row[0] < 0.0) && lost > 0.1, "no contact for seed {seed}");
    let (linear, angular) = ((end.linear - first.linear).norm(), (end.angular - first.angular).norm());
    assert!(linear < 2e-14 && angular < 1e-12, "{seed} {kind:?}: {linear:e} N s, {angular:e} N m s");
    let open = open_energy(&models, &recording) / lost;
    assert!(open < energy, "{seed} {kind:?} {friction:?}: {open:e}");
}

const FRICTION: Friction = Friction {
    static_coefficient: 0.4,
    kinetic_coefficient: 0.3,
    stiffness: 1e5,
    damping: None,
    torsional: 0.01,
};

#[test]
fn spheres_keep_momentum_and_energy() {
    for seed in 0..6 {
        for friction in [None, Some(FRICTION)] {
            check(seed, Kind::Spheres, friction, 1e-8);
        }
    }
}

/// Where the nearest features of polyhedra change, the normal jumps within a step, which is then shortened until
/// its energy is right.
#[test]
fn polyhedra_keep_momentum_and_energy() {
    for seed in 0..6 {
        for friction in [None, Some(FRICTION)] {
            check(seed, Kind::Polyhedra, friction, 1e-8);
        }
    }
}

/// Negative control: without steps that are shortened for their energy, some collisions lose it.
#[test]
fn steps_across_a_jump_of_the_normal_lose_energy() {
    let steps = ContactSteps { energy_error: f64::INFINITY, ..ContactSteps::default() };
    for seed in [0, 3, 12] {
        let (models, recording) = collide(seed, (Kind::Boxes, steps, 0.5), None);
        let open = open_energy(&models, &recording) / dissipated(&recording);
        assert!(open > 1e-6, "{seed}: {open:e}");
        check(seed, Kind::Boxes, None, 1e-8);
    }
}
