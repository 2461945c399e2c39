//! One run with a thousand contacts: random trees with random convex bodies in a floating box.
//!
//! The test takes minutes and is run by `make contact-campaign`; `CONTACTS` sets the number of contacts,
//! `SEED` the first world and `THREADS` the number of worlds that run at a time, by default that of processors.
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
    let declare = |name: &str, sides| Contact {
        name: name.to_owned(),
        sides,
        law,
        impact: None,
        may_start_overlapping: false,
    };
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

/// Errors of a run, and what they refer to.
struct Outcome {
    touches: usize,
    /// Sum of the magnitudes of the impulses, N s.
    impulse: f64,
    /// Sum of the largest energies stored between two lift-offs, J.
    exchanged: f64,
    /// Changes of the linear momentum and of the angular momenta about the origin of W and about the common
    /// centre of mass, relative to `impulse`.
    momentum: [f64; 3],
    /// Change of the energy relative to `exchanged`.
    energy: f64,
}

/// Runs the world with this seed for a minute and shows how far it is.
fn run(seed: u64) -> Outcome {
    let (masses, mut simulation) = world(seed);
    let mut stepper = simulation.start(Some(END)).unwrap();
    for k in 0..6 {
        let t = END * f64::from(k + 1) / 6.0;
        stepper.advance_to(t).unwrap();
        eprintln!("{seed}: {t:.0} of {END:.0} s");
    }
    outcome(&masses, &stepper.finish().map_err(|failure| failure.error).unwrap())
}

fn outcome(masses: &[f64], recording: &Recording) -> Outcome {
    let rows = recording.rows();
    let (first, last) = (totals(masses, recording, 0), totals(masses, recording, rows - 1));
    let impulse: f64 = recording.events.iter().map(|event| vector(&event.impulse).norm()).sum();
    let (mut touches, mut exchanged) = (0, 0.0);
    for column in recording.systems.iter().flat_map(|trace| &trace.contacts) {
        let row = |k: usize| &column.values[19 * k..19 * k + 19];
        touches += row(rows - 1)[17] as usize;
        let mut stored = 0.0_f64;
        for k in 1..rows {
            stored = stored.max(row(k)[12]);
            if row(k)[12] == 0.0 {
                (exchanged, stored) = (exchanged + stored, 0.0);
            }
        }
    }
    let momentum = [
        (last.linear - first.linear).norm(),
        (last.angular - first.angular).norm(),
        (last.about_com - first.about_com).norm(),
    ]
    .map(|change| change / impulse);
    let energy = (last.energy - first.energy).abs() / exchanged;
    Outcome { touches, impulse, exchanged, momentum, energy }
}

/// Returns the value of an environment variable, or `default` if it is not set.
fn setting(name: &str, default: usize) -> usize {
    std::env::var(name).map_or(default, |value| value.parse().unwrap())
}

#[test]
#[ignore = "takes minutes: run by make contact-campaign"]
fn a_thousand_contacts_keep_momentum_and_energy() {
    let wanted = setting("CONTACTS", 1000);
    let threads = setting("THREADS", std::thread::available_parallelism().map_or(1, usize::from));
    let (mut contacts, mut seed) = (0, setting("SEED", 0) as u64);
    let mut largest = [0.0_f64; 4];
    while contacts < wanted {
        let seeds = seed..seed + threads as u64;
        let outcomes: Vec<Outcome> = std::thread::scope(|scope| {
            let runs: Vec<_> = seeds.clone().map(|seed| scope.spawn(move || run(seed))).collect();
            runs.into_iter().map(|run| run.join().unwrap()).collect()
        });
        for (seed, outcome) in seeds.clone().zip(outcomes) {
            let Outcome { touches, impulse, exchanged, momentum: [linear, angular, about_com], energy } =
                outcome;
            contacts += touches;
            println!(
                "{seed}: {touches} contacts, {contacts} of {wanted}; Σ|impulse| {impulse:.1} N s, energy \
                 exchanged {exchanged:.1} J: momentum {linear:.1e}, angular {angular:.1e}, about the centre of mass \
                 {about_com:.1e}, energy {energy:.1e}"
            );
            assert!(touches > 10, "the bodies hardly touch");
            let errors = [linear, angular, about_com, energy];
            largest = std::array::from_fn(|i| largest[i].max(errors[i]));
        }
        seed = seeds.end;
    }
    let [linear, angular, about_com, energy] = largest;
    println!(
        "{contacts} contacts: momentum {linear:.1e}, angular {angular:.1e}, about the centre of mass {about_com:.1e}, \
         energy {energy:.1e}"
    );
    assert!(linear < 1e-12 && angular < 1e-12 && about_com < 1e-12 && energy < 1e-8);
}
