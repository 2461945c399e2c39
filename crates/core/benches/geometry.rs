//! Benches of the distance and of the contact points of two shapes.
//!
//! Varied: the kinds of shapes, and their distance: 0.1 m apart or overlapping by 1 mm. Fixed: the size of
//! the shapes, about 1 m. The poses vary from call to call.
#![allow(missing_docs, clippy::unwrap_used)] // criterion's macros make an undocumented function

#[path = "../tests/common/random_shapes.rs"]
mod random_shapes;

use criterion::{Criterion, criterion_group, criterion_main};
use onorbit_core::geometry::{Pose, Shape, closest, manifold};
use random_shapes::{KINDS, Random};
use std::hint::black_box;

const PAIRS: usize = 256;

/// Pairs of kinds of shapes that are timed, as indices into [`KINDS`].
const COMBINATIONS: [(usize, usize); 7] = [(0, 2), (1, 1), (1, 2), (2, 2), (5, 5), (2, 3), (3, 3)];

fn pairs(i: usize, j: usize, distance: f64) -> Vec<(Shape, Pose, Shape, Pose)> {
    let mut random = Random(3);
    let mut pair = || {
        let (a, b, at_a, mut at_b) = (random.shape(i), random.shape(j), random.pose(1.0), random.pose(1.0));
        let found = closest(&a, &at_a, &b, &at_b).unwrap();
        at_b.pos += found.normal * (distance - found.distance);
        (a, at_a, b, at_b)
    };
    (0..PAIRS).map(|_| pair()).collect()
}

fn geometry(c: &mut Criterion) {
    for (what, distance) in [("apart", 0.1), ("overlapping", -1e-3)] {
        let mut group = c.benchmark_group(what);
        for (i, j) in COMBINATIONS {
            let pairs = pairs(i, j, distance);
            let mut k = 0;
            group.bench_function(format!("closest_{}_{}", KINDS[i], KINDS[j]), |bencher| {
                bencher.iter(|| {
                    k = (k + 1) % PAIRS;
                    let (a, at_a, b, at_b) = &pairs[k];
                    closest(black_box(a), at_a, b, at_b)
                });
            });
            group.bench_function(format!("manifold_{}_{}", KINDS[i], KINDS[j]), |bencher| {
                bencher.iter(|| {
                    k = (k + 1) % PAIRS;
                    let (a, at_a, b, at_b) = &pairs[k];
                    manifold(black_box(a), at_a, b, at_b)
                });
            });
        }
        group.finish();
    }
}

criterion_group!(benches, geometry);
criterion_main!(benches);
