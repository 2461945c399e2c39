//! Checks that a robot with another root has the same motion, momentum and energy.

#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test

mod common;

use common::{Random, difference, random_model, random_state};
use nalgebra::{Isometry3, Vector3};
use onorbit_core::dynamics::{
    Data, FrameWrench, center_of_mass, forward_dynamics, frame_acceleration, kinetic_energy, momentum,
    transfer_state,
};
use onorbit_core::model::{Joint, JointKind, Link, Model, ModelBuilder, ModelError, Mount};
use onorbit_core::spatial::Force;

/// What does not depend on the root: accelerations of the joints by name and of all frames, momentum, energy
/// and centre of mass.
struct Motion {
    joints: Vec<f64>,
    frames: Vec<f64>,
    sums: Vec<f64>,
}

/// Returns the motion at a state, with torques `tau` by the name of the joint and `wrench` on the frame
/// `tool`. The order of joints and frames is that of `names`.
fn motion(model: &Model, names: &Model, (q, v): (&[f64], &[f64]), tau: &[f64], wrench: &[f64]) -> Motion {
    let mut torques = vec![0.0; model.nv()];
    for (name, tau) in names.joint_names().zip(tau) {
        torques[6 + model.joint(name).unwrap()] = *tau;
    }
    let (mut data, mut a) = (Data::new(model), vec![0.0; model.nv()]);
    let external = [FrameWrench { frame: model.frame("tool").unwrap(), wrench: Force::from_slice(wrench) }];
    forward_dynamics(model, &mut data, q, v, &torques, &external, &mut a);
    let joints = names.joint_names().map(|name| a[6 + model.joint(name).unwrap()]).collect();
    let mut frames = Vec::new();
    for name in names.frame_names() {
        let acceleration = frame_acceleration(model, &data, q, model.frame(name).unwrap());
        for part in [acceleration.linear, acceleration.angular] {
            frames.extend(part.to_nalgebra().iter());
        }
    }
    let h = momentum(&data, q);
    let com = center_of_mass(&data, q);
    let mut sums = vec![kinetic_energy(model, &data, v)];
    for part in [h.linear, h.angular, com] {
        sums.extend(part.to_nalgebra().iter());
    }
    Motion { joints, frames, sums }
}

/// Returns the largest relative difference of the motions of two models of one robot at one state.
fn largest_difference(model: &Model, other: &Model, random: &mut Random) -> f64 {
    let (q, v) = random_state(model, random);
    let (tau, wrench) = (random.numbers(model.joint_count()), random.numbers(6));
    let (other_q, other_v) = transfer_state(model, &q, &v, other).unwrap();
    let a = motion(model, model, (&q, &v), &tau, &wrench);
    let b = motion(other, model, (&other_q, &other_v), &tau, &wrench);
    [(a.joints, b.joints), (a.frames, b.frames), (a.sums, b.sums)]
        .iter()
        .map(|(a, b)| difference(a, b))
        .fold(0.0, f64::max)
}

#[test]
fn every_link_of_a_random_tree_can_be_the_root() {
    let (mut worst, mut reversed) = (0.0_f64, 0);
    for seed in 0..60 {
        let model = random_model(seed, 12);
        let mut random = Random::new(1000 + seed);
        for link in 0..12 {
            let rerooted = model.rerooted(&format!("link{link}")).unwrap();
            assert_eq!(rerooted.joint_count(), model.joint_count());
            assert_eq!(rerooted.frames().len(), model.frames().len());
            assert_eq!(rerooted.body(&format!("link{link}")), Ok(0));
            worst = worst.max(largest_difference(&model, &rerooted, &mut random));
            reversed += usize::from(rerooted.body_names().ne(model.body_names()));
        }
    }
    assert!(reversed > 300, "{reversed}");
    assert!(worst < 1e-12, "{worst:e}");
}

#[test]
fn the_way_back_gives_the_same_state() {
    for seed in 0..20 {
        let model = random_model(seed, 9);
        let there = model.rerooted("link8").unwrap();
        let back = there.rerooted("link0").unwrap();
        let (q, v) = random_state(&model, &mut Random::new(seed));
        let (q_there, v_there) = transfer_state(&model, &q, &v, &there).unwrap();
        let (q_back, v_back) = transfer_state(&there, &q_there, &v_there, &model).unwrap();
        let sign = if q[6] * q_back[6] < 0.0 { -1.0 } else { 1.0 }; // two quaternions are one attitude
        let q_back: Vec<f64> =
            q_back.iter().enumerate().map(|(i, x)| if (3..7).contains(&i) { sign * x } else { *x }).collect();
        assert!(difference(&q_back, &q) < 1e-14 && difference(&v_back, &v) < 1e-13, "seed {seed}");
        assert!(largest_difference(&model, &back, &mut Random::new(seed)) < 1e-12, "seed {seed}");
    }
}

/// Returns a body and a second one on a joint that is traversed from its child, whose axis is `sign` times
/// that of the reversed joint.
fn reversed_by_hand(sign: f64, links: &[Link; 2], joint: &Joint, axis: Vector3<f64>) -> Model {
    let backwards = Joint {
        origin: Isometry3::identity(),
        child_pose: joint.origin.inverse(),
        ..Joint::new("joint", JointKind::Revolute(axis * sign), Isometry3::identity())
    };
    let mut builder = ModelBuilder::new("pair", links[1].clone()).unwrap();
    builder.add("b", backwards, links[0].clone()).unwrap();
    builder.add_frame("tool", "b", Isometry3::identity()).unwrap();
    builder.build().unwrap()
}

/// Negative control: a reversed joint that keeps its axis gives other accelerations.
#[test]
fn a_reversed_joint_that_keeps_its_axis_is_another_robot() {
    let mut random = Random::new(7);
    let axis = random.vector();
    let links = [Link::new("a", Some(random.inertial())), Link::new("b", Some(random.inertial()))];
    let joint = Joint::new("joint", JointKind::Revolute(axis), random.pose());
    let mut builder = ModelBuilder::new("pair", links[0].clone()).unwrap();
    builder.add("a", joint.clone(), links[1].clone()).unwrap();
    builder.add_frame("tool", "b", Isometry3::identity()).unwrap();
    let model = builder.build().unwrap();
    let [negated, kept] = [-1.0, 1.0].map(|sign| reversed_by_hand(sign, &links, &joint, axis));
    assert!(largest_difference(&model, &negated, &mut random) < 1e-13);
    assert!(largest_difference(&model, &kept, &mut random) > 0.1);
}

#[test]
fn a_robot_attached_by_its_tool_is_rerooted() {
    for seed in 0..20 {
        let (bus, arm) = (random_model(seed, 4), random_model(100 + seed, 7));
        let mount = Mount { frame: Some("tool".into()), prefix: "arm_".into(), ..Mount::default() };
        let whole = bus.attach("tool", &arm, &mount).unwrap();
        assert_eq!(whole.joint_count(), bus.joint_count() + arm.joint_count());
        let tools = [whole.frame("tool").unwrap(), whole.frame("arm_tool").unwrap()];
        let [a, b] = tools.map(|frame| &whole.frames()[frame]);
        assert_eq!(a.body, b.body);
        assert!((a.pos_kf - b.pos_kf).to_nalgebra().amax() < 1e-14);
        assert!((a.rot_kf.to_nalgebra() - b.rot_kf.to_nalgebra()).amax() < 1e-14);
        assert!((whole.mass() - bus.mass() - arm.mass()).abs() < 1e-13 * whole.mass());
    }
}

/// The mass matrix of a robot is singular with every root or with none.
#[test]
fn a_massless_link_between_joints_can_be_the_root() {
    let mut random = Random::new(2);
    let mut builder = ModelBuilder::new("universal", Link::new("base", Some(random.inertial()))).unwrap();
    let turn = |name: &str, axis| Joint::new(name, JointKind::Revolute(axis), Isometry3::identity());
    builder.add("base", turn("first", Vector3::x()), Link::new("cross", None)).unwrap();
    builder.add("cross", turn("second", Vector3::y()), Link::new("hand", Some(random.inertial()))).unwrap();
    builder.add_frame("tool", "hand", random.pose()).unwrap();
    let universal = builder.build().unwrap();
    let cross = universal.rerooted("cross").unwrap();
    assert!(largest_difference(&universal, &cross, &mut random) < 1e-12);
}

#[test]
fn an_unknown_root_is_refused() {
    let error = random_model(1, 5).rerooted("lnk3").unwrap_err();
    assert!(matches!(error, ModelError::UnknownName { .. }));
    assert!(error.to_string().contains("there is no link 'lnk3'; did you mean 'link"), "{error}");
}
