//! Checks the certificate: correct runs pass, and incorrect runs fail.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // set-up that fails should stop; --nocapture shows the numbers

mod common;

use common::humanoid::{humanoid, start};
use common::stepper::{Turning, free_motion};
use common::{Random, random_model, random_state};
use nalgebra::{Matrix3, Vector3};
use onorbit_core::environment::{BodyWrench, GravityGradient};
use onorbit_core::model::{Model, neutral};
use onorbit_core::orbit::{Kepler, MU_EARTH};
use onorbit_core::simulation::{Certificate, Integrator, Simulation, Trace, certify};
use onorbit_core::spatial::{Quat, Vec3, exp_so3, log_so3};
use std::sync::Arc;

fn run(simulation: &mut Simulation, duration: f64) -> Trace {
    simulation.run(duration).unwrap().only()
}

fn random_simulation(seed: u64) -> Simulation {
    let model = Arc::new(random_model(seed, 8));
    let (q, v) = random_state(&model, &mut Random::new(seed));
    Simulation::new(model, q, v)
}

fn failed(certificate: &Certificate) -> Vec<&'static str> {
    certificate.checks().iter().filter(|check| !check.passed()).map(|check| check.name).collect()
}

/// A run in orbit, away from the reference, with a wrench that ends off the grid.
fn pushed(switched: bool) -> Simulation {
    let mut simulation = random_simulation(2);
    let (r, v) = (Vector3::new(6_778e3, 0.0, 0.0), Vector3::new(0.0, 5_000.0, 5_900.0));
    simulation.orbit = Some(Arc::new(Kepler::from_state(r, v, MU_EARTH).unwrap()));
    simulation.effects.push(Arc::new(GravityGradient));
    let wrench = BodyWrench::new(1, Vector3::new(1.0, -2.0, 0.5), Vector3::new(0.1, 0.2, -0.3)).unwrap();
    let wrench = if switched { wrench.during(0.3333, 1.2345).unwrap() } else { wrench };
    simulation.effects.push(Arc::new(wrench));
    simulation
}

#[test]
fn honest_free_motion_of_random_robots_is_green() {
    for seed in 0..8 {
        for time_step in [1e-3, 4e-3] {
            let mut simulation = random_simulation(seed);
            simulation.time_step = time_step;
            let trace = run(&mut simulation, 2.0);
            let certificate = certify(&simulation.systems[0].model, &trace);
            println!("seed {seed}, step {time_step}: {:?}", certificate.checks());
            assert!(certificate.passed(), "seed {seed}: {certificate:#?}");
            assert_eq!(certificate.checks().len(), 9);
        }
    }
}

#[test]
fn honest_pushed_runs_are_green_switches_included() {
    for switched in [false, true] {
        let mut simulation = pushed(switched);
        let trace = run(&mut simulation, 2.0);
        let certificate = certify(&simulation.systems[0].model, &trace);
        println!("switched {switched}: {:?}", certificate.checks());
        assert!(certificate.passed(), "{certificate:#?}");
    }
}

/// Spacecraft with vanishing scales: at rest, drifting without rotation, rotating about an axis.
#[test]
fn single_bodies_with_vanishing_scales_are_green() {
    let inertia = nalgebra::Matrix3::from_diagonal(&Vector3::new(2.0, 3.0, 4.0));
    let model = Arc::new(Model::rigid_body(10.0, inertia).unwrap());
    let motions = [
        [0.0; 6],
        [3.0, -1.0, 2.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.7, 0.0],
        [900.0, 0.0, 0.0, 0.1, 0.7, -0.3],
    ];
    for v in motions {
        for in_orbit in [false, true] {
            let mut simulation =
                Simulation::new(Arc::clone(&model), vec![5.0, 0.0, 2.0, 0.0, 0.6, 0.0, 0.8], v.to_vec());
            simulation.time_step = 0.01;
            if in_orbit {
                let (r, v) = (Vector3::new(6_778e3, 0.0, 0.0), Vector3::new(0.0, 7_700.0, 0.0));
                simulation.orbit = Some(Arc::new(Kepler::from_state(r, v, MU_EARTH).unwrap()));
                simulation.effects.push(Arc::new(GravityGradient));
            }
            let certificate = certify(&model, &run(&mut simulation, 20.0));
            println!("{v:?} in orbit {in_orbit}: {:?}", certificate.checks());
            assert!(certificate.passed(), "{v:?} in orbit {in_orbit}: {certificate:#?}");
        }
    }
}

/// Momentum is conserved by construction; the attitude is wrong, which the certificate detects.
#[test]
fn naively_composed_attitudes_are_red() {
    for (seed, model) in [(1, random_model(1, 8)), (4, random_model(4, 8)), (9, humanoid())] {
        let (mut q, v) = random_state(&model, &mut Random::new(seed));
        if seed == 9 {
            q = start(&model);
        }
        for h in [1e-3, 5e-3] {
            let steps = (2.0 / h) as usize;
            let honest = certify(&model, &free_motion(&model, &q, &v, h, steps, Turning::OnTheGroup));
            let naive = certify(&model, &free_motion(&model, &q, &v, h, steps, Turning::Averaged));
            let ratio = naive.attitude_consistency.unwrap();
            println!(
                "seed {seed}, step {h}: honest {:?}, naive {ratio}",
                honest.attitude_consistency.unwrap()
            );
            assert!(honest.passed(), "{honest:#?}");
            assert!((0.9..1.1).contains(&ratio), "{naive:#?}");
            assert!(failed(&naive).contains(&"attitude_consistency"));
            assert!(naive.linear_momentum_drift_rel < 1e-12 && naive.angular_momentum_drift_rel < 1e-12);
        }
    }
}

/// The series of the certificate against an accurate integration: fifth order per step, third order without
/// the commutator.
#[test]
fn the_magnus_series_is_of_fifth_order_per_step() {
    let omega = |t: f64| Vec3::new((1.3 * t).sin() + 0.4, (0.9 * t).cos(), 0.7 * t - 0.2 * t * t * t);
    let change = |t: f64| Vec3::new(1.3 * (1.3 * t).cos(), -0.9 * (0.9 * t).sin(), 0.7 - 0.6 * t * t);
    let errors = |h: f64| {
        let mut exact = Quat { v: Vec3::zero(), w: 1.0 };
        let pieces = 20_000;
        let piece = h / f64::from(pieces);
        for k in 0..pieces {
            // exact to piece³ each: 1e-15 here
            exact = exact.product(exp_so3(omega((f64::from(k) + 0.5) * piece) * piece)).normalized();
        }
        let integral = (omega(0.0) + omega(h)) * (0.5 * h) + (change(0.0) - change(h)) * (h * h / 12.0);
        let commutator = omega(0.0).cross(omega(h)) * (h * h / 12.0);
        let turn = log_so3(exact);
        [(turn - integral - commutator).norm(), (turn - integral).norm()]
    };
    let (coarse, fine) = (errors(0.2), errors(0.1));
    let orders = [(coarse[0] / fine[0]).log2(), (coarse[1] / fine[1]).log2()];
    println!("errors {coarse:?} {fine:?}, orders {orders:?}");
    assert!((4.6..5.6).contains(&orders[0]) && (2.7..3.3).contains(&orders[1]), "{orders:?}");
}

/// Omits a wrench from the recorded loads, and from the actual loads.
#[test]
fn an_omitted_wrench_is_red() {
    let trace = run(&mut pushed(false), 2.0);
    let model = std::sync::Arc::clone(&pushed(false).systems[0].model);
    let mut without = pushed(false);
    without.effects.pop();
    let unpushed = run(&mut without, 2.0);

    // omitted from the impulse column
    let missing = Trace { impulse: unpushed.impulse.clone(), ..trace.clone() };
    let certificate = certify(&model, &missing);
    println!("impulse without it: {:?}", certificate.checks());
    let red = failed(&certificate);
    for name in ["linear_momentum_drift_rel", "angular_momentum_drift_rel", "base_rows_residual_rel"] {
        assert!(red.contains(&name), "{red:?}");
    }

    // omitted from the work column
    let missing = Trace { work: unpushed.work.clone(), ..trace.clone() };
    assert_eq!(failed(&certify(&model, &missing)), ["energy_balance_error_rel"]);

    // omitted from the equations of motion, but not from the balances
    let missing = Trace { impulse: trace.impulse.clone(), work: trace.work.clone(), ..unpushed };
    let red = failed(&certify(&model, &missing));
    for name in ["linear_momentum_drift_rel", "energy_balance_error_rel", "base_rows_residual_rel"] {
        assert!(red.contains(&name), "{red:?}");
    }
}

/// The finite differences of a last step of 1 ns are rounding error; only this step is excused.
#[test]
fn an_end_off_the_grid_does_not_shrink_the_residual_of_a_missing_force() {
    let residual = |duration: f64| {
        let mut simulation = random_simulation(2);
        let push = BodyWrench::new(1, Vector3::new(0.1, 0.0, 0.0), Vector3::zeros()).unwrap();
        simulation.effects.push(Arc::new(push));
        let trace = run(&mut simulation, duration);
        let missing = Trace { impulse: vec![0.0; trace.impulse.len()], ..trace.clone() };
        assert_eq!(failed(&certify(&simulation.systems[0].model, &trace)), [""; 0]);
        let certificate = certify(&simulation.systems[0].model, &missing);
        assert!(failed(&certificate).contains(&"base_rows_residual_rel"), "{duration}: {certificate:#?}");
        certificate.base_rows_residual_rel.unwrap()
    };
    let [on, off] = [0.5, 0.5 + 1e-9].map(residual);
    println!("missing 0.1 N: {on:e} on the grid, {off:e} with a last step of a nanosecond");
    assert!((off / on - 1.0).abs() < 1e-3, "{off:e} for {on:e}");
}

/// An integrator that projects the momentum hides a missing torque; the base rows detect it.
#[test]
fn velocities_that_do_not_follow_from_the_wrenches_are_red() {
    let mut simulation = random_simulation(3);
    let mut trace = run(&mut simulation, 1.0);
    let nv = simulation.systems[0].model.nv();
    for (k, v) in trace.v.chunks_exact_mut(nv).enumerate() {
        v[4] += 1e-3 * (k as f64 * 1e-3); // as if 1e-3 rad/s² had no cause
    }
    let red = failed(&certify(&simulation.systems[0].model, &trace));
    assert!(red.contains(&"base_rows_residual_rel") && red.contains(&"attitude_consistency"), "{red:?}");
}

/// The centre of mass is compared with the integral of the momentum, for any integrator.
#[test]
fn a_center_of_mass_that_leaves_its_path_is_red() {
    let mut simulation = random_simulation(3);
    let mut trace = run(&mut simulation, 1.0);
    for (k, c) in trace.center_of_mass.chunks_exact_mut(3).enumerate() {
        c[0] += 1e-9 * k as f64; // 1 µm/s
    }
    assert_eq!(failed(&certify(&simulation.systems[0].model, &trace)), ["center_of_mass_error_rel"]);
}

#[test]
fn a_first_order_integrator_is_not_certified_at_a_millisecond() {
    let mut simulation = random_simulation(5);
    simulation.integrator = Integrator::SemiImplicitEuler;
    let trace = run(&mut simulation, 2.0);
    let red = failed(&certify(&simulation.systems[0].model, &trace));
    assert!(red.contains(&"energy_balance_error_rel") && red.contains(&"attitude_consistency"), "{red:?}");
    assert!(!red.contains(&"linear_momentum_drift_rel"), "{red:?}");
}

/// Checks that compare neighbouring steps are evaluated at every step, recorded or not.
#[test]
fn sparse_rows_evaluate_every_step_and_nan_is_red() {
    let mut simulation = pushed(true);
    let trace = run(&mut simulation, 1.0);
    let dense = certify(&simulation.systems[0].model, &trace);
    simulation.record_every = 10;
    let trace = run(&mut simulation, 1.0);
    let certificate = certify(&simulation.systems[0].model, &trace);
    assert!(certificate.passed(), "{certificate:#?}");
    assert_eq!(dense.checks().len(), certificate.checks().len());
    for (dense, sparse) in dense.checks().iter().zip(certificate.checks()) {
        println!("{}: {:e}, with sparse rows {:e}", dense.name, dense.value, sparse.value);
        assert_eq!(dense.name, sparse.name);
    }
    let mut broken = trace;
    broken.kinetic_energy[5] = f64::NAN;
    broken.momentum[12] = f64::NAN;
    let red = failed(&certify(&simulation.systems[0].model, &broken));
    assert_eq!(red, ["linear_momentum_drift_rel", "energy_balance_error_rel"]);
    assert!(certify(&simulation.systems[0].model, &Trace::default()).passed()); // neither passed nor failed
}

/// Negative control: what is red with every step a row is red with every hundredth.
#[test]
fn a_first_order_integrator_is_red_with_sparse_rows_too() {
    let mut simulation = random_simulation(5);
    simulation.integrator = Integrator::SemiImplicitEuler;
    simulation.record_every = 100;
    let trace = run(&mut simulation, 2.0);
    let red = failed(&certify(&simulation.systems[0].model, &trace));
    assert!(red.contains(&"center_of_mass_error_rel") == red.contains(&"attitude_consistency"), "{red:?}");
    assert!(red.contains(&"attitude_consistency") && red.contains(&"joint_step_doubling_rel"), "{red:?}");
}

/// Regression: about 60 of 168 were red, since the rounding of the residual grows with the rows and not with
/// their root.
#[test]
fn uniform_spins_are_green_for_all_shapes_rates_and_steps() {
    let mut random = Random::new(14);
    for case in 0..60 {
        let mut between = |low: f64, high: f64| low + (high - low) * (0.5 + 0.5 * random.unit());
        let size = 10_f64.powf(between(-6.0, 8.0));
        let moments = [1.0, between(1.05, 1.4), between(1.45, 1.9)].map(|x| x * size);
        let rate = 10_f64.powf(between(-5.0, 0.5));
        let time_step = 10_f64.powf(between(-4.0, 1.0)).min(0.1 / rate);
        let rows = 10_f64.powf(between(2.0, if case % 10 == 0 { 5.0 } else { 4.0 })).round();
        let axis = [3, 5][case % 2]; // of the least and of the largest moment: the third is unstable
        let inertia = Matrix3::from_diagonal(&Vector3::from(moments));
        let body = Arc::new(Model::rigid_body(10_f64.powf(between(-3.0, 6.0)), inertia).unwrap());
        let mut q = neutral(&body);
        let turned = Quat { v: Vec3::new(between(-1.0, 1.0), 0.3, between(-1.0, 1.0)), w: 0.4 }.normalized();
        turned.write_xyzw(&mut q[3..]);
        let mut v = vec![0.0; 6];
        v[axis] = rate;
        let record_every = [1, 7][case % 3 / 2];
        let mut simulation =
            Simulation { time_step, record_every, ..Simulation::new(Arc::clone(&body), q, v) };
        let certificate = certify(&body, &run(&mut simulation, rows * time_step));
        assert!(certificate.passed(), "{rate} rad/s, {rows} steps of {time_step} s: {certificate:#?}");
    }
}

/// Two links of 0.1 g on a base of 100 kg, which are negligible in the balances of the whole robot.
fn light_links(time_step: f64, record_every: usize) -> Certificate {
    let model = Arc::new(common::light::light_links(1e-4));
    let mut v = vec![0.0; model.nv()];
    v[3..].copy_from_slice(&[0.02, 0.03, 0.1, 3.0, 2.0]);
    let q = neutral(&model);
    let mut simulation = Simulation { time_step, record_every, ..Simulation::new(Arc::clone(&model), q, v) };
    certify(&model, &run(&mut simulation, 10.0))
}

/// The joints end with an error of 6e-3 rad at 0.1 s, while all other checks pass.
#[test]
fn badly_integrated_light_links_are_red() {
    for record_every in [1, 10] {
        let certificate = light_links(0.1, record_every);
        println!("{certificate:#?}");
        assert_eq!(failed(&certificate), ["joint_step_doubling_rel"]);
        let fine = light_links(0.005, record_every);
        assert!(fine.passed(), "{fine:#?}");
    }
}

#[test]
fn a_push_through_the_centre_of_mass_is_green() {
    // without rotation, the angular scales are rounding error
    let body = Model::rigid_body(10.0, Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.5))).unwrap();
    let q = neutral(&body);
    let mut simulation = Simulation::new(Arc::new(body), q, vec![0.0; 6]);
    let push = BodyWrench::new(0, Vector3::new(0.1, 0.7, 0.3), Vector3::zeros()).unwrap();
    simulation.effects.push(Arc::new(push));
    simulation.time_step = 0.01;
    let trace = run(&mut simulation, 1.0);
    let certificate = certify(&simulation.systems[0].model, &trace);
    assert!(certificate.passed(), "{certificate:#?}");
}

#[test]
fn a_step_too_long_for_the_spin_is_red() {
    // rotation about the intermediate axis at 3 rad/s, which is unstable: 200 s of 20 ms steps end with an
    // error of mrad
    let spin = |time_step: f64| {
        let body = Model::rigid_body(10.0, Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.5))).unwrap();
        let q = neutral(&body);
        let mut simulation = Simulation::new(Arc::new(body), q, vec![0.0, 0.0, 0.0, 0.03, 3.0, 0.03]);
        simulation.time_step = time_step;
        let trace = run(&mut simulation, 200.0);
        certify(&simulation.systems[0].model, &trace)
    };
    let (coarse, fine) = (spin(0.02), spin(1e-3));
    let estimate = |certificate: &Certificate| certificate.attitude_step_doubling_rad.unwrap();
    println!("estimates {:e} and {:e} rad", estimate(&coarse), estimate(&fine));
    assert!(!coarse.passed() && coarse.linear_momentum_drift_rel < 1e-11);
    assert!(fine.passed(), "{fine:#?}");
}
