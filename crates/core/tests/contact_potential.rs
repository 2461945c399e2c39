//! Elastic energy of polyhedra: the forces are its gradient, so that an elastic impact returns it.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // a test that prints its largest errors

mod common;

use common::Random;
use common::touch::{body, contact, side};
use nalgebra::{UnitQuaternion, Vector3};
use onorbit_core::contact::{ContactLaw, ContactSteps, NormalLaw};
use onorbit_core::geometry::Shape;
use onorbit_core::simulation::Simulation;

const EDGES: [f64; 3] = [0.1, 0.08, 0.05];
/// Ways in which a box meets the floor.
const MEETINGS: [&str; 3] = ["face", "edge", "random"];

fn turn(x: f64, y: f64, z: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_euler_angles(x, y, z)
}

fn attitude(meeting: &str, random: &mut Random) -> UnitQuaternion<f64> {
    let (x, y, z) = (random.unit(), random.unit(), 3.0 * random.unit());
    match meeting {
        "face" => turn(0.03 * x, 0.03 * y, 0.0) * turn(0.0, 0.0, z),
        "edge" => turn(0.0, 0.0, z) * turn(0.01 * x, 0.0, 0.0) * turn(0.0, 0.4 + 0.3 * y, 0.0),
        _ => UnitQuaternion::new(random.vector() * 3.0),
    }
}

/// Throws a box at a free floor. Returns the largest and the least energy that counts as dissipated during
/// the run, and the energy dissipated at its end, each relative to the largest elastic energy.
fn throw(
    (floor, meeting, seed): (&Shape, &str, u64),
    exponent: f64,
    dissipation: f64,
    steps: ContactSteps,
) -> [f64; 3] {
    let mut random = Random::new(seed);
    let turned = attitude(meeting, &mut random);
    let spin = random.vector() * 0.3;
    let below = if matches!(floor, Shape::HalfSpace) { 0.0 } else { -0.05 };
    let aside = [0.04 * random.unit(), 0.04 * random.unit()];
    let mut falling = body("box", 2.0, 0.006, [aside[0], aside[1], 0.16], 0.0);
    falling.q[3..].copy_from_slice(&[turned.i, turned.j, turned.k, turned.w]);
    falling.v[..3].copy_from_slice((turned.inverse() * Vector3::new(0.02, 0.01, -0.3)).as_slice());
    falling.v[3..].copy_from_slice((turned.inverse() * spin).as_slice());
    let mut simulation = Simulation::of(vec![body("floor", 3.0, 0.01, [0.0, 0.0, below], 0.0), falling]);
    let stiffness = if exponent == 1.0 { 2e5 } else { 2e6 };
    let normal = NormalLaw::HuntCrossley { stiffness, exponent, dissipation };
    let sides = [side(0, 0, floor.clone()), side(1, 0, Shape::Box { half_edges: EDGES })];
    simulation.contacts = vec![contact("floor", sides, ContactLaw { normal, friction: None })];
    simulation.time_step = 0.01;
    simulation.contact_steps = steps;
    let recording = simulation.run(0.8).unwrap();
    let column = &recording.systems[0].contacts[0].values;
    let values = |k: usize| column.chunks_exact(19).map(move |row| row[k]);
    let stored = values(12).fold(0.0, f64::max);
    assert!(stored > 0.0);
    let [largest, least] = [values(13).fold(0.0, f64::max), values(13).fold(0.0, f64::min)];
    [largest, least, values(13).next_back().unwrap()].map(|energy| energy / stored)
}

fn floors() -> [Shape; 2] {
    [Shape::HalfSpace, Shape::Box { half_edges: [0.16, 0.15, 0.05] }]
}

fn every(mut check: impl FnMut(&Shape, &str, u64)) {
    for floor in floors() {
        for meeting in MEETINGS {
            (1000..1012).for_each(|seed| check(&floor, meeting, seed));
        }
    }
}

/// Where the elastic energy or a force jumps within a step, more than 1e-8 may remain.
#[test]
fn an_elastic_impact_returns_its_energy() {
    for (exponent, others) in [(1.0, 0), (1.5, 3)] {
        let (mut worst, mut above) = (0.0_f64, 0);
        every(|floor, meeting, seed| {
            let [largest, least, _] = throw((floor, meeting, seed), exponent, 0.0, ContactSteps::default());
            let open = largest.max(-least);
            worst = worst.max(open);
            if open > 1e-8 {
                println!("{} {meeting} {seed}: {open:e}", floor.name());
                above += 1;
            }
        });
        println!("exponent {exponent}: {worst:e}");
        assert!(worst < 1e-6 && above <= others, "exponent {exponent}: {worst:e}, {above} above 1e-8");
    }
}

/// With losses, the energy dissipated is never negative.
#[test]
fn a_passive_law_dissipates() {
    every(|floor, meeting, seed| {
        let [_, least, lost] = throw((floor, meeting, seed), 1.0, 2.0, ContactSteps::default());
        let name = floor.name();
        assert!(least > -1e-7 && lost > 0.01, "{name} {meeting} {seed}: {least:e} {lost:e}");
    });
}

/// Negative control: forces along the normal at the points, without the change of the weights, create and
/// destroy energy.
#[test]
fn forces_at_the_points_alone_have_no_potential() {
    let steps = ContactSteps { is_conservative: false, ..ContactSteps::default() };
    let (mut gained, mut lost) = (0.0_f64, 0.0_f64);
    every(|floor, meeting, seed| {
        let [_, _, end] = throw((floor, meeting, seed), 1.0, 0.0, steps);
        (gained, lost) = (gained.max(-end), lost.max(end));
    });
    println!("control: gained {gained:e}, lost {lost:e}");
    assert!(gained > 0.01 && lost > 0.01, "{gained:e} {lost:e}");
}
