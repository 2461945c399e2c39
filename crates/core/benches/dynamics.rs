//! Benches of the kernels on a torso with one (nv = 13) or two (nv = 20) seven-joint arms. The state varies
//! from call to call.
#![allow(missing_docs, clippy::unwrap_used)] // criterion's macros write undocumented items

mod common;

use common::torso;
use criterion::{Criterion, criterion_group, criterion_main};
use onorbit_core::dynamics::{
    Data, FreeFloating, bias_forces, center_of_mass, forward_dynamics, frame_drift, frame_jacobian,
    free_floating, inverse_dynamics, kinematics, kinetic_energy, mass_matrix, momentum, positions,
};
use onorbit_core::model::{difference, integrate};
use onorbit_core::spatial::{Fused, Real};
use std::hint::black_box;

const STATES: usize = 256;

fn numbers<S: Real>(n: usize, seed: usize) -> Vec<S> {
    (0..n).map(|i| S::of((1.3 * i as f64 + 0.7 * seed as f64 + 0.1).sin())).collect()
}

fn kernels<S: Real>(c: &mut Criterion, scalar: &str, arms: usize) {
    let model = torso(arms);
    let (nv, tool) = (model.nv(), model.frames().len() - 1);
    let states: Vec<_> = (0..STATES)
        .map(|k| {
            let mut q: Vec<S> = numbers(model.nq(), k);
            [0.0, 0.0, 0.6, 0.8].iter().enumerate().for_each(|(i, x)| q[3 + i] = S::of(*x));
            (q, numbers::<S>(nv, k + 1), numbers::<S>(nv, k + 2))
        })
        .collect();
    let (mut data, mut ff) = (Data::new(&model), FreeFloating::new(&model));
    let (mut out, mut matrix) = (vec![S::of(0.0); nv], vec![S::of(0.0); nv * nv]);
    let mut group = c.benchmark_group(format!("{scalar}/nv{nv}"));
    let mut k = 0;
    let mut next = || {
        k = (k + 1) % STATES;
        black_box(&states[k])
    };
    group.bench_function("aba", |b| {
        b.iter(|| {
            let (q, v, tau) = next();
            forward_dynamics(&model, &mut data, q, v, tau, &[], &mut out);
        });
    });
    group.bench_function("rnea", |b| {
        b.iter(|| {
            let (q, v, a) = next();
            inverse_dynamics(&model, &mut data, q, v, a, &[], &mut out);
        });
    });
    group.bench_function("bias_forces", |b| {
        b.iter(|| {
            let (q, v, _) = next();
            bias_forces(&model, &mut data, q, v, &[], &mut out);
        });
    });
    group.bench_function("crba", |b| {
        b.iter(|| {
            let (q, _, _) = next();
            mass_matrix(&model, &mut data, q, &mut matrix);
        });
    });
    group.bench_function("kinematics", |b| {
        b.iter(|| {
            let (q, v, _) = next();
            kinematics(&model, &mut data, q, v);
        });
    });
    group.bench_function("frame_jacobian_and_drift", |b| {
        b.iter(|| {
            let (q, v, _) = next();
            kinematics(&model, &mut data, q, v);
            frame_jacobian(&model, &data, q, tool, &mut matrix[..6 * nv]);
            frame_drift(&model, &data, q, v, tool)
        });
    });
    group.bench_function("momentum", |b| {
        b.iter(|| {
            let (q, v, _) = next();
            kinematics(&model, &mut data, q, v);
            momentum(&data, q)
        });
    });
    group.bench_function("kinetic_energy", |b| {
        b.iter(|| {
            let (q, v, _) = next();
            kinematics(&model, &mut data, q, v);
            kinetic_energy(&model, &data, v)
        });
    });
    group.bench_function("center_of_mass", |b| {
        b.iter(|| {
            let (q, _, _) = next();
            positions(&model, &mut data, q);
            center_of_mass(&data, q)
        });
    });
    let mut moved = vec![S::of(0.0); model.nq()];
    group.bench_function("integrate", |b| {
        b.iter(|| {
            let (q, v, _) = next();
            integrate(q, v, &mut moved);
        });
    });
    group.bench_function("difference", |b| {
        b.iter(|| {
            let (q, v, _) = next();
            integrate(q, v, &mut moved);
            difference(q, &moved, &mut out);
        });
    });
    group.bench_function("free_floating", |b| {
        b.iter(|| {
            let (q, v, _) = next();
            free_floating(&model, &mut data, q, v, tool, &[], &mut ff);
        });
    });
    group.finish();
}

fn benches(c: &mut Criterion) {
    for arms in [1, 2] {
        kernels::<f64>(c, "plain", arms);
        if Fused::is_available() {
            kernels::<Fused>(c, "fused", arms);
        }
    }
}

criterion_group! {
    name = dynamics;
    config = Criterion::default().sample_size(20).warm_up_time(std::time::Duration::from_millis(200))
        .measurement_time(std::time::Duration::from_millis(600)).without_plots();
    targets = benches
}
criterion_main!(dynamics);
