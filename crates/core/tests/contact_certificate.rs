//! Certificates of runs in which bodies press on each other for some seconds.
#![allow(clippy::unwrap_used)]

mod common;

use common::touch::{contact, side};
use nalgebra::Matrix3;
use onorbit_core::contact::{Contact, ContactLaw, Friction, NormalLaw};
use onorbit_core::control::{Control, GripForce, Law, PerJoint};
use onorbit_core::geometry::Shape;
use onorbit_core::model::Model;
use onorbit_core::model::urdf::from_str;
use onorbit_core::simulation::{Certificate, Simulation, certify};
use onorbit_core::spatial::Vec3;
use onorbit_core::world::System;
use std::sync::Arc;

/// Returns a palm with three fingers on revolute joints at 120 degrees about z.
fn hand() -> Model {
    let palm = r#"<link name="palm"><inertial><origin xyz="0 0 0.06"/><mass value="4"/>
        <inertia ixx="0.009" iyy="0.009" izz="0.011" ixy="0" ixz="0" iyz="0"/></inertial></link>"#;
    let finger = |number: usize| {
        let angle = std::f64::consts::TAU * number as f64 / 3.0;
        let (x, y) = (0.055 * angle.cos(), 0.055 * angle.sin());
        format!(
            r#"<joint name="knuckle_{number}" type="revolute"><parent link="palm"/><child link="finger_{number}"/>
            <origin xyz="{x} {y} 0.11" rpy="0 0 {angle}"/><axis xyz="0 1 0"/>
            <limit lower="-0.6" upper="0.6" effort="20" velocity="1"/><dynamics damping="0.02"/></joint>
            <link name="finger_{number}"><inertial><origin xyz="0 0 0.06"/><mass value="0.4"/>
            <inertia ixx="0.0006" iyy="0.0006" izz="5e-05" ixy="0" ixz="0" iyz="0"/></inertial></link>"#
        )
    };
    let fingers: String = (0..3).map(finger).collect();
    from_str(&format!(r#"<robot name="hand">{palm}{fingers}</robot>"#), None, &Default::default()).unwrap()
}

/// Returns the contact of a finger with the pin.
fn touch(model: &Model, number: usize) -> Contact {
    let frame = model.frame(&format!("finger_{number}")).unwrap();
    let mut sides = [
        side(0, frame, Shape::Capsule { radius: 0.012, half_length: 0.055 }),
        side(1, 0, Shape::Cylinder { radius: 0.03, half_length: 0.1 }),
    ];
    sides[0].pose.pos = Vec3::new(0.0, 0.0, 0.055);
    let normal = NormalLaw::HuntCrossley { stiffness: 2e4, exponent: 1.0, dissipation: 50.0 };
    let friction = Friction {
        static_coefficient: 0.6,
        kinetic_coefficient: 0.6,
        stiffness: 2e4,
        damping: None,
        torsional: 0.0,
    };
    contact(&format!("finger_{number}"), sides, ContactLaw { normal, friction: Some(friction) })
}

/// Returns the certificate of the hand after 5 s, of which it holds a pin for 4 s. An elastic impact lasts
/// `count` steps.
fn grip(time_step: f64, count: usize) -> Certificate {
    let model = Arc::new(hand());
    let mut q = vec![0.0; model.nq()];
    q[6] = 1.0;
    let law = GripForce {
        closing_rate: PerJoint::from(-0.2),
        damping: PerJoint::from(0.2),
        stiffness: PerJoint::from(20.0),
        ramp: 0.2,
        ..GripForce::new(25.0, -0.2, 0.2)
    };
    let mut gripper = System::new("hand", Arc::clone(&model), q, vec![0.0; model.nv()]);
    gripper.controls = vec![Control::new("grip", vec![0, 1, 2], Law::Grip(Box::new(law)))];
    gripper.control_period = Some(5e-3);
    let pin = Arc::new(Model::rigid_body(20.0, Matrix3::from_diagonal(&[0.2, 0.2, 0.1].into())).unwrap());
    let held = System::new("pin", pin, vec![0.0, 0.0, 0.21, 0.0, 0.0, 0.0, 1.0], vec![0.0; 6]);
    let mut simulation = Simulation::of(vec![gripper, held]);
    simulation.contacts = (0..3).map(|number| touch(&model, number)).collect();
    simulation.contact_steps.count = count;
    (simulation.time_step, simulation.record_every) = (time_step, 1000);
    let recording = simulation.run(5.0).unwrap();
    let forces = &recording.systems[0].tau;
    assert!(forces[forces.len() - 1].abs() > 1.0, "the hand does not grip");
    certify(&model, &recording.systems[0])
}

/// These fingers are exactly symmetric. `tests/test_grip_force.py` has the regression with the rounded
/// numbers of the bundled hand, where the rounding errors of the contacts are larger.
#[test]
fn a_long_grip_by_independent_fingers_is_green() {
    for time_step in [5e-3, 1e-3] {
        let certificate = grip(time_step, 128);
        println!("{certificate:#?}");
        assert!(certificate.passed(), "{certificate:#?}");
        assert!(certificate.joint_step_doubling_rel.unwrap() < 1e-5);
        assert!(certificate.position_step_doubling_rel.unwrap() < 1e-6);
    }
}

/// Negative control: steps of a quarter of an impact do not resolve the grip.
#[test]
fn a_grip_with_steps_that_are_too_long_is_red() {
    let certificate = grip(5e-3, 4);
    println!("{certificate:#?}");
    assert!(certificate.joint_step_doubling_rel.unwrap() > 2e-4, "{certificate:#?}");
}
