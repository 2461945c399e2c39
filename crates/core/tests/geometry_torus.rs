//! Distances of tori against a dense search along both surfaces.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // a test that prints its largest errors

#[path = "common/random_shapes.rs"]
mod random_shapes;

use onorbit_core::geometry::{GeometryError, Pose, Shape, closest, signed_distance};
use onorbit_core::spatial::Vec3;
use random_shapes::Random;
use std::f64::consts::TAU;

fn torus(random: &mut Random) -> (Shape, f64, f64) {
    let (major_radius, minor_radius) = (random.within(0.5, 1.5), random.within(0.05, 0.4));
    (Shape::Torus { major_radius, minor_radius }, major_radius, minor_radius)
}

/// Returns the least distance of the points of a circle from a shape, less a radius.
fn searched(shape: &Shape, at: &Pose, (major, minor): (f64, f64), pose: &Pose) -> f64 {
    let distance = |angle: f64| {
        let p = pose.to_common(Vec3::new(major * angle.cos(), major * angle.sin(), 0.0));
        match signed_distance(shape, at.to_shape(p)) {
            Some(nearest) => nearest.distance,
            None => {
                closest(shape, at, &Shape::Sphere { radius: 1e-3 }, &Pose::at(p)).unwrap().distance + 1e-3
            }
        }
    };
    let mut best = (f64::INFINITY, 0.0);
    for k in 0..2000 {
        let angle = TAU * f64::from(k) / 2000.0;
        if distance(angle) < best.0 {
            best = (distance(angle), angle);
        }
    }
    let mut width = TAU / 2000.0;
    while width > 1e-9 {
        for angle in [best.1 - width, best.1 + width] {
            if distance(angle) < best.0 {
                best = (distance(angle), angle);
            }
        }
        width *= 0.7;
    }
    best.0 - minor
}

#[test]
fn tori_have_the_distance_of_a_dense_search_and_follow_their_normal() {
    let (mut random, mut worst, mut deep) = (Random(41), [0.0_f64; 3], 0);
    for k in 0..420 {
        let (ring, major, minor) = torus(&mut random);
        let other = if k % 7 == 6 { torus(&mut random).0 } else { random.shape(k % 7) };
        let (at_other, mut at_ring) = (random.pose(0.5), random.pose(1.5));
        let Ok(first) = closest(&other, &at_other, &ring, &at_ring) else {
            deep += 1;
            continue;
        };
        // half of the pairs overlap by less than the minor radius
        let target = if k % 2 == 0 { -0.5 * minor } else { random.within(1e-6, 1.0) };
        at_ring.pos += first.normal * (target - first.distance);
        let found = match closest(&other, &at_other, &ring, &at_ring) {
            Ok(found) => found,
            Err(GeometryError::Unavailable(_)) => {
                deep += 1;
                continue;
            }
            Err(error) => panic!("{k}: {error}"),
        };
        let exact = searched(&other, &at_other, (major, minor), &at_ring);
        worst[0] = worst[0].max((found.distance - exact).abs());
        let between = found.point_b - found.point_a - found.normal * found.distance;
        worst[1] = worst[1].max(between.norm()).max((found.normal.norm() - 1.0).abs());
        let moved = Pose { pos: at_ring.pos + found.normal * 1e-6, ..at_ring };
        let moved = closest(&other, &at_other, &ring, &moved).unwrap();
        worst[2] = worst[2].max((moved.distance - found.distance - 1e-6).abs());
        let exchanged = closest(&ring, &at_ring, &other, &at_other).unwrap();
        assert!((exchanged.distance - found.distance).abs() < 1e-12, "{k}");
    }
    println!("search {:e}, points {:e}, moved {:e}, {deep} of 420 too deep", worst[0], worst[1], worst[2]);
    assert!(worst[0] < 1e-9 && worst[1] < 1e-9 && worst[2] < 1e-9);
    assert!(deep < 210);
}
