//! Checks captures and releases of rigid spacecraft against closed forms.

#![allow(missing_docs, clippy::unwrap_used)]

use nalgebra::{Isometry3, Matrix3, Vector3};
use onorbit_core::model::{Inertial, Link, Model, ModelBuilder, neutral};
use onorbit_core::simulation::{Recording, Simulation, certify, world_rows};
use onorbit_core::world::{Action, Event, FrameIndex, System, When};
use std::sync::Arc;

/// A rigid craft with a frame `grip` at a point of its base.
fn craft(mass: f64, inertia: [f64; 3], grip: [f64; 3]) -> Arc<Model> {
    let inertia = Matrix3::from_diagonal(&Vector3::from(inertia));
    let inertial = Inertial { mass, com: Vector3::zeros(), inertia };
    let mut builder = ModelBuilder::new("craft", Link::new("base", Some(inertial))).unwrap();
    builder.add_frame("grip", "base", Isometry3::translation(grip[0], grip[1], grip[2])).unwrap();
    Arc::new(builder.build().unwrap())
}

/// Two craft, one at rest, the other approaching and tumbling. Their grips coincide at (1.5, 0, 0) m.
fn two_craft() -> Simulation {
    let (a, b) = (
        craft(1000.0, [300.0, 400.0, 500.0], [1.5, 0.0, 0.0]),
        craft(500.0, [120.0, 90.0, 150.0], [-1.0, 0.0, 0.0]),
    );
    let (q, mut other) = (neutral(&a), neutral(&b));
    other[0] = 2.5;
    let v = vec![-0.05, 0.02, 0.01, 0.02, 0.05, -0.03];
    Simulation::of(vec![System::new("a", a, q, vec![0.0; 6]), System::new("b", b, other, v)])
}

fn capture(when: When) -> Event {
    let grip = |system: usize| FrameIndex { system, frame: 1 };
    Event { name: "grasp".into(), when, action: Action::Capture { by: grip(0), of: grip(1), seat: None } }
}

fn energy(recording: &Recording, row: usize) -> f64 {
    recording.systems.iter().map(|trace| trace.kinetic_energy[row]).sum()
}

/// Energy and rate of the composite body; the lost energy follows from the reduced mass and inertia.
#[test]
fn two_rigid_craft_lose_the_energy_of_the_closed_form() {
    let mut simulation = two_craft();
    simulation.events = vec![capture(When::At(0.0))];
    let recording = simulation.run(2.0).unwrap();
    let event = &recording.events[0];
    println!("{event:?}");
    assert!((event.energy_lost - 0.667209466941).abs() < 1e-12, "{}", event.energy_lost);
    assert!(event.passed() && event.momentum_error.iter().all(|error| *error <= 1e-15));
    let (before, after) = (energy(&recording, 0), energy(&recording, 1));
    assert!((before - 0.954).abs() < 1e-12 && (after - 0.286790533059).abs() < 1e-12, "{before} {after}");
    let rate = [0.00571429, -0.00148964, 0.00445122];
    for trace in &recording.systems {
        for (i, rate) in rate.iter().enumerate() {
            assert!((trace.v[6 + 3 + i] - rate).abs() < 5e-9, "{:?}", &trace.v[6..12]);
        }
    }
    // the grips stay together, to rounding
    let last = recording.rows() - 1;
    let grip = |system: usize, x: f64| {
        let q = &recording.systems[system].q[7 * last..];
        let rotation =
            nalgebra::UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(q[6], q[3], q[4], q[5]));
        rotation * Vector3::new(x, 0.0, 0.0) + Vector3::new(q[0], q[1], q[2])
    };
    let gap = (grip(0, 1.5) - grip(1, -1.0)).norm();
    println!("gap {gap:e}");
    assert!(gap < 1e-15);
    let models = simulation.systems.iter().map(|system| Arc::clone(&system.model));
    for (trace, model) in recording.systems.iter().zip(models) {
        let certificate = certify(&model, trace);
        assert!(certificate.passed(), "{:?}", certificate.checks());
    }
}

/// Systems of different groups never interact: each has the bits of a separate run.
#[test]
fn two_systems_that_cannot_touch_have_the_bits_of_two_runs() {
    let both = two_craft().run(1.0).unwrap();
    for (number, trace) in both.systems.iter().enumerate() {
        let system = two_craft().systems.remove(number);
        let alone = Simulation::of(vec![system]).run(1.0).unwrap().only();
        for ((name, a), (_, b)) in alone.columns().zip(trace.columns()) {
            assert!(a.iter().map(|x| x.to_bits()).eq(b.iter().map(|x| x.to_bits())), "{name}");
        }
    }
}

#[test]
fn a_release_pushes_both_craft_apart() {
    let mut simulation = two_craft();
    let impulse = [3.0, 0.0, 1.0, 0.0, 0.5, 0.0];
    let release = Event {
        name: "let_go".into(),
        when: When::After { event: 0, delay: 0.5 },
        action: Action::Release { capture: 0, impulse },
    };
    simulation.events = vec![capture(When::At(0.25)), release];
    let recording = simulation.run(2.0).unwrap();
    let [_, event] = &recording.events[..] else { panic!("{:?}", recording.events) };
    println!("{event:?}");
    assert!(event.passed() && event.time == 0.75 && event.energy_lost < 0.0);
    let size = |x: &[f64]| Vector3::from_column_slice(x).norm();
    assert!((size(&event.impulse[..3]) - size(&impulse[..3])).abs() < 1e-12);
    assert!((size(&event.impulse[3..]) - 0.5).abs() < 1e-12);
    let systems = simulation.systems.iter().zip(&recording.systems);
    let systems: Vec<_> = systems.map(|(system, trace)| (trace, &*system.model)).collect();
    let rows = world_rows(&systems).momentum;
    let drift = (0..6).map(|i| (rows[rows.len() - 6 + i] - rows[i]).abs()).fold(0.0, f64::max);
    println!("drift {drift:e}");
    assert!(drift < 1e-12);
    for check in recording.groups[0].checks() {
        assert!(check.value < 1e-12, "{check:?}");
    }
}
