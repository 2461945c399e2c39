//! Checks the recorded wrenches per effect and body, which must be the loads that moved the robot.
#![allow(clippy::print_stdout)] // shows what was measured when a test fails

mod common;

use nalgebra::Vector3;
use onorbit_core::environment::{BodyWrench, Effect, GravityGradient};
use onorbit_core::model::Model;
use onorbit_core::orbit::{Kepler, MU_EARTH};
use onorbit_core::simulation::{Simulation, Trace};
use std::sync::Arc;

fn run(record_every: usize, record_wrenches: bool) -> (Arc<Model>, Trace) {
    let model = Arc::new(common::humanoid::humanoid());
    let joints = model.joint_count();
    let mut q = vec![0.0; model.nq()];
    (q[2], q[6]) = (3.0, 1.0);
    let mut v = vec![0.0; model.nv()];
    v[6..6 + joints].iter_mut().enumerate().for_each(|(j, v)| *v = 0.05 * (j as f64 - 2.0));
    let (r, speed) = (Vector3::x() * 6.778e6, Vector3::y() * 7668.6);
    let push = |force: Vector3<f64>, start| -> Arc<dyn Effect> {
        let wrench = BodyWrench::new(0, force, Vector3::z() * 0.1).and_then(|w| w.during(start, 9.0));
        Arc::new(wrench.expect("in order"))
    };
    let mut simulation = Simulation::new(Arc::clone(&model), q, v);
    simulation.orbit = Some(Arc::new(Kepler::from_state(r, speed, MU_EARTH).expect("an ellipse")));
    simulation.effects =
        vec![Arc::new(GravityGradient), push(Vector3::x() * 0.5, 0.05), push(Vector3::y(), 0.1)];
    simulation.time_step = 0.01;
    simulation.record_every = record_every;
    simulation.record_wrenches = record_wrenches;
    let trace = simulation.run(0.5).expect("a run").only();
    (model, trace)
}

#[test]
fn every_effect_has_a_column() {
    let (model, trace) = run(1, true);
    let names: Vec<&str> = trace.wrenches.iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names, ["gravity_gradient", "body_wrench", "body_wrench_2", "gravity"]);
    let width = 6 * model.nodes().len();
    assert!(trace.wrenches.iter().all(|w| w.width == width && w.values.len() == width * trace.rows()));
    // before it is switched on the wrench is zero
    assert!(trace.wrenches[1].values[..4 * width].iter().all(|x| *x == 0.0));
    assert!(trace.wrenches[1].values[6 * width].abs() > 0.4);
    // without the option no column is stored, and the run is the same
    let (_, plain) = run(1, false);
    assert!(plain.wrenches.is_empty());
    assert_eq!(plain.q, trace.q);
}

#[test]
fn their_sum_is_the_rate_of_the_momentum() {
    let (_, trace) = run(1, true);
    let total = |k: usize| -> Vector3<f64> {
        let bodies = trace.wrenches.iter().flat_map(|w| {
            w.values[k * w.width..(k + 1) * w.width].chunks_exact(6).map(|f| Vector3::new(f[0], f[1], f[2]))
        });
        bodies.sum()
    };
    let (mut worst, mut without) = (0.0_f64, 0.0_f64);
    for k in 20..trace.rows() - 1 {
        let h = trace.time[k + 1] - trace.time[k];
        let momentum = |k: usize| Vector3::from_row_slice(&trace.momentum[6 * k..6 * k + 3]);
        let rate = (momentum(k + 1) - momentum(k)) / h;
        // trapezoidal rule over a step, of second order
        worst = worst.max((rate - (total(k) + total(k + 1)) / 2.0).norm());
        without = without.max(rate.norm());
    }
    println!("momentum's rate less the wrenches: {worst:.1e} N of {without:.1e} N");
    assert!(worst < 1e-6 * without);
}

#[test]
fn sparse_rows_hold_the_same_wrenches() {
    let ((_, all), (_, few)) = (run(1, true), run(5, true));
    for (all_rows, few_rows) in all.wrenches.iter().zip(&few.wrenches) {
        let width = few_rows.width;
        for (k, t) in few.time.iter().enumerate() {
            let same = all.time.iter().position(|time| time == t).expect("on the grid");
            let [a, b] = [(&all_rows.values, same), (&few_rows.values, k)]
                .map(|(values, k)| &values[k * width..(k + 1) * width]);
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12), "{} at {t} s", few_rows.name);
        }
    }
}
