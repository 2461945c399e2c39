//! Checks identities that hold for any robot in any state, on random trees with every joint type.

#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test

mod common;

use common::{Random, difference, random_model, random_state};
use onorbit_core::dynamics::{
    Data, FrameWrench, FreeFloating, bias_forces, forward_dynamics, frame_acceleration, frame_drift,
    frame_jacobian, frame_velocity, free_floating, inverse_dynamics, kinematics, kinetic_energy, mass_matrix,
    momentum, projected_base_twist,
};
use onorbit_core::model::{Model, integrate};
use onorbit_core::spatial::{Force, Fused, Motion, Vec3};

/// Relative rounding error of recursions over a dozen bodies.
const ROUNDING: f64 = 1e-11;

fn robots() -> impl Iterator<Item = (u64, Model, Random)> {
    (1..=24).map(|seed| (seed, random_model(seed, 3 + seed as usize % 11), Random::new(seed + 1000)))
}

fn times(m: &[f64], v: &[f64]) -> Vec<f64> {
    m.chunks(v.len()).map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum()).collect()
}

fn six(m: Motion<f64>) -> [f64; 6] {
    let mut out = [0.0; 6];
    m.write(&mut out);
    out
}

fn wrenches(model: &Model, random: &mut Random) -> Vec<FrameWrench<f64>> {
    (0..model.frames().len())
        .map(|frame| FrameWrench { frame, wrench: Force::from_slice(&random.numbers(6)) })
        .collect()
}

#[test]
fn forward_dynamics_inverts_inverse_dynamics() {
    for (seed, model, mut random) in robots() {
        let (q, v) = random_state(&model, &mut random);
        let (a, external) = (random.numbers(model.nv()), wrenches(&model, &mut random));
        let (mut tau, mut back) = (vec![0.0; model.nv()], vec![0.0; model.nv()]);
        let mut data = Data::new(&model);
        inverse_dynamics(&model, &mut data, &q, &v, &a, &external, &mut tau);
        forward_dynamics(&model, &mut data, &q, &v, &tau, &external, &mut back);
        assert!(difference(&back, &a) < ROUNDING, "seed {seed}: {}", difference(&back, &a));
    }
}

#[test]
fn inverse_dynamics_is_mass_matrix_times_acceleration_plus_bias_less_external() {
    for (seed, model, mut random) in robots() {
        let (q, v) = random_state(&model, &mut random);
        let (a, external) = (random.numbers(model.nv()), wrenches(&model, &mut random));
        let nv = model.nv();
        let (mut m, mut c, mut tau) = (vec![0.0; nv * nv], vec![0.0; nv], vec![0.0; nv]);
        let mut data = Data::new(&model);
        mass_matrix(&model, &mut data, &q, &mut m);
        bias_forces(&model, &mut data, &q, &v, &[], &mut c);
        inverse_dynamics(&model, &mut data, &q, &v, &a, &external, &mut tau);
        let mut expected: Vec<f64> = times(&m, &a).iter().zip(&c).map(|(x, y)| x + y).collect();
        let mut jacobian = vec![0.0; 6 * nv];
        for FrameWrench { frame, wrench } in &external {
            // Σ Jᵀ F with the wrench rotated to W axes
            frame_jacobian(&model, &data, &q, *frame, &mut jacobian);
            let rot = onorbit_core::dynamics::frame_pose(&model, &data, &q, *frame).rot_wf;
            let w = six(Motion::new(rot * wrench.linear, rot * wrench.angular));
            for j in 0..nv {
                expected[j] -= (0..6).map(|i| jacobian[i * nv + j] * w[i]).sum::<f64>();
            }
        }
        assert!(difference(&tau, &expected) < ROUNDING, "seed {seed}");
    }
}

#[test]
fn kinetic_energy_and_momentum_follow_from_the_mass_matrix() {
    for (seed, model, mut random) in robots() {
        let (q, v) = random_state(&model, &mut random);
        let nv = model.nv();
        let mut m = vec![0.0; nv * nv];
        let mut data = Data::new(&model);
        mass_matrix(&model, &mut data, &q, &mut m);
        kinematics(&model, &mut data, &q, &v);
        let mv = times(&m, &v);
        let half: f64 = 0.5 * mv.iter().zip(&v).map(|(a, b)| a * b).sum::<f64>();
        assert!((kinetic_energy(&model, &data, &v) - half).abs() < ROUNDING * half, "seed {seed}");
        // the base rows of M v are the momentum in base axes about the base's origin
        let (_, h) = onorbit_core::dynamics::composite_momentum(&data);
        let mut six = [0.0; 6];
        h.write(&mut six);
        assert!(difference(&six, &mv[..6]) < ROUNDING, "seed {seed}");
    }
}

#[test]
fn dynamics_are_independent_of_the_base_pose() {
    for (seed, model, mut random) in robots() {
        let (q, v) = random_state(&model, &mut random);
        let (mut moved, _) = random_state(&model, &mut random);
        moved[7..].copy_from_slice(&q[7..]);
        let tau = random.numbers(model.nv());
        let (mut here, mut there) = (vec![0.0; model.nv()], vec![0.0; model.nv()]);
        let mut data = Data::new(&model);
        forward_dynamics(&model, &mut data, &q, &v, &tau, &[], &mut here);
        forward_dynamics(&model, &mut data, &moved, &v, &tau, &[], &mut there);
        assert_eq!(here, there, "seed {seed}");
    }
}

#[test]
fn jacobian_gives_the_twist_and_drift_its_rate() {
    for (seed, model, mut random) in robots() {
        let (q, v) = random_state(&model, &mut random);
        let (nv, frame) = (model.nv(), model.frame("tool").unwrap());
        let mut data = Data::new(&model);
        let mut jacobian = vec![0.0; 6 * nv];
        let mut twist_at = |t: f64| {
            let step: Vec<f64> = v.iter().map(|x| x * t).collect();
            let mut moved = q.clone();
            integrate(&q, &step, &mut moved);
            kinematics(&model, &mut data, &moved, &v);
            frame_jacobian(&model, &data, &moved, frame, &mut jacobian);
            let by_jacobian = times(&jacobian, &v);
            let twist = six(frame_velocity(&model, &data, &moved, frame));
            assert!(difference(&twist, &by_jacobian) < ROUNDING, "seed {seed}");
            by_jacobian
        };
        // fourth-order central difference of J(q ⊕ t v) v; 1e-3: truncation ~1e-11, rounding ~1e-12
        let h = 1e-3;
        let (a, b, c, d) = (twist_at(-2.0 * h), twist_at(-h), twist_at(h), twist_at(2.0 * h));
        let rate: Vec<f64> = (0..6).map(|i| (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * h)).collect();
        kinematics(&model, &mut data, &q, &v);
        let drift = six(frame_drift(&model, &data, &q, &v, frame));
        assert!(difference(&drift, &rate) < 1e-8, "seed {seed}: {drift:?} {rate:?}");
    }
}

#[test]
fn reduced_model_is_exact_for_any_momentum_and_any_wrench() {
    for (seed, model, mut random) in robots() {
        let (q, v) = random_state(&model, &mut random);
        let (n, nv, frame) = (model.joint_count(), model.nv(), model.frame("tool").unwrap());
        let external = wrenches(&model, &mut random);
        let mut tau = random.numbers(nv);
        tau[..6].fill(0.0);
        let (mut data, mut ff) = (Data::new(&model), FreeFloating::new(&model));
        let mut a = vec![0.0; nv];
        free_floating(&model, &mut data, &q, &v, frame, &external, &mut ff);
        forward_dynamics(&model, &mut data, &q, &v, &tau, &external, &mut a);
        // M* q̈ + c* = τ + Q*
        let left: Vec<f64> = times(&ff.inertia, &a[6..]).iter().zip(&ff.bias).map(|(x, c)| x + c).collect();
        let right: Vec<f64> = (0..n).map(|j| tau[j + 6] + ff.external[j]).collect();
        assert!(difference(&left, &right) < ROUNDING, "seed {seed}");
        // ẍ = Jg q̈ + d
        let task = times(&ff.jacobian, &a[6..]);
        let d = six(ff.drift);
        let predicted: Vec<f64> = task.iter().zip(&d).map(|(x, d)| x + d).collect();
        let actual = six(frame_acceleration(&model, &data, &q, frame));
        assert!(difference(&predicted, &actual) < ROUNDING, "seed {seed}: {predicted:?} {actual:?}");
        // negative control: without the paper's d/dt(Mbb⁻¹ Mbm) the error exceeds rounding
        let forgotten = six(frame_drift(&model, &data, &q, &v, frame));
        assert!(difference(&forgotten, &d) > 1e-3, "seed {seed}");
    }
}

#[test]
fn projected_base_twist_recovers_the_momentum() {
    for (seed, model, mut random) in robots() {
        let (q, mut v) = random_state(&model, &mut random);
        let mut data = Data::new(&model);
        kinematics(&model, &mut data, &q, &v);
        let target = momentum(&data, &q);
        let expected = v.clone();
        v[..6].copy_from_slice(&random.numbers(6));
        kinematics(&model, &mut data, &q, &v);
        six(projected_base_twist(&data, &q, &v, target)).iter().zip(&mut v).for_each(|(x, y)| *y = *x);
        assert!(difference(&v, &expected) < ROUNDING, "seed {seed}");
    }
}

#[test]
fn fused_numbers_agree_with_plain_ones_to_rounding() {
    if !Fused::is_available() {
        println!("skipped: this processor has no fused multiply-add");
        return;
    }
    let fused = |x: &[f64]| x.iter().map(|x| Fused(*x)).collect::<Vec<_>>();
    for (seed, model, mut random) in robots() {
        let (q, v) = random_state(&model, &mut random);
        let tau = random.numbers(model.nv());
        let mut plain = vec![0.0; model.nv()];
        let mut other = vec![Fused(0.0); model.nv()];
        forward_dynamics(&model, &mut Data::new(&model), &q, &v, &tau, &[], &mut plain);
        forward_dynamics(
            &model,
            &mut Data::new(&model),
            &fused(&q),
            &fused(&v),
            &fused(&tau),
            &[],
            &mut other,
        );
        let other: Vec<f64> = other.iter().map(|x| x.0).collect();
        assert!(difference(&other, &plain) < ROUNDING, "seed {seed}");
    }
}

#[test]
fn a_point_mass_far_out_has_the_textbook_momentum() {
    let model = Model::rigid_body(2.0, nalgebra::Matrix3::identity()).unwrap();
    let mut data = Data::new(&model);
    let q = [1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0];
    kinematics(&model, &mut data, &q, &[0.5, 0.0, 0.0, 0.0, 0.0, 0.25]);
    let h = momentum(&data, &q);
    assert_eq!((h.linear, h.angular), (Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 0.25)));
}
