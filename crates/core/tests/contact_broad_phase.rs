//! The broad phase changes no bit: random trees that collide, are captured and released, with it and without it.
#![allow(clippy::unwrap_used)]

mod common;
#[path = "common/random_shapes.rs"]
mod random_shapes;

use common::stepping::assert_same_bits;
use common::{Random, random_model, random_state};
use nalgebra::Vector3;
use onorbit_core::contact::{Contact, ContactLaw, ContactSide, ContactSteps, Friction, NormalLaw};
use onorbit_core::geometry::Shape;
use onorbit_core::model::Model;
use onorbit_core::simulation::{Integrator, Recording, Simulation};
use onorbit_core::world::{Action, Event, FrameIndex, System, When};
use std::sync::Arc;

const SYSTEMS: usize = 5;

/// Returns a system at a corner of a ring of radius 5 m that moves towards its centre.
fn system(number: usize, random: &mut Random) -> System {
    let model = Arc::new(random_model(random.index(1000) as u64, 1 + random.index(4)));
    let (mut q, mut v) = random_state(&model, random);
    let angle = 2.0 * std::f64::consts::PI * number as f64 / SYSTEMS as f64;
    let away = Vector3::new(5.0 * angle.cos(), 5.0 * angle.sin(), 0.2 * random.unit());
    q[..3].copy_from_slice(away.as_slice());
    v.iter_mut().for_each(|v| *v *= 0.3);
    let rot = nalgebra::UnitQuaternion::new_normalize(nalgebra::Quaternion::new(q[6], q[3], q[4], q[5]));
    v[..3].copy_from_slice((rot.inverse() * away * (-0.3 - 0.2 * random.unit())).as_slice());
    System::new(&format!("s{number}"), model, q, v)
}

/// Returns spheres and boxes on the links of a system.
fn pieces(system: usize, model: &Model, shapes: &mut random_shapes::Random) -> Vec<ContactSide> {
    let links = (0..model.frames().len()).filter(|frame| model.frames()[*frame].name.starts_with("link"));
    let mut all: Vec<_> = links
        .flat_map(|frame| (0..3).map(move |_| FrameIndex { system, frame }))
        .map(|frame| {
            let mut half = || shapes.within(0.1, 0.4);
            let half_edges = [half(), half(), half()];
            let shape = match shapes.unit() < 0.5 {
                true => Shape::Box { half_edges },
                false => Shape::Sphere { radius: half_edges[0] },
            };
            ContactSide { frame, shape, pose: shapes.pose(0.3) }
        })
        .collect();
    all.truncate(1 + (3.0 * shapes.unit()) as usize + all.len() / 2);
    all
}

fn simulation(seed: u64, has_broad_phase: bool) -> Simulation {
    let mut random = Random::new(seed);
    let mut shapes = random_shapes::Random(seed);
    let systems: Vec<System> = (0..SYSTEMS).map(|number| system(number, &mut random)).collect();
    let sides: Vec<_> =
        systems.iter().enumerate().map(|(i, one)| pieces(i, &one.model, &mut shapes)).collect();
    let normal = NormalLaw::HuntCrossley { stiffness: 2e4, exponent: 1.5, dissipation: 0.5 };
    let friction = Friction {
        static_coefficient: 0.4,
        kinetic_coefficient: 0.3,
        stiffness: 1e4,
        damping: None,
        torsional: 0.0,
    };
    let law = ContactLaw { normal, friction: seed.is_multiple_of(2).then_some(friction) };
    let contact = |name: &str, sides: [Vec<ContactSide>; 2], law: Option<ContactLaw>| Contact {
        name: name.to_owned(),
        sides,
        law,
        impact: None,
        may_start_overlapping: true,
    };
    let mut simulation = Simulation::of(systems);
    simulation.contacts = vec![
        contact("first", [sides[0].clone(), sides[1..].concat()], Some(law)),
        contact("others", [sides[1..3].concat(), sides[3..].concat()], Some(law)),
        contact("observed", [sides[1].clone(), sides[2].clone()], None),
        contact("own", [sides[0].clone(), sides[0].clone()], None),
    ];
    simulation.contacts.retain(|contact| contact.check().is_ok()); // a system of one link has no contact with itself
    let capture = |t: f64, by: usize, of: usize| Event {
        name: format!("capture {by} {of}"),
        when: When::At(t),
        action: Action::Capture {
            by: FrameIndex { system: by, frame: 0 },
            of: FrameIndex { system: of, frame: 0 },
            seat: None,
        },
    };
    let release = Action::Release { capture: 0, impulse: [5.0, 0.0, 0.0, 0.0, 1.0, 0.0] };
    let release =
        Event { name: "release".to_owned(), when: When::After { event: 0, delay: 0.7 }, action: release };
    simulation.events = vec![capture(0.8, 1, 3), release, capture(2.0, 0, 4)];
    simulation.contact_steps = ContactSteps { has_broad_phase, ..ContactSteps::default() };
    simulation.time_step = 0.02;
    if seed % 3 == 2 {
        simulation.integrator = Integrator::DormandPrince;
    }
    simulation
}

/// Returns all recorded numbers as text, in which different bits differ.
fn text(recording: &Recording) -> String {
    format!("{recording:?}")
}

#[test]
fn the_broad_phase_changes_no_bit() {
    let mut touches = 0.0;
    for seed in 0..6 {
        let [with, without] = [true, false].map(|is_on| simulation(seed, is_on).run(2.6).unwrap());
        let is_same = text(&with) == text(&without);
        assert!(is_same, "seed {seed}");
        let last = |values: &[f64]| values[values.len() - 2];
        let contacts = with.systems.iter().flat_map(|trace| &trace.contacts);
        touches += contacts.map(|contact| last(&contact.values)).sum::<f64>();
    }
    assert!(touches > 5.0, "{touches}");
}

/// A checkpoint holds the states of far pairs too.
#[test]
fn a_resumed_run_has_the_bits_of_the_whole_run() {
    for seed in [1, 2] {
        let whole = simulation(seed, true).run(2.6).unwrap();
        for pause in [1.2, 2.5] {
            let mut paused = simulation(seed, true);
            let mut stepper = paused.start(Some(2.6)).unwrap();
            stepper.advance_to(pause).unwrap();
            let rows = (0..SYSTEMS).map(|system| stepper.rows(system).clone()).collect();
            let (checkpoint, mut again) = (stepper.checkpoint().unwrap(), simulation(seed, true));
            let mut resumed = again.resume(None, checkpoint, rows).unwrap();
            resumed.advance_to(2.6).unwrap();
            let rest = resumed.finish().map_err(|failure| failure.error).unwrap();
            assert_eq!(rest.events, whole.events, "seed {seed}, {pause} s");
            rest.systems.iter().zip(&whole.systems).for_each(|(a, b)| assert_same_bits(a, b));
        }
    }
}
