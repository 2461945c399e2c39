//! What a simulation refuses, each with its own error.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // set-up that fails should stop; --nocapture shows the numbers

mod common;

use common::humanoid::{humanoid, start};
use nalgebra::{Matrix3, Vector3};
use onorbit_core::control::{ComputedTorque, ControlError, ControlLaw};
use onorbit_core::environment::{BodyWrench, EnvironmentError, GravityGradient};
use onorbit_core::reference::Hold;
use onorbit_core::simulation::{Simulation, SimulationError};
use std::ops::ControlFlow;
use std::sync::Arc;

fn sound() -> Simulation {
    let model = humanoid();
    let (q, v) = (start(&model), vec![0.0; model.nv()]);
    Simulation::new(Arc::new(model), q, v)
}

/// The error of a simulation after `spoil`; nothing may have been recorded.
fn refused(spoil: impl FnOnce(&mut Simulation)) -> SimulationError {
    let mut simulation = sound();
    spoil(&mut simulation);
    let failure = simulation.run(1.0, &mut |_| ControlFlow::Continue(())).unwrap_err();
    assert_eq!(failure.trace.rows(), 0);
    println!("{failure}");
    failure.error
}

fn tracking(simulation: &mut Simulation) -> usize {
    let tool = simulation.model.frame("tool").unwrap();
    let hold = Hold::new(Matrix3::identity(), Vector3::zeros()).unwrap();
    simulation.reference = Some(hold.into());
    simulation.tool = Some(tool);
    tool
}

#[test]
fn states_of_the_wrong_length_or_that_are_no_numbers() {
    let is = |error, wanted: (&str, usize, usize)| matches!(error, SimulationError::WrongLength { name, expected, got } if (name, expected, got) == wanted);
    assert!(is(refused(|s| s.q.truncate(13)), ("q", 14, 13)));
    assert!(is(refused(|s| s.v.push(0.0)), ("v", 13, 14)));
    for value in [f64::NAN, f64::INFINITY] {
        let error = refused(|s| s.q[9] = value);
        assert!(matches!(error, SimulationError::NotFinite { name: "q", index: 9, .. }));
        let error = refused(|s| s.v[2] = value);
        assert!(matches!(error, SimulationError::NotFinite { name: "v", index: 2, .. }));
    }
}

#[test]
fn a_quaternion_off_unit_norm() {
    assert!(matches!(refused(|s| s.q[6] = 1.000_002), SimulationError::QuaternionNorm { .. }));
    assert!(matches!(refused(|s| s.q[6] = 0.0), SimulationError::QuaternionNorm { norm: 0.0 }));
    let mut nearly = sound();
    nearly.q[6] = 1.000_000_5;
    let trace = nearly.run(0.01, &mut |_| ControlFlow::Continue(())).unwrap();
    assert!((trace.q[6] - 1.0).abs() < 1e-15); // put right, not carried along
}

#[test]
fn steps_periods_and_durations_that_are_not_positive() {
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = refused(|s| s.time_step = value);
        assert!(matches!(error, SimulationError::NotPositive { name: "time_step", .. }));
        let error = refused(|s| s.control_period = Some(value));
        assert!(matches!(error, SimulationError::NotPositive { name: "control_period", .. }));
        let failure = sound().run(value, &mut |_| ControlFlow::Continue(())).unwrap_err();
        assert!(matches!(failure.error, SimulationError::NotPositive { name: "duration", .. }));
    }
    assert!(matches!(refused(|s| s.record_every = 0), SimulationError::RecordEvery));
}

#[test]
fn more_rows_than_memory_holds() {
    let failure = sound().run(1e15, &mut |_| ControlFlow::Continue(())).unwrap_err();
    assert!(matches!(failure.error, SimulationError::TooManyRows { .. }), "{failure}");
}

#[test]
fn effects_without_what_they_need() {
    let error = refused(|s| s.effects.push(Arc::new(GravityGradient)));
    assert!(matches!(error, SimulationError::NeedsOrbit { .. }));
    let push = BodyWrench::new(8, Vector3::x(), Vector3::zeros()).unwrap();
    let error = refused(|s| s.effects.push(Arc::new(push)));
    let SimulationError::Environment { source, .. } = error else { panic!("{error}") };
    assert_eq!(source, EnvironmentError::UnknownBody { body: 8, count: 8 });
}

#[test]
fn laws_and_references_without_each_other() {
    let error = refused(|s| {
        let tool = s.model.frame("tool").unwrap();
        s.control = ControlLaw::ComputedTorque(Box::new(ComputedTorque::new(tool, 100.0, 20.0)));
    });
    assert!(matches!(error, SimulationError::NeedsReference));
    let error = refused(|s| {
        tracking(s);
        s.tool = None;
    });
    assert!(matches!(error, SimulationError::NeedsTool));
}

#[test]
fn gains_and_frames_that_cannot_work() {
    let law = |change: fn(&mut ComputedTorque)| {
        refused(|s| {
            let mut law = ComputedTorque::new(tracking(s), 100.0, 20.0);
            change(&mut law);
            s.control = ControlLaw::ComputedTorque(Box::new(law));
        })
    };
    let is_finite_error = |error| matches!(error, SimulationError::Control(ControlError::NotFinite { .. }));
    assert!(is_finite_error(law(|law| law.kp[3] = f64::NAN)));
    assert!(is_finite_error(law(|law| law.damping = f64::INFINITY)));
    let is_negative = |error| matches!(error, SimulationError::Control(ControlError::Negative { .. }));
    assert!(is_negative(law(|law| law.kd[7] = -1.0)));
    assert!(is_negative(law(|law| law.null_space_damping = -1.0)));
    let error = law(|law| law.frame = 0); // the torso itself
    assert!(matches!(error, SimulationError::Control(ControlError::TooFewJoints { joints: 0, .. })));
}

/// Found while testing: indices were trusted, and the run panicked.
#[test]
fn frames_the_robot_does_not_have() {
    let error = refused(|s| s.tool = Some(99));
    assert!(matches!(error, SimulationError::UnknownFrame { frame: 99, .. }), "{error}");
    let error = refused(|s| {
        tracking(s);
        s.control = ControlLaw::ComputedTorque(Box::new(ComputedTorque::new(99, 1.0, 1.0)));
    });
    assert!(matches!(error, SimulationError::UnknownFrame { frame: 99, .. }), "{error}");
}
