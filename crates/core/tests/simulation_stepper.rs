//! A run that is advanced in pieces has the bits of one call, and takes commands from outside.
#![allow(clippy::unwrap_used)] // a test that cannot set up should stop

mod common;

use common::humanoid::{START, humanoid, humanoid_with, start};
use common::stepping::{assert_same_bits, resumed};
use nalgebra::Vector3;
use onorbit_core::control::{
    Begin, ComputedTorque, Control, ControlError, Controller, JointComputedTorque, Law, Observation,
};
use onorbit_core::dynamics::{Data, frame_pose, positions};
use onorbit_core::environment::{BodyWrench, GravityGradient};
use onorbit_core::orbit::{Kepler, MU_EARTH};
use onorbit_core::reference::{JointHold, LineParabola};
use onorbit_core::simulation::{Integrator, Simulation, SimulationError, Stepper};
use std::sync::Arc;

const DURATION: f64 = 0.6;

const INTEGRATORS: [Integrator; 3] =
    [Integrator::Rk4, Integrator::SemiImplicitEuler, Integrator::DormandPrince];

/// Joints that move freely in orbit, with a push that starts and ends between steps.
fn passive(integrator: Integrator) -> Simulation {
    let model = Arc::new(humanoid());
    let (q, v) = (start(&model), vec![0.02; model.nv()]);
    let (r, u) = (Vector3::new(6_778e3, 0.0, 0.0), Vector3::new(0.0, 4_700.0, 6_100.0));
    let push = BodyWrench::new(0, Vector3::y(), Vector3::z() * 0.2).unwrap();
    let mut simulation = Simulation::new(model, q, v);
    simulation.orbit = Some(Arc::new(Kepler::from_state(r, u, MU_EARTH).unwrap()));
    simulation.effects = vec![Arc::new(GravityGradient), Arc::new(push.during(0.1503, 0.4007).unwrap())];
    simulation.integrator = integrator;
    simulation
}

/// The same with a reach, whose control is slower than the steps and no multiple of them.
fn reaching(integrator: Integrator) -> Simulation {
    let mut simulation = passive(integrator);
    let model = Arc::clone(&simulation.systems[0].model);
    let tool = model.frame("tool").unwrap();
    let mut data = Data::new(&model);
    positions(&model, &mut data, &simulation.systems[0].q);
    let pose = frame_pose(&model, &data, &simulation.systems[0].q, tool);
    let (rot, from) = (pose.rot_wf.to_nalgebra(), pose.pos_w.to_nalgebra());
    let line = LineParabola::new(rot, from, Vector3::x() * 0.2, Vector3::z() * 0.1, 0.5).unwrap();
    let law = Law::TaskComputedTorque(Box::new(ComputedTorque::new(tool, 100.0, 20.0)), line.into());
    simulation.systems[0].controls = vec![Control::on_all_joints(&model, law)];
    simulation.systems[0].tool = Some(tool);
    simulation.systems[0].control_period = Some(2.5e-3);
    simulation
}

/// Joints that stick, slip and hit stops.
fn with_stops(integrator: Integrator) -> Simulation {
    let mut simulation = passive(integrator);
    simulation.systems[0].model = Arc::new(humanoid_with(|joint| {
        let at = START[joint.name[4..].parse::<usize>().unwrap() - 1];
        joint.limits.position = Some((at - 0.1, at + 0.1));
        joint.friction = 1e-3;
    }));
    simulation.systems[0].v[6..].copy_from_slice(&[1.0, -0.8, 0.9, 1.1, -0.7, 1.0, -1.2]);
    simulation.systems[0].stops = Some(0.5);
    simulation
}

/// Advances to the end by `dt` at a time and looks at the state after every piece.
fn in_pieces(stepper: &mut Stepper<'_>, dt: f64, end: f64) {
    let (mut q, mut v) = ([0.0; 14], [0.0; 13]);
    while stepper.time() < end {
        stepper.advance_to((stepper.time() + dt).min(end)).unwrap();
        stepper.read_state(0, &mut q, &mut v).unwrap();
        assert!(q.iter().chain(&v).all(|x| x.is_finite()));
    }
}

#[test]
fn pieces_have_the_bits_of_one_call() {
    for make in [passive, reaching, with_stops] {
        for integrator in INTEGRATORS {
            for record_every in [1, 7] {
                let simulation = || {
                    let mut simulation = make(integrator);
                    simulation.record_every = record_every;
                    simulation
                };
                let whole = simulation().run(DURATION).unwrap().only();
                for dt in [0.02, 0.00717, 0.35] {
                    let mut simulation = simulation();
                    let mut stepper = simulation.start(Some(DURATION)).unwrap();
                    in_pieces(&mut stepper, dt, DURATION);
                    assert_same_bits(&stepper.recording().unwrap().only(), &whole);
                    assert_same_bits(&stepper.finish().unwrap().only(), &whole);
                }
            }
        }
    }
}

#[test]
fn without_a_planned_end_fixed_steps_have_the_same_bits_too() {
    for make in [passive, reaching, with_stops] {
        for integrator in [Integrator::Rk4, Integrator::SemiImplicitEuler] {
            let mut whole = make(integrator).run(DURATION).unwrap().only();
            let mut simulation = make(integrator);
            let mut stepper = simulation.start(None).unwrap();
            in_pieces(&mut stepper, 0.02, DURATION);
            let trace = stepper.recording().unwrap().only();
            // the estimates of the error depend on how many steps are planned
            whole.attitude_step_doubling = trace.attitude_step_doubling;
            whole.step_doubling = trace.step_doubling.clone();
            assert_same_bits(&trace, &whole);
            stepper.advance(0.1).unwrap();
            assert!((stepper.time() - DURATION - 0.1).abs() < 1e-12);
        }
    }
}

#[test]
fn the_state_within_a_step_is_that_of_the_motion() {
    for make in [passive, reaching, with_stops] {
        for integrator in INTEGRATORS {
            let mut fine = make(integrator);
            (fine.integrator, fine.time_step) = (Integrator::DormandPrince, 1e-4);
            let fine = fine.run(DURATION).unwrap().only();
            let mut simulation = make(integrator);
            let mut stepper = simulation.start(Some(DURATION)).unwrap();
            let (mut q, mut v) = ([0.0; 14], [0.0; 13]);
            for t in [0.0312, 0.2005, 0.3337] {
                stepper.advance_to(t).unwrap();
                assert_eq!(stepper.time(), t);
                stepper.read_state(0, &mut q, &mut v).unwrap();
                let row = fine.time.iter().position(|time| (time - t).abs() < 1e-9).unwrap();
                let off = |a: &[f64], b: &[f64]| {
                    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0_f64, f64::max)
                };
                let (at_q, at_v) = (&fine.q[14 * row..][..14], &fine.v[13 * row..][..13]);
                let gate = if integrator == Integrator::SemiImplicitEuler { 2e-3 } else { 2e-5 };
                assert!(
                    off(&q, at_q) < gate && off(&v, at_v) < 5.0 * gate,
                    "{} {}",
                    off(&q, at_q),
                    off(&v, at_v)
                );
                let trace = stepper.recording().unwrap().only();
                assert_eq!(trace.time.last(), Some(&t));
                assert!(off(&trace.q[trace.q.len() - 14..], &q) == 0.0);
            }
        }
    }
}

#[test]
fn a_checkpoint_within_a_step_resumes_with_the_same_bits() {
    for make in [passive, reaching, with_stops] {
        for integrator in INTEGRATORS {
            let whole = make(integrator).run(DURATION).unwrap().only();
            for stop in [0.2, 0.30047, 0.4321] {
                let mut simulation = make(integrator);
                let mut stepper = simulation.start(Some(DURATION)).unwrap();
                stepper.advance_to(stop).unwrap();
                let (checkpoint, rows) = (stepper.checkpoint().unwrap(), stepper.rows(0).clone());
                assert!((checkpoint.time() - stop).abs() < 1e-12);
                let rest = resumed(&mut make(integrator), DURATION, &checkpoint, rows).unwrap();
                assert_same_bits(&rest, &whole);
            }
        }
    }
}

/// Torques that a user's controller and a caller of `command` give alike.
fn torques(t: f64) -> [f64; 7] {
    std::array::from_fn(|j| 1e-2 * (3.0 * t + j as f64).sin())
}

struct Scripted {
    calls: usize,
}

impl Controller for Scripted {
    fn update(&mut self, now: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError> {
        self.calls += 1;
        now.joints.iter().zip(tau).for_each(|(&j, tau)| *tau = torques(now.time)[j]);
        Ok(())
    }
}

fn scripted(joints: Vec<usize>) -> Control {
    Control::new("script", joints, Law::User(Box::new(Scripted { calls: 0 }), None))
}

#[test]
fn commands_have_the_bits_of_a_controller_that_gives_them() {
    for make in [passive, with_stops] {
        for (integrator, period) in [(Integrator::Rk4, 0.02), (Integrator::SemiImplicitEuler, 0.0125)] {
            let mut controlled = make(integrator);
            controlled.systems[0].controls = vec![scripted((0..7).collect())];
            controlled.systems[0].control_period = Some(period);
            let whole = controlled.run(DURATION).unwrap().only();

            let mut simulation = make(integrator);
            let mut stepper = simulation.start(Some(DURATION)).unwrap();
            for k in 0..(DURATION / period).round() as usize {
                stepper.command(0, &torques(stepper.time()).map(Some)).unwrap();
                stepper.advance_to(((k + 1) as f64 * period).min(DURATION)).unwrap();
            }
            stepper.command(0, &torques(DURATION).map(Some)).unwrap();
            let trace = stepper.finish().unwrap().only();
            assert_eq!(trace.time, whole.time);
            for (a, b) in [(&trace.q, &whole.q), (&trace.v, &whole.v), (&trace.tau, &whole.tau)] {
                assert!(a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits()));
            }
        }
    }
}

#[test]
fn a_command_works_beside_controllers_of_other_joints() {
    let hold = || {
        let law = JointComputedTorque::new(25.0, 10.0);
        let at = Arc::new(JointHold::new(START[..4].to_vec()).unwrap());
        Control::new("hold", (0..4).collect(), Law::JointComputedTorque(law, at))
    };
    let period = 0.02;
    let mut controlled = passive(Integrator::Rk4);
    controlled.systems[0].controls = vec![hold(), scripted(vec![4, 5, 6])];
    controlled.systems[0].control_period = Some(period);
    let whole = controlled.run(DURATION).unwrap().only();

    let mut simulation = passive(Integrator::Rk4);
    simulation.systems[0].controls = vec![hold()];
    simulation.systems[0].control_period = Some(period);
    let mut stepper = simulation.start(Some(DURATION)).unwrap();
    for k in 0..30 {
        let tau = torques(stepper.time());
        stepper.command(0, &std::array::from_fn::<_, 7, _>(|j| (j > 3).then_some(tau[j]))).unwrap();
        stepper.advance_to(((k + 1) as f64 * period).min(DURATION)).unwrap();
    }
    let trace = stepper.finish().unwrap().only();
    let off = trace.q.iter().zip(&whole.q).map(|(a, b)| (a - b).abs()).fold(0.0_f64, f64::max);
    assert!(off < 1e-9, "{off:e}"); // torque-controlled joints take no part in the solution of the others
    assert!(trace.tau.chunks_exact(7).any(|tau| tau[0] != 0.0) && trace.tau[4] == torques(0.0)[4]);
}

/// Counts its updates in the torque of its joint.
struct Counting(f64);

impl Controller for Counting {
    fn update(&mut self, _: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError> {
        self.0 += 1.0;
        tau.fill(1e-6 * self.0);
        Ok(())
    }
}

#[test]
fn a_controller_is_updated_once_per_tick_however_often_the_run_is_looked_at() {
    for integrator in INTEGRATORS {
        let mut simulation = passive(integrator);
        simulation.systems[0].controls =
            vec![Control::new("count", vec![0], Law::User(Box::new(Counting(0.0)), None))];
        simulation.systems[0].control_period = Some(0.05);
        let mut stepper = simulation.start(Some(DURATION)).unwrap();
        let (mut q, mut v) = ([0.0; 14], [0.0; 13]);
        for k in 1..=24 {
            for _ in 0..3 {
                stepper.read_state(0, &mut q, &mut v).unwrap();
                let _ = stepper.recording().unwrap().only();
            }
            stepper.advance_to((k as f64 * 0.025).min(DURATION)).unwrap();
        }
        let trace = stepper.finish().unwrap().only();
        let last = trace.tau[trace.tau.len() - 7];
        assert!((last - 13e-6).abs() < 1e-12, "{last}"); // at 0, 0.05, …, 0.6
    }
}

#[test]
fn bad_input_leaves_the_run_as_it_was() {
    let mut simulation = passive(Integrator::Rk4);
    let whole = simulation.run(DURATION).unwrap().only();
    simulation.systems[0].controls.clear();
    let mut stepper = simulation.start(Some(DURATION)).unwrap();
    stepper.advance(0.1).unwrap();
    for dt in [0.0, -0.1, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(matches!(stepper.advance(dt), Err(SimulationError::NotPositive { name: "dt", .. })), "{dt}");
    }
    for t in [f64::NAN, f64::INFINITY] {
        assert!(matches!(stepper.advance_to(t), Err(SimulationError::TimeNotFinite { .. })));
    }
    for t in [-1.0, 0.0, 0.09] {
        assert!(matches!(stepper.advance_to(t), Err(SimulationError::PastTime { .. })));
    }
    assert!(matches!(stepper.advance(DURATION), Err(SimulationError::AfterEnd { .. })));
    let wrong = [Some(0.0); 6];
    assert!(matches!(stepper.command(0, &wrong), Err(SimulationError::WrongLength { name: "tau", .. })));
    let mut tau = [Some(0.0); 7];
    tau[3] = Some(f64::NAN);
    assert!(matches!(
        stepper.command(0, &tau),
        Err(SimulationError::NotFinite { name: "tau", index: 3, .. })
    ));
    stepper.advance_to(0.1).unwrap(); // the present: nothing to do
    stepper.advance_to(DURATION).unwrap();
    assert!(matches!(stepper.advance(0.1), Err(SimulationError::AfterEnd { .. })));
    assert_same_bits(&stepper.finish().unwrap().only(), &whole);
}

#[test]
fn a_joint_of_an_active_control_takes_no_command() {
    let mut simulation = passive(Integrator::Rk4);
    let mut later = scripted(vec![1]);
    (later.name, later.begin) = ("later".to_owned(), Begin::At(0.3));
    simulation.systems[0].controls = vec![scripted(vec![0]), later];
    let mut stepper = simulation.start(Some(DURATION)).unwrap();
    let only = |j: usize| std::array::from_fn::<_, 7, _>(|k| (k == j).then_some(1e-3));
    for t in [0.0, 0.2, 0.3, 0.4] {
        stepper.advance_to(t).unwrap();
        let refused = stepper.command(0, &only(0)).unwrap_err();
        assert!(refused.to_string().contains("joint 'arm_1' is driven by control 'script'"), "{refused}");
        assert_eq!(stepper.command(0, &only(1)).is_ok(), t < 0.3, "{t}");
    }
    let trace = stepper.recording().unwrap().only();
    let tau = |t: f64| trace.tau[7 * trace.time.iter().position(|time| *time >= t).unwrap() + 1];
    assert_eq!(tau(0.1), 1e-3);
    assert_eq!(tau(0.35), torques(0.35)[1]); // the control has taken the joint over
}

#[test]
fn a_run_that_failed_has_its_rows_and_goes_no_further() {
    let mut simulation = passive(Integrator::Rk4);
    simulation.systems[0].v[6] = 1e5;
    simulation.time_step = 1e-2;
    let mut stepper = simulation.start(None).unwrap();
    let error = stepper.advance(100.0).unwrap_err();
    assert!(matches!(error, SimulationError::Diverged { .. }), "{error}");
    assert!(matches!(stepper.advance(1.0), Err(SimulationError::Ended)));
    assert!(matches!(stepper.command(0, &[None; 7]), Err(SimulationError::Ended)));
    assert!(matches!(stepper.checkpoint(), Err(SimulationError::Ended)));
    assert!(matches!(stepper.recording(), Err(SimulationError::Ended)));
    assert!(stepper.finish().unwrap().only().rows() >= 1);
}
