//! Checks that a stopped run resumes with identical bits.
#![allow(clippy::unwrap_used)] // a test that cannot set up should stop

mod common;

use common::humanoid::{START, humanoid, humanoid_with, start};
use common::slider::{moving, slider};
use common::stepping::{assert_same_bits, resumed, stopped};
use nalgebra::Vector3;
use onorbit_core::control::{
    Begin, ComputedTorque, Control, ControlError, Controller, Goal, Interface, JointComputedTorque, JointPid,
    Law, Observation,
};
use onorbit_core::dynamics::{Data, frame_pose, positions};
use onorbit_core::environment::{BodyWrench, GravityGradient};
use onorbit_core::orbit::{Kepler, MU_EARTH};
use onorbit_core::reference::{JointHold, LineParabola};
use onorbit_core::simulation::{
    Checkpoint, CheckpointError, Integrator, Simulation, SimulationError, Trace, certify,
};
use std::sync::Arc;

const DURATION: f64 = 1.5;

/// A reach in orbit with a push that starts and ends between steps, and control slower than the steps.
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
    let law = Law::TaskComputedTorque(Box::new(ComputedTorque::new(tool, 100.0, 20.0)), line.into());
    simulation.systems[0].controls = vec![Control::on_all_joints(&model, law)];
    simulation.systems[0].tool = Some(tool);
    simulation.systems[0].control_period = Some(2.5e-3);
    simulation.integrator = integrator;
    simulation.record_every = record_every;
    simulation
}

#[test]
fn a_resumed_run_has_the_bits_of_an_uninterrupted_one() {
    for (integrator, every) in [
        (Integrator::Rk4, 1),
        (Integrator::Rk4, 7),
        (Integrator::SemiImplicitEuler, 1),
        (Integrator::DormandPrince, 1),
    ] {
        let whole = simulation(integrator, every).run(DURATION).unwrap().only();
        for stop in [0.1, 0.4, 0.77] {
            let (checkpoint, rows) = stopped(&mut simulation(integrator, every), DURATION, stop);
            let mut second = simulation(integrator, every);
            let rest = resumed(&mut second, DURATION, &checkpoint, rows).unwrap();
            assert_same_bits(&rest, &whole);
            assert_eq!(certify(&second.systems[0].model, &rest), certify(&second.systems[0].model, &whole));
        }
    }
}

/// Joints that stick, slip and hit stops, and adaptive steps: their state is restored.
#[test]
fn joint_modes_and_step_sizes_are_resumed() {
    let make = |integrator| {
        let mut simulation = simulation(integrator, 1);
        simulation.systems[0].model = Arc::new(humanoid_with(|joint| {
            let at = START[joint.name[4..].parse::<usize>().unwrap() - 1];
            joint.limits.position = Some((at - 0.2, at + 0.2));
            joint.friction = 1e-3;
        }));
        simulation.systems[0].v[6..].copy_from_slice(&[1.0, -0.8, 0.9, 1.1, -0.7, 1.0, -1.2]);
        simulation.systems[0].controls = Vec::new();
        simulation.systems[0].tool = None;
        simulation.systems[0].stops = Some(0.5);
        simulation
    };
    for integrator in [Integrator::Rk4, Integrator::DormandPrince] {
        let whole = make(integrator).run(DURATION).unwrap().only();
        assert!(*whole.dissipated.last().unwrap() > 0.0);
        let (checkpoint, rows) = stopped(&mut make(integrator), DURATION, 0.3);
        let rest = resumed(&mut make(integrator), DURATION, &checkpoint, rows).unwrap();
        assert_same_bits(&rest, &whole);
    }
}

/// A controller that sums over its calls; with `forgets` it saves no state.
struct Summing {
    sum: f64,
    forgets: bool,
}

impl Controller for Summing {
    fn reset(&mut self) -> Result<(), ControlError> {
        self.sum = 0.0;
        Ok(())
    }

    fn update(&mut self, now: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError> {
        self.sum += 1e-5 * (now.time.sin() - now.v[now.joints[0] + 6]);
        tau.fill(self.sum);
        Ok(())
    }

    fn save(&self) -> Result<Vec<u8>, ControlError> {
        Ok(if self.forgets { Vec::new() } else { self.sum.to_le_bytes().to_vec() })
    }

    fn load(&mut self, saved: &[u8]) -> Result<(), ControlError> {
        saved.try_into().into_iter().for_each(|bytes| self.sum = f64::from_le_bytes(bytes));
        Ok(())
    }
}

/// The reach with six joints, which are then held; the seventh driven by a PID, then by a user's controller.
fn several_controls(integrator: Integrator, forgets: bool) -> Simulation {
    let mut simulation = simulation(integrator, 3);
    let law = simulation.systems[0].controls.remove(0).law;
    let hold = |q: &[f64]| Arc::new(JointHold::new(q.to_vec()).unwrap());
    let arm: Vec<usize> = (0..6).collect();
    let mut reach = Control::new("reach", arm.clone(), law);
    reach.goal = Some(Goal { path: Some(0.01.into()), tolerance: 1e-3.into(), time: None });
    let law = Law::JointComputedTorque(JointComputedTorque::new(25.0, 10.0), hold(&START[..6]));
    let mut stay = Control::new("stay", arm, law);
    (stay.begin, stay.starts_at_present) = (Begin::After(0), true);
    let mut law = JointPid::new(Interface::Position, 0.02, 0.05, 2e-3);
    law.i_limit = 1e-3.into();
    let mut wrist = Control::new("wrist", vec![6], Law::Pid(law, hold(&[START[6] + 0.1])));
    wrist.end = 0.9013;
    let own = Law::User(Box::new(Summing { sum: 0.0, forgets }), None);
    let mut own = Control::new("own", vec![6], own);
    own.begin = Begin::At(0.9013);
    simulation.systems[0].controls = vec![reach, stay, wrist, own];
    simulation
}

/// Returns the whole run, and one that was stopped and resumed.
fn whole_and_continued(make: impl Fn() -> Simulation, stop: f64) -> (Trace, Trace) {
    let whole = make().run(DURATION).unwrap().only();
    let (checkpoint, rows) = stopped(&mut make(), DURATION, stop);
    let rest = resumed(&mut make(), DURATION, &checkpoint, rows).unwrap();
    (whole, rest)
}

#[test]
fn controls_are_resumed() {
    for integrator in [Integrator::Rk4, Integrator::DormandPrince] {
        for stop in [0.1, 0.5, 1.35] {
            let (whole, rest) = whole_and_continued(|| several_controls(integrator, false), stop);
            assert_same_bits(&rest, &whole);
            let switched = whole.results[0].outcome.time().unwrap();
            assert!((0.2..0.3).contains(&switched), "{:?}", whole.results); // six joints cannot reach it
            let names: Vec<&str> = whole.tracking.iter().map(|tracking| tracking.name.as_str()).collect();
            assert_eq!(names, ["reach", "stay", "wrist"]);
            assert!(whole.tracking.iter().all(|tracking| tracking.values.iter().any(|e| *e != 0.0)));
        }
    }
}

#[test]
fn a_users_controller_is_resumed_if_it_saves_its_state() {
    let alone = |forgets| {
        let mut simulation = simulation(Integrator::Rk4, 1);
        simulation.systems[0].controls = vec![Control::on_all_joints(
            &simulation.systems[0].model,
            Law::User(Box::new(Summing { sum: 0.0, forgets }), None),
        )];
        simulation
    };
    let (whole, rest) = whole_and_continued(|| alone(false), 0.5);
    assert_same_bits(&rest, &whole);
    // negative control: without its state the torques jump
    for (whole, rest) in [
        whole_and_continued(|| alone(true), 0.5),
        whole_and_continued(|| several_controls(Integrator::Rk4, true), 1.35),
    ] {
        assert_eq!(whole.time, rest.time);
        assert!(whole.tau.iter().zip(&rest.tau).any(|(a, b)| (a - b).abs() > 1e-5));
    }
}

#[test]
fn a_checkpoint_at_the_very_end_is_the_whole_run() {
    let make = || moving(slider(0.0, 0.1, None, 0.3), 0.2, Integrator::Rk4, 1e-3);
    let duration = 0.128;
    let whole = make().run(duration).unwrap().only();
    let (checkpoint, rows) = stopped(&mut make(), duration, duration);
    assert!(checkpoint.time() == duration && checkpoint.rows() + 1 == whole.rows());
    let rest = resumed(&mut make(), duration, &checkpoint, rows);
    assert_same_bits(&rest.unwrap(), &whole);
}

#[test]
fn one_bit_of_the_state_shows() {
    // negative control: the comparison above would see the last bit of one number
    let whole = simulation(Integrator::Rk4, 1).run(DURATION).unwrap().only();
    let (checkpoint, rows) = stopped(&mut simulation(Integrator::Rk4, 1), DURATION, 0.4);
    let mut value: serde_json::Value = serde_json::from_str(&checkpoint.to_json()).unwrap();
    let q = value["groups"][0]["progress"]["state"]["trees"][0]["q"][0].as_f64().unwrap();
    value["groups"][0]["progress"]["state"]["trees"][0]["q"][0] = f64::from_bits(q.to_bits() + 1).into();
    let bent = Checkpoint::from_json(&value.to_string()).unwrap();
    let mut second = simulation(Integrator::Rk4, 1);
    let rest = resumed(&mut second, DURATION, &bent, rows).unwrap();
    assert_eq!(rest.rows(), whole.rows());
    assert!(rest.q.iter().zip(&whole.q).any(|(a, b)| a.to_bits() != b.to_bits()));
}

#[test]
fn what_cannot_be_continued_is_refused() {
    let (checkpoint, rows) = stopped(&mut simulation(Integrator::Rk4, 1), DURATION, 0.4);
    let text = checkpoint.to_json();
    let refused = |text: &str, duration: f64, rows: &Trace| {
        let checkpoint = Checkpoint::from_json(text).map_err(SimulationError::from)?;
        resumed(&mut simulation(Integrator::Rk4, 1), duration, &checkpoint, rows.clone())
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
    assert!(matches!(error(&text, DURATION, &fewer), CheckpointError::MissingRows { .. }));
    let mut ragged = rows.clone();
    ragged.q.pop();
    assert!(matches!(error(&text, DURATION, &ragged), CheckpointError::OtherSize { name: "q", .. }));
    assert!(refused(&text, DURATION, &rows).is_ok());
}

#[test]
fn a_certificate_that_is_missing_or_of_another_form_is_refused() {
    let (checkpoint, rows) = stopped(&mut simulation(Integrator::Rk4, 7), DURATION, 0.4);
    let resume = |change: fn(&mut serde_json::Value)| {
        let mut value: serde_json::Value = serde_json::from_str(&checkpoint.to_json()).unwrap();
        change(&mut value["groups"][0]["progress"]["trees"][0]);
        let changed = Checkpoint::from_json(&value.to_string()).map_err(SimulationError::from)?;
        resumed(&mut simulation(Integrator::Rk4, 7), DURATION, &changed, rows.clone())
    };
    let changes: [fn(&mut serde_json::Value); 4] = [
        |progress| progress["checks"] = serde_json::Value::Null,
        |progress| progress["errors"] = serde_json::Value::Null,
        |progress| progress["checks"]["sums"]["size"] = "large".into(),
        |progress| progress["checks"]["start"]["base"]["attitude"]["w"] = serde_json::Value::Null,
    ];
    for change in changes {
        match resume(change) {
            Err(SimulationError::Checkpoint(_)) => {}
            other => panic!("not refused: {:?}", other.map(|trace| trace.rows())),
        }
    }
    assert!(resume(|_| ()).is_ok());
}

/// Regression: sizes and counts that indexed out of bounds or overflowed in a resumed run.
#[test]
fn the_state_of_step_doubling_is_checked_on_resuming() {
    type Change = fn(&mut serde_json::Value);
    let (checkpoint, rows) = stopped(&mut simulation(Integrator::Rk4, 1), DURATION, 0.4);
    let resume = |change: Change| {
        let mut value: serde_json::Value = serde_json::from_str(&checkpoint.to_json()).unwrap();
        change(&mut value);
        let changed = Checkpoint::from_json(&value.to_string()).unwrap();
        let mut second = simulation(Integrator::Rk4, 1);
        let rest = resumed(&mut second, DURATION, &changed, rows.clone());
        rest.map_err(|error| error.to_string())
    };
    let changes: [(Change, &str); 6] = [
        (
            |value| {
                value["groups"][0]["progress"]["trees"][0]["errors"]["jumps"]["ended"] = vec![0.0; 9].into()
            },
            "it has 9 entries for 'joints with jumps of acceleration'",
        ),
        (
            |value| {
                value["groups"][0]["progress"]["trees"][0]["errors"]["jumps"]["jumps"] = vec![0.0; 0].into()
            },
            "it has 0 entries for 'joints with jumps of acceleration'",
        ),
        (
            |value| {
                value["groups"][0]["progress"]["trees"][0]["errors"]["jumps"]["fastest"] = vec![0.0; 1].into()
            },
            "it has 1 entry for 'joints with jumps of acceleration'",
        ),
        (|value| value["groups"][0]["progress"]["steps"] = 1.into(), "the number of steps (1)"),
        (
            |value| value["groups"][0]["progress"]["steps"] = u64::MAX.into(),
            "the number of steps (18446744073709551615)",
        ),
        (
            |value| value["groups"][0]["progress"]["idle_steps"] = u64::MAX.into(),
            "idle steps (18446744073709551615)",
        ),
    ];
    for (change, said) in changes {
        match resume(change) {
            Err(error) => assert!(error.contains(said), "{error}"),
            Ok(trace) => panic!("not refused: {}", trace.rows()),
        }
    }
    assert!(resume(|_| ()).is_ok());
}
