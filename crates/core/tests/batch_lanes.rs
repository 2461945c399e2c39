//! Checks that batches on SIMD lanes agree with single states, for every kernel and every instruction set of
//! this processor.
#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test

mod common;

use common::{Random, difference, random_model, random_state};
use onorbit_core::batch::{Evaluator, InputError, Kernel, Rollout, RolloutControl, Rows, Wrenches};
use onorbit_core::model::Model;
use onorbit_core::simulation::{Integrator, Simulation};
use onorbit_core::spatial::InstructionSet;
use std::sync::{Arc, atomic::AtomicBool};

/// Rounding error over a dozen bodies, with another order of summation or fused products.
const ROUNDING: f64 = 1e-11;

fn kernels(tool: usize) -> [Kernel; 16] {
    [
        Kernel::FramePose(tool),
        Kernel::FrameVelocity(tool),
        Kernel::FrameJacobian(tool),
        Kernel::MassMatrix,
        Kernel::BiasForces,
        Kernel::InverseDynamics,
        Kernel::ForwardDynamics,
        Kernel::InverseDynamicsDerivatives,
        Kernel::ForwardDynamicsDerivatives,
        Kernel::FreeFloatingDerivatives(tool),
        Kernel::Momentum,
        Kernel::KineticEnergy,
        Kernel::CenterOfMass,
        Kernel::FreeFloating(tool),
        Kernel::Integrate,
        Kernel::Difference,
    ]
}

/// Returns `count` rows of every input of a kernel.
fn inputs(kernel: Kernel, model: &Model, random: &mut Random, count: usize) -> Vec<(Vec<f64>, usize)> {
    let row = |name: &str, random: &mut Random| {
        let (q, v) = random_state(model, random);
        match name {
            "joint_acceleration" => v[6..].to_vec(),
            _ if name.starts_with('q') => q,
            _ => v,
        }
    };
    let rows = |name: &&str| {
        let data: Vec<f64> = (0..count).flat_map(|_| row(name, random)).collect();
        let width = data.len() / count;
        (data, width)
    };
    kernel.inputs().iter().map(rows).collect()
}

/// Returns all outputs of a kernel, one after the other, each over all rows.
fn many(
    kernel: Kernel,
    model: &Model,
    inputs: &[(Vec<f64>, usize)],
    threads: Option<usize>,
) -> Vec<Vec<f64>> {
    let count = inputs[0].0.len() / inputs[0].1;
    let mut outputs: Vec<Vec<f64>> =
        kernel.outputs(model).iter().map(|width| vec![0.0; width * count]).collect();
    let rows: Vec<Rows<'_>> = inputs.iter().map(|(data, width)| Rows { data, width: *width }).collect();
    let mut slices: Vec<&mut [f64]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
    Evaluator::many(kernel, model, &rows, &wrenches(), &mut slices, threads).unwrap();
    outputs
}

fn wrenches() -> [Wrenches<'static>; 1] {
    [Wrenches { frame: 1, rows: &[1.0, -2.0, 0.5, 0.3, 0.2, -0.7] }]
}

/// One test, since the instruction set is global to the process; levels that do not exist here fall back.
#[test]
fn every_kernel_on_every_instruction_set() {
    let model = random_model(7, 9);
    let tool = model.frame("tool").unwrap();
    for kernel in kernels(tool) {
        let mut random = Random::new(70);
        let states = inputs(kernel, &model, &mut random, 131); // not a multiple of the lanes or of a task
        InstructionSet::limit(InstructionSet::Baseline);
        let plain = many(kernel, &model, &states, Some(1));
        let mut single_states = Vec::new();
        for level in [InstructionSet::Fused, InstructionSet::Wide] {
            InstructionSet::limit(level);
            let lanes = many(kernel, &model, &states, Some(1));
            assert_eq!(lanes, many(kernel, &model, &states, None), "{kernel:?}: threads");
            for (lanes, plain) in lanes.iter().zip(&plain) {
                assert!(
                    difference(lanes, plain) < ROUNDING,
                    "{kernel:?} {level:?} {}",
                    difference(lanes, plain)
                );
            }
            let mut evaluator = Evaluator::new(&model);
            for k in [0, 130] {
                let one: Vec<Rows<'_>> = states
                    .iter()
                    .map(|(data, w)| Rows { data: &data[k * w..(k + 1) * w], width: *w })
                    .collect();
                let mut outputs: Vec<Vec<f64>> =
                    kernel.outputs(&model).iter().map(|w| vec![0.0; *w]).collect();
                let mut slices: Vec<&mut [f64]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
                evaluator.single(kernel, &model, &one, &wrenches(), &mut slices).unwrap();
                for (single, lanes) in outputs.iter().zip(&lanes) {
                    let row = &lanes[k * single.len()..(k + 1) * single.len()];
                    assert!(difference(single, row) < ROUNDING, "{kernel:?} {level:?} row {k}");
                }
                single_states.push(outputs);
            }
        }
        // for one state, the registers of AVX-512 (if they are used) do not change the bits
        let (fused, wide) = single_states.split_at(2);
        assert_eq!(fused, wide, "{kernel:?}");
        InstructionSet::limit(InstructionSet::Wide);
    }
}

#[test]
fn a_rollout_is_a_simulation_in_empty_space() {
    let model = random_model(11, 8);
    let mut random = Random::new(110);
    let (count, steps, h) = (19, 50, 1e-3);
    let states: Vec<_> = (0..count).map(|_| random_state(&model, &mut random)).collect();
    let q0: Vec<f64> = states.iter().flat_map(|(q, _)| q.clone()).collect();
    let v0: Vec<f64> = states.iter().flat_map(|(_, v)| v.clone()).collect();
    let stop = AtomicBool::new(false);
    let rollout = Rollout {
        steps,
        time_step: h,
        integrator: Integrator::Rk4,
        control: RolloutControl::Passive,
        record_every: None,
        threads: None,
        stop: &stop,
    };
    let (mut q, mut v) = (vec![0.0; q0.len()], vec![0.0; v0.len()]);
    rollout.run(&model, &q0, &v0, &mut q, &mut v).unwrap();
    let model = Arc::new(model);
    for (k, (q_k, v_k)) in states.iter().enumerate() {
        let mut simulation = Simulation::new(Arc::clone(&model), q_k.clone(), v_k.clone());
        simulation.time_step = h;
        let trace = simulation.run(steps as f64 * h).unwrap().only();
        let last = |column: &[f64], width: usize| column[column.len() - width..].to_vec();
        assert!(difference(&q[k * model.nq()..][..model.nq()], &last(&trace.q, model.nq())) < 1e-12);
        assert!(difference(&v[k * model.nv()..][..model.nv()], &last(&trace.v, model.nv())) < ROUNDING);
    }
}

#[test]
fn bad_input_is_refused_before_anything_is_written() {
    let model = random_model(3, 4);
    let (mut q, v) = random_state(&model, &mut Random::new(30));
    let refuse = |q: &[f64], v: &[f64], width: usize| {
        let rows = [Rows { data: q, width }, Rows { data: v, width: model.nv() }];
        let mut out = vec![7.0; 6];
        let result =
            Evaluator::new(&model).single(Kernel::Momentum, &model, &rows, &[], &mut [out.as_mut_slice()]);
        assert_eq!(out, [7.0; 6]);
        result.unwrap_err()
    };
    assert!(matches!(refuse(&q[1..], &v, q.len() - 1), InputError::WrongLength { name: "q", .. }));
    let nan = vec![f64::NAN; v.len()];
    assert!(matches!(refuse(&q, &nan, q.len()), InputError::NotFinite { name: "v", state: None, .. }));
    q[3] += 1e-3;
    assert!(matches!(refuse(&q, &v, q.len()), InputError::QuaternionNorm { state: 0, .. }));
}
