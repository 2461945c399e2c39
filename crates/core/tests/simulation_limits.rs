//! Checks rigid stops: bounces against closed forms, balances of momentum and energy, and no penetration.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // set-up that fails should stop; --nocapture shows the numbers

mod common;

use common::humanoid::{humanoid_with, start};
use common::slider::{BASE, INTEGRATORS, REDUCED, SLIDER, driven, moving, run, slider};
use onorbit_core::simulation::{Integrator, Simulation, SimulationError, certify};
use std::sync::Arc;

#[test]
fn a_slider_bounces_as_in_the_closed_form() {
    let (rate, limit) = (0.8, 0.25);
    for integrator in INTEGRATORS {
        for e in [0.0, 0.5, 1.0] {
            let mut simulation = moving(slider(0.0, 0.0, Some((-limit, limit)), 0.3), rate, integrator, 0.01);
            simulation.systems[0].stops = Some(e);
            let trace = run(&mut simulation, 2.0);
            // q = u t; then back and forth, with the rate reduced by 1 − e at each impact
            for (k, t) in trace.time.iter().enumerate() {
                let (mut q, mut u, mut left) = (0.0, rate, *t);
                while u != 0.0 {
                    let way: f64 = if u > 0.0 { limit - q } else { -limit - q };
                    if way / u > left {
                        break;
                    }
                    left -= way / u;
                    (q, u) = (q + way, -e * u);
                }
                let off = (trace.q[8 * k + 7] - (q + u * left)).abs();
                assert!(off < 1e-11, "{integrator:?} {e} at {t}: {off:e}");
                assert!(trace.q[8 * k + 7].abs() <= limit + 1e-9);
            }
            let certificate = certify(&simulation.systems[0].model, &trace);
            let lost = trace.dissipated[trace.rows() - 1];
            println!("{integrator:?}, restitution {e}: {lost} J lost, {:?}", certificate.checks());
            assert!(certificate.passed(), "{certificate:#?}");
            if e == 0.0 {
                assert!((lost - 0.5 * REDUCED * rate * rate).abs() < 1e-13);
                assert_eq!(trace.v[trace.v.len() - 1], 0.0);
                let base = trace.v[trace.v.len() - 7];
                assert!((base - SLIDER * rate / (BASE + SLIDER)).abs() < 1e-14);
            }
        }
    }
}

/// A joint pushed against its stop stays there; pulled, it leaves at once.
#[test]
fn a_stop_is_unilateral() {
    for friction in [0.0, 1.0] {
        for integrator in INTEGRATORS {
            let model = slider(friction, 0.0, Some((-1.0, 0.1)), 0.3);
            let mut simulation =
                driven(moving(model, 0.0, integrator, 0.01), |t| if t < 1.995 { 3.0 } else { -3.0 });
            simulation.systems[0].stops = Some(0.4);
            let trace = run(&mut simulation, 2.5);
            let certificate = certify(&simulation.systems[0].model, &trace);
            let at = |t: f64| trace.time.iter().position(|x| *x > t).unwrap();
            for k in at(1.5)..at(1.99) {
                assert!(trace.v[7 * k + 6] == 0.0 && trace.q[8 * k + 7] == 0.1, "{integrator:?} {friction}");
            }
            let k = trace.rows() - 1;
            let (u, way) = (trace.v[7 * k + 6], trace.q[8 * k + 7] - 0.1);
            let exact = -(3.0 - friction) / REDUCED * 0.5;
            println!(
                "{integrator:?}, friction {friction}: {} rows, leaves {way} m, rate {:e} off",
                trace.rows(),
                u - exact
            );
            assert!((u - exact).abs() < 1e-11);
            let is_first_order = integrator == Integrator::SemiImplicitEuler;
            assert!(is_first_order || certificate.energy_balance_error_rel < 1e-8, "{certificate:#?}");
            assert!(trace.rows() < 500);
        }
    }
}

/// An arm with limits all around its swing.
#[test]
fn an_arm_between_its_stops_keeps_its_balances() {
    for (integrator, e) in [(Integrator::Rk4, 0.3), (Integrator::Rk4, 0.0), (Integrator::DormandPrince, 0.3)]
    {
        let model = humanoid_with(|joint| {
            let at = common::humanoid::START[joint.name[4..].parse::<usize>().unwrap() - 1];
            joint.limits.position = Some((at - 0.3, at + 0.3));
            joint.friction = if joint.name.as_str() > "arm_4" { 1e-4 } else { 0.01 };
        });
        let (q, mut v) = (start(&model), vec![0.0; model.nv()]);
        v[6..].copy_from_slice(&[1.0, -0.8, 0.9, 1.1, -0.7, 1.0, -1.2]);
        let mut simulation = Simulation::new(Arc::new(model), q.clone(), v);
        (simulation.systems[0].stops, simulation.integrator) = (Some(e), integrator);
        let trace = run(&mut simulation, 5.0);
        let certificate = certify(&simulation.systems[0].model, &trace);
        let beyond = trace.q.chunks(14).flat_map(|row| (7..14).map(|j| (row[j] - q[j]).abs() - 0.3));
        let beyond = beyond.fold(f64::NEG_INFINITY, f64::max);
        println!(
            "{integrator:?} {e}: {} rows, {beyond:e} rad beyond; {:?}",
            trace.rows(),
            certificate.checks()
        );
        assert!(beyond < 1e-9 && beyond > -1e-5);
        assert!(certificate.passed(), "{certificate:#?}");
        assert!(certificate.energy_balance_error_rel < 1e-8);
        assert!(certificate.angular_momentum_drift_rel < 1e-12);
    }
}

#[test]
fn a_start_outside_a_limit_is_refused() {
    let mut simulation = moving(slider(0.0, 0.0, Some((-0.1, 0.1)), 0.3), 0.0, Integrator::Rk4, 0.01);
    simulation.systems[0].q[7] = 0.2;
    simulation.check().unwrap(); // limits are enforced only on request
    simulation.systems[0].stops = Some(0.0);
    let error = simulation.check().unwrap_err();
    assert!(
        matches!(&error, SimulationError::OutsideLimits { joint, value, .. } if joint == "slide" && *value == 0.2)
    );
    assert!(error.to_string().contains("-0.1 to 0.1"), "{error}");
    simulation.systems[0].stops = Some(1.5);
    assert!(matches!(simulation.check(), Err(SimulationError::Restitution { .. })));
}
