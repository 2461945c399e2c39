//! Checks the observed orders of the integrators, and of a negative control that composes attitudes naively.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // set-up that fails should stop; --nocapture shows the numbers

mod common;

use common::stepper::{Turning, free_motion};
use common::{Random, random_model, random_state};
use onorbit_core::model::{Model, difference};
use onorbit_core::simulation::{Integrator, Simulation};
use std::sync::Arc;

const DURATION: f64 = 2.0;

/// Returns configurations at the end with 2, 1 and ½ times the step, and with a much shorter one.
fn orders(model: &Model, end: impl Fn(usize) -> Vec<f64>, steps: usize) -> [f64; 3] {
    let exact = reference(model);
    let error = |steps: usize| {
        let mut delta = vec![0.0; model.nv()];
        difference(&exact, &end(steps), &mut delta);
        let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        [norm(&delta[..3]), norm(&delta[3..6]), norm(&delta[6..])]
    };
    let (coarse, fine) = (error(steps), error(2 * steps));
    std::array::from_fn(|i| (coarse[i] / fine[i]).log2())
}

fn simulated(model: &Model, integrator: Integrator, steps: usize) -> Vec<f64> {
    let (q, v) = random_state(model, &mut Random::new(7));
    let mut simulation = Simulation::new(Arc::new(model.clone()), q, v);
    simulation.integrator = integrator;
    simulation.time_step = DURATION / steps as f64;
    simulation.record_every = steps;
    let trace = simulation.run(DURATION).unwrap().only();
    trace.q[trace.q.len() - model.nq()..].to_vec()
}

fn reference(model: &Model) -> Vec<f64> {
    simulated(model, Integrator::Rk4, 8000)
}

fn stepped(model: &Model, turning: Turning, steps: usize) -> Vec<f64> {
    let (q, v) = random_state(model, &mut Random::new(7));
    let trace = free_motion(model, &q, &v, DURATION / steps as f64, steps, turning);
    trace.q[trace.q.len() - model.nq()..].to_vec()
}

#[test]
fn runge_kutta_is_of_fourth_order_in_position_attitude_and_joints() {
    let model = random_model(3, 8);
    let orders = orders(&model, |steps| simulated(&model, Integrator::Rk4, steps), 160);
    println!("RK4 position, attitude, joints: {orders:?}");
    assert!(orders.iter().all(|order| (3.6..4.6).contains(order)), "{orders:?}");
}

#[test]
fn semi_implicit_euler_is_of_first_order() {
    let model = random_model(3, 8);
    let orders = orders(&model, |steps| simulated(&model, Integrator::SemiImplicitEuler, steps), 1600);
    println!("semi-implicit Euler position, attitude, joints: {orders:?}");
    assert!(orders.iter().all(|order| (0.85..1.15).contains(order)), "{orders:?}");
}

/// Negative control: the same stages, with the attitude composed from averaged rates.
#[test]
fn a_naive_composition_of_rates_collapses_to_second_order() {
    let model = random_model(3, 8);
    let naive = orders(&model, |steps| stepped(&model, Turning::Averaged, steps), 160);
    println!("naive position, attitude, joints: {naive:?}");
    assert!((1.8..2.2).contains(&naive[1]), "{naive:?}");
    let group = orders(&model, |steps| stepped(&model, Turning::OnTheGroup, steps), 160);
    println!("the same on the group: {group:?}");
    assert!(group[1] > 3.6, "{group:?}");
}
