//! Closed loops against the dense equations with Lagrange multipliers, for random trees.
#![allow(clippy::unwrap_used)] // a test that cannot set up should stop

mod common;

use common::{Random, random_model, random_state};
use nalgebra::{DMatrix, DVector, Isometry3, Rotation3};
use onorbit_core::dynamics::{
    ClosedLoops, Data, bias_forces, close_velocity, closure_errors, constrained_forward_dynamics,
    constrained_free_floating, frame_drift, frame_jacobian, frame_pose, kinematics, mass_matrix, positions,
};
use onorbit_core::model::{Loop, LoopKind, Model, integrate};
use onorbit_core::spatial::{Fused, Real};

const KINDS: [LoopKind; 5] =
    [LoopKind::Weld, LoopKind::Revolute, LoopKind::Spherical, LoopKind::Prismatic, LoopKind::Distance];

/// Returns a random robot whose loops of these kinds are closed at a random configuration, which is returned too.
fn closed(seed: u64, links: usize, kinds: &[LoopKind]) -> (Model, Vec<f64>) {
    let (model, mut random) = (random_model(seed, links), Random::new(seed + 1));
    let (q, _) = random_state(&model, &mut random);
    let mut data = Data::<f64>::new(&model);
    positions(&model, &mut data, &q);
    let mut loops = Vec::new();
    for (i, &kind) in kinds.iter().enumerate() {
        let frame = |random: &mut Random| random.index(model.frames().len());
        let (mut a, mut b) = (frame(&mut random), frame(&mut random));
        while model.frames()[a].body == model.frames()[b].body {
            (a, b) = (frame(&mut random), frame(&mut random));
        }
        let pose = |frame: usize| {
            let pose = frame_pose(&model, &data, &q, frame);
            let rotation = Rotation3::from_matrix_unchecked(pose.rot_wf.to_nalgebra());
            Isometry3::from_parts(pose.pos_w.to_nalgebra().into(), rotation.into())
        };
        let own = random.pose();
        let other = pose(b).inverse() * pose(a) * own;
        let length = (kind == LoopKind::Distance).then_some(0.7);
        let shift = Isometry3::translation(0.0, 0.0, length.unwrap_or(0.0));
        loops.push(Loop {
            name: format!("loop {i}"),
            kind,
            frames: [a, b].map(|frame| model.frames()[frame].name.clone()),
            poses: [own, other * shift],
            length,
            project: false,
        });
    }
    (model.closed(&loops).unwrap(), q)
}

/// Returns `φ(q)`.
fn errors(model: &Model, loops: &mut ClosedLoops<f64>, q: &[f64]) -> DVector<f64> {
    let mut data = Data::new(model);
    closure_errors(model, &mut data, loops, q);
    DVector::from_column_slice(loops.errors())
}

/// Returns `∂φ/∂δ` along `q ⊕ δ`, by central differences.
fn jacobian(model: &Model, loops: &mut ClosedLoops<f64>, q: &[f64]) -> DMatrix<f64> {
    const STEP: f64 = 1e-5;
    let at = |j: usize, step: f64| {
        let (mut delta, mut moved) = (vec![0.0; model.nv()], q.to_vec());
        delta[j] = step;
        integrate(q, &delta, &mut moved);
        moved
    };
    let columns: Vec<_> = (0..model.nv())
        .map(|j| {
            let mut value = |step: f64| errors(model, loops, &at(j, step));
            (value(STEP) - value(-STEP)) / (2.0 * STEP)
        })
        .collect();
    DMatrix::from_columns(&columns)
}

/// Returns the solution of least norm of `A x = b` for a symmetric positive semidefinite matrix, and its rank.
fn least_norm(a: DMatrix<f64>, b: &DVector<f64>) -> (DVector<f64>, usize) {
    let eigen = a.symmetric_eigen();
    let least = 1e-7 * eigen.eigenvalues.amax();
    let (mut x, mut rank) = (DVector::zeros(b.len()), 0);
    for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        if *value > least {
            x += vector * (vector.dot(b) / value);
            rank += 1;
        }
    }
    (x, rank)
}

/// Returns the acceleration from the dense equations `[M Jᵀ; J 0]`, with the drift `J̇ v` by differences, and the
/// number of independent constraints.
fn dense(model: &Model, q: &[f64], v: &[f64], tau: &[f64]) -> (DVector<f64>, usize) {
    let mut loops = ClosedLoops::new(model, model.closures());
    let (mut data, nv) = (Data::<f64>::new(model), model.nv());
    let (mut mass, mut bias) = (vec![0.0; nv * nv], vec![0.0; nv]);
    mass_matrix(model, &mut data, q, &mut mass);
    bias_forces(model, &mut data, q, v, &[], &mut bias);
    let mass = DMatrix::from_row_slice(nv, nv, &mass);
    let free = DVector::from_column_slice(tau) - DVector::from_vec(bias);
    let j = jacobian(model, &mut loops, q);
    // φ̈ = J a + d²φ(q ⊕ t v)/dt², with the second derivative along the curve of constant v
    const STEP: f64 = 2e-4;
    let mut along = |t: f64| {
        let (delta, mut moved): (Vec<f64>, _) = (v.iter().map(|v| v * t).collect(), q.to_vec());
        integrate(q, &delta, &mut moved);
        errors(model, &mut loops, &moved)
    };
    let far = along(2.0 * STEP) + along(-2.0 * STEP);
    let drift = ((along(STEP) + along(-STEP)) * 16.0 - far - along(0.0) * 30.0) / (12.0 * STEP * STEP);
    let inverse = mass.cholesky().unwrap();
    let a = inverse.solve(&free);
    let response = inverse.solve(&j.transpose());
    assert!(drift.iter().chain(j.iter()).all(|x| x.is_finite()), "{drift} {j}");
    let (force, rank) = least_norm(&j * &response, &-(&j * &a + drift));
    (a + response * force, rank)
}

/// Returns the constrained acceleration of the engine and the rank.
fn engine<S: Real>(model: &Model, q: &[f64], v: &[f64], tau: &[f64]) -> (Vec<f64>, f64) {
    let lift = |x: &[f64]| x.iter().map(|x| S::of(*x)).collect::<Vec<S>>();
    let (mut data, mut loops) = (Data::new(model), ClosedLoops::new(model, model.closures()));
    let mut a = lift(&vec![0.0; model.nv()]);
    let system = (model, &mut data, &mut loops);
    let rank = constrained_forward_dynamics(system, &lift(q), &lift(v), &lift(tau), &[], &mut a);
    (a.iter().map(|a| a.lane(0)).collect(), rank.lane(0))
}

/// Returns a velocity that satisfies the constraints.
fn permitted(model: &Model, q: &[f64], v: &[f64]) -> Vec<f64> {
    let mut loops = ClosedLoops::new(model, model.closures());
    let j = jacobian(model, &mut loops, q);
    let v = DVector::from_column_slice(v);
    let (change, _) = least_norm(&j * j.transpose(), &(&j * &v));
    (v - j.transpose() * change).as_slice().to_vec()
}

fn compare(model: &Model, q: &[f64], seed: u64) {
    let mut random = Random::new(seed + 17);
    let (_, v) = random_state(model, &mut random);
    let tau = random.numbers(model.nv());
    let v = permitted(model, q, &v);
    let (expected, rank) = dense(model, q, &v, &tau);
    let results = [engine::<f64>(model, q, &v, &tau), engine::<Fused>(model, q, &v, &tau)];
    for (a, found) in results {
        assert_eq!(found, rank as f64, "rank");
        let error = (DVector::from_vec(a) - &expected).amax() / expected.amax();
        assert!(error < 2e-6, "{error:.1e}"); // the drift by differences has errors of 1e-7
    }
}

#[test]
fn accelerations_of_closed_loops_agree_with_the_dense_equations() {
    for seed in 0..40 {
        let kinds = [KINDS[seed as usize % 5], KINDS[(seed as usize / 5) % 5]];
        let (model, q) = closed(seed, 9 + seed as usize % 7, &kinds[..1 + seed as usize % 2]);
        compare(&model, &q, seed);
    }
}

/// Returns a state of a random looped robot that satisfies the constraints.
fn closed_state(seed: u64, links: usize, kinds: &[LoopKind]) -> (Model, Vec<f64>, Vec<f64>) {
    let (model, q) = closed(seed, links, kinds);
    let mut v: Vec<f64> = Random::new(seed + 9).numbers(model.nv());
    let mut loops = ClosedLoops::new(&model, model.closures());
    close_velocity(&model, &mut Data::new(&model), &mut loops, &q, &mut v);
    (model, q, v)
}

#[test]
fn the_model_of_independent_joints_has_the_constrained_acceleration() {
    let (mut redundant, mut with_drift) = (0, 0);
    for seed in 0..40 {
        let kinds = [KINDS[seed as usize % 5], KINDS[(seed as usize / 5) % 5]];
        let (model, q, v) = closed_state(seed, 9, &kinds[..1 + seed as usize % 2]);
        let (n, nv) = (model.joint_count(), model.nv());
        let mut tau = Random::new(seed + 3).numbers(nv);
        tau[..6].fill(0.0);
        let (mut data, mut loops) = (Data::<f64>::new(&model), ClosedLoops::new(&model, model.closures()));
        let mut a = vec![0.0; nv];
        let rank = constrained_forward_dynamics((&model, &mut data, &mut loops), &q, &v, &tau, &[], &mut a);
        redundant += usize::from((rank as usize) < loops.count());

        let frame = model.frames().len() - 1;
        let reduced = constrained_free_floating(&model, (&q, &v), frame, &[], &[]);
        let f = reduced.joints.count();
        assert_eq!(f, n - rank as usize, "seed {seed}");
        // M ÿ = Gᵀ τ − c
        let inertia = DMatrix::from_row_slice(f, f, &reduced.inertia);
        let map = DMatrix::from_row_slice(n, f, &reduced.joints.map);
        let bias = DVector::from_column_slice(&reduced.bias);
        let y =
            inertia.lu().solve(&(map.transpose() * DVector::from_column_slice(&tau[6..]) - bias)).unwrap();
        let found = &map * &y + DVector::from_column_slice(&reduced.joints.drift);
        let expected = DVector::from_column_slice(&a[6..]);
        let error = (&found - &expected).amax() / (1.0 + expected.amax());
        assert!(error < 1e-10, "seed {seed}: {error:.1e}");
        // the rates of the independent joints determine all rates
        let independent = DVector::from_iterator(f, reduced.joints.independent.iter().map(|&j| v[6 + j]));
        assert!((&map * independent - DVector::from_column_slice(&v[6..])).amax() < 1e-10);
        // the task acceleration is that of the constrained motion
        kinematics(&model, &mut data, &q, &v);
        let (mut jacobian, mut task) = (vec![0.0; 6 * nv], [0.0; 6]);
        frame_jacobian(&model, &data, &q, frame, &mut jacobian);
        frame_drift(&model, &data, &q, &v, frame).write(&mut task);
        let expected = DMatrix::from_row_slice(6, nv, &jacobian) * DVector::from_column_slice(&a)
            + DVector::from_column_slice(&task);
        let found = DMatrix::from_row_slice(6, f, &reduced.jacobian) * &y
            + DVector::from_column_slice(&reduced.drift);
        assert!((&found - &expected).amax() < 1e-9 * (1.0 + expected.amax()), "seed {seed}");
        // the control: without g, the accelerations differ, unless the dependent joints cannot move
        let without = (&map * &y - DVector::from_column_slice(&a[6..])).amax();
        with_drift += usize::from(without > 1e-6);
    }
    assert!(with_drift > 4, "{with_drift}");
    assert!(redundant > 3, "{redundant}");
}
