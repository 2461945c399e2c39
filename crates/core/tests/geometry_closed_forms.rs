//! Distances with closed forms, hulls, compounds, and invalid input.
#![allow(clippy::unwrap_used)] // a test

#[path = "common/random_shapes.rs"]
mod random_shapes;

use onorbit_core::geometry::{GeometryError, Hull, Pose, Shape, closest};
use onorbit_core::spatial::{Vec3, exp_so3};
use random_shapes::{Random, height};
use std::sync::Arc;

fn distance(a: &Shape, b: &Shape, x: f64, y: f64, z: f64) -> f64 {
    let (here, there) = (Pose::identity(), Pose::at(Vec3::new(x, y, z)));
    let found = closest(a, &here, b, &there).unwrap();
    assert!((found.normal.norm() - 1.0).abs() < 1e-15);
    found.distance
}

#[test]
fn simple_poses_have_the_distances_of_their_closed_forms() {
    let sphere = Shape::Sphere { radius: 0.5 };
    let capsule = Shape::Capsule { radius: 0.25, half_length: 1.0 };
    let cube = Shape::Box { half_edges: [1.0; 3] };
    let cylinder = Shape::Cylinder { radius: 1.0, half_length: 0.5 };
    let cone = Shape::Cone { radius: 1.0, half_length: 0.5 };
    let torus = Shape::Torus { major_radius: 2.0, minor_radius: 0.5 };
    let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    close(distance(&sphere, &sphere, 3.0, 4.0, 0.0), 4.0);
    close(distance(&sphere, &sphere, 0.0, 0.0, 0.0), -1.0);
    close(distance(&sphere, &capsule, 0.0, 3.0, 5.0), 5.0 - 0.75);
    close(distance(&capsule, &capsule, 1.0, 0.0, 0.5), 0.5);
    close(distance(&capsule, &capsule, 0.0, 3.0, 6.0), 4.5);
    close(distance(&sphere, &cube, 3.0, 3.0, 0.0), 8.0_f64.sqrt() - 0.5);
    close(distance(&sphere, &cube, 0.9, 0.0, 0.0), -0.6);
    close(distance(&sphere, &cylinder, 0.0, 4.0, 0.0), 2.5);
    close(distance(&sphere, &cylinder, 4.0, 0.0, 4.5), 4.5);
    close(distance(&sphere, &cone, 0.0, 0.0, -3.0), 2.0);
    close(distance(&sphere, &torus, 2.0, 0.0, 1.0), 0.0);
    close(distance(&sphere, &torus, 0.0, 0.0, 0.0), 1.0);
    close(distance(&cube, &cube, 2.5, 0.0, 0.0), 0.5);
    close(distance(&cube, &cube, 1.75, 0.5, 0.0), -0.25);
    close(distance(&capsule, &cube, 1.5, 0.0, 0.0), 0.25);
    close(distance(&cylinder, &cylinder, 0.0, 0.0, 0.75), -0.25);
}

#[test]
fn half_spaces_have_the_distance_of_the_lowest_point() {
    let mut random = Random(3);
    for k in 0..120 {
        let (shape, pose, ground) = (random.shape(k % 6), random.pose(2.0), random.pose(1.0));
        let found = closest(&shape, &pose, &Shape::HalfSpace, &ground).unwrap();
        let up = ground.rot.z;
        let lowest = -height(&shape, &pose, -up) - ground.pos.dot(up);
        assert!((found.distance - lowest).abs() < 1e-14, "{k}");
        assert!((found.normal + up).norm() < 1e-14);
        let exchanged = closest(&Shape::HalfSpace, &ground, &shape, &pose).unwrap();
        assert_eq!(exchanged, found.exchanged());
    }
    let torus = Shape::Torus { major_radius: 2.0, minor_radius: 0.5 };
    let tilted = Pose { rot: exp_so3(Vec3::new(0.3, 0.0, 0.0)).matrix(), pos: Vec3::new(0.0, 0.0, 3.0) };
    let found = closest(&torus, &tilted, &Shape::HalfSpace, &Pose::identity()).unwrap();
    assert!((found.distance - (3.0 - 2.0 * 0.3_f64.sin() - 0.5)).abs() < 1e-15);
}

#[test]
fn capsules_that_cross_have_a_normal_perpendicular_to_both_axes() {
    let capsule = Shape::Capsule { radius: 0.25, half_length: 1.0 };
    let across = Pose {
        rot: exp_so3(Vec3::new(0.0, std::f64::consts::FRAC_PI_2, 0.0)).matrix(),
        pos: Vec3::new(0.3, 0.0, 0.2),
    };
    let found = closest(&capsule, &Pose::identity(), &capsule, &across).unwrap();
    assert!((found.distance + 0.5).abs() < 1e-15 && found.normal.y.abs() > 1.0 - 1e-15, "{found:?}");
    let parallel =
        closest(&capsule, &Pose::identity(), &capsule, &Pose::at(Vec3::new(0.0, 1.0, 0.5))).unwrap();
    assert!((parallel.point_a - Vec3::new(0.0, 0.25, 0.25)).norm() < 1e-15, "{parallel:?}");
}

#[test]
fn a_hull_has_the_faces_of_its_polytope() {
    let sign = |k: usize, bit: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
    let mut points: Vec<_> = (0..8).map(|k| Vec3::new(sign(k, 0), 2.0 * sign(k, 1), sign(k, 2))).collect();
    let inside: Vec<_> = (0..1000).map(|k| points[k % 8] * (0.001 * k as f64)).collect();
    points.extend(inside);
    points.push(Vec3::new(0.5, 2.0, 0.25)); // inside a face
    let hull = Hull::new(&points).unwrap();
    assert_eq!((hull.vertices().len(), hull.faces().len()), (8, 6));
    assert!(hull.faces().iter().all(|face| face.corners.len() == 4));
    let mut random = Random(5);
    let ball: Vec<_> = (0..2000).map(|_| random.direction()).collect();
    let hull = Hull::new(&ball).unwrap();
    let corners: usize = hull.faces().iter().map(|face| face.corners.len()).sum();
    assert_eq!(hull.vertices().len() + hull.faces().len(), corners / 2 + 2); // Euler
    for face in hull.faces() {
        let offset = face.normal.dot(hull.vertices()[face.corners[0]]);
        assert!(ball.iter().all(|p| p.dot(face.normal) <= offset + 1e-11));
    }
}

#[test]
fn a_compound_has_the_distance_of_its_nearest_piece_and_a_sphere_around_all() {
    let sphere = Shape::Sphere { radius: 0.5 };
    let at = |x: f64| Pose::at(Vec3::new(x, 0.0, 0.0));
    let pair: Shape = Shape::Compound(Arc::new([(sphere.clone(), at(-2.0)), (sphere.clone(), at(2.0))]));
    let found = closest(&sphere, &at(5.0), &pair, &Pose::identity()).unwrap();
    assert!((found.distance - 2.0).abs() < 1e-15);
    let both = closest(&pair, &Pose::identity(), &pair, &at(6.0)).unwrap();
    assert!((both.distance - 1.0).abs() < 1e-15);
    let around = pair.bounding_sphere();
    assert_eq!((around.center, around.radius), (Vec3::zero(), 2.5));
    let empty = Shape::Compound(Arc::new([]));
    assert_eq!(empty.check(), Err(GeometryError::EmptyCompound));
}

#[test]
fn bounding_spheres_contain_their_shapes() {
    let mut random = Random(9);
    for k in 0..600 {
        let (shape, d) = (random.shape(k % 6), random.direction());
        let sphere = shape.bounding_sphere();
        let reach = height(&shape, &Pose::identity(), d) - sphere.center.dot(d);
        assert!(reach <= sphere.radius * (1.0 + 1e-15), "{k}");
    }
    assert_eq!(Shape::HalfSpace.bounding_sphere().radius, f64::INFINITY);
}

#[test]
fn shapes_without_volume_and_poses_that_are_not_finite_are_refused() {
    let (at, cube) = (Pose::identity(), Shape::Box { half_edges: [1.0; 3] });
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for shape in [
            Shape::Sphere { radius },
            Shape::Box { half_edges: [1.0, radius, 1.0] },
            Shape::Cone { radius, half_length: 1.0 },
            Shape::Torus { major_radius: 1.0 + radius, minor_radius: 1.0 },
        ] {
            let error = closest(&shape, &at, &cube, &at).unwrap_err();
            assert!(error.to_string().contains("positive and finite"), "{error}");
        }
    }
    let capsule = |half_length| Shape::Capsule { radius: 1.0, half_length }.check();
    assert_eq!(capsule(0.0), Ok(()));
    assert_eq!(
        capsule(-1.0).unwrap_err().to_string(),
        "the half length of a capsule is -1 m; it must be finite and at least 0"
    );
    let lost = Pose::at(Vec3::new(f64::NAN, 0.0, 0.0));
    let error = closest(&cube, &at, &cube, &lost).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the pose of a box contains infinity or NaN; give a finite position and rotation"
    );
    let flat: Vec<_> = (0..9).map(|k| Vec3::new(f64::from(k % 3), f64::from(k / 3), 0.0)).collect();
    for points in [flat, vec![Vec3::new(f64::NAN, 0.0, 0.0); 5], vec![], vec![Vec3::zero(); 8]] {
        let error = Shape::hull(&points).unwrap_err();
        assert!(error.to_string().contains("a convex hull with a volume cannot be formed"), "{error}");
    }
    let torus = Shape::Torus { major_radius: 1.0, minor_radius: 0.1 };
    let error = closest(&torus, &at, &cube, &at).unwrap_err();
    assert!(error.to_string().contains("between a box and a torus is not available"), "{error}");
    assert!(error.to_string().contains("the centre line of the tube of the torus"), "{error}");
    let error = closest(&Shape::HalfSpace, &at, &Shape::HalfSpace, &at).unwrap_err();
    assert!(error.to_string().contains("both are unbounded"), "{error}");
}
