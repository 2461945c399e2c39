//! Checks that invalid lengths and indices are errors, never panics, at the public functions of every module.
#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test

mod common;

use common::random_model;
use common::touch::side;
use nalgebra::Vector3;
use onorbit_core::contact::{Contact, ContactError};
use onorbit_core::control::{Compliance, ComputedTorque, Control, ControlError, Law, check_controls};
use onorbit_core::environment::surfaces::{Optics, Surface, SurfaceError};
use onorbit_core::environment::{BodyWrench, EnvironmentError};
use onorbit_core::geometry::Shape;
use onorbit_core::gravity::{GravityError, GravityField};
use onorbit_core::model::Frame;
use onorbit_core::reference::{Hold, JointHold, ReferenceError, TaskReference, joint_table, task_table};
use onorbit_core::spatial::{Spline, SplineError};

#[test]
fn frames_and_bodies_the_robot_does_not_have() {
    let model = random_model(3, 9);
    let (frames, bodies) = (model.frames().len(), model.nodes().len());
    let wrench = BodyWrench::on_frame(&model, frames, Vector3::x(), Vector3::x()).unwrap_err();
    assert_eq!(wrench, EnvironmentError::UnknownFrame { frame: frames, count: frames });
    let law = ComputedTorque::new(frames, 1.0, 1.0);
    let unknown = |error: ControlError| matches!(error, ControlError::NoSuchFrame { frame, count } if frame == frames && count == frames);
    assert!(unknown(law.check(&model).unwrap_err()));
    let hold = || TaskReference::from(Hold::new(nalgebra::Matrix3::identity(), Vector3::zeros()).unwrap());
    let gain = ComputedTorque::diagonal([1.0; 6]);
    for law in [
        Law::TaskComputedTorque(Box::new(law), hold()),
        Law::Compliance(
            Box::new(Compliance { frame: frames, stiffness: gain, damping: gain, null_space_damping: 0.0 }),
            hold(),
        ),
    ] {
        let control = Control::new("arm", (0..model.joint_count()).collect(), law);
        let refused = check_controls(&[control], &model).unwrap_err();
        assert!(refused.to_string().starts_with("control 'arm': frame "), "{refused}");
        let ControlError::OfControl { source, .. } = refused else { panic!("{refused}") };
        assert!(unknown(*source));
    }
    let error = Surface::from_shapes(&model, bodies, 2.2, Optics::default()).unwrap_err();
    let unknown =
        |error: &SurfaceError| matches!(error, SurfaceError::UnknownBody { body, .. } if body.body == bodies);
    assert!(unknown(&error), "{error}");
    let elsewhere = Frame { body: bodies, ..model.frames()[0].clone() };
    let (areas, x) = ([1.0], [[1.0, 0.0, 0.0]]);
    let plates = Surface::plates(&model, &elsewhere, &areas, &x, &x, 2.2, Optics::default());
    assert!(unknown(&plates.unwrap_err()));
}

#[test]
fn tables_without_room() {
    let times = [0.0, 1.0];
    let path = JointHold::new(vec![0.1, 0.2, 0.3]).unwrap();
    let (mut a, mut b, mut short) = ([0.0; 6], [0.0; 6], [0.0; 5]);
    let error = joint_table(&path, &times, [&mut a, &mut b, &mut short]).unwrap_err();
    assert_eq!(error, ReferenceError::WrongLength { name: "accelerations", expected: 6, got: 5 });
    let hold = TaskReference::from(Hold::new(nalgebra::Matrix3::identity(), Vector3::zeros()).unwrap());
    let (mut v, mut dv) = ([0.0; 12], [0.0; 12]);
    let error = task_table(&hold, false, &times, [&mut a, &mut v, &mut dv]).unwrap_err();
    assert_eq!(error, ReferenceError::WrongLength { name: "poses", expected: 32, got: 6 });
    let field = GravityField::zonal(2).unwrap();
    let error = field.accelerations(&[7e6, 0.0, 0.0, 7e6], &mut [0.0; 3]).unwrap_err();
    assert!(matches!(error, GravityError::WrongLength { name: "positions", got: 4, .. }), "{error}");
}

#[test]
fn contacts_with_an_empty_side() {
    let piece = || side(0, 0, Shape::Sphere { radius: 1.0 });
    for sides in [[vec![], vec![piece()]], [vec![piece()], vec![]], [vec![], vec![]]] {
        let contact = Contact {
            name: "touch".to_owned(),
            sides,
            law: None,
            impact: None,
            may_start_overlapping: false,
        };
        assert_eq!(contact.check(), Err(ContactError::NoPieces { contact: "touch".to_owned() }));
    }
}

#[test]
fn curves_of_no_numbers() {
    let error = Spline::resting(&[0.0, 1.0], 0, &[]).unwrap_err();
    assert!(matches!(error, SplineError::WrongLength { name: "values", .. }), "{error}");
}
