//! Checks the operation counts of the recursions on arms of increasing length, which are linear except for
//! the mass matrix.
#![allow(missing_docs, unreachable_pub, clippy::unwrap_used)]

#[path = "common/chain.rs"]
mod chain;
#[path = "../../../benches/contestant/operation_count.rs"]
mod operation_count;

use chain::chain;
use onorbit_core::dynamics::{
    Data, FreeFloating, forward_dynamics, free_floating, inverse_dynamics, mass_matrix,
};
use onorbit_core::spatial::Real;
use operation_count::{CountedF64, during};

/// Returns the operations of forward dynamics, inverse dynamics, the mass matrix and the reduced model.
fn operations(joints: usize) -> [i64; 4] {
    let model = chain(joints);
    let numbers = |n: usize, seed: f64| -> Vec<CountedF64> {
        (0..n).map(|i| CountedF64::of((i as f64 + seed).sin())).collect()
    };
    let (mut q, v, x) = (numbers(joints + 7, 0.1), numbers(joints + 6, 0.2), numbers(joints + 6, 0.3));
    [0.0, 0.0, 0.6, 0.8].iter().zip(&mut q[3..7]).for_each(|(x, q)| *q = CountedF64::of(*x));
    let (mut data, mut reduced) = (Data::new(&model), FreeFloating::new(&model));
    let (mut a, mut matrix) = (numbers(joints + 6, 0.0), numbers((joints + 6) * (joints + 6), 0.0));
    let counted = [
        during(|| forward_dynamics(&model, &mut data, &q, &v, &x, &[], &mut a)),
        during(|| inverse_dynamics(&model, &mut data, &q, &v, &x, &[], &mut a)),
        during(|| mass_matrix(&model, &mut data, &q, &mut matrix)),
        during(|| free_floating(&model, &mut data, &q, &v, joints, &[], &mut reduced)),
    ];
    counted.map(|json| {
        let counts: std::collections::BTreeMap<String, i64> = serde_json::from_str(&json).unwrap();
        counts.values().sum()
    })
}

#[test]
fn forward_and_inverse_dynamics_have_linear_cost() {
    let counts = [20, 60, 100].map(operations);
    for kernel in 0..4 {
        let [short, middle, long] = counts.map(|count| count[kernel]);
        println!("{short} {middle} {long}: {} a joint", (long - middle) / 40);
        let second_difference = (long - middle) - (middle - short);
        // the entries of a matrix grow with the number of pairs of joints; recursions must not
        assert_eq!(
            second_difference == 0,
            kernel < 2,
            "kernel {kernel}: second difference {second_difference}"
        );
    }
}
