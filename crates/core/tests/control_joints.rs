//! Checks joint-space laws against closed forms, and their goals and successive controls.
#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test

mod common;

use common::humanoid::{humanoid, start};
use nalgebra::{Isometry3, Matrix3, Vector3};
use onorbit_core::control::{
    Begin, Control, ControlError, ControlMemory, ControllerSet, Goal, Interface, JointComputedTorque,
    JointPid, Law, Outcome, PerJoint,
};
use onorbit_core::dynamics::{Data, kinematics};
use onorbit_core::model::{Inertial, Joint, JointKind, Link, Model, ModelBuilder, neutral};
use onorbit_core::reference::{JointHold, JointPath, JointReference, JointSample};
use onorbit_core::simulation::{Simulation, SimulationError, Trace};
use std::sync::Arc;

/// Two masses on a line through both centres of mass: `M* = m₁ m₂/(m₁ + m₂)`, without rotation.
fn slider() -> Model {
    let link = |name: &str, mass: f64| {
        let inertial = Inertial { mass, com: Vector3::zeros(), inertia: Matrix3::identity() };
        Link::new(name, Some(inertial))
    };
    let mut builder = ModelBuilder::new("slider", link("base", 6.0)).unwrap();
    let joint = Joint::new("slide", JointKind::Prismatic(Vector3::x()), Isometry3::identity());
    builder.add("base", joint, link("mass", 3.0)).unwrap();
    builder.build().unwrap()
}

const REDUCED_MASS: f64 = 2.0;

/// A path with constant rate from zero, then at rest.
#[derive(Debug)]
struct Ramp {
    rate: f64,
    duration: f64,
}

impl JointPath for Ramp {
    fn count(&self) -> usize {
        1
    }
    fn sample(&self, t: f64, out: &mut JointSample) {
        let is_moving = t < self.duration;
        out.q[0] = self.rate * t.clamp(0.0, self.duration);
        out.v[0] = if is_moving { self.rate } else { 0.0 };
        out.a[0] = 0.0;
    }
    fn duration(&self) -> f64 {
        self.duration
    }
}

fn hold(q: f64) -> JointReference {
    Arc::new(JointHold::new(vec![q]).unwrap())
}

fn effort(name: &str, value: f64) -> Control {
    Control::new(name, vec![0], Law::Pid(JointPid::new(Interface::Effort, 0.0, 0.0, 0.0), hold(value)))
}

fn simulation(controls: Vec<Control>) -> Simulation {
    let model = slider();
    let q = neutral(&model);
    let v = vec![0.0; model.nv()];
    let mut simulation = Simulation::new(Arc::new(model), q, v);
    (simulation.time_step, simulation.systems[0].controls) = (0.01, controls);
    simulation
}

fn run(controls: Vec<Control>, duration: f64) -> Trace {
    simulation(controls).run(duration).unwrap().only()
}

fn joint(trace: &Trace, row: usize) -> (f64, f64) {
    (trace.q[8 * row + 7], trace.v[7 * row + 6])
}

#[test]
fn a_pid_agrees_with_a_hand_written_loop() {
    for (interface, limit) in
        [(Interface::Position, 3.0), (Interface::Velocity, 1.2), (Interface::Position, 1e9)]
    {
        let (p, i, d, i_limit) = (20.0, 15.0, 4.0, 2.5);
        let mut law = JointPid::new(interface, p, i, d);
        (law.i_limit, law.effort_limit) = (i_limit.into(), limit.into());
        let path = Arc::new(Ramp { rate: 0.4, duration: 1.0 });
        let trace = run(vec![Control::new("slide", vec![0], Law::Pid(law, path))], 3.0);

        let (mut x, mut v, mut sum, mut last, h) = (0.0_f64, 0.0_f64, 0.0_f64, None, 0.01);
        for k in 0..=300 {
            let t = f64::from(k) * h;
            assert!((joint(&trace, k as usize).0 - x).abs() < 1e-12, "{interface:?} {limit} at {t}");
            let (goal, rate) = if t < 1.0 { (0.4 * t, 0.4) } else { (0.4, 0.0) };
            let (e, de) = match interface {
                Interface::Position => (goal - x, rate - v),
                _ => (rate - v, last.map_or(0.0, |last| (rate - v - last) / h)),
            };
            let step = if last.is_some() { h } else { 0.0 };
            last = Some(e);
            let trial = (sum + i * e * step).clamp(-i_limit, i_limit);
            let whole = p * e + trial + d * de;
            if whole.abs() <= limit || (trial - sum) * whole <= 0.0 {
                sum = trial;
            }
            let force = (p * e + sum + d * de).clamp(-limit, limit);
            x += v * h + 0.5 * force / REDUCED_MASS * h * h;
            v += force / REDUCED_MASS * h;
        }
        let most = trace.tau.iter().fold(0.0_f64, |most, tau| most.max(tau.abs()));
        assert_eq!(most.min(limit), most);
    }
}

#[test]
fn the_error_of_joint_computed_torque_obeys_a_linear_second_order_equation() {
    // critically damped: e = e₀ (1 + 5 t) exp(−5 t) on all seven joints, with a free base
    let off = |h: f64| {
        let model = humanoid();
        let (q, v) = (start(&model), vec![0.0; model.nv()]);
        let target: Vec<f64> = q[7..].iter().enumerate().map(|(j, q)| q + 0.1 * (j as f64 - 3.0)).collect();
        let law = Law::JointComputedTorque(
            JointComputedTorque::new(25.0, 10.0),
            Arc::new(JointHold::new(target.clone()).unwrap()),
        );
        let mut simulation = Simulation::new(Arc::new(model), q, v);
        simulation.time_step = h;
        simulation.systems[0].controls = vec![Control::new("arm", (0..7).collect(), law)];
        let refused = simulation.check().unwrap_err();
        assert!(
            matches!(refused, SimulationError::JointsStartAway { offset, .. } if (offset - 0.3).abs() < 1e-12)
        );
        simulation.systems[0].reference_start_tolerance[1] = 0.31; // rad
        let trace = simulation.run(1.0).unwrap().only();
        let mut most = 0.0_f64;
        for (row, t) in trace.time.iter().enumerate() {
            for j in 0..7 {
                let exact = 0.1 * (j as f64 - 3.0) * (1.0 + 5.0 * t) * (-5.0 * t).exp();
                most = most.max((target[j] - trace.q[14 * row + 7 + j] - exact).abs());
            }
        }
        most
    };
    let (coarse, fine) = (off(2e-3), off(1e-3));
    // the torque is held over each step, which is of first order
    assert!(fine < 1e-3 && (coarse / fine - 2.0).abs() < 0.1, "{coarse} {fine}");
}

#[test]
fn a_switch_is_exact_whatever_the_control_period() {
    let mut first = effort("first", 1.0);
    first.end = 0.3537;
    let mut second = effort("second", -2.0);
    (second.begin, second.end) = (Begin::At(0.6), 0.9001);
    let mut simulation = simulation(vec![first, second]);
    simulation.systems[0].control_period = Some(0.25);
    let trace = simulation.run(1.0).unwrap().only();
    let expected = (1.0 * 0.3537 - 2.0 * 0.3001) / REDUCED_MASS;
    let (_, rate) = joint(&trace, trace.rows() - 1);
    assert!((rate - expected).abs() < 1e-12, "{rate} {expected}");
    assert!(trace.time.contains(&0.3537) && trace.time.contains(&0.9001));
}

fn ramp(rate: f64, duration: f64) -> JointReference {
    Arc::new(Ramp { rate, duration })
}

/// A stiff law that follows a ramp with an initial error of 0.02 m.
fn follow(name: &str, goal: Goal, duration: f64) -> Control {
    let mut control = Control::new(
        name,
        vec![0],
        Law::JointComputedTorque(JointComputedTorque::new(100.0, 20.0), ramp(0.2, duration)),
    );
    control.goal = Some(goal);
    control
}

#[test]
fn goals_succeed_violate_path_or_goal_tolerance_or_stay_unfinished() {
    let outcome = |goal: Goal, duration: f64| run(vec![follow("slide", goal, duration)], 2.0);
    let reached = outcome(Goal { time: Some(1.0), ..Goal::within(1e-4) }, 0.5);
    let Outcome::Succeeded { time } = reached.results[0].outcome else { panic!("{:?}", reached.results) };
    // at the end of the path the error reaches v/(k e) = 7 mm; critically damped, it is below 1e-4 m at 1.2 s
    assert!(time > 0.5 && time < 1.3, "{time}");

    let missed = outcome(Goal { path: Some(PerJoint::from(5e-3)), ..Goal::within(1e-4) }, 1.0);
    let Outcome::PathToleranceViolated(miss) = missed.results[0].outcome else {
        panic!("{:?}", missed.results)
    };
    assert_eq!(missed.results[0].component.as_deref(), Some("slide"));
    // e = 0.2 t exp(−10 t) passes 5 mm at 0.036 s
    assert!(miss.error > 5e-3 && (miss.time - 0.04).abs() < 1e-9, "{miss:?}");
    let row = missed.time.iter().position(|t| (t - miss.time).abs() < 1e-9).unwrap();
    let (there, at_end) = (joint(&missed, row).0, joint(&missed, missed.rows() - 1).0);
    assert!((there - at_end).abs() < 1e-6, "it holds where it was: {there} {at_end}");

    let late = outcome(Goal { time: Some(0.05), ..Goal::within(1e-4) }, 0.5);
    assert!(
        matches!(late.results[0].outcome, Outcome::GoalToleranceViolated(miss) if (miss.time - 0.55).abs() < 1e-9)
    );
    assert_eq!(outcome(Goal::within(1e-4), 5.0).results[0].outcome, Outcome::Unfinished);
}

#[test]
fn a_control_starts_when_the_goal_of_another_is_decided_from_where_the_joint_is() {
    let first = follow("first", Goal::within(1e-3), 0.5);
    let mut second = follow("second", Goal::within(1e-3), 0.5);
    (second.begin, second.starts_at_present) = (Begin::After(0), true);
    let trace = run(vec![first, second], 4.0);
    let times: Vec<f64> = trace.results.iter().map(|result| result.outcome.time().unwrap()).collect();
    assert!(times[1] > times[0] + 0.5 - 1e-9);
    let row = trace.time.iter().position(|t| (t - times[0]).abs() < 1e-9).unwrap();
    assert!(trace.tracking[1].values[row].abs() < 1e-15, "its reference begins where the joint is");
    let moved = joint(&trace, trace.rows() - 1).0 - joint(&trace, row).0;
    assert!((moved - 0.1).abs() < 1e-5, "{moved}");
    assert!(trace.tracking[0].values[row..].iter().all(|e| *e == 0.0), "the first has stopped");
}

#[test]
fn invalid_controls_are_refused_by_name() {
    let refused = |controls: Vec<Control>| match simulation(controls).check() {
        Err(SimulationError::Control(error)) => error.to_string(),
        other => panic!("{other:?}"),
    };
    let both = refused(vec![effort("a", 1.0), effort("b", 1.0)]);
    assert!(both.starts_with("controls 'a' and 'b' both drive joint 'slide' at t = 0 s"), "{both}");
    assert!(refused(vec![effort("a", 1.0), effort("a", 1.0)]).contains("two controls are named 'a'"));
    let group = |joints: Vec<usize>| refused(vec![Control { joints, ..effort("a", 1.0) }]);
    assert!(group(vec![]).contains("drives no joint"));
    assert!(group(vec![1]).contains("the robot has only joint 0"));
    assert!(group(vec![0, 0]).contains("twice"));
    let window =
        |begin: f64, end: f64| refused(vec![Control { begin: Begin::At(begin), end, ..effort("a", 1.0) }]);
    assert!(window(1.0, 1.0).contains("before the end"));
    assert!(window(f64::NAN, 1.0).contains("finite"));
    let after = |first: Begin| {
        refused(vec![
            Control { begin: first, ..effort("a", 1.0) },
            Control { begin: Begin::After(0), ..effort("b", 1.0) },
        ])
    };
    assert!(after(Begin::At(0.0)).contains("'a', which has neither a goal nor an end"));
    assert!(after(Begin::After(1)).contains("waits for itself"));
    assert!(
        refused(vec![Control { goal: Some(Goal::within(1.0)), ..effort("a", 1.0) }])
            .contains("has no reference")
    );
    let mut pid = JointPid::new(Interface::Position, 1.0, 0.0, 0.0);
    pid.p = PerJoint::new(vec![1.0, 2.0]);
    let gains = refused(vec![Control::new("a", vec![0], Law::Pid(pid, hold(0.0)))]);
    assert!(gains.contains("'p' has 2 numbers; expected 1"), "{gains}");
    let two = Arc::new(JointHold::new(vec![0.0; 2]).unwrap());
    let law = Law::JointComputedTorque(JointComputedTorque::new(1.0, 1.0), two);
    assert!(refused(vec![Control::new("a", vec![0], law)]).contains("has 2 joints, but its group has 1"));
}

#[test]
fn controls_that_overlap_during_the_run_are_refused() {
    let first = follow("first", Goal::within(1e-3), 0.5);
    let mut second = follow("second", Goal::within(1e-3), 0.5);
    second.begin = Begin::After(0);
    let mut third = effort("third", 0.0);
    third.begin = Begin::At(1.5);
    let failure = simulation(vec![first, second, third]).run(2.0).unwrap_err();
    let SimulationError::Control(ControlError::Overlap { first, second, joint, time }) = failure.error else {
        panic!("{failure:?}")
    };
    assert_eq!((first.as_str(), second.as_str(), joint.as_str(), time), ("second", "third", "slide", 1.5));
}

#[test]
fn states_of_controls_are_saved_and_restored_bit_by_bit() {
    let model = slider();
    let controls = || {
        let mut law = JointPid::new(Interface::Velocity, 3.0, 2.0, 0.1);
        law.i_limit = 0.5.into();
        let mut first = Control::new("first", vec![0], Law::Pid(law.clone(), ramp(0.3, 0.4)));
        first.goal = Some(Goal { path: Some(0.2.into()), tolerance: 0.05.into(), time: None });
        let mut second = Control::new("second", vec![0], Law::Pid(law, ramp(-0.3, 0.4)));
        (second.begin, second.starts_at_present) = (Begin::After(0), true);
        [first, second]
    };
    let mut data = Data::<f64>::new(&model);
    let mut step = |set: &mut ControllerSet<'_, f64>, k: i32| {
        let t = f64::from(k) * 0.05;
        let (mut q, mut v, mut tau) = (neutral(&model), vec![0.0; 7], [0.0]);
        (q[7], v[6]) = ((3.0 * t).sin() * 0.1, if t < 0.4 { 0.2 + 0.1 * t } else { 0.02 });
        kinematics(&model, &mut data, &q, &v);
        set.update(t, &model, &mut data, &q, &v, &mut tau).unwrap();
        tau[0].to_bits()
    };
    for cut in [3, 9, 14] {
        let (mut one, mut other) = (controls(), controls());
        let mut one = ControllerSet::new(&mut one, &model, 1e-12, false).unwrap();
        (0..cut).for_each(|k| _ = step(&mut one, k));
        let text = serde_json::to_string(&one.save().unwrap()).unwrap();
        let mut saved: Vec<ControlMemory> = serde_json::from_str(&text).unwrap();
        let mut other = ControllerSet::new(&mut other, &model, 1e-12, false).unwrap();
        other.load(&saved).unwrap();
        for k in cut..20 {
            assert_eq!(step(&mut one, k), step(&mut other, k), "cut at {cut}, tick {k}");
        }
        assert_eq!(one.outcome(0), other.outcome(0));
        assert!(other.load(&saved[1..]).is_err());
        saved.push(saved[0].clone());
        assert!(other.load(&saved).is_err());
    }
}
