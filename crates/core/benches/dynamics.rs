//! Kernels on a torso with one (nv = 13) or two (nv = 20) seven-joint arms; states vary per call.
#![allow(missing_docs, clippy::unwrap_used)] // criterion's macros write undocumented items

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{Isometry3, Matrix3, Vector3};
use onorbit_core::dynamics::{
    Data, FreeFloating, bias_forces, forward_dynamics, frame_drift, frame_jacobian, free_floating,
    inverse_dynamics, kinematics, mass_matrix, momentum,
};
use onorbit_core::model::{Inertial, Joint, JointKind, Link, Model, ModelBuilder};
use onorbit_core::spatial::{Fused, Real};
use std::hint::black_box;

const MASS: [f64; 7] = [2.741, 2.425, 2.209, 0.877, 1.878, 0.409, 0.308];
const LENGTH: [f64; 7] = [0.28, 0.144, 0.0, 0.274, 0.265, 0.0, 0.0];
const STATES: usize = 256;

fn torso(arms: usize) -> Model {
    let body = |mass: f64, z: f64, moments: [f64; 3]| {
        let inertia = Matrix3::from_diagonal(&Vector3::from(moments));
        Some(Inertial { mass, com: Vector3::new(0.0, 0.0, z), inertia })
    };
    let base = Link::new("torso", body(93.0, 0.0, [18.6, 15.4, 4.1]));
    let mut builder = ModelBuilder::new("torso", base).unwrap();
    for arm in 0..arms {
        let (mut parent, mut origin) = ("torso".to_owned(), Vector3::new(0.0, 0.25 - 0.5 * arm as f64, 0.5));
        for i in 0..7 {
            let axis = if i % 2 == 0 { Vector3::z() } else { Vector3::y() };
            let name = format!("arm{arm}_link{i}");
            let joint = Joint::new(
                &format!("arm{arm}_joint{i}"),
                JointKind::Revolute(axis),
                Isometry3::translation(origin.x, origin.y, origin.z),
            );
            let link = Link::new(&name, body(MASS[i], LENGTH[i] / 2.0, [0.012, 0.011, 0.01]));
            builder.add(&parent, joint, link).unwrap();
            (parent, origin) = (name, Vector3::new(0.0, 0.0, LENGTH[i]));
        }
    }
    builder.build().unwrap()
}

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
            bias_forces(&model, &mut data, q, v, &mut out);
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
