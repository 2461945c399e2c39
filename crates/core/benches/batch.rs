//! Benches of batches on one thread: 1024 states of forward dynamics, and rollouts of 1024 runs of 100 steps.
//! The throughput is given in states and in steps of one run.
#![allow(missing_docs, clippy::unwrap_used)] // criterion's macros write undocumented items

mod common;

use common::torso;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use nalgebra::{Matrix3, Vector3};
use onorbit_core::batch::{Evaluator, Kernel, Rollout, RolloutControl, Rows};
use onorbit_core::control::ComputedTorque;
use onorbit_core::reference::Hold;
use onorbit_core::simulation::Integrator;
use onorbit_core::spatial::InstructionSet;
use std::hint::black_box;
use std::sync::atomic::AtomicBool;

const STATES: usize = 1024;
const STEPS: usize = 100;

fn numbers(n: usize, seed: f64) -> Vec<f64> {
    (0..n).map(|i| (1.3 * i as f64 + seed).sin()).collect()
}

fn batches(c: &mut Criterion, arms: usize, level: InstructionSet) {
    let model = torso(arms);
    let (nq, nv) = (model.nq(), model.nv());
    let mut q = numbers(STATES * nq, 0.1);
    q.chunks_mut(nq).for_each(|row| row[3..7].copy_from_slice(&[0.0, 0.0, 0.6, 0.8]));
    let (v, tau) = (numbers(STATES * nv, 0.2), numbers(STATES * nv, 0.3));
    let mut group = c.benchmark_group(format!("{}/nv{nv}", level.name()));
    group.throughput(Throughput::Elements(STATES as u64));
    group.bench_function("forward_dynamics", |b| {
        let mut a = vec![0.0; STATES * nv];
        b.iter(|| {
            let rows =
                [(&q, nq), (&v, nv), (&tau, nv)].map(|(data, width)| Rows { data: black_box(data), width });
            Evaluator::many(Kernel::ForwardDynamics, &model, &rows, &[], &mut [&mut a], Some(1)).unwrap();
        });
    });
    group.throughput(Throughput::Elements((STATES * STEPS) as u64));
    group.bench_function("rollout_rk4", |b| {
        let (mut to_q, mut to_v, stop) = (q.clone(), v.clone(), AtomicBool::new(false));
        let rollout = Rollout {
            steps: STEPS,
            time_step: 1e-3,
            integrator: Integrator::Rk4,
            control: RolloutControl::Passive,
            record_every: None,
            threads: Some(1),
            stop: &stop,
        };
        b.iter(|| rollout.run(&model, black_box(&q), &v, &mut to_q, &mut to_v).unwrap());
    });
    if arms == 1 {
        group.bench_function("rollout_computed_torque", |b| {
            let (mut to_q, mut to_v, stop) = (q.clone(), v.clone(), AtomicBool::new(false));
            let law = ComputedTorque::new(model.frames().len() - 1, 4.0, 4.0);
            let hold = Hold::new(Matrix3::identity(), Vector3::new(0.2, 0.0, 0.5)).unwrap().into();
            let rollout = Rollout {
                steps: STEPS,
                time_step: 1e-3,
                integrator: Integrator::SemiImplicitEuler, // the law once per evaluation
                control: RolloutControl::ComputedTorque(&law, &hold),
                record_every: None,
                threads: Some(1),
                stop: &stop,
            };
            // diverging states cost the same
            b.iter(|| _ = rollout.run(&model, black_box(&q), &v, &mut to_q, &mut to_v));
        });
    }
    group.finish();
}

fn benches(c: &mut Criterion) {
    let best = InstructionSet::current();
    for level in [InstructionSet::Baseline, InstructionSet::Fused, InstructionSet::Wide] {
        if level <= best {
            InstructionSet::limit(level);
            batches(c, 1, level);
            batches(c, 2, level);
        }
    }
}

criterion_group! {
    name = batch;
    config = Criterion::default().sample_size(10).warm_up_time(std::time::Duration::from_millis(200))
        .measurement_time(std::time::Duration::from_millis(800)).without_plots();
    targets = benches
}
criterion_main!(batch);
