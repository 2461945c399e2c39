//! What the recursions cost on longer and longer arms, in operations counted: linear, but for the mass matrix.
#![allow(missing_docs, unreachable_pub, clippy::unwrap_used)]

#[path = "common/chain.rs"]
mod chain;
#[path = "../../../benches/contestant/counted.rs"]
mod counted;

use chain::chain;
use counted::{Counted, during};
use onorbit_core::dynamics::{
    Data, FreeFloating, forward_dynamics, free_floating, inverse_dynamics, mass_matrix,
};
use onorbit_core::spatial::Real;

/// Operations of forward dynamics, inverse dynamics, the mass matrix and the reduced model.
fn operations(joints: usize) -> [i64; 4] {
    let model = chain(joints);
    let numbers = |n: usize, seed: f64| -> Vec<Counted> {
        (0..n).map(|i| Counted::of((i as f64 + seed).sin())).collect()
    };
    let (mut q, v, x) = (numbers(joints + 7, 0.1), numbers(joints + 6, 0.2), numbers(joints + 6, 0.3));
    [0.0, 0.0, 0.6, 0.8].iter().zip(&mut q[3..7]).for_each(|(x, q)| *q = Counted::of(*x));
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
fn forward_and_inverse_dynamics_cost_the_same_for_every_joint_more() {
    let counts = [20, 60, 100].map(operations);
    for kernel in 0..4 {
        let [short, middle, long] = counts.map(|count| count[kernel]);
        println!("{short} {middle} {long}: {} a joint", (long - middle) / 40);
        let bend = (long - middle) - (middle - short);
        // entries of a matrix are as many as pairs of joints; a recursion must not cost the like
        assert_eq!(bend == 0, kernel < 2, "kernel {kernel}: bent by {bend}");
    }
}
