//! Checks Coulomb friction: a joint stops as in the closed form, sticks exactly, and breaks away at the right
//! time.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // set-up that fails should stop; --nocapture shows the numbers

mod common;

use common::humanoid::{humanoid_with, start};
use common::slider::{BASE, INTEGRATORS, REDUCED, SLIDER, driven, moving, run, slider};
use nalgebra::Vector3;
use onorbit_core::batch::{Rollout, RolloutControl};
use onorbit_core::environment::BodyWrench;
use onorbit_core::simulation::{Integrator, Simulation, certify};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Kinetic friction, N.
const FRICTION: f64 = 2.0;

#[test]
fn a_slider_stops_at_the_closed_form_time_and_place_and_stays() {
    let rate = 0.7;
    // u̇ = −f/μ
    let (time, way) = (rate * REDUCED / FRICTION, 0.5 * rate * rate * REDUCED / FRICTION);
    for integrator in INTEGRATORS {
        let mut simulation = moving(slider(FRICTION, 0.0, None, 0.3), rate, integrator, 0.01);
        let trace = run(&mut simulation, 3.0);
        let (nq, nv, rows) = (8, 7, trace.rows());
        let rates: Vec<f64> = trace.v.chunks(nv).map(|v| v[6]).collect();
        let (q, v) = (&trace.q[(rows - 1) * nq..], &trace.v[(rows - 1) * nv..]);
        // semi-implicit Euler is of first order in the distance, and exact in the time
        let tolerance = if integrator == Integrator::SemiImplicitEuler { 0.01 * rate } else { 1e-12 };
        println!("{integrator:?}: stopped {:e} m off", q[7] - way);
        assert!((q[7] - way).abs() < tolerance);
        assert!(trace.time.iter().zip(&rates).all(|(t, u)| (*t < time - 1e-9) == (*u != 0.0)));
        if integrator != Integrator::DormandPrince {
            assert!(trace.time.iter().any(|t| (t - time).abs() < 1e-12)); // the stop is a row
        }
        // the base receives all momentum: P/(M + m)
        assert!((v[0] - SLIDER * rate / (BASE + SLIDER)).abs() < 1e-14);
        let lost = 0.5 * REDUCED * rate * rate;
        let certificate = certify(&simulation.systems[0].model, &trace);
        if integrator != Integrator::SemiImplicitEuler {
            assert!((trace.dissipated[rows - 1] - lost).abs() < 1e-12);
            assert!((trace.work[rows - 1] + lost).abs() < 1e-12);
            assert!(certificate.energy_balance_error_rel < 1e-10, "{certificate:#?}");
            assert!(certificate.passed(), "{certificate:#?}");
        }
    }
}

#[test]
fn a_slider_sticks_below_the_friction_and_breaks_away_above() {
    for integrator in INTEGRATORS {
        let still = moving(slider(FRICTION, 0.0, None, 0.3), 0.0, integrator, 0.01);
        let mut loaded = driven(still, |t| if t < 4.995 { 0.95 * FRICTION } else { 1.2 * FRICTION });
        let trace = run(&mut loaded, 6.0);
        for (k, t) in trace.time.iter().enumerate() {
            let (q, u) = (trace.q[8 * k + 7], trace.v[7 * k + 6]);
            if *t <= 5.0 {
                assert!(q == 0.0 && u == 0.0, "{integrator:?} creeps at {t}: {q} {u}"); // exactly
            } else {
                assert!((u - 0.2 * FRICTION / REDUCED * (t - 5.0)).abs() < 1e-12, "{integrator:?} {t}: {u}");
            }
        }
    }
    // negative control: with friction smoothed over 1 mm/s the slider creeps 5 mm
    let smooth = moving(slider(0.0, FRICTION / 1e-3, None, 0.3), 0.0, Integrator::Rk4, 1e-3);
    let trace = run(&mut driven(smooth, |_| 0.95 * FRICTION), 5.0);
    assert!(trace.q[trace.q.len() - 1] > 4e-3);
}

/// A thruster spins the base up until the slider moves, in the middle of a step.
#[test]
fn it_breaks_away_within_a_step_when_the_spin_is_fast_enough() {
    let (offset, torque) = (0.3, 0.8);
    // μ ω² d = f, ω = T t/I with I = Σ I + μ d²
    let inertia = 0.1 * (BASE + SLIDER) + REDUCED * offset * offset;
    let time = (FRICTION / (REDUCED * offset)).sqrt() * inertia / torque;
    for integrator in [Integrator::Rk4, Integrator::DormandPrince] {
        let mut simulation = moving(slider(FRICTION, 0.0, None, offset), 0.0, integrator, 0.05);
        simulation
            .effects
            .push(Arc::new(BodyWrench::new(0, Vector3::zeros(), Vector3::z() * torque).unwrap()));
        let trace = run(&mut simulation, time + 1.0);
        let first = trace.time.iter().zip(trace.v.chunks(7)).find(|(_, v)| v[6] != 0.0).unwrap();
        let certificate = certify(&simulation.systems[0].model, &trace);
        let off = trace.time.iter().map(|t| (t - time).abs()).fold(f64::INFINITY, f64::min);
        println!("{integrator:?}: breaks away at {time}, row {off:e} s off, moves at {}", first.0);
        assert!(*first.0 > time && *first.0 < time + 0.051);
        assert!(integrator == Integrator::DormandPrince || off < 1e-9);
        assert!(certificate.energy_balance_error_rel < 1e-8, "{certificate:#?}");
    }
}

/// An arm that swings, slips and sticks: seven joints with friction, some loaded.
fn sticking(integrator: Integrator) -> Simulation {
    let model = humanoid_with(|joint| {
        let is_wrist = matches!(joint.name.as_str(), "arm_5" | "arm_6" | "arm_7");
        joint.friction = if is_wrist { 2e-4 } else { 0.05 };
        joint.damping = if is_wrist { 1e-4 } else { 0.01 };
    });
    let (q, mut v) = (start(&model), vec![0.0; model.nv()]);
    v[..6].copy_from_slice(&[0.02, -0.01, 0.03, 0.1, -0.05, 0.08]);
    v[6..].copy_from_slice(&[1.0, -0.8, 0.9, 1.1, -0.7, 1.0, -1.2]);
    let mut simulation = Simulation::new(Arc::new(model), q, v);
    simulation.integrator = integrator;
    simulation
}

#[test]
fn a_stick_slip_run_is_certified_and_does_not_chatter() {
    for integrator in [Integrator::Rk4, Integrator::DormandPrince] {
        let mut simulation = sticking(integrator);
        let trace = run(&mut simulation, 8.0);
        let certificate = certify(&simulation.systems[0].model, &trace);
        let changes: usize = (0..7)
            .map(|j| {
                let mode = |v: &[f64]| if v[6 + j] == 0.0 { 0 } else { v[6 + j].signum() as i8 };
                let modes: Vec<i8> = trace.v.chunks(13).map(mode).collect();
                modes.windows(2).filter(|w| w[0] != w[1]).count()
            })
            .sum();
        let stuck = trace.v[trace.v.len() - 7..].iter().filter(|u| **u == 0.0).count();
        println!(
            "{integrator:?}: {} rows, {changes} changes, {stuck} stuck at the end; {:?}",
            trace.rows(),
            certificate.checks()
        );
        assert!(certificate.passed(), "{certificate:#?}");
        assert!(certificate.energy_balance_error_rel < 1e-8);
        assert!(changes < 100 && stuck > 2);
        assert!(trace.dissipated.windows(2).all(|e| e[1] >= e[0] - 1e-15));
        let (first, last) = (trace.kinetic_energy[0], trace.kinetic_energy[trace.rows() - 1]);
        assert!((first - last - trace.dissipated[trace.rows() - 1]).abs() < 1e-8 * first); // no motor
    }
}

#[test]
fn stick_slip_has_the_order_of_the_integrator() {
    let end = |time_step: f64| {
        let mut simulation = sticking(Integrator::Rk4);
        simulation.time_step = time_step;
        let trace = run(&mut simulation, 1.5);
        trace.q[trace.q.len() - 7..].to_vec()
    };
    let off = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let exact = end(2.5e-4);
    let (coarse, fine) = (off(&end(4e-3), &exact), off(&end(2e-3), &exact));
    let order = (coarse / fine).log2();
    println!("{coarse:e} {fine:e}: order {order}");
    assert!(order > 3.0, "{order}");
}

#[test]
fn a_rollout_sticks_as_a_simulation_does() {
    let mut simulation = sticking(Integrator::Rk4);
    let trace = run(&mut simulation, 2.0);
    let (model, stop) = (Arc::clone(&simulation.systems[0].model), AtomicBool::new(false));
    let rollout = Rollout {
        steps: 2000,
        time_step: 1e-3,
        integrator: Integrator::Rk4,
        control: RolloutControl::Passive,
        record_every: None,
        threads: Some(1),
        stop: &stop,
    };
    let (q0, v0) = ([&simulation.systems[0].q[..]; 9].concat(), [&simulation.systems[0].v[..]; 9].concat());
    let (mut q, mut v) = (vec![0.0; 9 * 14], vec![0.0; 9 * 13]);
    rollout.run(&model, &q0, &v0, &mut q, &mut v).unwrap();
    let last = &trace.q[trace.q.len() - 14..];
    for q in q.chunks(14) {
        assert!(q.iter().zip(last).all(|(a, b)| (a - b).abs() < 1e-12));
    }
}
