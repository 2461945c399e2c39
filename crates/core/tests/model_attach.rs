//! Checks that attached robots, and robots with a changed link, equal the same robots built directly.

#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test

mod common;

use common::Random;
use nalgebra::{Isometry3, Matrix3, Vector3};
use onorbit_core::model::{
    Inertial, Joint, JointKind, Link, LinkChange, Model, ModelBuilder, ModelError, ModelWarning, Mount,
};

/// Returns a chain `base, l0, l1, …` with a frame `tip` at its end, with names that begin with `prefix`.
fn chain(random: &mut Random, count: usize) -> Vec<(Link, Option<Joint>)> {
    let mut links = vec![(Link::new("base", Some(random.inertial())), None)];
    for i in 0..count {
        let axis = random.vector();
        let kind = [JointKind::Revolute(axis), JointKind::Prismatic(axis), JointKind::Fixed][i % 3].clone();
        let joint = Joint::new(&format!("j{i}"), kind, random.pose());
        links.push((Link::new(&format!("l{i}"), Some(random.inertial())), Some(joint)));
    }
    links
}

fn add_chain(builder: &mut ModelBuilder, links: &[(Link, Option<Joint>)], prefix: &str) {
    let mut parent = format!("{prefix}base");
    for (link, joint) in &links[1..] {
        let (mut link, mut joint) = (link.clone(), joint.clone().unwrap());
        link.name.insert_str(0, prefix);
        joint.name.insert_str(0, prefix);
        let name = link.name.clone();
        builder.add(&parent, joint, link).unwrap();
        parent = name;
    }
}

fn built(links: &[(Link, Option<Joint>)], tip: Isometry3<f64>) -> Model {
    let mut builder = ModelBuilder::new("chain", links[0].0.clone()).unwrap();
    add_chain(&mut builder, links, "");
    builder.add_frame("tip", &links.last().unwrap().0.name, tip).unwrap();
    builder.build().unwrap()
}

/// Returns the largest difference of all numbers of two robots, and whether names and parents are equal.
fn difference(a: &Model, b: &Model) -> f64 {
    assert!(a.is_like(b), "{:?} {:?}", a.frames(), b.frames());
    let mut largest = 0.0_f64;
    for (x, y) in a.nodes().iter().zip(b.nodes()) {
        assert_eq!((x.parent, x.end, x.is_fork, x.axis), (y.parent, y.end, y.is_fork, y.axis));
        largest = [
            (x.rot_pk.to_nalgebra() - y.rot_pk.to_nalgebra()).amax(),
            (x.pos_pk - y.pos_pk).to_nalgebra().amax(),
            (x.mass - y.mass).abs(),
            (x.com - y.com).to_nalgebra().amax(),
            (x.about_com.to_nalgebra() - y.about_com.to_nalgebra()).amax(),
        ]
        .into_iter()
        .fold(largest, f64::max);
    }
    for (x, y) in a.frames().iter().zip(b.frames()) {
        assert_eq!(x.body, y.body);
        largest = largest.max((x.pos_kf - y.pos_kf).to_nalgebra().amax());
        largest = largest.max((x.rot_kf.to_nalgebra() - y.rot_kf.to_nalgebra()).amax());
    }
    largest
}

#[test]
fn attached_is_the_same_as_built_in_one_go() {
    for seed in 0..40 {
        let mut random = Random::new(seed);
        let (bus, arm) = (chain(&mut random, 4), chain(&mut random, 5));
        let (tip, end, pose) = (random.pose(), random.pose(), random.pose());
        let mount = Mount { pose, prefix: "arm_".into(), ..Mount::default() };
        let attached = built(&bus, tip).attach("tip", &built(&arm, end), &mount).unwrap();

        let in_one_go = |pose: Isometry3<f64>| {
            let mut builder = ModelBuilder::new("chain", bus[0].0.clone()).unwrap();
            add_chain(&mut builder, &bus, "");
            builder.add_frame("tip", "l3", tip).unwrap();
            let mut root = arm[0].0.clone();
            root.name.insert_str(0, "arm_");
            builder.add("l3", Joint::new("mount", JointKind::Fixed, tip * pose), root).unwrap();
            add_chain(&mut builder, &arm, "arm_");
            builder.add_frame("arm_tip", "arm_l4", end).unwrap();
            builder.build().unwrap()
        };
        assert!(difference(&attached, &in_one_go(pose)) < 1e-14, "seed {seed}");
        assert!(difference(&attached, &in_one_go(pose * random.pose())) > 1e-3, "seed {seed}");
        assert_eq!(attached.joint_count(), 7); // two of the nine joints are fixed
    }
}

#[test]
fn a_frame_on_the_base_of_the_other_is_put_on_the_mount() {
    let mut random = Random::new(3);
    let (bus, arm) = (chain(&mut random, 1), chain(&mut random, 2));
    let flange = random.pose();
    let mut builder = ModelBuilder::new("arm", arm[0].0.clone()).unwrap();
    add_chain(&mut builder, &arm, "");
    builder.add_frame("flange", "base", flange).unwrap();
    let (bus, arm) = (built(&bus, Isometry3::identity()), builder.build().unwrap());
    let mount = |frame: &str, pose| Mount {
        frame: Some(frame.into()),
        pose,
        prefix: "arm_".into(),
        ..Mount::default()
    };
    let pose = random.pose();
    let by_flange = bus.attach("tip", &arm, &mount("flange", pose)).unwrap();
    let by_root = bus.attach("tip", &arm, &mount("base", pose * flange.inverse())).unwrap();
    assert!(difference(&by_flange, &by_root) < 1e-14);
    let refused = bus.attach("tip", &arm, &mount("flnge", pose)).unwrap_err();
    assert!(refused.to_string().ends_with("did you mean 'flange'?"), "{refused}");
}

#[test]
fn duplicate_names_are_reported_with_a_suggested_prefix() {
    let mut random = Random::new(5);
    let (bus, arm) = (chain(&mut random, 1), chain(&mut random, 2));
    let (bus, arm) = (built(&bus, Isometry3::identity()), built(&arm, Isometry3::identity()));
    let with = |prefix: &str| Mount { prefix: prefix.into(), ..Mount::default() };
    let refused = bus.attach("tip", &arm, &with("")).unwrap_err();
    assert_eq!(refused, ModelError::NameOfBoth { what: "link or frame", name: "base".into() });
    let left = bus.attach("tip", &arm, &with("left_")).unwrap();
    let refused = left.attach("tip", &arm, &with("left_")).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "with the prefix 'left_', both robots have a link or frame 'left_base'; choose a different prefix"
    );
    let both = left.attach("tip", &arm, &with("right_")).unwrap();
    assert!(both.frame("left_tip").is_ok() && both.frame("right_tip").is_ok());
    let refused = bus.attach("tipp", &arm, &with("left_")).unwrap_err();
    assert!(refused.to_string().ends_with("did you mean 'tip'?"), "{refused}");
    let here = Mount { pose: Isometry3::translation(f64::NAN, 0.0, 0.0), ..with("x_") };
    assert!(matches!(bus.attach("tip", &arm, &here).unwrap_err(), ModelError::NotFinite { .. }));
}

#[test]
fn a_link_changed_is_the_same_as_built_so() {
    let mut random = Random::new(8);
    let mut links = chain(&mut random, 4);
    let (tip, old) = (random.pose(), links[2].0.inertial.clone().unwrap());
    let model = built(&links, tip);
    let new = random.inertial();
    let change = |mass, com, inertia| LinkChange { link: "l1".into(), mass, com, inertia };
    for (change, expected) in [
        (change(Some(7.0), None, None), Inertial { mass: 7.0, ..old.clone() }),
        (change(None, Some(new.com), None), Inertial { com: new.com, ..old.clone() }),
        (change(None, None, Some(new.inertia)), Inertial { inertia: new.inertia, ..old.clone() }),
        (change(Some(new.mass), Some(new.com), Some(new.inertia)), new),
    ] {
        let changed = model.with_link(&change).unwrap();
        links[2].0.inertial = Some(expected);
        assert_eq!(difference(&changed, &built(&links, tip)), 0.0);
        assert!(difference(&changed, &model) > 1e-6);
    }
}

#[test]
fn invalid_link_changes_are_refused() {
    let mut random = Random::new(9);
    let mut builder = ModelBuilder::new("r", Link::new("base", Some(random.inertial()))).unwrap();
    builder.add("base", Joint::new("f", JointKind::Fixed, random.pose()), Link::new("plate", None)).unwrap();
    builder.warn(ModelWarning::Note("a remark".into()));
    let model = builder.build().unwrap();
    let change = |link: &str| LinkChange { link: link.into(), ..LinkChange::default() };
    let heavy = |link: &str, mass| LinkChange { mass: Some(mass), ..change(link) };
    let refused = model.with_link(&heavy("plte", 1.0)).unwrap_err();
    assert!(refused.to_string().ends_with("did you mean 'plate'?"), "{refused}");
    let refused = model.with_link(&change("plate")).unwrap_err();
    assert_eq!(refused, ModelError::ChangeWithoutMass { link: "plate".into() });
    let refused = model.with_link(&heavy("base", -1.0)).unwrap_err();
    assert!(matches!(refused, ModelError::MassNotPositive { .. }));
    let flat = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, -1.0));
    let refused = model.with_link(&LinkChange { inertia: Some(flat), ..change("base") }).unwrap_err();
    assert!(matches!(refused, ModelError::IndefiniteInertia { .. }));
    let point = model.with_link(&heavy("plate", 2.0)).unwrap();
    assert!((point.mass() - model.mass() - 2.0).abs() < 1e-15);
    assert_eq!(point.warnings(), model.warnings());
    // the warning about an inertia is kept
    let odd = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 20.0));
    let odd = model.with_link(&LinkChange { inertia: Some(odd), ..change("base") }).unwrap();
    assert_eq!(odd.warnings().len(), 2);
    let round = LinkChange { inertia: Some(Matrix3::identity()), ..change("base") };
    assert_eq!(odd.with_link(&round).unwrap().warnings(), model.warnings());
}
