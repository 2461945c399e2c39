//! A run that was stopped goes on with the same bits.
#![allow(clippy::unwrap_used)] // a test that cannot set up should stop

mod common;

use common::humanoid::{START, humanoid, humanoid_with, start};
use nalgebra::Vector3;
use onorbit_core::control::{ComputedTorque, ControlLaw};
use onorbit_core::dynamics::{Data, frame_pose, positions};
use onorbit_core::environment::{BodyWrench, GravityGradient};
use onorbit_core::orbit::{Kepler, MU_EARTH};
use onorbit_core::reference::LineParabola;
use onorbit_core::simulation::{
    Checkpoint, CheckpointError, Integrator, Simulation, SimulationError, Trace, certify,
};
use std::ops::ControlFlow;
use std::sync::Arc;

const DURATION: f64 = 1.5;

/// A reach in orbit with a push that starts and ends between steps, control slower than the steps.
fn simulation(integrator: Integrator, record_every: usize) -> Simulation {
    let model = Arc::new(humanoid());
    let (q, v) = (start(&model), vec![0.01; model.nv()]);
    let tool = model.frame("tool").unwrap();
    let mut data = Data::new(&model);
    positions(&model, &mut data, &q);
    let pose = frame_pose(&model, &data, &q, tool);
    let (rot, from) = (pose.rot_wf.to_nalgebra(), pose.pos_w.to_nalgebra());
    let line = LineParabola::new(rot, from, Vector3::x() * 0.2, Vector3::z() * 0.1, 1.2).unwrap();
    let (r, u) = (Vector3::new(6_778e3, 0.0, 0.0), Vector3::new(0.0, 4_700.0, 6_100.0));
    let push = BodyWrench::new(0, Vector3::y(), Vector3::z() * 0.2).unwrap();
    let mut simulation = Simulation::new(Arc::clone(&model), q, v);
    simulation.orbit = Some(Arc::new(Kepler::from_state(r, u, MU_EARTH).unwrap()));
    simulation.effects = vec![Arc::new(GravityGradient), Arc::new(push.during(0.2503, 1.1007).unwrap())];
    simulation.control = ControlLaw::ComputedTorque(Box::new(ComputedTorque::new(tool, 100.0, 20.0)));
    simulation.tool = Some(tool);
    simulation.reference = Some(line.into());
    simulation.control_period = Some(2.5e-3);
    simulation.integrator = integrator;
    simulation.record_every = record_every;
    simulation
}

/// Runs until `stop`, and what there is to go on from.
fn stopped(simulation: &mut Simulation, stop: f64) -> (Checkpoint, Trace) {
    let mut kept = None;
    let failure = simulation
        .run(DURATION, &mut |now| {
            if now.time < stop {
                return ControlFlow::Continue(());
            }
            kept = Some((now.checkpoint(), now.trace.clone()));
            ControlFlow::Break(())
        })
        .unwrap_err();
    assert!(matches!(failure.error, SimulationError::Interrupted { .. }));
    kept.unwrap()
}

fn assert_same_bits(a: &Trace, b: &Trace) {
    for ((name, a), (_, b)) in a.columns().zip(b.columns()) {
        assert_eq!(a.len(), b.len(), "{name}");
        assert!(a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits()), "{name}");
    }
    assert_eq!(a.work_done.to_bits(), b.work_done.to_bits());
    assert_eq!(a.attitude_step_doubling, b.attitude_step_doubling);
}

#[test]
fn a_run_continued_has_the_bits_of_one_that_was_not_stopped() {
    for (integrator, every) in [
        (Integrator::Rk4, 1),
        (Integrator::Rk4, 7),
        (Integrator::SemiImplicitEuler, 1),
        (Integrator::DormandPrince, 1),
    ] {
        let whole = simulation(integrator, every).run(DURATION, &mut |_| ControlFlow::Continue(())).unwrap();
        for stop in [0.1, 0.4, 0.77] {
            let (checkpoint, rows) = stopped(&mut simulation(integrator, every), stop);
            let read = Checkpoint::from_json(&checkpoint.to_json()).unwrap();
            assert_eq!(read, checkpoint);
            let mut second = simulation(integrator, every);
            let rest = second.resume(DURATION, (&read, rows), &mut |_| ControlFlow::Continue(())).unwrap();
            assert_same_bits(&rest, &whole);
            assert_eq!(certify(&second.model, &rest), certify(&second.model, &whole));
        }
    }
}

/// Joints that stick, slip and hit stops; steps that adapt: what they remember is kept.
#[test]
fn modes_of_joints_and_the_pace_of_steps_are_continued_too() {
    let make = |integrator| {
        let mut simulation = simulation(integrator, 1);
        simulation.model = Arc::new(humanoid_with(|joint| {
            let at = START[joint.name[4..].parse::<usize>().unwrap() - 1];
            joint.limits.position = Some((at - 0.2, at + 0.2));
            joint.friction = 1e-3;
        }));
        simulation.v[6..].copy_from_slice(&[1.0, -0.8, 0.9, 1.1, -0.7, 1.0, -1.2]);
        simulation.control = ControlLaw::None;
        (simulation.reference, simulation.tool) = (None, None);
        simulation.stops = Some(0.5);
        simulation
    };
    for integrator in [Integrator::Rk4, Integrator::DormandPrince] {
        let whole = make(integrator).run(DURATION, &mut |_| ControlFlow::Continue(())).unwrap();
        assert!(*whole.dissipated.last().unwrap() > 0.0);
        let (checkpoint, rows) = stopped(&mut make(integrator), 0.3);
        let read = Checkpoint::from_json(&checkpoint.to_json()).unwrap();
        let mut second = make(integrator);
        let rest = second.resume(DURATION, (&read, rows), &mut |_| ControlFlow::Continue(())).unwrap();
        assert_same_bits(&rest, &whole);
    }
}

#[test]
fn one_bit_of_the_state_shows() {
    // negative control: the comparison above would see the last bit of one number
    let whole = simulation(Integrator::Rk4, 1).run(DURATION, &mut |_| ControlFlow::Continue(())).unwrap();
    let (checkpoint, rows) = stopped(&mut simulation(Integrator::Rk4, 1), 0.4);
    let mut value: serde_json::Value = serde_json::from_str(&checkpoint.to_json()).unwrap();
    let q = value["state"]["q"][0].as_f64().unwrap();
    value["state"]["q"][0] = f64::from_bits(q.to_bits() + 1).into();
    let bent = Checkpoint::from_json(&value.to_string()).unwrap();
    let mut second = simulation(Integrator::Rk4, 1);
    let rest = second.resume(DURATION, (&bent, rows), &mut |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(rest.rows(), whole.rows());
    assert!(rest.q.iter().zip(&whole.q).any(|(a, b)| a.to_bits() != b.to_bits()));
}

#[test]
fn what_cannot_be_continued_is_refused() {
    let (checkpoint, rows) = stopped(&mut simulation(Integrator::Rk4, 1), 0.4);
    let text = checkpoint.to_json();
    let refused = |text: &str, duration: f64, rows: &Trace| {
        let checkpoint = Checkpoint::from_json(text).map_err(SimulationError::from)?;
        let outcome =
            simulation(Integrator::Rk4, 1)
                .resume(duration, (&checkpoint, rows.clone()), &mut |_| ControlFlow::Continue(()));
        outcome.map_err(|failure| failure.error)
    };
    let error = |text: &str, duration, rows| match refused(text, duration, rows) {
        Err(SimulationError::Checkpoint(error)) => error,
        other => panic!("not refused: {:?}", other.map(|trace| trace.rows())),
    };
    assert!(matches!(error("{", DURATION, &rows), CheckpointError::Unreadable { .. }));
    assert!(matches!(
        error("{\"version\": \"0.0.1\"}", DURATION, &rows),
        CheckpointError::OtherVersion { .. }
    ));
    let other_set = text.replace("\"instruction_set\":\"", "\"instruction_set\":\"no ");
    assert!(matches!(error(&other_set, DURATION, &rows), CheckpointError::OtherInstructionSet { .. }));
    assert!(matches!(error(&text, 2.0, &rows), CheckpointError::OtherSchedule { .. }));
    let mut fewer = rows.clone();
    fewer.time.pop();
    assert!(matches!(error(&text, DURATION, &fewer), CheckpointError::OtherSize { name: "rows", .. }));
    let mut ragged = rows.clone();
    ragged.q.pop();
    assert!(matches!(error(&text, DURATION, &ragged), CheckpointError::OtherSize { name: "q", .. }));
    assert!(refused(&text, DURATION, &rows).is_ok());
}
