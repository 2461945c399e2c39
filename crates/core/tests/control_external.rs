//! Checks commands from outside of a run against closed forms: laws, trajectories, timeouts, wrenches and checkpoints.
#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test

mod common;

use common::slider::{REDUCED, slider};
use common::stepping::assert_same_bits;
use nalgebra::Vector3;
use onorbit_core::control::{
    Control, ControlError, External, ExternalCommand, Interface, JointComputedTorque, JointTrajectory, Law,
    OnTimeout, Setpoint,
};
use onorbit_core::model::neutral;
use onorbit_core::simulation::{
    Checkpoint, Recording, Simulation, SimulationError, Stepper, Trace, WrenchAxes, WrenchCommand,
};
use std::sync::Arc;

const KP: f64 = 25.0;
const KD: f64 = 10.0;
const STEP: f64 = 1e-3;
fn simulation(kp: f64, kd: f64, timeout: Option<f64>, on_timeout: OnTimeout) -> Simulation {
    let model = Arc::new(slider(0.0, 0.0, None, 0.0));
    let mut simulation = Simulation::new(Arc::clone(&model), neutral(&model), vec![0.0; model.nv()]);
    let mut law = External::new(JointComputedTorque::new(kp, kd));
    (law.timeout, law.on_timeout) = (timeout, on_timeout);
    simulation.systems[0].controls = vec![Control::new("control", vec![0], Law::External(Box::new(law)))];
    simulation.time_step = STEP;
    simulation
}

fn send(stepper: &mut Stepper<'_>, setpoint: Setpoint) {
    stepper.send(0, "control", ExternalCommand::Setpoint(setpoint)).unwrap();
}

fn finished(mut stepper: Stepper<'_>, end: f64) -> Trace {
    stepper.advance_to(end).unwrap();
    stepper.finish().map(Recording::only).unwrap()
}

/// Returns position and rate of the slide at the end.
fn end(trace: &Trace) -> (f64, f64) {
    (*trace.q.last().unwrap(), *trace.v.last().unwrap())
}

/// Returns error and rate of error after a number of steps, each with a constant acceleration `kp e + kd ė`.
fn sampled((mut e, mut rate): (f64, f64), (kp, kd): (f64, f64), steps: usize) -> (f64, f64) {
    for _ in 0..steps {
        let acceleration = -(kp * e + kd * rate);
        e += rate * STEP + acceleration * STEP * STEP / 2.0;
        rate += acceleration * STEP;
    }
    (e, rate)
}

#[test]
fn positions_and_rates_obey_the_sampled_error_law() {
    let mut simulation = simulation(KP, KD, None, OnTimeout::Hold);
    let mut stepper = simulation.start(None).unwrap();
    send(&mut stepper, Setpoint::position(vec![0.4]));
    stepper.advance_to(0.5).unwrap();
    let (mut q, mut v) = ([0.0; 8], [0.0; 7]);
    stepper.read_state(0, &mut q, &mut v).unwrap();
    let (e, rate) = sampled((0.4, 0.0), (KP, KD), 500);
    assert!((0.4 - q[7] - e).abs() < 1e-12 && (-v[6] - rate).abs() < 1e-12, "{q:?} {v:?}");
    send(&mut stepper, Setpoint { effort: Some(vec![0.5]), ..Setpoint::velocity(vec![0.3]) });
    // q̈ = kd (vd − q̇) + τd/m
    let (settled, before) = (0.3 + 0.5 / REDUCED / KD, v[6]);
    let (_, after) = end(&finished(stepper, 0.75));
    let expected = settled + (before - settled) * (1.0 - KD * STEP).powi(250);
    assert!((after - expected).abs() < 1e-12, "{after} {expected}");
}

#[test]
fn efforts_accelerate_the_reduced_mass() {
    let mut simulation = simulation(0.0, 0.0, None, OnTimeout::Hold);
    let mut stepper = simulation.start(None).unwrap();
    assert_eq!(stepper.external(0)[0].interface, Interface::Effort);
    stepper.advance_to(0.25).unwrap();
    send(&mut stepper, Setpoint::effort(vec![0.8]));
    let (q, v) = end(&finished(stepper, 1.25));
    assert!((v - 0.8 / REDUCED).abs() < 1e-12 && (q - 0.4 / REDUCED).abs() < 1e-12);
}

/// `10 u³ − 15 u⁴ + 6 u⁵`, from rest to rest.
fn quintic(u: f64) -> f64 {
    u * u * u * (10.0 + u * (-15.0 + 6.0 * u))
}

#[test]
fn trajectories_are_interpolated_by_what_their_points_have() {
    let shape = |kind: usize, u: f64| [u, u * u * (3.0 - 2.0 * u), quintic(u)][kind];
    for kind in 0..3 {
        let mut simulation = simulation(KP, KD, None, OnTimeout::Hold);
        let mut stepper = simulation.start(None).unwrap();
        let rest = |has: bool| has.then(|| vec![0.0; 2]);
        let trajectory = JointTrajectory {
            start: 0.0,
            times: vec![0.5, 1.0],
            positions: vec![0.2, -0.1],
            velocities: rest(kind > 0),
            accelerations: rest(kind > 1),
        };
        stepper.send(0, "control", ExternalCommand::Trajectory(trajectory)).unwrap();
        let trace = finished(stepper, 1.2);
        for (row, t) in trace.time.iter().enumerate() {
            let desired = trace.q[8 * row + 7] + trace.tracking[0].values[row];
            let expected = match t {
                t if *t < 0.5 => 0.2 * shape(kind, t / 0.5),
                t if *t < 1.0 => 0.2 - 0.3 * shape(kind, (t - 0.5) / 0.5),
                _ => -0.1,
            };
            assert!((desired - expected).abs() < 1e-14, "{kind} {t}: {desired} {expected}");
        }
    }
}

#[test]
fn after_a_timeout_the_joint_holds_stops_or_is_free() {
    for (on_timeout, kp, (moved, rate)) in [
        (OnTimeout::Hold, KP, (0.0, 0.0)),
        (OnTimeout::Damp, 0.0, (0.3 / KD, 0.0)),
        (OnTimeout::Zero, 0.0, (0.3 * 3.0, 0.3)),
    ] {
        let mut simulation = simulation(kp, KD, Some(1.0), on_timeout);
        let mut stepper = simulation.start(None).unwrap();
        send(&mut stepper, Setpoint::velocity(vec![0.3]));
        let trace = finished(stepper, 4.0);
        let due = trace.time.iter().position(|t| (t - 1.0).abs() < 1e-9).unwrap();
        let (q, v) = end(&trace);
        let distance = q - trace.q[8 * due + 7];
        assert!((distance - moved).abs() < 2e-4 && (v - rate).abs() < 1e-4, "{on_timeout:?} {distance} {v}");
    }
}

/// A joint that moves at a commanded rate, with a trajectory that starts long after the timeout of the rate.
fn with_later_trajectory(stepper: &mut Stepper<'_>) {
    send(stepper, Setpoint::velocity(vec![0.3]));
    stepper.advance_to(0.1).unwrap();
    let trajectory = JointTrajectory {
        start: 1.5,
        times: vec![0.5],
        positions: vec![0.2],
        velocities: Some(vec![0.1]),
        accelerations: None,
    };
    stepper.send(0, "control", ExternalCommand::Trajectory(trajectory)).unwrap();
}

#[test]
fn a_trajectory_with_a_later_start_does_not_suspend_the_timeout() {
    let make = || simulation(KP, KD, Some(0.2), OnTimeout::Zero);
    let mut first = make();
    let mut stepper = first.start(Some(2.5)).unwrap();
    with_later_trajectory(&mut stepper);
    let whole = finished(stepper, 2.5);
    let torque = |t: f64| whole.tau[whole.time.iter().position(|time| (time - t).abs() < 1e-9).unwrap()];
    assert!(torque(0.19) != 0.0 && torque(0.21) == 0.0, "the timeout of the running command");
    assert!(torque(1.6) != 0.0 && torque(2.19) != 0.0 && torque(2.21) == 0.0, "that of the trajectory");
    for stop in [0.15, 0.25, 1.55, 2.1] {
        let mut one = make();
        let mut stepper = one.start(Some(2.5)).unwrap();
        with_later_trajectory(&mut stepper);
        stepper.advance_to(stop).unwrap();
        let read = Checkpoint::from_json(&stepper.checkpoint().unwrap().to_json()).unwrap();
        let rows = stepper.rows(0).clone();
        drop(stepper);
        let mut second = make();
        assert_same_bits(&finished(second.resume(None, read, vec![rows]).unwrap(), 2.5), &whole);
    }
}

#[test]
fn the_present_row_is_the_last_row_of_the_recording() {
    let mut simulation = simulation(KP, KD, None, OnTimeout::Hold);
    let mut stepper = simulation.start(None).unwrap();
    for t in [0.0, 0.1, 0.1234567] {
        if t > 0.0 {
            stepper.advance_to(t).unwrap();
        }
        let row = Recording { systems: stepper.present_rows().unwrap(), ..Recording::default() }.only();
        let all = stepper.recording().unwrap().only();
        assert_eq!((row.rows(), row.time[0]), (1, t));
        for ((name, one), (_, column)) in row.columns().zip(all.columns()) {
            assert_eq!(one[..], column[column.len() - one.len()..], "{name}");
            assert_eq!(one.is_empty(), column.is_empty(), "{name}");
        }
    }
}

#[test]
fn a_checked_command_is_not_sent() {
    let mut simulation = simulation(KP, KD, None, OnTimeout::Hold);
    let stepper = simulation.start(None).unwrap();
    stepper.check_send(0, "control", &ExternalCommand::Setpoint(Setpoint::position(vec![0.4]))).unwrap();
    assert_eq!(end(&finished(stepper, 0.1)), (0.0, 0.0));
}

/// Sends trajectories with later starts, and wrenches, at times within steps.
fn drive(stepper: &mut Stepper<'_>, commands: std::ops::Range<usize>) {
    for k in commands {
        stepper.advance_to(0.1 * (k + 1) as f64 + 0.0004).unwrap();
        let trajectory = JointTrajectory {
            start: stepper.time() + 0.05,
            times: vec![0.1],
            positions: vec![0.1 * k as f64],
            velocities: Some(vec![0.0]),
            accelerations: None,
        };
        stepper.send(0, "control", ExternalCommand::Trajectory(trajectory)).unwrap();
        let force = Vector3::new(0.1, k as f64, 0.0);
        let wrench = WrenchCommand { force, axes: WrenchAxes::Body, ..WrenchCommand::default() };
        stepper.wrench(0, 0, wrench).unwrap();
    }
}

#[test]
fn a_checkpoint_contains_commands_wrenches_and_deadlines() {
    let make = || simulation(KP, KD, Some(0.2), OnTimeout::Damp);
    let mut first = make();
    let mut stepper = first.start(Some(1.0)).unwrap();
    drive(&mut stepper, 0..3);
    let whole = finished(stepper, 1.0);
    assert!(whole.impulse[6 * (whole.rows() - 1) + 1] > 0.5);
    for stop in 0..=3 {
        let mut one = make();
        let mut stepper = one.start(Some(1.0)).unwrap();
        drive(&mut stepper, 0..stop);
        let read = Checkpoint::from_json(&stepper.checkpoint().unwrap().to_json()).unwrap();
        let rows = stepper.rows(0).clone();
        drop(stepper);
        let mut second = make();
        let mut stepper = second.resume(None, read, vec![rows]).unwrap();
        drive(&mut stepper, stop..3);
        assert_same_bits(&finished(stepper, 1.0), &whole);
    }
    // a checkpoint of another law
    let mut other = make();
    let stepper = other.start(Some(1.0)).unwrap();
    let text = stepper.checkpoint().unwrap().to_json();
    drop(stepper);
    let damaged = text.replace("\"velocity\":null", "\"velocity\":[0.0,1.0]");
    let broken = Checkpoint::from_json(&damaged).unwrap();
    let refused = other.resume(None, broken, vec![Trace::default()]).map(|_| ());
    assert_ne!(damaged, text);
    assert!(
        matches!(refused, Err(SimulationError::Control(ControlError::OtherMemory { .. }))),
        "{refused:?}"
    );
}

#[test]
fn invalid_commands_are_errors() {
    let mut simulation = simulation(0.0, KD, None, OnTimeout::Hold);
    let mut stepper = simulation.start(None).unwrap();
    let mut error = |control: &str, setpoint: Setpoint| match stepper.send(
        0,
        control,
        ExternalCommand::Setpoint(setpoint),
    ) {
        Err(SimulationError::Control(error)) => error,
        other => panic!("{other:?}"),
    };
    let velocity = |values: &[f64]| Setpoint::velocity(values.to_vec());
    assert!(matches!(error("arm", velocity(&[0.0])), ControlError::UnknownControl { .. }));
    assert!(matches!(error("control", velocity(&[0.0; 2])), ControlError::CommandLength { got: 2, .. }));
    assert!(matches!(error("control", velocity(&[f64::NAN])), ControlError::CommandNumber { .. }));
    assert!(matches!(error("control", Setpoint::default()), ControlError::EmptyCommand { .. }));
    let position = Setpoint::position(vec![0.0]);
    assert!(matches!(error("control", position), ControlError::CommandGain { gain: "kp", .. }));
    let wrench = WrenchCommand { force: Vector3::x() * f64::INFINITY, ..WrenchCommand::default() };
    assert!(matches!(stepper.wrench(0, 0, wrench), Err(SimulationError::NotFinite { name: "force", .. })));
    let wrench = WrenchCommand::default();
    assert!(matches!(stepper.wrench(0, 99, wrench), Err(SimulationError::UnknownFrame { .. })));
    assert!(!stepper.has_ended());
}
