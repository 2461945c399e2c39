//! Signed distances of random pairs of shapes against the definition: the largest separation of supporting planes.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // a test that prints its largest errors

#[path = "common/random_shapes.rs"]
mod random_shapes;

use onorbit_core::geometry::{Pose, Proximity, Shape, closest, signed_distance};
use onorbit_core::spatial::{Vec3, exp_so3};
use random_shapes::{KINDS, Random, separation};

/// Largest error of a distance for shapes of 1 m, m.
const ACCURACY: f64 = 1e-9;

type Worst = [[f64; 6]; 6];

fn print(title: &str, worst: &Worst) {
    println!("{title}: {KINDS:?}");
    for (name, row) in KINDS.iter().zip(worst) {
        println!("{name:>9} {:?}", row.map(|x| format!("{x:.0e}")));
    }
}

fn largest(worst: &Worst) -> f64 {
    worst.iter().flatten().fold(0.0, |a: f64, b| if b.is_nan() { f64::NAN } else { a.max(*b) })
}

/// Returns how far a point is from the surface of a shape, where a closed form exists.
fn off_surface(shape: &Shape, pose: &Pose, point: Vec3<f64>) -> f64 {
    signed_distance(shape, pose.to_shape(point)).map_or(0.0, |nearest| nearest.distance.abs())
}

#[test]
fn separated_convex_pairs_attain_the_bound_of_their_separating_planes() {
    let (mut random, mut worst, mut points) = (Random(7), Worst::default(), Worst::default());
    for (i, j) in (0..36).map(|k| (k / 6, k % 6)) {
        for _ in 0..200 {
            let (a, b) = (random.shape(i), random.shape(j));
            let (at_a, mut at_b) = (random.pose(1.0), random.pose(1.0));
            at_b.pos += Vec3::new(5.0, 0.0, 0.0);
            // a second time at a distance of a micrometre to a metre
            let first = closest(&a, &at_a, &b, &at_b).unwrap();
            let gap = 10_f64.powf(random.within(-6.0, 0.0));
            at_b.pos += first.normal * (gap - first.distance);
            for at_b in [at_b, Pose { pos: at_b.pos + first.normal, ..at_b }] {
                let found = closest(&a, &at_a, &b, &at_b).unwrap();
                assert!(found.distance > 0.0);
                let below = separation((&a, &at_a), (&b, &at_b), found.normal);
                let between = (found.point_b - found.point_a).norm();
                worst[i][j] = worst[i][j].max((found.distance - below).abs());
                points[i][j] = points[i][j]
                    .max((found.distance - between).abs())
                    .max(off_surface(&a, &at_a, found.point_a))
                    .max(off_surface(&b, &at_b, found.point_b));
            }
        }
    }
    print("distance against the planes", &worst);
    print("witness points", &points);
    assert!(largest(&worst) < ACCURACY && largest(&points) < ACCURACY);
}

/// Returns all normals at which the separation of two polytopes can be largest: of faces, and of pairs of edges.
fn candidates(hulls: [(&Shape, &Pose); 2]) -> Vec<Vec3<f64>> {
    let mut normals = Vec::new();
    let mut edges = [Vec::new(), Vec::new()];
    for (index, (shape, pose)) in hulls.into_iter().enumerate() {
        let Shape::Hull(hull) = shape else { unreachable!() };
        let vertices = hull.vertices();
        for face in hull.faces() {
            normals.push(pose.rot * face.normal);
            for (k, corner) in face.corners.iter().enumerate() {
                let other = face.corners[(k + 1) % face.corners.len()];
                edges[index].push(pose.rot * (vertices[other] - vertices[*corner]));
            }
        }
    }
    for u in &edges[0] {
        for v in &edges[1] {
            let cross = u.cross(*v);
            if cross.norm() > 1e-9 {
                normals.push(cross * (1.0 / cross.norm()));
            }
        }
    }
    normals.iter().flat_map(|n| [*n, -*n]).collect()
}

fn corners_of_box([x, y, z]: [f64; 3]) -> Shape {
    let sign = |k: usize, bit: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
    Shape::hull(
        &(0..8).map(|k| Vec3::new(x * sign(k, 0), y * sign(k, 1), z * sign(k, 2))).collect::<Vec<_>>(),
    )
    .unwrap()
}

#[test]
fn overlapping_polytopes_have_the_depth_of_the_best_of_all_their_normals() {
    let (mut random, mut worst) = (Random(11), 0.0_f64);
    for k in 0..400 {
        let half_edges = [random.within(0.1, 1.0), random.within(0.1, 1.0), random.within(0.1, 1.0)];
        let (a, b) = (corners_of_box(half_edges), random.shape(5));
        let (at_a, at_b) = (random.pose(0.3), random.pose(if k % 2 == 0 { 0.3 } else { 1.2 }));
        let normals = candidates([(&a, &at_a), (&b, &at_b)]);
        let exact = normals
            .iter()
            .map(|n| separation((&a, &at_a), (&b, &at_b), *n))
            .fold(f64::NEG_INFINITY, f64::max);
        if exact > 0.0 {
            continue;
        }
        for a in [&a, &Shape::Box { half_edges }] {
            let found = closest(a, &at_a, &b, &at_b).unwrap();
            worst = worst.max((found.distance - exact).abs());
            let between = found.point_b - found.point_a;
            assert!((between - found.normal * exact).norm() < ACCURACY, "{k}: {found:?} {exact}");
        }
    }
    println!("overlapping polytopes: {worst:e}");
    assert!(worst < 1e-13);
}

/// Returns the largest separation near a normal and over random normals.
fn searched(a: (&Shape, &Pose), b: (&Shape, &Pose), n: Vec3<f64>, random: &mut Random) -> f64 {
    let mut best = f64::NEG_INFINITY;
    for k in 0..400 {
        let spread = 10_f64.powf(-f64::from(k % 8));
        let near = n + random.direction() * spread;
        for d in [near * (1.0 / near.norm()), random.direction()] {
            best = best.max(separation(a, b, d));
        }
    }
    best
}

#[test]
fn overlapping_convex_pairs_have_no_shorter_translation_that_separates_them() {
    let (mut random, mut worst, mut points) = (Random(13), Worst::default(), Worst::default());
    for (i, j) in (0..36).map(|k| (k / 6, k % 6)) {
        for k in 0..60 {
            let (a, b) = (random.shape(i), random.shape(j));
            let (at_a, mut at_b) = (random.pose(0.3), random.pose(0.6));
            let first = closest(&a, &at_a, &b, &at_b).unwrap_or_else(|e| panic!("{i} {j} {k}: {e}"));
            if k % 2 == 0 {
                // shallow: a micrometre to 10 cm
                let depth = 10_f64.powf(random.within(-6.0, -1.0));
                at_b.pos += first.normal * (-depth - first.distance);
            }
            let found = closest(&a, &at_a, &b, &at_b).unwrap();
            let at = |n| separation((&a, &at_a), (&b, &at_b), n);
            worst[i][j] = worst[i][j].max((found.distance - at(found.normal)).abs());
            let better = searched((&a, &at_a), (&b, &at_b), found.normal, &mut random) - found.distance;
            worst[i][j] = worst[i][j].max(if found.distance < 0.0 { better } else { 0.0 });
            points[i][j] =
                points[i][j].max((found.point_b - found.point_a - found.normal * found.distance).norm());
        }
    }
    print("better normals", &worst);
    print("witness points", &points);
    assert!(largest(&worst) < ACCURACY);
}

fn any_pair(random: &mut Random, k: usize) -> (Shape, Pose, Shape, Pose) {
    let (a, b) = (random.shape(k % 6), random.shape(k / 6 % 6));
    let apart = [0.3, 1.0, 2.0][k / 36 % 3];
    let (at_a, at_b) = (random.pose(0.3), random.pose(apart));
    (a, at_a, b, at_b)
}

#[test]
fn moving_a_body_along_the_normal_changes_the_distance_by_as_much() {
    let (mut random, mut worst) = (Random(17), Worst::default());
    for k in 0..3600 {
        let (a, at_a, b, at_b) = any_pair(&mut random, k);
        let found = closest(&a, &at_a, &b, &at_b).unwrap();
        for eps in [1e-3, -1e-3] {
            let moved = Pose { pos: at_b.pos + found.normal * eps, ..at_b };
            let moved = closest(&a, &at_a, &b, &moved).unwrap();
            // inside, another normal may become the best: the depth is then less
            let error = moved.distance - found.distance - eps;
            let error = if found.distance < 0.0 && eps < 0.0 && error > 0.0 { 0.0 } else { error.abs() };
            worst[k % 6][k / 6 % 6] = worst[k % 6][k / 6 % 6].max(error);
        }
    }
    print("moved along the normal", &worst);
    assert!(largest(&worst) < ACCURACY);
}

fn difference(p: &Proximity, q: &Proximity) -> f64 {
    (p.distance - q.distance).abs()
}

#[test]
fn exchanged_shapes_and_moved_axes_give_the_same_distance() {
    let (mut random, mut worst) = (Random(19), [0.0_f64; 3]);
    for k in 0..1080 {
        let (a, at_a, b, at_b) = any_pair(&mut random, k);
        let found = closest(&a, &at_a, &b, &at_b).unwrap();
        let exchanged = closest(&b, &at_b, &a, &at_a).unwrap();
        worst[0] = worst[0].max(difference(&found, &exchanged));
        let normals = (found.normal + exchanged.normal).norm();
        assert!(normals < 1e-5 || k % 6 == k / 6 % 6, "{k}: {found:?} {exchanged:?}");
        assert!((found.normal.norm() - 1.0).abs() < 1e-14, "{k}");
        let turned = random.pose(3.0);
        let moved = closest(&a, &turned.compose(&at_a), &b, &turned.compose(&at_b)).unwrap();
        worst[1] = worst[1].max(difference(&found, &moved));
        let far = Pose::at(Vec3::new(1e5, -1e5, 1e5));
        let moved = closest(&a, &far.compose(&at_a), &b, &far.compose(&at_b)).unwrap();
        worst[2] = worst[2].max(difference(&found, &moved));
    }
    println!("exchanged {:e}, turned {:e}, far {:e}", worst[0], worst[1], worst[2]);
    assert!(worst[0] < ACCURACY && worst[1] < ACCURACY);
    assert!(worst[2] < 1e-10 + ACCURACY); // positions are rounded to 1.5e-11 m
}

#[test]
fn touching_aligned_and_identical_poses_have_a_distance_and_a_unit_normal() {
    let (mut random, mut worst) = (Random(23), 0.0_f64);
    let quarter = exp_so3(Vec3::new(0.0, std::f64::consts::FRAC_PI_2, 0.0)).matrix();
    for k in 0..10_800 {
        let (mut a, mut b) = (random.shape(k % 6), random.shape(k / 6 % 6));
        if k % 3 == 0 {
            (a, b) = (unit_shape(k % 5), unit_shape(k / 6 % 5));
        }
        let at_a = Pose::identity();
        let mut step = || f64::from((random.unit() * 5.0) as u32) * 0.5 - 1.0;
        let mut at_b = Pose::at(Vec3::new(step(), step(), step()));
        if k % 2 == 0 {
            at_b.rot = quarter;
        }
        let found = closest(&a, &at_a, &b, &at_b).unwrap_or_else(|error| panic!("{k}: {error}"));
        assert!((found.normal.norm() - 1.0).abs() < 1e-9, "{k}: {found:?}");
        let certified = separation((&a, &at_a), (&b, &at_b), found.normal);
        let better = searched((&a, &at_a), (&b, &at_b), found.normal, &mut random);
        worst = worst.max((certified - found.distance).abs());
        if found.distance < 0.0 {
            worst = worst.max(better - found.distance);
        }
        assert!(worst < ACCURACY, "{k}: {worst:e} {a:?} {b:?} {at_b:?} {found:?}");
    }
    println!("aligned: {worst:e}");
}

/// Returns a shape with round dimensions.
fn unit_shape(kind: usize) -> Shape {
    match kind {
        0 => Shape::Sphere { radius: 0.5 },
        1 => Shape::Capsule { radius: 0.5, half_length: 0.5 },
        2 => Shape::Box { half_edges: [0.5; 3] },
        3 => Shape::Cylinder { radius: 0.5, half_length: 0.5 },
        _ => Shape::Cone { radius: 0.5, half_length: 0.5 },
    }
}

/// Returns a shape with lengths between 1 mm and 10 m.
fn thin_or_long(random: &mut Random, kind: usize) -> Shape {
    let mut length = || 10_f64.powf(random.within(-3.0, 1.0));
    let (radius, half_length, third) = (length(), length(), length());
    match kind {
        0 => Shape::Sphere { radius },
        1 => Shape::Capsule { radius, half_length },
        2 => Shape::Box { half_edges: [radius, half_length, third] },
        3 => Shape::Cylinder { radius, half_length },
        4 => Shape::Cone { radius, half_length },
        _ => {
            let points = (0..20).map(|_| random.vector(1.0));
            let scaled = |v: Vec3<f64>| Vec3::new(radius * v.x, half_length * v.y, third * v.z);
            Shape::hull(&points.map(scaled).collect::<Vec<_>>()).unwrap()
        }
    }
}

#[test]
fn plates_and_rods_close_to_contact_have_the_separation_of_their_planes() {
    let (mut random, mut worst) = (Random(77), 0.0_f64);
    for k in 0..3600 {
        let (a, b) = (thin_or_long(&mut random, k % 6), thin_or_long(&mut random, k / 6 % 6));
        let (at_a, mut at_b) = (random.pose(3.0), random.pose(3.0));
        let size = a.bounding_sphere().radius.max(b.bounding_sphere().radius);
        for sign in [1.0, -1.0, 0.0] {
            let found = closest(&a, &at_a, &b, &at_b).unwrap_or_else(|error| panic!("{k}: {error}"));
            let planes = separation((&a, &at_a), (&b, &at_b), found.normal);
            worst = worst.max((planes - found.distance).abs() / size);
            // next at a distance or a depth of 1e-9 to 1e-2 of the size, and in contact
            let target = sign * size * 10_f64.powf(random.within(-9.0, -2.0));
            at_b.pos += found.normal * (target - found.distance);
        }
    }
    println!("plates and rods: {worst:e} of the size");
    assert!(worst < ACCURACY);
}
