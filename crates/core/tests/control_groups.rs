//! Checks several laws on one robot: each realizes its command, independently of the others.
#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test

mod common;

use common::humanoid::{START, humanoid, humanoid_with_idle_joint, start};
use common::{Random, difference};
use nalgebra::{Isometry3, Vector3};
use onorbit_core::control::{
    ComputedTorque, Control, ControlError, Controller, ControllerSet, Interface, JointComputedTorque,
    JointPid, Law, Observation,
};
use onorbit_core::dynamics::{
    Data, FrameWrench, apply_external, forward_dynamics_recursion, frame_acceleration, frame_pose,
    frame_velocity, inverse_dynamics_recursion, kinematics, positions,
};
use onorbit_core::model::urdf::from_file;
use onorbit_core::model::{Joint, JointKind, Link, Model, ModelBuilder, neutral};
use onorbit_core::reference::{
    Hold, JointHold, LineParabola, ReferenceFrame, TaskPath, TaskReference, TaskSample,
};
use onorbit_core::simulation::{Simulation, Trace};
use onorbit_core::spatial::{Force, Motion, Vec3, log_rotation};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Two arms of seven joints and a tail of two on a base, frames `right`, `left` and `tail`.
fn two_arms() -> Model {
    let mut random = Random::new(7);
    let mut inertial = |mass: f64| {
        let mut of = random.inertial();
        (of.inertia, of.mass) = (of.inertia * (mass / of.mass), mass);
        Some(of)
    };
    let base = Link::new("base", inertial(40.0));
    let mut builder = ModelBuilder::new("two_arms", base).unwrap();
    let axes =
        [Vector3::z(), Vector3::x(), Vector3::z(), Vector3::y(), Vector3::z(), Vector3::x(), Vector3::y()];
    for (side, count, at) in [("right", 7, -0.3), ("left", 7, 0.3), ("tail", 2, 0.0)] {
        let mut parent = "base".to_owned();
        for (i, axis) in axes.into_iter().take(count).enumerate() {
            let step = if i == 0 { Vector3::new(0.1, at, 0.2) } else { Vector3::new(0.02, 0.1 * at, -0.16) };
            let origin = Isometry3::translation(step.x, step.y, step.z);
            let mut joint = Joint::new(&format!("{side}_{i}"), JointKind::Revolute(axis), origin);
            (joint.damping, joint.friction) = (0.3, 0.1);
            let name = format!("{side}_link_{i}");
            builder.add(&parent, joint, Link::new(&name, inertial(3.0 - 0.3 * i as f64))).unwrap();
            parent = name;
        }
        builder.add_frame(side, &parent, Isometry3::translation(0.0, 0.0, -0.1)).unwrap();
    }
    builder.build().unwrap()
}

fn joints(model: &Model, side: &str) -> Vec<usize> {
    let named = model.joint_names().enumerate().filter(|(_, name)| name.starts_with(side));
    named.map(|(j, _)| j).collect()
}

/// Returns a pose near that of a frame at `q`, in W.
fn near(model: &Model, q: &[f64], frame: usize) -> Hold {
    let mut data = Data::<f64>::new(model);
    positions(model, &mut data, q);
    let pose = frame_pose(model, &data, q, frame);
    Hold::new(pose.rot_wf.to_nalgebra(), pose.pos_w.to_nalgebra() + Vector3::new(0.02, -0.01, 0.03)).unwrap()
}

/// Returns `ẍ` and `p̈r` of a frame, W axes, under torques; `relative` is the base frame for laws relative to
/// the base.
fn wanted(law: &ComputedTorque, model: &Model, data: &Data<f64>, q: &[f64], hold: &Hold) -> Motion<f64> {
    let (pose, twist) = (frame_pose(model, data, q, law.frame), frame_velocity(model, data, q, law.frame));
    let desired = TaskReference::from(hold.clone()).sample(0.0, 0.0).unwrap();
    let turn = log_rotation(&(desired.rot_wd * pose.rot_wf.transpose()));
    let error = Motion::new(desired.pos_w - pose.pos_w, turn);
    error * law.kp[0] - twist * law.kd[0]
}

#[test]
fn every_law_of_a_list_realizes_its_commanded_acceleration() {
    let model = two_arms();
    let (n, mut random) = (model.joint_count(), Random::new(3));
    let [right, left] = ["right", "left"].map(|name| model.frame(name).unwrap());
    let (mut q, v) = (neutral(&model), random.numbers(model.nv()));
    q[7..].copy_from_slice(&random.numbers(n));
    // undamped, since a damped inverse does not realize the command
    let law = |frame| ComputedTorque { damping: 0.0, ..ComputedTorque::new(frame, 100.0, 20.0) };
    let [law_r, law_l] = [right, left].map(law);
    let [hold_r, hold_l] = [right, left].map(|frame| near(&model, &q, frame));
    // the last joint of the left arm has its own law: six joints realize the left task; one joint of the tail
    // is driven by a PID and one is free
    let [group_r, mut group_l, tail] = ["right", "left", "tail"].map(|side| joints(&model, side));
    let single = vec![group_l.pop().unwrap()];
    let hold = |q: f64| Arc::new(JointHold::new(vec![q]).unwrap());
    let single_law = JointComputedTorque::new(25.0, 7.0);
    let mut controls = [
        Control::new("r", group_r, Law::TaskComputedTorque(Box::new(law_r.clone()), hold_r.clone().into())),
        Control::new("l", group_l, Law::TaskComputedTorque(Box::new(law_l.clone()), hold_l.clone().into())),
        Control::new("j", single.clone(), Law::JointComputedTorque(single_law, hold(0.3))),
        Control::new(
            "p",
            vec![tail[0]],
            Law::Pid(JointPid::new(Interface::Position, 8.0, 0.0, 2.0), hold(0.5)),
        ),
    ];
    let mut set = ControllerSet::<f64>::new(&mut controls, &model, 1e-12, false).unwrap();
    let mut data = Data::new(&model);
    kinematics(&model, &mut data, &q, &v);
    let push = Force::new(Vec3::new(3.0, -2.0, 1.0), Vec3::new(0.4, 0.2, -0.3));
    let external = [FrameWrench { frame: left, wrench: push }, FrameWrench { frame: 0, wrench: push }];
    apply_external(&model, &mut data, &external);
    let mut tau = vec![0.0; n];
    set.update(0.0, &model, &mut data, &q, &v, &mut tau).unwrap();
    assert_eq!(tau[tail[0]], 8.0 * (0.5 - q[7 + tail[0]]) - 2.0 * v[6 + tail[0]]);
    assert_eq!(tau[tail[1]], 0.0);

    // the accelerations under these torques, by ABA, with damping at all joints and friction where no drive
    // compensates it
    let mut forces = vec![0.0; model.nv()];
    for (j, joint) in model.joints().iter().enumerate() {
        let (rate, is_compensated) = (v[j + 6], set.desired_accelerations()[j].is_some());
        assert_eq!(is_compensated, !tail.contains(&j));
        let friction = if is_compensated { 0.0 } else { joint.friction * rate.signum() };
        forces[j + 6] = tau[j] - joint.damping * rate - friction;
    }
    let mut a = vec![0.0; model.nv()];
    forward_dynamics_recursion(&model, &mut data, &v, &forces, &mut a);
    let j = single[0];
    let expected = 25.0 * (0.3 - q[7 + j]) - 7.0 * v[6 + j];
    assert!((a[6 + j] - expected).abs() < 1e-9 * expected.abs(), "{} {expected}", a[6 + j]);
    let mut whole = vec![0.0; model.nv()];
    inverse_dynamics_recursion(&model, &mut data, &v, Some(&a), &mut whole);
    for (law, hold) in [(&law_r, &hold_r), (&law_l, &hold_l)] {
        let got = frame_acceleration(&model, &data, &q, law.frame);
        let (mut a, mut b) = ([0.0; 6], [0.0; 6]);
        got.write(&mut a);
        wanted(law, &model, &data, &q, hold).write(&mut b);
        assert!(difference(&a, &b) < 1e-9, "{}: {a:?} {b:?}", law.frame); // rounding through M_EE⁻¹ and J⁺
    }
}

fn runs(mut simulation: Simulation, duration: f64) -> Trace {
    simulation.run(duration).unwrap().only()
}

/// Returns the humanoid, with or without an idle joint that makes the arm a group.
fn robot(in_group: bool) -> Model {
    if in_group { humanoid_with_idle_joint(|_| {}) } else { humanoid() }
}

/// Returns the reach of the humanoid with a rotating base, in the frame given.
fn reach(frame: ReferenceFrame, in_group: bool, time_step: f64) -> Trace {
    let model = robot(in_group);
    let (q, tool) = (start(&model), model.frame("tool").unwrap());
    let mut data = Data::<f64>::new(&model);
    positions(&model, &mut data, &q);
    let pose = frame_pose(&model, &data, &q, tool); // the base is at the origin: W and B coincide
    let (rot, pos) = (pose.rot_wf.to_nalgebra(), pose.pos_w.to_nalgebra());
    let line = LineParabola::new(rot, pos, Vector3::new(0.3, 0.1, 0.0), Vector3::z() * 0.2, 1.0).unwrap();
    let reference = TaskReference { path: Arc::new(line), frame };
    let mut v = vec![0.0; model.nv()];
    v[..6].copy_from_slice(&[0.02, -0.01, 0.03, 0.05, -0.08, 0.03]);
    let mut law = ComputedTorque::new(tool, 100.0, 20.0);
    law.null_space_damping = 2.0;
    let mut simulation = Simulation::new(Arc::new(model), q, v);
    (simulation.systems[0].tool, simulation.time_step) = (Some(tool), time_step);
    let law = Law::TaskComputedTorque(Box::new(law), reference);
    simulation.systems[0].controls = vec![Control::new("arm", (0..7).collect(), law)];
    runs(simulation, 1.2)
}

#[test]
fn a_task_law_on_a_group_is_that_on_all_joints() {
    for frame in [ReferenceFrame::World, ReferenceFrame::Base] {
        let (alone, in_group) = (reach(frame.clone(), false, 1e-3), reach(frame, true, 1e-3));
        // products in another order, over a second of motion
        let tau: Vec<f64> = in_group.tau.chunks(8).flat_map(|tau| &tau[..7]).copied().collect();
        assert!(difference(&tau, &alone.tau) < 1e-9);
        assert!(tau.iter().zip(&alone.tau).any(|(a, b)| a != b), "the fast case is compared with itself");
        assert!(in_group.tau.chunks(8).all(|tau| tau[7] == 0.0));
        assert!(difference(&in_group.reference_pose, &alone.reference_pose) < 1e-12);
        for trace in [&alone, &in_group] {
            let errors = &trace.tracking[0].values;
            for row in 0..trace.rows() {
                let norm = |e: &[f64]| e.iter().map(|x| x * x).sum::<f64>().sqrt();
                let (own, run) =
                    (norm(&errors[6 * row..6 * row + 3]), norm(&trace.position_error[3 * row..3 * row + 3]));
                assert!((own - run).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn a_line_in_the_base_frame_is_tracked_while_the_base_turns() {
    let largest = |trace: &Trace| trace.position_error.iter().fold(0.0_f64, |most, e| most.max(e.abs()));
    let trace = reach(ReferenceFrame::Base, true, 1e-3);
    // 3.3e-5 m: the torque is held over each step, so that the error halves with it
    let (coarse, fine) = (largest(&trace), largest(&reach(ReferenceFrame::Base, true, 5e-4)));
    assert!(coarse < 5e-5 && (coarse / fine - 2.0).abs() < 0.1, "{coarse} {fine}");
    // independent check: relative to the recorded base pose, the recorded tool pose is on the line
    let model = robot(true);
    let seen = |row: usize| {
        let q = &trace.q[row * model.nq()..];
        let turn =
            nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(q[6], q[3], q[4], q[5]));
        let t = &trace.tool_pose[16 * row..];
        turn.inverse() * (Vector3::new(t[3], t[7], t[11]) - Vector3::new(q[0], q[1], q[2]))
    };
    let moved = seen(1000) - seen(0);
    assert!((moved - Vector3::new(0.3, 0.1, 0.0)).norm() < 5e-5, "{moved}");
    // the base moves, so that the line in W is a different motion of the arm
    assert!((trace.q[1000 * model.nq() + 4]).abs() > 0.03);
    let in_w = reach(ReferenceFrame::World, true, 1e-3);
    assert!(difference(&in_w.tau, &trace.tau) > 1e-2);
}

/// Two arms, each controlled as if the other were passive.
struct Deaf {
    model: Arc<Model>,
    arms: Vec<ControllerSet<'static, f64>>,
}

impl Controller for Deaf {
    fn update(&mut self, now: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError> {
        let (mut data, mut own) = (Data::new(&self.model), vec![0.0; tau.len()]);
        tau.fill(0.0);
        for arm in &mut self.arms {
            kinematics(&self.model, &mut data, now.q, now.v);
            arm.update(now.time, &self.model, &mut data, now.q, now.v, &mut own)?;
            tau.iter_mut().zip(&own).for_each(|(tau, own)| *tau += own); // the groups are disjoint
        }
        Ok(())
    }
}

#[test]
fn two_arms_track_simultaneously_but_not_if_each_ignores_the_other() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../python/onorbit_rs/robots");
    let model = Arc::new(from_file(&folder.join("humanoid_dual_arm.urdf"), &Default::default()).unwrap());
    let mut q = neutral(&model);
    q[7..14].copy_from_slice(&START); // equal values are mirror images
    q[14..].copy_from_slice(&START);
    let mut data = Data::<f64>::new(&model);
    positions(&model, &mut data, &q);
    let parts = ["right", "left"].map(|side| {
        let frame = model.frame(&format!("{side}_tool")).unwrap();
        let pose = frame_pose(&model, &data, &q, frame);
        let (rot, pos) = (pose.rot_wf.to_nalgebra(), pose.pos_w.to_nalgebra());
        // the reach of the paper with the right arm, a shorter and lower one with the left
        let (way, height) = if side == "right" { (0.5, 0.4) } else { (0.3, -0.1) };
        let line = LineParabola::new(rot, pos, Vector3::x() * way, Vector3::z() * height, 2.0).unwrap();
        // low gains, so that unmodelled effects are visible: the error is the acceleration error over kp
        let mut law = ComputedTorque::new(frame, 4.0, 4.0);
        law.null_space_damping = 2.0;
        (law, TaskReference::from(line), joints(&model, side))
    });
    let run = |controls: Vec<Control>| {
        let v = vec![0.0; model.nv()];
        let mut simulation = Simulation::new(Arc::clone(&model), q.clone(), v);
        simulation.systems[0].controls = controls;
        (simulation.systems[0].tool, simulation.time_step) = (Some(parts[0].0.frame), 1e-4);
        runs(simulation, 2.5)
    };
    let control = |i: usize| {
        let (law, reference, group) = &parts[i];
        let law = Law::TaskComputedTorque(Box::new(law.clone()), reference.clone());
        Control::new(["right", "left"][i], group.clone(), law)
    };
    let trace = run(vec![control(0), control(1)]);
    for tracking in &trace.tracking {
        let most = tracking.values.iter().fold(0.0_f64, |most, e| most.max(e.abs()));
        assert!(most < 1e-4, "{}: {most}", tracking.name);
    }
    let alone = |i| ControllerSet::new(Box::leak(Box::new([control(i)])), &model, 1e-12, false).unwrap();
    let deaf = Deaf { model: Arc::clone(&model), arms: vec![alone(0), alone(1)] };
    let trace = run(vec![Control::on_all_joints(&model, Law::User(Box::new(deaf), None))]);
    let off = |row: usize| {
        let desired = parts[0].1.sample(trace.time[row], 0.0).unwrap().pos_w.to_nalgebra();
        let t = &trace.tool_pose[16 * row..];
        (desired - Vector3::new(t[3], t[7], t[11])).norm()
    };
    let most = (0..trace.rows()).map(off).fold(0.0, f64::max);
    assert!(most > 3e-4, "each on its own is off by {most}");
}

/// A path that counts its samples.
#[derive(Debug)]
struct Counted(Hold, AtomicUsize);

impl TaskPath for Counted {
    fn sample(&self, t: f64) -> TaskSample<f64> {
        self.1.fetch_add(1, Ordering::Relaxed);
        self.0.sample(t)
    }
    fn duration(&self) -> f64 {
        0.0
    }
}

/// Recorded rows reuse the sample of the control tick at the same instant and state.
#[test]
fn a_reference_is_sampled_once_for_a_tick_and_its_row() {
    let model = humanoid();
    let (q, mut v, tool) = (start(&model), vec![0.0; model.nv()], model.frame("tool").unwrap());
    let path = Arc::new(Counted(near(&model, &q, tool), AtomicUsize::new(0)));
    let reference =
        TaskReference { path: Arc::clone(&path) as Arc<dyn TaskPath>, frame: ReferenceFrame::World };
    let law = Law::TaskComputedTorque(Box::new(ComputedTorque::new(tool, 4.0, 4.0)), reference);
    let mut controls = [Control::new("arm", (0..7).collect(), law)];
    let mut set = ControllerSet::<f64>::new(&mut controls, &model, 1e-12, false).unwrap();
    let (mut data, mut tau) = (Data::new(&model), vec![0.0; 7]);
    kinematics(&model, &mut data, &q, &v);
    set.update(0.0, &model, &mut data, &q, &v, &mut tau).unwrap();
    let asked = || path.1.swap(0, Ordering::Relaxed);
    asked();
    set.update_errors(0.0, &model, &data, &q, &v).unwrap();
    assert_eq!(asked(), 0);
    set.update(1e-3, &model, &mut data, &q, &v, &mut tau).unwrap();
    set.update_errors(1e-3, &model, &data, &q, &v).unwrap();
    assert_eq!(asked(), 1);
    // another state at the same instant, as after an impact, and another instant
    v[7] = 0.1;
    kinematics(&model, &mut data, &q, &v);
    set.update_errors(1e-3, &model, &data, &q, &v).unwrap();
    set.update_errors(2e-3, &model, &data, &q, &v).unwrap();
    assert_eq!(asked(), 2);
}
