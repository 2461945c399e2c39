//! Checks checkpoints of worlds: identical bits and certificate after resuming, and errors for damaged
//! connections.

#![allow(missing_docs, clippy::unwrap_used)]

mod common;

use common::stepping::assert_same_bits;
use nalgebra::{Isometry3, Matrix3, Vector3};
use onorbit_core::model::{Inertial, Link, Model, ModelBuilder, neutral};
use onorbit_core::simulation::{Checkpoint, Recording, Simulation, SimulationError, Trace};
use onorbit_core::world::{Action, Envelope, Event, FrameIndex, System, When};
use serde_json::Value;
use std::sync::Arc;

const DURATION: f64 = 1.0;

/// A rigid craft with a frame `grip` 1 m in front of its base.
fn craft() -> Arc<Model> {
    let inertia = Matrix3::from_diagonal(&Vector3::new(3.0, 4.0, 5.0));
    let inertial = Inertial { mass: 100.0, com: Vector3::zeros(), inertia };
    let mut builder = ModelBuilder::new("craft", Link::new("base", Some(inertial))).unwrap();
    builder.add_frame("grip", "base", Isometry3::translation(1.0, 0.0, 0.0)).unwrap();
    Arc::new(builder.build().unwrap())
}

/// The first craft captures the second by a latch that is held for 0.2 s, and releases it. A third one is
/// alone.
fn simulation() -> Simulation {
    let model = craft();
    let system = |name: &str, x: f64, v: [f64; 6]| {
        let mut q = neutral(&model);
        (q[0], q[1]) = (x, 0.02);
        System::new(name, Arc::clone(&model), q, v.to_vec())
    };
    let mut simulation = Simulation::of(vec![
        system("a", 0.0, [0.0, 0.01, 0.0, 0.0, 0.02, 0.1]),
        system("alone", 100.0, [0.1; 6]),
        system("b", 0.02, [0.0, 0.0, -0.01, 0.03, 0.0, 0.0]),
    ]);
    let grip = |system: usize| FrameIndex { system, frame: 1 };
    let envelope =
        Envelope { within: [0.2, 1.0], slower_than: [f64::INFINITY; 2], held_for: 0.2, touching: Vec::new() };
    simulation.events = vec![
        Event {
            name: "grasp".into(),
            when: When::Latch(envelope),
            action: Action::Capture { by: grip(0), of: grip(2), seat: None },
        },
        Event {
            name: "let_go".into(),
            when: When::After { event: 0, delay: 0.3 },
            action: Action::Release { capture: 0, impulse: [1.0, 0.0, 0.0, 0.0, 0.1, 0.0] },
        },
    ];
    simulation.time_step = 2e-3;
    simulation.record_every = 3;
    simulation
}

/// Returns a checkpoint at `stop`, written and read back, and the rows of each system before it.
fn stopped(stop: f64) -> (Checkpoint, Vec<Trace>) {
    let mut simulation = simulation();
    let mut stepper = simulation.start(Some(DURATION)).unwrap();
    stepper.advance_to(stop).unwrap();
    let checkpoint = stepper.checkpoint().unwrap();
    let read = Checkpoint::from_json(&checkpoint.to_json()).unwrap();
    assert_eq!(read, checkpoint);
    (read, (0..3).map(|system| stepper.rows(system).clone()).collect())
}

fn resumed(from: Checkpoint, rows: Vec<Trace>) -> Result<Recording, SimulationError> {
    let mut simulation = simulation();
    let mut stepper = simulation.resume(None, from, rows)?;
    stepper.advance_to(DURATION)?;
    stepper.finish().map_err(|failure| failure.error)
}

#[test]
fn a_resumed_world_has_the_bits_and_the_certificate_of_an_uninterrupted_run() {
    let whole = simulation().run(DURATION).unwrap();
    assert_eq!(whole.events.iter().map(|event| event.time).collect::<Vec<_>>(), [0.2, 0.5]);
    for stop in [0.05, 0.1001, 0.2, 0.3, 0.5, 0.7] {
        let (checkpoint, rows) = stopped(stop);
        let rest = resumed(checkpoint, rows).unwrap();
        for (a, b) in whole.systems.iter().zip(&rest.systems) {
            assert_same_bits(a, b);
        }
        assert_eq!(whole.events, rest.events);
        assert_eq!(whole.groups, rest.groups);
    }
}

/// Regression: the tree that remained after a release was rooted at another system than in its checkpoint,
/// and a resumed run read its coordinates as those of the other system.
#[test]
fn a_tree_that_its_root_has_left_resumes_with_the_same_bits() {
    let grip = |system: usize| FrameIndex { system, frame: 1 };
    let event = |name: &str, t: f64, action: Action| Event { name: name.into(), when: When::At(t), action };
    let capture = |by: usize, of: usize| Action::Capture { by: grip(by), of: grip(of), seat: None };
    let make = || {
        let mut simulation = simulation();
        simulation.events = vec![
            event("pair", 0.1, capture(2, 1)),
            event("carry", 0.2, capture(0, 2)),
            event("let_go", 0.3, Action::Release { capture: 1, impulse: [1.0, 0.0, 0.0, 0.0, 0.1, 0.0] }),
        ];
        simulation
    };
    let whole = make().run(DURATION).unwrap();
    let (mut first, mut second) = (make(), make());
    let mut stepper = first.start(Some(DURATION)).unwrap();
    stepper.advance_to(0.5).unwrap();
    let rows = (0..3).map(|system| stepper.rows(system).clone()).collect();
    let mut rest = second.resume(None, stepper.checkpoint().unwrap(), rows).unwrap();
    rest.advance_to(DURATION).unwrap();
    let rest = rest.finish().unwrap();
    whole.systems.iter().zip(&rest.systems).for_each(|(a, b)| assert_same_bits(a, b));
    assert_eq!(whole.groups, rest.groups);
}

/// Regression: with these steps, the end of a turn is rounded to a number after the step that ends there, and
/// the run did not end.
#[test]
fn several_groups_advance_whatever_the_length_of_the_steps() {
    for time_step in [1e-4, 2e-4, 3e-4, 0.01, 0.1] {
        let mut simulation = simulation();
        (simulation.time_step, simulation.events) = (time_step, vec![]);
        simulation.record_every = 64;
        let duration = 6400.0 * time_step;
        let mut stepper = simulation.start(Some(duration)).unwrap();
        let mut calls = 0;
        while stepper.time() < duration - 1e-9 {
            let _ = stepper.advance_until(duration, &mut |_| std::ops::ControlFlow::Break(())).unwrap();
            calls += 1;
            assert!(calls <= 101, "{time_step}: at {}", stepper.time());
        }
    }
}

#[test]
fn another_balance_of_the_group_shows() {
    let whole = simulation().run(DURATION).unwrap();
    let (checkpoint, rows) = stopped(0.3);
    let mut value: Value = serde_json::from_str(&checkpoint.to_json()).unwrap();
    let balance = &mut value["groups"][0]["progress"]["world"]["balance"];
    let worked = balance["worked"].as_f64().unwrap();
    balance["worked"] = (worked + 1e-9).into();
    let bent = Checkpoint::from_json(&value.to_string()).unwrap();
    assert_ne!(whole.groups, resumed(bent, rows).unwrap().groups);
}

#[test]
fn connections_that_do_not_belong_to_the_world_are_refused() {
    type Change = fn(&mut Value);
    let (checkpoint, rows) = stopped(0.3);
    let resume = |change: Change| {
        let mut value: Value = serde_json::from_str(&checkpoint.to_json()).unwrap();
        change(&mut value["groups"][0]["progress"]);
        let changed = Checkpoint::from_json(&value.to_string()).unwrap();
        resumed(changed, rows.clone()).map_err(|error| error.to_string())
    };
    let changes: [(Change, &str); 9] = [
        (|p| p["world"]["members"]["active"]["welds"][0]["by"]["system"] = 7.into(), "frames of the run"),
        (|p| p["world"]["members"]["active"]["welds"][0]["of"]["frame"] = 7.into(), "frames of the run"),
        (|p| p["world"]["members"]["active"]["welds"][0]["capture"] = 2.into(), "event of the run"),
        (|p| p["world"]["members"]["active"]["roots"][0] = 2.into(), "root of a tree"),
        (|p| p["world"]["records"][0]["systems"][0] = 1.into(), "systems of the run"),
        (|p| p["world"]["members"]["parts"][1]["state"]["q"] = vec![0.0; 3].into(), "coordinates"),
        (|p| p["world"]["members"]["parts"] = Vec::<Value>::new().into(), "systems that share trees"),
        (
            |p| p["world"]["members"]["active"]["welds"] = Vec::<Value>::new().into(),
            "systems that share trees",
        ),
        (|p| p["state"]["trees"][0]["shares"] = vec![0.0].into(), "members of a tree"),
    ];
    for (change, said) in changes {
        match resume(change) {
            Err(error) => assert!(error.contains(said), "{error}"),
            Ok(_) => panic!("not refused: {said}"),
        }
    }
    assert!(resume(|_| ()).is_ok());
}
