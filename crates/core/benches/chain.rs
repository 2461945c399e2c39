//! Prints the time per joint of the recursions on chains of 10 to 100 joints. It is expected to be constant,
//! except for the mass matrix, whose number of entries grows with the number of pairs of joints.
#![allow(missing_docs, unreachable_pub, clippy::unwrap_used, clippy::print_stdout)] // a program that prints

#[path = "../tests/common/chain.rs"]
mod chain;

use chain::chain;
use onorbit_core::dynamics::{Data, forward_dynamics, inverse_dynamics, mass_matrix};
use onorbit_core::spatial::{Fused, Real};
use std::hint::black_box;
use std::time::Instant;

const ROUNDS: usize = 50;
const CALLS: usize = 200;

/// Returns the shortest mean time of a call, ns, over the rounds.
fn best(mut f: impl FnMut()) -> f64 {
    let round = |_| {
        let started = Instant::now();
        (0..CALLS).for_each(|_| f());
        started.elapsed().as_secs_f64() * 1e9 / CALLS as f64
    };
    (0..ROUNDS).map(round).fold(f64::INFINITY, f64::min)
}

fn measure<S: Real>(scalar: &str) {
    println!("{scalar}: ns per joint\njoints      aba     rnea     crba");
    for joints in [10, 20, 40, 70, 100] {
        let model = chain(joints);
        let numbers =
            |n: usize, seed: f64| -> Vec<S> { (0..n).map(|i| S::of((i as f64 + seed).sin())).collect() };
        let (mut q, v, tau) = (numbers(joints + 7, 0.1), numbers(joints + 6, 0.2), numbers(joints + 6, 0.3));
        [0.0, 0.0, 0.6, 0.8].iter().zip(&mut q[3..7]).for_each(|(x, q)| *q = S::of(*x));
        let (mut data, mut out) = (Data::<S>::new(&model), numbers((joints + 6) * (joints + 6), 0.0));
        let times = [
            best(|| forward_dynamics(&model, &mut data, black_box(&q), &v, &tau, &[], &mut out)),
            best(|| inverse_dynamics(&model, &mut data, black_box(&q), &v, &tau, &[], &mut out)),
            best(|| mass_matrix(&model, &mut data, black_box(&q), &mut out)),
        ];
        let [aba, rnea, crba] = times.map(|time| time / joints as f64);
        println!("{joints:6} {aba:8.1} {rnea:8.1} {crba:8.1}");
    }
}

fn main() {
    measure::<f64>("plain");
    if Fused::is_available() {
        measure::<Fused>("fused");
    }
}
