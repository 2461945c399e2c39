//! Checks that batches with wrong lengths, frames or robots return errors and never panic.
#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test

mod common;

use common::{Random, random_model, random_state};
use onorbit_core::batch::{
    Evaluator, InputError, Kernel, Rollout, RolloutControl, Rows, Times, Wrenches, kepler_states, propagate,
};
use onorbit_core::control::ComputedTorque;
use onorbit_core::model::{Inertial, Joint, JointKind, Link, Model, ModelBuilder};
use onorbit_core::orbit::{Elements, Kepler, Orbit, OrbitError, Size, StateRows};
use onorbit_core::reference::{Hold, TaskReference};
use onorbit_core::simulation::Integrator;
use onorbit_core::spatial::{Fused, Real};
use std::sync::{Arc, atomic::AtomicBool};

const NO_WRENCH: &[Wrenches<'_>] = &[];

/// Runs both ways to compute, with outputs of these lengths.
fn refuse(
    kernel: Kernel,
    model: &Model,
    inputs: &[Rows<'_>],
    external: &[Wrenches<'_>],
    lengths: &[usize],
) -> InputError {
    let mut outputs: Vec<Vec<f64>> = lengths.iter().map(|&length| vec![7.0; length]).collect();
    let mut slices: Vec<&mut [f64]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
    let one = Evaluator::new(model).single(kernel, model, inputs, external, &mut slices).unwrap_err();
    let many = Evaluator::many(kernel, model, inputs, external, &mut slices, Some(1)).unwrap_err();
    assert_eq!(one, many);
    assert!(outputs.iter().flatten().all(|x| *x == 7.0));
    assert!(!one.to_string().is_empty());
    one
}

#[test]
fn outputs_of_another_length_are_refused() {
    let model = random_model(3, 4);
    let (q, v) = random_state(&model, &mut Random::new(30));
    let (nq, nv) = (model.nq(), model.nv());
    let inputs = [Rows { data: &q, width: nq }, Rows { data: &v, width: nv }];
    for wrong in [0, nv - 1, nv + 1, 2 * nv] {
        let error = refuse(Kernel::BiasForces, &model, &inputs, NO_WRENCH, &[wrong]);
        assert_eq!(error, InputError::WrongOutput { output: 0, expected: nv, got: wrong });
    }
    for wrong in [&[][..], &[nv, nv]] {
        let error = refuse(Kernel::BiasForces, &model, &inputs, NO_WRENCH, wrong);
        assert_eq!(error, InputError::WrongCount { what: "outputs", expected: 1, got: wrong.len() });
    }
}

#[test]
fn inputs_that_are_missing_or_ragged_are_refused() {
    let model = random_model(3, 4);
    let (mut q, v) = random_state(&model, &mut Random::new(30));
    let (nq, nv) = (model.nq(), model.nv());
    let (one, other) = (Rows { data: &q, width: nq }, Rows { data: &v, width: nv });
    for inputs in [&[][..], &[one], &[one, other, other]] {
        let error = refuse(Kernel::BiasForces, &model, inputs, NO_WRENCH, &[nv]);
        assert_eq!(error, InputError::WrongCount { what: "inputs", expected: 2, got: inputs.len() });
    }
    q.extend([0.0; 3]); // part of a second state
    let inputs = [Rows { data: &q, width: nq }, other];
    let error = refuse(Kernel::BiasForces, &model, &inputs, NO_WRENCH, &[nv]);
    assert_eq!(error, InputError::Ragged { name: "q", width: nq, got: nq + 3 });
}

#[test]
fn unknown_frames_are_refused() {
    let model = random_model(3, 4);
    let (q, v) = random_state(&model, &mut Random::new(30));
    let count = model.frames().len();
    let inputs = [Rows { data: &q, width: model.nq() }, Rows { data: &v, width: model.nv() }];
    let error = refuse(Kernel::FramePose(count), &model, &inputs[..1], NO_WRENCH, &[16]);
    assert_eq!(error, InputError::UnknownFrame { frame: count, count });
    let wrench = [Wrenches { frame: usize::MAX, rows: &[0.0; 6] }];
    let error = refuse(Kernel::BiasForces, &model, &inputs, &wrench, &[model.nv()]);
    assert_eq!(error, InputError::UnknownFrame { frame: usize::MAX, count });
}

/// Returns a base of this mass, kg, with one arm.
fn with_base_of(mass: f64) -> Model {
    let mut random = Random::new(7);
    let base = Link::new("base", Some(Inertial { mass, ..random.inertial() }));
    let mut builder = ModelBuilder::new("two", base).unwrap();
    let joint = Joint::new("joint", JointKind::Revolute(random.vector()), random.pose());
    builder.add("base", joint, Link::new("arm", Some(random.inertial()))).unwrap();
    builder.build().unwrap()
}

#[test]
fn a_single_state_must_fit_the_robot() {
    let (small, large) = (random_model(3, 4), random_model(5, 9));
    let heavier = with_base_of(5.0); // of equal length, with bases that differ
    let lighter = with_base_of(2.0);
    let mut evaluator = Evaluator::new(&small);
    for model in [&large, &small, &heavier, &lighter] {
        let (q, v) = random_state(model, &mut Random::new(30));
        let inputs = [Rows { data: &q, width: model.nq() }, Rows { data: &v, width: model.nv() }];
        let (mut one, mut same) = (vec![0.0; model.nv()], vec![0.0; model.nv()]);
        evaluator.single(Kernel::BiasForces, model, &inputs, &[], &mut [&mut one]).unwrap();
        Evaluator::new(model).single(Kernel::BiasForces, model, &inputs, &[], &mut [&mut same]).unwrap();
        assert_eq!(one, same);
    }
    let none = [Rows { data: &[], width: small.nq() }, Rows { data: &[], width: small.nv() }];
    let error = evaluator.single(Kernel::BiasForces, &small, &none, &[], &mut [&mut []]).unwrap_err();
    assert_eq!(error, InputError::NotSingle { got: 0 });
}

#[test]
fn rollouts_refuse_frames_and_ragged_states() {
    let model = random_model(3, 9);
    let (q0, v0) = random_state(&model, &mut Random::new(30));
    let stop = AtomicBool::new(false);
    let law = ComputedTorque::new(model.frames().len(), 1.0, 1.0);
    let hold = Hold::new(nalgebra::Matrix3::identity(), nalgebra::Vector3::zeros()).unwrap();
    let reference = TaskReference::from(hold);
    let rollout = Rollout {
        steps: 2,
        time_step: 1e-3,
        integrator: Integrator::Rk4,
        control: RolloutControl::ComputedTorque(&law, &reference),
        record_every: None,
        threads: Some(1),
        stop: &stop,
    };
    let (mut q, mut v) = (q0.clone(), v0.clone());
    let error = rollout.run(&model, &q0, &v0, &mut q, &mut v).unwrap_err();
    assert!(matches!(error, InputError::UnknownFrame { .. }), "{error}");
    let passive = Rollout { control: RolloutControl::Passive, ..rollout };
    let two = [&q0[..], &q0[..3]].concat();
    let error = passive.run(&model, &two, &v0, &mut q, &mut v).unwrap_err();
    assert!(matches!(error, InputError::Ragged { name: "q0", .. }), "{error}");
}

#[test]
fn orbits_refuse_ragged_rows() {
    let one: &[f64] = &[0.0];
    let elements = [&[7e6][..], one, one, one, one, one, one];
    for length in [1, 2, 4] {
        let (mut r, mut v) = (vec![0.0; length], vec![0.0; length]);
        let error = kepler_states(elements, 4e14, &mut r, &mut v, Some(1)).unwrap_err();
        assert_eq!(error, InputError::Ragged { name: "positions", width: 3, got: length });
    }
    let orbit = Kepler::new(&Elements::new(Size::SemiMajorAxis(7e6), 0.0)).unwrap();
    let orbits: Vec<Arc<dyn Orbit>> = vec![Arc::new(orbit), Arc::new(orbit)];
    let (mut r, mut v) = ([0.0; 6], [0.0; 6]);
    let error = propagate(&orbits, Times::Each(&[0.0, 1.0, 2.0]), &mut r, &mut v, Some(1)).unwrap_err();
    assert_eq!(error, InputError::UnevenTimes { orbits: 2, got: 3 });
    // orbits with more instants than rows, and with fewer
    for times in [&[0.0, 1.0, 2.0][..], &[0.0]] {
        let rows = StateRows::new(2, &mut r, &mut v).unwrap();
        let error = orbit.fill(times, rows).unwrap_err();
        assert_eq!(error, OrbitError::WrongRows { expected: times.len(), got: 2 });
    }
}

/// Outside of `enter`, sines of several angles at once have the same bits as one at a time.
#[test]
fn sin_cos_each_works_outside_an_entry_point() {
    let angles: Vec<Fused> = (0..7).map(|k| Fused(0.37 * f64::from(k) - 1.0)).collect();
    let mut out = vec![Default::default(); 7];
    Fused::sin_cos_each(&angles, &mut out);
    for (angle, (s, c)) in angles.iter().zip(out) {
        assert!((s.0 - angle.0.sin()).abs() < 2e-16 && (c.0 - angle.0.cos()).abs() < 2e-16);
    }
}
