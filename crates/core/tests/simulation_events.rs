//! Checks time and events: switches, control period, repeatability, interruption.
#![allow(clippy::unwrap_used)] // a test that cannot set up should stop

mod common;

use common::humanoid::{humanoid, humanoid_with, start};
use nalgebra::{Matrix3, Vector3};
use onorbit_core::control::{ComputedTorque, Control, ControlError, Controller, Law, Observation};
use onorbit_core::dynamics::{Data, frame_pose, positions};
use onorbit_core::environment::{BodyWrench, GravityGradient};
use onorbit_core::model::{Model, neutral};
use onorbit_core::orbit::{Kepler, MU_EARTH};
use onorbit_core::reference::Hold;
use onorbit_core::simulation::{Simulation, SimulationError, Trace};
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex};

fn run(simulation: &mut Simulation, duration: f64) -> Trace {
    simulation.run(duration).unwrap().only()
}

fn low_orbit() -> Arc<Kepler> {
    let (r, v) = (Vector3::new(6_778e3, 0.0, 0.0), Vector3::new(0.0, 4_700.0, 6_100.0));
    Arc::new(Kepler::from_state(r, v, MU_EARTH).unwrap())
}

/// The humanoid holding its tool, in orbit with the gravity gradient.
fn holding(kp: f64, kd: f64) -> Simulation {
    let model = humanoid();
    let (q, tool) = (start(&model), model.frame("tool").unwrap());
    let mut data = Data::new(&model);
    positions(&model, &mut data, &q);
    let pose = frame_pose(&model, &data, &q, tool);
    let mut v = vec![0.0; model.nv()];
    v[6..].copy_from_slice(&[0.05; 7]);
    let mut simulation = Simulation::new(Arc::new(model), q, v);
    simulation.systems[0].tool = Some(tool);
    let hold = Hold::new(pose.rot_wf.to_nalgebra(), pose.pos_w.to_nalgebra()).unwrap();
    let law = Law::TaskComputedTorque(Box::new(ComputedTorque::new(tool, kp, kd)), hold.into());
    simulation.systems[0].controls = vec![Control::on_all_joints(&simulation.systems[0].model, law)];
    simulation.orbit = Some(low_orbit());
    simulation.effects.push(Arc::new(GravityGradient));
    simulation
}

#[test]
fn a_timed_push_off_the_grid_acts_for_its_exact_duration() {
    let model = Model::rigid_body(7.0, Matrix3::identity()).unwrap();
    let (start, end) = (0.1234, 0.456_789);
    for time_step in [0.01, 0.3, 5.0] {
        let mut simulation = Simulation::new(Arc::new(model.clone()), neutral(&model), vec![0.0; 6]);
        let force = Vector3::new(3.0, -1.0, 0.5);
        let push = BodyWrench::new(0, force, Vector3::zeros()).unwrap().during(start, end).unwrap();
        simulation.effects.push(Arc::new(push));
        simulation.time_step = time_step;
        let trace = run(&mut simulation, 1.0);
        let gained = Vector3::from_column_slice(&trace.v[trace.v.len() - 6..]);
        assert!((gained - force * ((end - start) / 7.0)).norm() < 1e-15);
        // p = ½ a Δt² + a Δt (1 − end), a quadratic, which Runge-Kutta integrates exactly
        let moved = Vector3::from_column_slice(&trace.q[trace.q.len() - 7..]);
        let on: f64 = end - start;
        assert!((moved - force / 7.0 * (0.5 * on * on + on * (1.0 - end))).norm() < 1e-15);
        assert!(trace.time.contains(&start) && trace.time.contains(&end)); // jumps lie at rows
    }
}

/// A controller that records its times, and returns a torque that grows by one at each call.
struct Clock(Arc<Mutex<Vec<f64>>>);

impl Controller for Clock {
    fn reset(&mut self) -> Result<(), ControlError> {
        self.0.lock().unwrap().clear();
        Ok(())
    }

    fn update(&mut self, now: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError> {
        let mut times = self.0.lock().unwrap();
        times.push(now.time);
        tau.fill(1e-4 * times.len() as f64);
        Ok(())
    }
}

#[test]
fn control_runs_at_its_period_and_its_torque_is_held() {
    let times = Arc::new(Mutex::new(Vec::new()));
    let model = humanoid();
    let mut simulation = Simulation::new(Arc::new(model.clone()), start(&model), vec![0.0; 13]);
    simulation.systems[0].controls = vec![Control::on_all_joints(
        &simulation.systems[0].model,
        Law::User(Box::new(Clock(Arc::clone(&times))), None),
    )];
    simulation.time_step = 0.01;
    simulation.systems[0].control_period = Some(0.04);
    let trace = run(&mut simulation, 0.1);
    assert_eq!(*times.lock().unwrap(), [0.0, 0.04, 0.08]); // not at the end, which is not a tick
    let first: Vec<f64> = trace.tau.iter().step_by(7).map(|tau| (tau * 1e4).round()).collect();
    assert_eq!(first, [1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0, 3.0, 3.0, 3.0]);
    // faster than the step: steps are shortened
    simulation.systems[0].control_period = Some(0.004);
    let trace = run(&mut simulation, 0.02);
    assert_eq!(times.lock().unwrap().len(), 6);
    assert_eq!(trace.rows(), 7); // 0, 4, 8, 10, 12, 16 and 20 ms
}

fn bits(trace: &Trace) -> Vec<u64> {
    let columns = [
        &trace.time,
        &trace.q,
        &trace.v,
        &trace.tau,
        &trace.acceleration,
        &trace.momentum,
        &trace.impulse,
        &trace.kinetic_energy,
        &trace.work,
        &trace.center_of_mass,
        &trace.tool_pose,
        &trace.position_error,
        &trace.attitude_error,
        &trace.position_eci,
        &trace.velocity_eci,
    ];
    columns.iter().flat_map(|column| column.iter().map(|x| x.to_bits())).collect()
}

#[test]
fn every_run_starts_from_the_given_state_and_gives_the_same_bits() {
    let mut simulation = holding(100.0, 20.0);
    let first = run(&mut simulation, 0.5);
    assert_eq!(first.q[..14], simulation.systems[0].q);
    assert_eq!(first.rows(), 501);
    let again = run(&mut simulation, 0.5);
    let elsewhere = std::thread::spawn(|| run(&mut holding(100.0, 20.0), 0.5)).join().unwrap();
    assert_eq!(bits(&first), bits(&again));
    assert_eq!(bits(&first), bits(&elsewhere));
    // sparse rows are the same rows
    simulation.record_every = 100;
    let sparse = run(&mut simulation, 0.5);
    assert_eq!(sparse.rows(), 6);
    assert_eq!(sparse.q[5 * 14..], first.q[500 * 14..]);
    assert!(!sparse.rows_suffice && first.rows_suffice);
}

#[test]
fn a_diverging_run_reports_time_and_state_and_keeps_its_trace() {
    // gains too high for steps of 10 ms, and joints damped too strongly for the step
    let mut hard = holding(1e9, 1e6);
    hard.time_step = 0.01;
    let mut stiff = holding(0.0, 0.0);
    stiff.systems[0].model = Arc::new(humanoid_with(|joint| joint.damping = 1e3));
    stiff.systems[0].controls = Vec::new();
    stiff.time_step = 0.01;
    for mut simulation in [hard, stiff] {
        let failure = simulation.run(100.0).unwrap_err();
        let SimulationError::Diverged { time, q, v, .. } = &failure.error else { panic!("{failure}") };
        assert!(q.iter().chain(v).all(|x| x.is_finite()) && q.len() == 14 && v.len() == 13);
        assert!(*time > 0.0 && *time < 100.0, "{failure}");
        let trace = &failure.recording.systems[0];
        assert!(trace.rows() > 1 && trace.time.last().unwrap() <= time);
        assert_eq!(trace.acceleration.len(), 13 * trace.rows());
        assert!(trace.q.iter().chain(&trace.v).all(|x| x.is_finite()));
        assert!(failure.to_string().contains("diverged at t ="), "{failure}");
        assert!(format!("{failure:?}").len() < 2000); // not the rows
    }
}

#[test]
fn an_interrupted_run_keeps_its_trace_up_to_there() {
    let mut simulation = holding(100.0, 20.0);
    let mut calls = 0;
    let mut stepper = simulation.start(Some(10.0)).unwrap();
    let advanced = stepper.advance_until(10.0, &mut |time| {
        calls += 1;
        if time > 0.2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(advanced.unwrap().is_break());
    let time = stepper.time();
    assert!(time > 0.2 && time < 0.3 && calls > 1);
    let trace = stepper.finish().unwrap().only();
    drop(stepper);
    assert_eq!(trace.time.last(), Some(&time));
    assert_eq!(trace.acceleration.len(), 13 * trace.rows());
    assert_eq!(run(&mut simulation, 0.1).rows(), 101); // and can run again
}

/// A controller that fails at its third call.
struct Failing(usize);

#[derive(Debug, thiserror::Error)]
#[error("out of coffee")]
struct OutOfCoffee;

impl Controller for Failing {
    fn update(&mut self, _: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError> {
        self.0 += 1;
        tau.fill(0.0);
        if self.0 == 3 { Err(ControlError::User(Box::new(OutOfCoffee))) } else { Ok(()) }
    }
}

#[test]
fn an_error_of_a_controller_is_returned_unchanged_with_the_rows_so_far() {
    let mut simulation = holding(100.0, 20.0);
    simulation.systems[0].controls =
        vec![Control::on_all_joints(&simulation.systems[0].model, Law::User(Box::new(Failing(0)), None))];
    let failure = simulation.run(1.0).unwrap_err();
    let SimulationError::Control(ControlError::User(error)) = failure.error else { panic!("{failure}") };
    assert!(error.is::<OutOfCoffee>());
    assert_eq!(failure.recording.systems[0].rows(), 2);
}

/// A controller that returns a torque that is not finite.
struct Broken;

impl Controller for Broken {
    fn update(&mut self, _: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError> {
        tau[3] = f64::NAN;
        Ok(())
    }
}

#[test]
fn a_torque_that_is_not_finite_is_refused() {
    let mut simulation = holding(100.0, 20.0);
    simulation.systems[0].controls =
        vec![Control::on_all_joints(&simulation.systems[0].model, Law::User(Box::new(Broken), None))];
    let failure = simulation.run(1.0).unwrap_err();
    let text = failure.to_string();
    assert!(text.contains("joint 'arm_4'") && text.contains("finite"), "{text}");
}
