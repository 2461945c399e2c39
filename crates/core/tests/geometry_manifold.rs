//! Contact points: corners of the common patch, and weights that are continuous.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // a test that prints its largest errors

#[path = "common/random_shapes.rs"]
mod random_shapes;

use onorbit_core::geometry::{Manifold, Pose, Shape, manifold};
use onorbit_core::spatial::{Mat3, Vec3, exp_so3};
use random_shapes::{KINDS, Random};

const BOX: Shape = Shape::Box { half_edges: [1.0, 2.0, 0.5] };

fn turned(x: f64, y: f64, z: f64) -> Mat3<f64> {
    exp_so3(Vec3::new(x, y, z)).matrix()
}

fn on_plane(shape: &Shape, rot: Mat3<f64>, z: f64) -> Manifold {
    manifold(&Shape::HalfSpace, &Pose::identity(), shape, &Pose { rot, pos: Vec3::new(0.0, 0.0, z) }).unwrap()
}

/// Returns force and moment about the origin on the second shape, for a linear stiffness of 1 N/m.
fn wrench(contact: &Manifold) -> [Vec3<f64>; 2] {
    contact.points.iter().fold([Vec3::zero(); 2], |[force, moment], point| {
        let part = contact.proximity.normal * (point.weight * point.depth.max(0.0));
        [force + part, moment + point.point_b.cross(part)]
    })
}

#[test]
fn a_box_that_lies_flat_has_four_points_of_a_quarter() {
    let contact = on_plane(&BOX, turned(0.0, 0.0, 0.3), 0.49);
    assert_eq!(contact.points.len(), 4);
    for point in &contact.points {
        assert!((point.weight - 0.25).abs() < 1e-15 && (point.depth - 0.01).abs() < 1e-15);
        assert!((point.point_a.z).abs() < 1e-15 && (point.point_b.z + 0.01).abs() < 1e-15);
        assert!((point.point_b.norm() - 5.0_f64.sqrt()).abs() < 1e-4);
    }
    let cube = Shape::Box { half_edges: [1.0; 3] };
    let above = Pose { rot: turned(0.0, 0.0, 0.4), pos: Vec3::new(1.5, 0.5, 1.99) };
    let contact = manifold(&cube, &Pose::identity(), &cube, &above).unwrap();
    let [force, moment] = wrench(&contact);
    assert!((force.z - 0.01).abs() < 1e-15);
    let total: f64 = contact.points.iter().map(|point| point.weight).sum();
    assert!((total - 1.0).abs() < 1e-15);
    // the force acts at the centroid of the patch, which lies inside both faces
    let center = Vec3::new(-moment.y, moment.x, 0.0) * (1.0 / force.z);
    assert!(center.x > 0.5 && center.x < 1.0 && center.y.abs() < 1.0, "{center:?}");
}

#[test]
fn the_resultant_of_a_flat_face_acts_at_its_centroid() {
    let base = [[0.0, 0.0], [4.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    let points: Vec<_> = base.iter().flat_map(|[x, y]| [0.0, 1.0].map(|z| Vec3::new(*x, *y, z))).collect();
    let contact = on_plane(&Shape::hull(&points).unwrap(), turned(0.0, 0.0, 0.0), -0.01);
    let [force, moment] = wrench(&contact);
    assert!((force.z - 0.01).abs() < 1e-15);
    assert!(
        (moment.x / force.z - 8.0 / 9.0).abs() < 1e-13 && (moment.y / force.z + 14.0 / 9.0).abs() < 1e-13
    );
    assert_eq!(contact.points.len(), 4);
}

#[test]
fn edges_corners_lines_and_points_have_the_whole_weight() {
    let weights = |contact: &Manifold| contact.points.iter().map(|p| p.weight).collect::<Vec<_>>();
    let edge = on_plane(&BOX, turned(0.0, 0.8, 0.0), 1.0);
    assert_eq!(weights(&edge), [0.5, 0.5]);
    let corner = on_plane(&BOX, turned(0.5, 0.8, 0.0), 1.0);
    assert_eq!(weights(&corner), [1.0]);
    assert!((corner.points[0].depth + corner.proximity.distance).abs() < 1e-15);
    let cylinder = Shape::Cylinder { radius: 0.5, half_length: 1.0 };
    let lying = on_plane(&cylinder, turned(std::f64::consts::FRAC_PI_2, 0.0, 0.0), 0.5);
    assert_eq!(weights(&lying), [0.5, 0.5]);
    let standing = on_plane(&cylinder, turned(0.0, 0.0, 0.0), 1.0);
    assert!(weights(&standing).iter().all(|weight| (weight - 0.125).abs() < 1e-15));
    assert_eq!(weights(&on_plane(&Shape::Sphere { radius: 0.5 }, turned(0.0, 0.0, 0.0), 0.4)), [1.0]);
    let capsule = Shape::Capsule { radius: 0.25, half_length: 1.0 };
    let at = |rot| Pose { rot, pos: Vec3::new(0.0, 0.49, 0.5) };
    let parallel = manifold(&capsule, &Pose::identity(), &capsule, &at(turned(0.0, 0.0, 1.0))).unwrap();
    assert_eq!(weights(&parallel), [0.5, 0.5]);
    assert!(parallel.points.iter().all(|point| (point.depth - 0.01).abs() < 1e-14));
    let crossed = manifold(&capsule, &Pose::identity(), &capsule, &at(turned(0.0, 1.0, 0.0))).unwrap();
    assert_eq!(weights(&crossed), [1.0]);
}

/// Returns the largest change of the force or the moment from one pose to the next on a path of `steps` poses.
fn largest_change(steps: usize, at: &dyn Fn(f64) -> Manifold) -> f64 {
    let mut before = wrench(&at(0.0));
    let mut largest = 0.0_f64;
    for k in 1..=steps {
        let now = wrench(&at(k as f64 / steps as f64));
        largest = largest.max((now[0] - before[0]).norm()).max((now[1] - before[1]).norm());
        before = now;
    }
    largest
}

#[test]
fn forces_are_continuous_while_a_body_tilts_turns_and_slides() {
    let mut random = Random(31);
    let cube = Shape::Box { half_edges: [1.0, 0.7, 0.5] };
    let slide = |t: f64| {
        let pose = Pose { rot: turned(0.0, 0.0, 2.0 * t), pos: Vec3::new(2.0 * t - 1.0, 0.3 - t, 0.99) };
        manifold(&cube, &Pose::identity(), &cube, &pose).unwrap()
    };
    // the change per step shrinks with the step: tenfold for ten times as many
    let shrinks = |name: &str, at: &dyn Fn(f64) -> Manifold| {
        let (coarse, fine) = (largest_change(2000, at), largest_change(20_000, at));
        println!("{name}: {coarse:e} {fine:e}");
        assert!(fine < 0.2 * coarse, "{name}: {coarse:e} {fine:e}");
    };
    shrinks("sliding box", &slide);
    for kind in 1..6 {
        let (shape, axis) = (random.shape(kind), random.direction());
        let tilt = |t: f64| {
            let rot = exp_so3(axis * (1.5 * t)).matrix();
            let low = on_plane(&shape, rot, 0.0).proximity.distance;
            on_plane(&shape, rot, -low - 0.01)
        };
        shrinks(&format!("tilting {}", KINDS[kind]), &tilt);
    }
    let capsule = Shape::Capsule { radius: 0.25, half_length: 1.0 };
    let twist = |t: f64| {
        let pose = Pose { rot: turned(0.0, 0.5 * t - 0.2, 0.0), pos: Vec3::new(0.0, 0.49, 0.3) };
        manifold(&capsule, &Pose::identity(), &capsule, &pose).unwrap()
    };
    shrinks("twisting capsules", &twist);
}

#[test]
fn random_contacts_have_weights_that_sum_to_one_and_no_point_deeper_than_the_depth() {
    let (mut random, mut missed, mut count) = (Random(37), 0, 0);
    for k in 0..3600 {
        let (a, b) = (random.shape(k % 6), random.shape(k / 6 % 6));
        let (at_a, mut at_b) = (random.pose(0.3), random.pose(0.6));
        let first = manifold(&a, &at_a, &b, &at_b).unwrap().proximity;
        at_b.pos += first.normal * (-1e-3 - first.distance);
        let contact = manifold(&a, &at_a, &b, &at_b).unwrap();
        let total: f64 = contact.points.iter().map(|point| point.weight).sum();
        assert!((total - 1.0).abs() < 1e-13, "{k}: {contact:?}");
        let depth = -contact.proximity.distance;
        let deepest = contact.points.iter().map(|p| p.depth).fold(f64::NEG_INFINITY, f64::max);
        assert!(deepest < depth + 1e-9, "{k}: {contact:?}");
        count += 1;
        if deepest < depth - 1e-6 {
            missed += 1;
            println!("{} {}: {deepest:e} {depth:e} {contact:?}", a.name(), b.name());
        }
    }
    println!("{missed} of {count} contacts miss the deepest point");
    assert_eq!(missed, 0);
}
