//! Checks laws with friction compensation: joints move as if they had no friction, from rest, through
//! reversals and at goals.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // set-up that fails should stop; --nocapture shows the numbers

mod common;

use common::humanoid::{START, humanoid_with, humanoid_with_idle_joint, start};
use common::slider::{run, slider_with};
use common::stepping::{assert_same_bits, resumed, stopped};
use nalgebra::{Isometry3, Matrix3, Vector3};
use onorbit_core::batch::{Rollout, RolloutControl};
use onorbit_core::control::{ComputedTorque, Control, JointComputedTorque, Law};
use onorbit_core::dynamics::{Data, frame_pose, positions};
use onorbit_core::model::{Inertial, Joint, JointKind, Link, Model, ModelBuilder, neutral};
use onorbit_core::reference::{JointHold, JointPath, JointSpline, LineParabola, TaskReference, Timing};
use onorbit_core::simulation::{Integrator, Simulation, Trace, certify};
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Remaining effect of friction, rad (m) and rad/s (m/s).
const TOLERANCE: f64 = 1e-6;

fn frictionless(_: &mut Joint) {}

/// Kinetic and static friction, N m (N).
fn friction(kinetic: f64, at_rest: f64) -> impl Fn(&mut Joint) {
    move |joint| (joint.friction, joint.static_friction) = (kinetic, Some(at_rest))
}

/// Returns arms of one link, 0.03 kg m² about their joints, on a common base.
fn hinges(count: usize, change: impl Fn(&mut Joint)) -> Model {
    let solid = |mass: f64, inertia: f64, x: f64| {
        Some(Inertial { mass, com: Vector3::x() * x, inertia: Matrix3::identity() * inertia })
    };
    let mut builder = ModelBuilder::new("hinges", Link::new("base", solid(50.0, 5.0, 0.0))).unwrap();
    for i in 0..count {
        let origin = Isometry3::translation(0.0, 0.3 * i as f64, 0.0);
        let mut joint = Joint::new(&format!("joint_{i}"), JointKind::Revolute(Vector3::z()), origin);
        change(&mut joint);
        builder.add("base", joint, Link::new(&format!("link_{i}"), solid(1.0, 0.02, 0.1))).unwrap();
    }
    builder.build().unwrap()
}

fn law(kp: f64, kd: f64, compensate_friction: bool) -> JointComputedTorque {
    JointComputedTorque { compensate_friction, ..JointComputedTorque::new(kp, kd) }
}

/// Returns a simulation with all joints under a joint law, from `q`.
fn led(model: Model, q: Vec<f64>, law: JointComputedTorque, path: Arc<dyn JointPath>) -> Simulation {
    let (joints, v) = ((0..model.joint_count()).collect(), vec![0.0; model.nv()]);
    let mut simulation = Simulation::new(Arc::new(model), q, v);
    simulation.systems[0].controls = vec![Control::new("arm", joints, Law::JointComputedTorque(law, path))];
    simulation
}

fn to(model: Model, goal: Vec<f64>, law: JointComputedTorque) -> Simulation {
    let q = neutral(&model);
    led(model, q, law, Arc::new(JointHold::new(goal).unwrap()))
}

/// Returns the largest difference of joint positions and rates at the common rows of two runs.
fn apart(a: &Trace, b: &Trace, n: usize) -> f64 {
    let joints = |trace: &Trace, k: usize| {
        let (q, v) = (&trace.q[k * (n + 7) + 7..][..n], &trace.v[k * (n + 6) + 6..][..n]);
        [q, v].concat()
    };
    let rows: HashMap<u64, usize> = a.time.iter().enumerate().map(|(k, t)| (t.to_bits(), k)).collect();
    let common: Vec<_> = (0..b.rows()).filter_map(|k| Some((*rows.get(&b.time[k].to_bits())?, k))).collect();
    assert!(common.len() > 100, "{} rows in common", common.len());
    let off = |(i, k): &(usize, usize)| {
        let pairs = joints(a, *i).into_iter().zip(joints(b, *k));
        pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
    };
    common.iter().map(off).fold(0.0, f64::max)
}

/// Returns how often the compensation of a joint changes its sign, and the last time.
fn flips(trace: &Trace, joint: usize, n: usize) -> (usize, f64) {
    let signs = trace.friction_compensation.chunks(n).map(|row| row[joint]).zip(&trace.time);
    let signs: Vec<(f64, f64)> = signs.filter(|(c, _)| *c != 0.0).map(|(c, t)| (c.signum(), *t)).collect();
    let changes = signs.windows(2).filter(|pair| pair[0].0 != pair[1].0);
    changes.fold((0, 0.0), |(count, _), pair| (count + 1, pair[1].1))
}

/// Returns the reversals of a joint without friction.
fn reversals(trace: &Trace, joint: usize, n: usize, until: f64) -> usize {
    let rates: Vec<f64> = trace
        .v
        .chunks(n + 6)
        .zip(&trace.time)
        .filter(|(_, t)| **t <= until)
        .map(|(v, _)| v[joint + 6])
        .collect();
    rates.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count()
}

/// 0.2 N m of static friction hold 0.03 kg m² if the law commands 0.15 N m.
#[test]
fn a_joint_at_rest_breaks_away_to_a_goal_near_by() {
    for change in [friction(0.2, 0.2), friction(0.2, 0.35)] {
        let free = run(&mut to(hinges(1, frictionless), vec![0.05], law(100.0, 20.0, true)), 20.0);
        let mut simulation = to(hinges(1, &change), vec![0.05], law(100.0, 20.0, true));
        let trace = run(&mut simulation, 20.0);
        let (off, (changes, _)) = (apart(&free, &trace, 1), flips(&trace, 0, 1));
        let miss = (trace.q[trace.q.len() - 1] - 0.05).abs();
        println!("{off:e} from the law without friction, {miss:e} rad from the goal, {changes} flips");
        assert!(off < TOLERANCE && miss < TOLERANCE && changes == 0);
        assert!(certify(&simulation.systems[0].model, &trace).passed());
        // negative control: without compensation the joint never moves
        let trace = run(&mut to(hinges(1, &change), vec![0.05], law(100.0, 20.0, false)), 20.0);
        assert!(trace.q.chunks(8).all(|q| q[7] == 0.0));
    }
}

#[test]
fn a_joint_that_swings_about_its_goal_obeys_the_law_without_friction_and_then_rests() {
    let slider = |change: &dyn Fn(&mut Joint)| slider_with(change, 0.3);
    let hinge = |change: &dyn Fn(&mut Joint)| hinges(1, change);
    for (name, model) in [("slider", &slider as &dyn Fn(&dyn Fn(&mut Joint)) -> Model), ("hinge", &hinge)] {
        let swing = || law(100.0, 2.0, true);
        let free = run(&mut to(model(&frictionless), vec![0.05], swing()), 25.0);
        let mut simulation = to(model(&friction(0.2, 0.3)), vec![0.05], swing());
        let trace = run(&mut simulation, 25.0);
        let (off, (changes, last)) = (apart(&free, &trace, 1), flips(&trace, 0, 1));
        let expected = reversals(&free, 0, 1, last);
        println!("{name}: {off:e} off, {changes} flips for {expected} reversals, the last at {last} s");
        assert!(off < TOLERANCE, "{off:e}");
        assert!(changes > 30 && changes <= expected + 1);
        assert_eq!(trace.v[trace.v.len() - 1], 0.0); // friction torque
        // the recorded work includes the drives: the torque is constant between rows
        let (rows, mut done) = (trace.rows(), 0.0);
        (1..rows).for_each(|k| done += trace.tau[k - 1] * (trace.q[8 * k + 7] - trace.q[8 * k - 1]));
        assert!((trace.work[rows - 1] + trace.dissipated[rows - 1] - done).abs() < 1e-12);
        let certificate = certify(&simulation.systems[0].model, &trace);
        assert!(certificate.passed(), "{certificate:#?}");
        // negative control: with 1e-4 N m of uncompensated friction the swing differs
        let less = |joint: &mut Joint| joint.friction = 1e-4;
        let trace = run(&mut to(model(&less), vec![0.05], law(100.0, 2.0, false)), 25.0);
        assert!(apart(&free, &trace, 1) > TOLERANCE);
    }
}

/// Friction that differs between joints, one without.
fn mixed(joint: &mut Joint) {
    let i = f64::from(joint.name.as_bytes()[4] - b'1');
    (joint.friction, joint.static_friction) = (0.02 * i, Some(0.03 * i));
}

#[test]
fn arms_with_mixed_friction_follow_a_path_with_reversals() {
    let path = || {
        let there: Vec<f64> = START.iter().enumerate().map(|(i, q)| q + 0.2 - 0.07 * i as f64).collect();
        let points = [&START[..], &there, &START, &there].concat();
        Arc::new(JointSpline::waypoints(7, &points, &Timing::Given(vec![0.0, 0.5, 1.1, 1.6]), false).unwrap())
    };
    for (integrator, period) in
        [(Integrator::Rk4, None), (Integrator::Rk4, Some(5e-3)), (Integrator::DormandPrince, None)]
    {
        let [free, rough] = [&frictionless as &dyn Fn(&mut Joint), &mixed].map(|change| {
            let model = humanoid_with(change);
            let q = start(&model);
            let mut simulation = led(model, q, law(100.0, 20.0, true), path());
            (simulation.integrator, simulation.systems[0].control_period) = (integrator, period);
            simulation.tolerance = 1e-12;
            let trace = run(&mut simulation, 3.0);
            assert!(certify(&simulation.systems[0].model, &trace).passed());
            trace
        });
        let off = apart(&free, &rough, 7);
        let changes: usize = (0..7).map(|j| flips(&rough, j, 7).0).sum();
        let expected: usize = (0..7).map(|j| reversals(&free, j, 7, 3.0)).sum();
        println!("{integrator:?} {period:?}: {off:e} off, {changes} flips for {expected} reversals");
        assert!(off < TOLERANCE, "{off:e}");
        assert!(changes > 10 && changes <= expected + 7);
    }
}

/// Returns the reach of the paper's humanoid.
fn reaching(change: impl Fn(&mut Joint), compensate_friction: bool, in_group: bool) -> Simulation {
    let model = if in_group { humanoid_with_idle_joint(change) } else { humanoid_with(change) };
    let (q, tool) = (start(&model), model.frame("tool").unwrap());
    let mut data = Data::<f64>::new(&model);
    positions(&model, &mut data, &q);
    let pose = frame_pose(&model, &data, &q, tool);
    let (rot, pos) = (pose.rot_wf.to_nalgebra(), pose.pos_w.to_nalgebra());
    let line = LineParabola::new(rot, pos, Vector3::new(0.2, 0.1, 0.0), Vector3::z() * 0.1, 1.5).unwrap();
    let reference = TaskReference::from(line);
    let plain = ComputedTorque::new(tool, 25.0, 10.0);
    let law = Box::new(ComputedTorque { compensate_friction, null_space_damping: 1.0, ..plain });
    let v = vec![0.0; model.nv()];
    let mut simulation = Simulation::new(Arc::new(model), q, v);
    simulation.systems[0].tool = Some(tool);
    let law = Law::TaskComputedTorque(law, reference);
    simulation.systems[0].controls = vec![Control::new("arm", (0..7).collect(), law)];
    simulation
}

#[test]
fn a_task_law_reaches_with_friction_as_without() {
    let largest = |trace: &Trace| trace.position_error.iter().fold(0.0_f64, |most, e| most.max(e.abs()));
    for in_group in [false, true] {
        let free = run(&mut reaching(frictionless, true, in_group), 3.0);
        for change in [friction(0.04, 0.04), friction(0.04, 0.06)] {
            let mut simulation = reaching(&change, true, in_group);
            let trace = run(&mut simulation, 3.0);
            let off = apart(&free, &trace, if in_group { 8 } else { 7 });
            let lost = largest(&run(&mut reaching(&change, false, in_group), 3.0));
            println!(
                "{off:e} off; misses by {:e} m, without friction {:e} m, uncompensated {lost:e} m",
                largest(&trace),
                largest(&free)
            );
            assert!(off < TOLERANCE);
            assert!((largest(&trace) - largest(&free)).abs() < TOLERANCE);
            assert!(lost > 10.0 * largest(&free)); // negative control
            assert!(certify(&simulation.systems[0].model, &trace).passed());
        }
    }
}

#[test]
fn a_rollout_compensates_friction_as_a_simulation_does() {
    let mut simulation = reaching(friction(0.04, 0.06), true, false);
    let trace = run(&mut simulation, 1.0);
    let (model, stop) = (Arc::clone(&simulation.systems[0].model), AtomicBool::new(false));
    let Law::TaskComputedTorque(law, reference) = &simulation.systems[0].controls[0].law else { panic!() };
    let rollout = Rollout {
        steps: 1000,
        time_step: 1e-3,
        integrator: Integrator::Rk4,
        control: RolloutControl::ComputedTorque(law, reference),
        record_every: None,
        threads: Some(1),
        stop: &stop,
    };
    let (q0, v0) = ([&simulation.systems[0].q[..]; 3].concat(), [&simulation.systems[0].v[..]; 3].concat());
    let (mut q, mut v) = (vec![0.0; 3 * 14], vec![0.0; 3 * 13]);
    rollout.run(&model, &q0, &v0, &mut q, &mut v).unwrap();
    for q in q.chunks(14) {
        assert!(common::difference(q, &trace.q[trace.q.len() - 14..]) < 1e-12);
    }
}

/// Joints that no law drives stick or slip; controlled joints realize their commanded accelerations.
#[test]
fn laws_account_for_joints_held_by_friction() {
    let mut held = Vec::new();
    for kinetic in [0.0, 1e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 1.0] {
        let model = humanoid_with(friction(kinetic, 1.5 * kinetic));
        let (q, driven) = (start(&model), vec![0, 1, 2, 3]);
        let ahead = |j: usize| 0.02 * (j as f64 + 1.0);
        let path = Arc::new(JointHold::new(driven.iter().map(|&j| START[j] + ahead(j)).collect()).unwrap());
        let v = vec![0.0; model.nv()];
        let mut simulation = Simulation::new(Arc::new(model), q, v);
        let law = Law::JointComputedTorque(law(100.0, 20.0, true), path);
        simulation.systems[0].controls = vec![Control::new("part", driven.clone(), law)];
        let trace = run(&mut simulation, 2e-3);
        let a = &trace.acceleration[6..13];
        for &j in &driven {
            let asked = 100.0 * ahead(j);
            assert!((a[j] - asked).abs() < 1e-9 * asked, "{kinetic}: {} {asked}", a[j]);
        }
        held.push(a[4..].iter().filter(|a| **a == 0.0).count());
    }
    println!("held {held:?}");
    assert!(held[0] == 0 && held[7] == 3 && held.iter().any(|count| *count == 1 || *count == 2), "{held:?}");
}

/// The second arm swings while the first, near its goal, approaches it.
#[test]
fn a_joint_at_its_goal_does_not_chatter_while_another_moves() {
    let points = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let path = || {
        let times = vec![0.0, 2.0, 4.0, 6.0];
        Arc::new(JointSpline::waypoints(2, &points, &Timing::Given(times), true).unwrap())
    };
    for offset in [0.0, 0.01] {
        let [free, rough] = [&frictionless as &dyn Fn(&mut Joint), &friction(0.2, 0.3)].map(|change| {
            let model = hinges(2, change);
            let mut q = neutral(&model);
            q[7] = offset;
            run(&mut led(model, q, law(100.0, 20.0, true), path()), 6.0)
        });
        let off = apart(&free, &rough, 2);
        let changes = [0, 1].map(|j| flips(&rough, j, 2));
        println!("{offset} rad off its goal: {off:e} off, flips {changes:?}, {} rows", rough.rows());
        assert!(off < TOLERANCE);
        assert!(changes[0].0 <= 4 && changes[1].0 <= 4, "{changes:?}");
    }
}

#[test]
fn friction_compensation_is_restored_from_a_checkpoint() {
    let simulation = || {
        let mut simulation = to(hinges(2, friction(0.2, 0.3)), vec![0.05, -0.08], law(100.0, 4.0, true));
        simulation.systems[0].control_period = Some(0.05);
        simulation
    };
    let whole = run(&mut simulation(), 1.5);
    let (checkpoint, rows) = stopped(&mut simulation(), 1.5, 0.7);
    assert_same_bits(&resumed(&mut simulation(), 1.5, &checkpoint, rows).unwrap(), &whole);
    assert!(!whole.friction_compensation.is_empty());
}
