//! Checks the errors of the builder, and that merging fixed links and aligning axes preserve the robot.

#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test

mod common;

use common::Random;
use nalgebra::{Isometry3, Matrix3, Rotation3, UnitQuaternion, Vector3};
use onorbit_core::dynamics::{
    Data, center_of_mass, frame_pose, kinematics, kinetic_energy, mass_matrix, positions,
};
use onorbit_core::model::{
    Inertial, Joint, JointKind, Link, Model, ModelBuilder, ModelError, ModelWarning, neutral,
};

fn ball(mass: f64) -> Option<Inertial> {
    Some(Inertial { mass, com: Vector3::zeros(), inertia: Matrix3::identity() * mass })
}

fn shaped(inertia: [f64; 3]) -> Option<Inertial> {
    Some(Inertial { mass: 1.0, com: Vector3::zeros(), inertia: Matrix3::from_diagonal(&inertia.into()) })
}

fn revolute(name: &str, axis: Vector3<f64>) -> Joint {
    Joint::new(name, JointKind::Revolute(axis), Isometry3::identity())
}

fn fixed(name: &str, origin: Isometry3<f64>) -> Joint {
    Joint::new(name, JointKind::Fixed, origin)
}

fn robot() -> ModelBuilder {
    ModelBuilder::new("r", Link::new("base", ball(1.0))).unwrap()
}

#[test]
fn links_with_invalid_inertia_are_refused() {
    let add =
        |inertial| robot().add("base", revolute("j", Vector3::z()), Link::new("l", inertial)).unwrap_err();
    assert!(matches!(add(ball(-1.0)), ModelError::MassNotPositive { mass: -1.0, .. }));
    assert!(matches!(add(ball(f64::NAN)), ModelError::NotFinite { .. }));
    assert!(matches!(add(shaped([-1.0, 1.0, 1.0])), ModelError::IndefiniteInertia { .. }));
    let mut skew = ball(1.0).unwrap();
    skew.inertia[(0, 1)] = 0.1;
    assert!(matches!(add(Some(skew)), ModelError::AsymmetricInertia { .. }));
    let mut flywheel = ball(1.0).unwrap();
    flywheel.mass = 0.0;
    flywheel.inertia[(0, 0)] = -1.0;
    let mut spinning = robot();
    spinning.add("base", revolute("j", Vector3::z()), Link::new("l", Some(flywheel))).unwrap();
    assert!(matches!(spinning.build().unwrap_err(), ModelError::IndefiniteInertia { .. }));
}

#[test]
fn an_indefinite_body_is_reported_with_the_indefinite_link_and_its_own_moments() {
    let massless = |moments: [f64; 3]| Some(Inertial { mass: 0.0, ..shaped(moments).unwrap() });
    let mut builder = robot();
    for (name, moments) in [("wheel", [0.1, 0.1, 0.2]), ("bad", [-5.0, 1.0, 1.0])] {
        let link = Link::new(name, massless(moments));
        builder.add("base", fixed(name, Isometry3::identity()), link).unwrap();
        // a thin rod in rotated axes: its least moment is zero up to rounding
        let axes = *Rotation3::from_euler_angles(0.3, 0.7, -0.4).matrix();
        let mut rod = massless([0.0, 0.1, 0.1]).unwrap();
        rod.inertia = axes * rod.inertia * axes.transpose();
        rod.inertia = (rod.inertia + rod.inertia.transpose()) * 0.5;
        let name = format!("rod before {name}");
        builder.add("base", fixed(&name, Isometry3::identity()), Link::new(&name, Some(rod))).unwrap();
    }
    let expected = ModelError::IndefiniteInertia { link: "bad".into(), moments: [-5.0, 1.0, 1.0] };
    assert_eq!(builder.build().unwrap_err(), expected);
}

#[test]
fn limits_may_be_infinite_but_not_nan() {
    let add = |x: f64, k: usize| {
        let mut joint = revolute("j", Vector3::z());
        match k {
            0 => joint.limits.position = Some((-1.0, x)),
            1 => joint.limits.velocity = Some(x),
            _ => joint.limits.effort = Some(x),
        }
        robot().add("base", joint, Link::new("l", ball(1.0))).map(|_| ())
    };
    for (k, what) in ["a position limit", "the velocity limit", "the effort limit"].into_iter().enumerate() {
        assert_eq!(add(f64::INFINITY, k), Ok(()));
        assert_eq!(add(f64::NAN, k), Err(ModelError::LimitIsNan { joint: "j".into(), what }));
    }
}

#[test]
fn names_are_used_once_and_known() {
    let mut builder = robot();
    builder.add("base", revolute("j", Vector3::z()), Link::new("arm", ball(1.0))).unwrap();
    let again = builder.add("base", revolute("j", Vector3::z()), Link::new("b", ball(1.0))).unwrap_err();
    assert_eq!(again, ModelError::DuplicateName { what: "joint", name: "j".into() });
    let again = builder.add("base", revolute("k", Vector3::z()), Link::new("arm", ball(1.0))).unwrap_err();
    assert_eq!(again, ModelError::DuplicateName { what: "link or frame", name: "arm".into() });
    let unknown = builder.add("amr", revolute("k", Vector3::z()), Link::new("b", None)).unwrap_err();
    assert!(unknown.to_string().ends_with("did you mean 'arm'?"), "{unknown}");
    let again = builder.add_frame("arm", "base", Isometry3::identity()).unwrap_err();
    assert!(matches!(again, ModelError::DuplicateName { .. }));
    // a rejected link does not change the builder
    builder.add("arm", revolute("k", Vector3::z()), Link::new("b", ball(1.0))).unwrap();
    let model = builder.build().unwrap();
    assert_eq!(model.joint_names().collect::<Vec<_>>(), ["j", "k"]);
    assert!(model.joint("jj").unwrap_err().to_string().contains("'j'"));
}

#[test]
fn robots_with_a_direction_without_inertia_are_refused() {
    let massless = ModelBuilder::new("r", Link::new("base", None)).unwrap().build();
    assert_eq!(massless.unwrap_err(), ModelError::NoMass);

    let mut idle = robot();
    idle.add("base", revolute("j", Vector3::z()), Link::new("l", None)).unwrap();
    let idle = idle.build().unwrap_err();
    assert_eq!(idle, ModelError::MasslessSubtree { joint: "j".into(), link: "l".into() });

    // a point mass on the axis, far from the base and in skew axes: its inertia is rounding error
    let point = Inertial { mass: 3.0, com: Vector3::new(0.1, 0.2, 0.3), inertia: Matrix3::zeros() };
    let mut on_axis = robot();
    let origin = Isometry3::new(Vector3::new(7.0, -5.0, 3.0), Vector3::new(0.3, 0.4, 0.5));
    let joint = Joint::new("j", JointKind::Revolute(point.com), origin);
    on_axis.add("base", joint, Link::new("l", Some(point))).unwrap();
    assert!(matches!(on_axis.build().unwrap_err(), ModelError::MasslessSubtree { .. }));

    // two motors about one axis without inertia between them
    let mut coaxial = robot();
    coaxial.add("base", revolute("a", Vector3::z()), Link::new("l", None)).unwrap();
    coaxial.add("l", revolute("b", Vector3::z()), Link::new("m", ball(1.0))).unwrap();
    assert!(
        matches!(coaxial.build().unwrap_err(), ModelError::MasslessSubtree { joint, .. } if joint == "a")
    );

    let mut spinning_base = ModelBuilder::new("r", Link::new("base", None)).unwrap();
    spinning_base.add("base", revolute("j", Vector3::z()), Link::new("l", ball(1.0))).unwrap();
    assert_eq!(
        spinning_base.build().unwrap_err(),
        ModelError::SingularBase { link: "base".into(), joints: vec!["j".into()] }
    );

    let point = Inertial { mass: 1.0, com: Vector3::new(1.0, 2.0, 3.0), inertia: Matrix3::zeros() };
    let point = ModelBuilder::new("r", Link::new("base", Some(point))).unwrap().build();
    assert!(matches!(point.unwrap_err(), ModelError::SingularBase { joints, .. } if joints.is_empty()));
}

fn flywheel() -> Option<Inertial> {
    Some(Inertial { mass: 0.0, ..ball(1.0).unwrap() })
}

#[test]
fn an_inertia_without_mass_needs_a_mass_that_moves_with_it() {
    let mut turning = robot();
    turning.add("base", revolute("j", Vector3::z()), Link::new("l", flywheel())).unwrap();
    let turning = turning.build().unwrap();
    assert_eq!(turning.warnings(), [ModelWarning::InertiaWithoutMass { link: "l".into() }]);

    let mut base = ModelBuilder::new("r", Link::new("base", flywheel())).unwrap();
    base.add("base", revolute("j", Vector3::z()), Link::new("l", ball(1.0))).unwrap();
    assert_eq!(base.build().unwrap().mass(), 1.0);

    // an inertia without mass resists no translation and makes no floating base
    let mut sliding = robot();
    let rail = Joint::new("j", JointKind::Prismatic(Vector3::z()), Isometry3::identity());
    sliding.add("base", rail, Link::new("l", flywheel())).unwrap();
    assert!(matches!(sliding.build().unwrap_err(), ModelError::MasslessSubtree { .. }));
    let alone = ModelBuilder::new("r", Link::new("base", flywheel())).unwrap();
    assert_eq!(alone.build().unwrap_err(), ModelError::NoMass);
}

#[test]
fn joints_between_a_world_link_and_the_base_are_named() {
    let mut mobile = ModelBuilder::new("r", Link::new("world", None)).unwrap();
    let rail = |name: &str, axis| Joint::new(name, JointKind::Prismatic(axis), Isometry3::identity());
    mobile.add("world", rail("x", Vector3::x()), Link::new("l1", None)).unwrap();
    mobile.add("l1", rail("y", Vector3::y()), Link::new("l2", None)).unwrap();
    mobile.add("l2", revolute("yaw", Vector3::z()), Link::new("body", ball(1.0))).unwrap();
    mobile.add("body", revolute("arm", Vector3::x()), Link::new("hand", ball(1.0))).unwrap();
    let refused = mobile.build().unwrap_err().to_string();
    let advice = "give it inertial properties, or remove the joints 'x', 'y', 'yaw' and the massless links above them; \
        the robot floats without them";
    assert!(refused.ends_with(advice), "{refused}");
}

#[test]
fn massless_links_are_allowed_if_their_descendants_have_inertia() {
    let mut wrist = robot();
    wrist.add("base", revolute("a", Vector3::x()), Link::new("l", None)).unwrap();
    wrist.add("l", revolute("b", Vector3::z()), Link::new("m", ball(1.0))).unwrap();
    assert_eq!(wrist.build().unwrap().joint_count(), 2);

    let mut rotor = robot();
    let geared = Joint { rotor_inertia: 0.1, ..revolute("a", Vector3::x()) };
    rotor.add("base", geared, Link::new("l", None)).unwrap();
    assert!(rotor.build().is_ok());
}

#[test]
fn an_indefinite_part_is_accepted_only_if_its_body_is_definite() {
    let part = shaped([-0.5, 1.0, 1.0]);
    let with = |base: f64| {
        let mut builder = ModelBuilder::new("r", Link::new("base", ball(base))).unwrap();
        builder.add("base", fixed("f", Isometry3::identity()), Link::new("part", part.clone())).unwrap();
        builder.build()
    };
    assert!(
        matches!(&with(1.0).unwrap().warnings()[0], ModelWarning::IndefinitePart { link, .. } if link == "part")
    );
    assert!(matches!(with(0.1).unwrap_err(), ModelError::IndefiniteInertia { link, .. } if link == "part"));
}

#[test]
fn a_broken_triangle_inequality_warns_with_the_link() {
    let model = ModelBuilder::new("r", Link::new("plate", shaped([1.0, 1.0, 3.0]))).unwrap().build().unwrap();
    let expected = ModelWarning::TriangleInequality { link: "plate".into(), moments: [1.0, 1.0, 3.0] };
    assert_eq!(model.warnings(), [expected]);
}

#[test]
fn folding_fixed_links_keeps_mass_centre_and_inertia() {
    let mut random = Random::new(5);
    for _ in 0..20 {
        let (parts, poses) =
            ([random.inertial(), random.inertial(), random.inertial()], [random.pose(), random.pose()]);
        let mut builder = ModelBuilder::new("r", Link::new("a", Some(parts[0].clone()))).unwrap();
        builder.add("a", fixed("ab", poses[0]), Link::new("b", Some(parts[1].clone()))).unwrap();
        builder.add("b", fixed("bc", poses[1]), Link::new("c", Some(parts[2].clone()))).unwrap();
        let model = builder.build().unwrap();
        let body = &model.nodes()[0];

        // about the base's origin the inertias add: Σ m, Σ m c, Σ R I Rᵀ − m c× c×
        let in_base = [Isometry3::identity(), poses[0], poses[0] * poses[1]];
        let (mut mass, mut moment, mut about_origin) = (0.0, Vector3::zeros(), Matrix3::zeros());
        for (part, pose) in parts.iter().zip(&in_base) {
            let (c, r) = (pose.transform_point(&part.com.into()).coords, pose.rotation.to_rotation_matrix());
            mass += part.mass;
            moment += c * part.mass;
            about_origin +=
                r * part.inertia * r.transpose() - c.cross_matrix() * c.cross_matrix() * part.mass;
        }
        let (com, c) = (moment / mass, (moment / mass).cross_matrix());
        assert!((body.mass - mass).abs() < 1e-13 * mass);
        assert!((body.com.to_nalgebra() - com).norm() < 1e-13);
        assert!(
            (body.about_com.to_nalgebra() - (about_origin + c * c * mass)).norm()
                < 1e-12 * about_origin.norm()
        );
        let frame = &model.frames()[model.frame("c").unwrap()];
        assert!((frame.pos_kf.to_nalgebra() - in_base[2].translation.vector).norm() < 1e-14);
    }
}

#[test]
fn a_root_without_mass_is_the_base_frame_of_what_is_fixed_to_it() {
    let mut random = Random::new(9);
    let (pose, next, eye) = (random.pose(), random.pose(), random.pose());
    let mut builder = ModelBuilder::new("r", Link::new("world", None)).unwrap();
    builder.add_frame("eye", "world", eye).unwrap();
    builder.add("world", fixed("w", pose), Link::new("footprint", None)).unwrap();
    builder.add("footprint", fixed("f", next), Link::new("hull", ball(1.0))).unwrap();
    builder.add("hull", revolute("j", Vector3::z()), Link::new("arm", ball(1.0))).unwrap();
    let model = builder.build().unwrap();
    assert_eq!(model.body_names().collect::<Vec<_>>(), ["world", "arm"]);
    let com = model.nodes()[0].com.to_nalgebra();
    assert!((com - (pose * next).translation.vector).norm() < 1e-14, "the hull is a ball about its origin");
    let identity = Isometry3::identity();
    for (name, expected) in [("world", identity), ("footprint", pose), ("hull", pose * next), ("eye", eye)] {
        let frame = &model.frames()[model.frame(name).unwrap()];
        assert_eq!(frame.body, 0);
        assert!((frame.pos_kf.to_nalgebra() - expected.translation.vector).norm() < 1e-14, "{name}");
        let turn = frame.rot_kf.to_nalgebra() - expected.rotation.to_rotation_matrix().matrix();
        assert!(turn.norm() < 1e-14, "{name}");
    }
}

/// A chain whose link axes are rotated by `turns`, with otherwise the same bodies and joints in space.
fn chain(turns: &[UnitQuaternion<f64>], seed: u64) -> Model {
    let mut random = Random::new(seed);
    let mut builder = ModelBuilder::new("r", Link::new("base", Some(random.inertial()))).unwrap();
    let (mut above, mut parent) = (UnitQuaternion::identity(), "base".to_owned());
    for (i, turn) in turns.iter().enumerate() {
        let (inertial, pose, axis) = (random.inertial(), random.pose(), random.vector());
        let (own, name) = (Isometry3::from_parts(Vector3::zeros().into(), *turn), format!("l{i}"));
        let axis = turn.inverse() * axis;
        let kind = if i % 2 == 0 { JointKind::Revolute(axis) } else { JointKind::Prismatic(axis) };
        let origin = Isometry3::from_parts(Vector3::zeros().into(), above.inverse()) * pose * own;
        let (r, c) = (turn.inverse().to_rotation_matrix(), turn.inverse() * inertial.com);
        let inertia = r * inertial.inertia * r.transpose();
        let inertia = (inertia + inertia.transpose()) / 2.0;
        let link = Link::new(&name, Some(Inertial { mass: inertial.mass, com: c, inertia }));
        builder.add(&parent, Joint::new(&format!("j{i}"), kind, origin), link).unwrap();
        (above, parent) = (*turn, name);
    }
    builder.build().unwrap()
}

#[test]
fn the_axes_that_links_are_drawn_in_do_not_matter() {
    for seed in 1..10 {
        let mut random = Random::new(100 + seed);
        let turns: Vec<_> = (0..5).map(|_| UnitQuaternion::from_scaled_axis(random.vector() * 3.0)).collect();
        let plain = chain(&[UnitQuaternion::identity(); 5], seed);
        let turned = chain(&turns, seed);
        let (mut q, v) = (neutral(&plain), random.numbers(plain.nv()));
        q[7..].copy_from_slice(&random.numbers(5));
        let measure = |model: &Model| {
            let (nv, mut data) = (model.nv(), Data::new(model));
            let mut m = vec![0.0; nv * nv];
            mass_matrix(model, &mut data, &q, &mut m);
            kinematics(model, &mut data, &q, &v);
            (m, kinetic_energy(model, &data, &v), center_of_mass(&data, &q).to_nalgebra())
        };
        let ((m, energy, com), (m2, energy2, com2)) = (measure(&plain), measure(&turned));
        assert!(m.iter().zip(&m2).all(|(a, b)| (a - b).abs() < 1e-12), "seed {seed}");
        assert!((energy - energy2).abs() < 1e-12 * energy, "seed {seed}");
        assert!((com - com2).norm() < 1e-13, "seed {seed}");
    }
}

#[test]
fn a_frame_moves_with_its_link_about_any_axis() {
    let axis = Vector3::new(1.0, -2.0, 0.5);
    let (mut builder, offset) = (robot(), Vector3::new(0.3, 0.1, -0.2));
    builder.add("base", revolute("j", axis), Link::new("l", ball(1.0))).unwrap();
    builder.add_frame("tip", "l", Isometry3::translation(offset.x, offset.y, offset.z)).unwrap();
    let model = builder.build().unwrap();
    let (mut data, mut q) = (Data::new(&model), neutral(&model));
    q[7] = 0.8;
    positions(&model, &mut data, &q);
    let tip = frame_pose(&model, &data, &q, model.frame("tip").unwrap());
    let turn = Rotation3::from_axis_angle(&nalgebra::Unit::new_normalize(axis), 0.8);
    assert!((tip.pos_w.to_nalgebra() - turn * offset).norm() < 1e-15);
    assert!((tip.rot_wf.to_nalgebra() - turn.matrix()).norm() < 1e-15);
}
