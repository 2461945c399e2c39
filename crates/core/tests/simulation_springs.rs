//! Checks springs at joints: closed forms with every integrator, sticking against a spring, and invalid springs.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // set-up that fails should stop; --nocapture shows the numbers

mod common;

use common::slider::{INTEGRATORS, REDUCED, moving, run, slider_with, try_slider_with};
use nalgebra::Vector3;
use onorbit_core::batch::{Rollout, RolloutControl};
use onorbit_core::model::{JointChange, JointKind, JointSpring, Model, ModelError, ModelWarning};
use onorbit_core::simulation::{Integrator, certify};
use std::sync::atomic::AtomicBool;

const STIFFNESS: f64 = 50.0;
const SPRING: JointSpring = JointSpring { stiffness: STIFFNESS, cubic_stiffness: 0.0, rest_position: 0.1 };

fn sprung(spring: JointSpring, friction: f64) -> Model {
    slider_with(|joint| (joint.spring, joint.friction) = (Some(spring), friction), 0.3)
}

#[test]
fn a_slider_oscillates_as_in_the_closed_form() {
    let omega = (STIFFNESS / REDUCED).sqrt();
    for integrator in INTEGRATORS {
        let mut simulation = moving(sprung(SPRING, 0.0), 0.0, integrator, 1e-3);
        simulation.tolerance = 1e-11;
        let trace = run(&mut simulation, 3.0);
        // d = −q₀ cos ωt
        let off = trace.time.iter().enumerate().map(|(k, t)| {
            let expected = 0.1 - 0.1 * (omega * t).cos();
            (trace.q[8 * k + 7] - expected).abs()
        });
        let worst = off.fold(0.0, f64::max);
        println!("{integrator:?}: {worst:e} m off");
        assert!(worst < if integrator == Integrator::SemiImplicitEuler { 1e-3 } else { 1e-9 });
        for (k, stored) in trace.spring_energy.iter().enumerate() {
            let deflection = trace.q[8 * k + 7] - 0.1;
            assert!((stored - 0.5 * STIFFNESS * deflection * deflection).abs() < 1e-15);
        }
        if integrator != Integrator::SemiImplicitEuler {
            let certificate = certify(&simulation.systems[0].model, &trace);
            assert!(certificate.passed(), "{certificate:#?}");
        }
    }
}

#[test]
fn a_slider_sticks_while_friction_holds_the_spring() {
    // the spring pulls with 5 N
    for (friction, sticks) in [(5.001, true), (4.999, false)] {
        let mut simulation = moving(sprung(SPRING, friction), 0.0, Integrator::Rk4, 0.01);
        let trace = run(&mut simulation, 1.0);
        let moved = trace.q[trace.q.len() - 1] != 0.0;
        assert_eq!(moved, !sticks, "{friction} N");
        assert_eq!(trace.v.chunks(7).all(|v| v[6] == 0.0), sticks);
    }
}

#[test]
fn lanes_and_single_states_have_the_same_springs() {
    let spring = JointSpring { cubic_stiffness: 300.0, ..SPRING };
    let model = sprung(spring, 0.0);
    let (count, steps) = (11, 200);
    let q0: Vec<f64> =
        (0..count).flat_map(|k| [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.05 * k as f64]).collect();
    let (v0, stop) = (vec![0.0; 7 * count], AtomicBool::new(false));
    let rollout = Rollout {
        steps,
        time_step: 1e-3,
        integrator: Integrator::Rk4,
        control: RolloutControl::Passive,
        record_every: None,
        threads: Some(2),
        stop: &stop,
    };
    let (mut q, mut v) = (vec![0.0; 8 * count], vec![0.0; 7 * count]);
    rollout.run(&model, &q0, &v0, &mut q, &mut v).unwrap();
    for k in 0..count {
        let mut simulation = moving(sprung(spring, 0.0), 0.0, Integrator::Rk4, 1e-3);
        simulation.systems[0].q = q0[8 * k..8 * k + 8].to_vec();
        let trace = run(&mut simulation, 0.2);
        let alone = trace.q[trace.q.len() - 1];
        assert!((q[8 * k + 7] - alone).abs() < 1e-14, "{k}: {} {alone}", q[8 * k + 7]);
    }
}

#[test]
fn invalid_springs_are_rejected_and_softening_ones_are_warnings() {
    let built = |spring: JointSpring, kind: JointKind| {
        try_slider_with(|joint| (joint.spring, joint.kind) = (Some(spring), kind.clone()), 0.0)
    };
    let prismatic = || JointKind::Prismatic(Vector3::x());
    let error = built(JointSpring { stiffness: -1.0, ..SPRING }, prismatic()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "joint 'slide': the stiffness of the spring is -1 N/m; it must not be negative"
    );
    let error = built(JointSpring { rest_position: f64::NAN, ..SPRING }, prismatic()).unwrap_err();
    assert!(matches!(error, ModelError::NotFinite { what: "the rest position of the spring", .. }));
    let repelling = JointSpring { stiffness: 0.0, cubic_stiffness: -1.0, rest_position: 0.0 };
    assert!(matches!(built(repelling, prismatic()), Err(ModelError::RepellingSpring { .. })));
    assert!(matches!(built(SPRING, JointKind::Fixed), Err(ModelError::FixedJoint { .. })));
    let softening = JointSpring { stiffness: 3.0, cubic_stiffness: -1.0, rest_position: 0.0 };
    let model = built(softening, prismatic()).unwrap();
    let expected = ModelWarning::SofteningSpring { joint: "slide".into(), deflection: 1.0, unit: "m" };
    assert_eq!(model.warnings(), [expected]);
}

#[test]
fn a_changed_joint_keeps_its_other_properties() {
    let model = sprung(SPRING, 2.0);
    let stiffer = JointChange { joint: "slide".into(), stiffness: Some(70.0), ..JointChange::default() };
    let joint = model.with_joint(&stiffer).unwrap().joints()[0].clone();
    assert_eq!((joint.spring, joint.friction), (Some(JointSpring { stiffness: 70.0, ..SPRING }), 2.0));
    let without = JointChange { stiffness: Some(0.0), ..stiffer.clone() };
    assert_eq!(model.with_joint(&without).unwrap().joints()[0].spring, None);
    let unknown = JointChange { joint: "slid".into(), ..stiffer };
    assert_eq!(model.with_joint(&unknown).unwrap_err().suggestion(), Some("slide"));
}
