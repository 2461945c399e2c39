//! One run with a thousand contacts: random trees with random convex bodies in a floating box.
//!
//! The test takes minutes and is run by `make contact-campaign`; `CONTACTS` sets the number of contacts.
#![allow(clippy::unwrap_used, clippy::print_stderr)]

mod common;

use common::touch::{body, side};
use common::{Random, random_model, random_state};
use nalgebra::Vector3;
use onorbit_core::contact::{Contact, ContactLaw, ContactSide, Friction, NormalLaw};
use onorbit_core::geometry::{Pose, Shape};
use onorbit_core::model::Model;
use onorbit_core::simulation::{Recording, Simulation};
use onorbit_core::spatial::Vec3;
use onorbit_core::world::System;
use std::sync::Arc;

const TREES: usize = 2;
/// Half of the inner edge of the box and half of the thickness of its walls, m.
const ROOM: f64 = 2.5;
const WALL: f64 = 0.5;
/// Duration of the run of each world, s.
const END: f64 = 60.0;

fn hull(random: &mut Random) -> Shape {
    let corner = |random: &mut Random| {
        let v = random.vector().normalize() * (0.2 + 0.1 * random.unit().abs());
        Vec3::new(v.x, v.y, v.z)
    };
    Shape::hull(&(0..24).map(|_| corner(random)).collect::<Vec<_>>()).unwrap()
}

/// Returns the walls of the box, system 0.
fn walls() -> Vec<ContactSide> {
    let wall = |axis: usize, sign: f64| {
        let (mut half, mut at) = ([ROOM + 2.0 * WALL; 3], [0.0; 3]);
        (half[axis], at[axis]) = (WALL, sign * (ROOM + WALL));
        let pose = Pose { pos: Vec3::new(at[0], at[1], at[2]), ..Pose::identity() };
        ContactSide { pose, ..side(0, 0, Shape::Box { half_edges: half }) }
    };
    (0..3).flat_map(|axis| [wall(axis, -1.0), wall(axis, 1.0)]).collect()
}

fn bodies(system: usize, model: &Model, random: &mut Random) -> Vec<ContactSide> {
    let links = (0..model.frames().len()).filter(|frame| model.frames()[*frame].name.starts_with("link"));
    links.map(|frame| side(system, frame, hull(random))).collect()
}

/// Returns random trees with a random motion in a box that floats.
fn world(seed: u64) -> (Vec<f64>, Simulation) {
    let mut random = Random::new(seed);
    let mut systems = vec![body("room", 200.0, 2000.0, [0.0; 3], 0.0)];
    let mut sides = Vec::new();
    for i in 0..TREES {
        let model = Arc::new(random_model(10 * seed + i as u64, 3));
        let (mut q, mut v) = random_state(&model, &mut random);
        q[..3].copy_from_slice(&[if i == 0 { -1.0 } else { 1.0 }, 0.0, 0.0]);
        q[7..].iter_mut().for_each(|q| *q *= 0.2);
        v.iter_mut().for_each(|v| *v *= 2.0);
        v[6..].fill(0.0);
        sides.push(bodies(i + 1, &model, &mut random));
        systems.push(System::new(["a", "b"][i], model, q, v));
    }
    let masses = systems.iter().map(|system| system.model.mass()).collect();
    let mut simulation = Simulation::of(systems);
    simulation.time_step = 2e-3;
    let normal = NormalLaw::HuntCrossley { stiffness: 2e5, exponent: 1.5, dissipation: 0.002 };
    let friction = Friction {
        static_coefficient: 0.03,
        kinetic_coefficient: 0.02,
        stiffness: 1e5,
        damping: None,
        torsional: 0.001,
    };
    let law = Some(ContactLaw { normal, friction: Some(friction) });
    let declare =
        |name: &str, sides| Contact { name: name.to_owned(), sides, law, may_start_overlapping: false };
    let all: Vec<ContactSide> = sides.concat();
    let [a, b]: [Vec<ContactSide>; TREES] = sides.try_into().unwrap();
    simulation.contacts = vec![declare("walls", [walls(), all]), declare("trees", [a, b])];
    (masses, simulation)
}

/// Momentum of all systems, its angular part about the origin of W and about the common centre of mass, energy
/// with that of the contacts, and the sums of the magnitudes of all forces.
struct Totals {
    linear: Vector3<f64>,
    angular: Vector3<f64>,
    about_com: Vector3<f64>,
    energy: f64,
}

fn vector(x: &[f64]) -> Vector3<f64> {
    Vector3::from_column_slice(&x[..3])
}

fn totals(masses: &[f64], recording: &Recording, k: usize) -> Totals {
    let (mut linear, mut angular, mut moment) = (Vector3::zeros(), Vector3::zeros(), Vector3::zeros());
    let mut energy = 0.0;
    for (mass, trace) in masses.iter().zip(&recording.systems) {
        let (h, c) = (&trace.momentum[6 * k..], vector(&trace.center_of_mass[3 * k..]));
        linear += vector(h);
        angular += vector(&h[3..]) + c.cross(&vector(h));
        moment += c * *mass;
        energy += trace.kinetic_energy[k];
        energy += trace
            .contacts
            .iter()
            .map(|column| column.values[19 * k + 12] + column.values[19 * k + 13])
            .sum::<f64>();
    }
    let center = moment / masses.iter().sum::<f64>();
    Totals { linear, angular, about_com: angular - center.cross(&linear), energy }
}

/// Runs a world for a minute and shows how far it is.
fn run(mut simulation: Simulation, title: &str) -> Recording {
    let mut stepper = simulation.start(Some(END)).unwrap();
    for k in 0..20 {
        let t = END * f64::from(k + 1) / 20.0;
        stepper.advance_to(t).unwrap();
        eprint!("\r{title} so far, {t:.0} of {END:.0} s ");
    }
    eprintln!();
    stepper.finish().map_err(|failure| failure.error).unwrap()
}

#[test]
#[ignore = "takes minutes: run by make contact-campaign"]
fn a_thousand_contacts_keep_momentum_and_energy() {
    let wanted: usize = std::env::var("CONTACTS").map_or(1000, |count| count.parse().unwrap());
    let first: u64 = std::env::var("SEED").map_or(0, |seed| seed.parse().unwrap());
    let (mut contacts, mut seed) = (0, first);
    while contacts < wanted {
        let (masses, simulation) = world(seed);
        let recording = run(simulation, &format!("{seed}: {contacts} of {wanted} contacts"));
        let rows = recording.rows();
        let (first, last) = (totals(&masses, &recording, 0), totals(&masses, &recording, rows - 1));
        let impulses = recording.events.iter().map(|event| vector(&event.impulse).norm());
        let impulse: f64 = impulses.sum();
        let (mut touches, mut exchanged) = (0, 0.0);
        for column in recording.systems.iter().flat_map(|trace| &trace.contacts) {
            let row = |k: usize| &column.values[19 * k..19 * k + 19];
            touches += row(rows - 1)[17] as usize;
            // the sum of the largest energies stored between two lift-offs
            let mut stored = 0.0_f64;
            for k in 1..rows {
                stored = stored.max(row(k)[12]);
                if row(k)[12] == 0.0 {
                    (exchanged, stored) = (exchanged + stored, 0.0);
                }
            }
        }
        let [linear, angular, about_com] = [
            (last.linear - first.linear).norm(),
            (last.angular - first.angular).norm(),
            (last.about_com - first.about_com).norm(),
        ]
        .map(|change| change / impulse);
        let open = (last.energy - first.energy).abs() / exchanged;
        println!(
            "{seed}: {touches} contacts, Σ|impulse| {impulse:.1} N s, energy exchanged {exchanged:.1} J: \
             momentum {linear:.1e}, angular {angular:.1e}, about the centre of mass {about_com:.1e}, energy {open:.1e}"
        );
        assert!(linear < 1e-12 && angular < 1e-12 && about_com < 1e-12 && open < 1e-8);
        assert!(touches > 10, "the bodies hardly touch");
        (contacts, seed) = (contacts + touches, seed + 1);
    }
}
