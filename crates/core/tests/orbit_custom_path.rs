//! Checks paths through given points: interpolation, smoothness, and order of convergence.
#![allow(clippy::print_stdout)] // shows what was measured when a test fails

use nalgebra::{Matrix3, UnitQuaternion, Vector3, Vector4};
use onorbit_core::orbit::{
    CustomPath, Elements, Ends, Kepler, Orbit, OrbitError, PathError, PathPoints, Size,
};

fn kepler() -> Kepler {
    let elements = Elements { inclination: 0.9, raan: 0.3, ..Elements::new(Size::SemiMajorAxis(8e6), 0.15) };
    Kepler::new(&elements).expect("an ellipse")
}

/// Points of the ellipse over 2000 s, with gaps that differ by up to 40 %.
fn sampled(pieces: usize, with_velocities: bool, with_accelerations: bool) -> PathPoints {
    let h = 2000.0 / pieces as f64;
    let uneven = |i: usize| h * (i as f64 + if i % 2 == 1 && i < pieces { 0.2 } else { 0.0 });
    let times: Vec<f64> = (0..=pieces).map(uneven).collect();
    let states: Vec<_> = times.iter().map(|t| kepler().state(*t).expect("an ellipse")).collect();
    PathPoints {
        times,
        positions: states.iter().map(|s| s.position).collect(),
        velocities: with_velocities.then(|| states.iter().map(|s| s.velocity).collect()),
        accelerations: with_accelerations.then(|| states.iter().map(|s| s.acceleration).collect()),
        attitudes: None,
    }
}

fn path(points: PathPoints) -> CustomPath {
    CustomPath::new(points, None, Ends::Error).expect("a path")
}

const KINDS: [(&str, bool, bool, f64); 3] =
    [("positions", false, false, 4.0), ("velocities", true, false, 6.0), ("accelerations", true, true, 6.0)];

#[test]
fn a_path_interpolates_its_points_exactly() {
    for (name, v, a, _) in KINDS {
        for pieces in [1, 2, 3, 7] {
            let points = sampled(pieces, v, a);
            let path = path(points.clone());
            for (i, t) in points.times.iter().enumerate() {
                let state = path.state(*t).expect("within");
                assert_eq!(state.position, points.positions[i], "{name}, {pieces} pieces");
                if let Some(given) = &points.velocities {
                    assert_eq!(state.velocity, given[i], "{name}, {pieces} pieces");
                }
                if let Some(given) = &points.accelerations {
                    assert_eq!(state.acceleration, given[i], "{name}, {pieces} pieces");
                }
            }
        }
    }
}

#[test]
fn position_velocity_and_acceleration_are_continuous() {
    for (name, v, a, _) in KINDS {
        let points = sampled(9, v, a);
        let path = path(points.clone());
        for t in &points.times[1..] {
            let just_before = path.state(t - t * f64::EPSILON).expect("within");
            let at = path.state(*t).expect("within");
            // rounding of positions of 8e6 m over gaps of 180 s and more, and half a nanosecond of motion
            assert!((just_before.position - at.position).norm() < 2e-8, "{name} at {t}");
            assert!((just_before.velocity - at.velocity).norm() < 1e-9, "{name} at {t}");
            assert!((just_before.acceleration - at.acceleration).norm() < 1e-11, "{name} at {t}");
        }
    }
}

#[test]
fn velocity_and_acceleration_are_derivatives() {
    for (name, v, a, _) in KINDS {
        let path = path(sampled(9, v, a));
        for t in [40.0, 333.0, 999.0, 1950.0] {
            let d = 0.5;
            let at = |t| path.state(t).expect("within");
            let slope = (at(t + d).position - at(t - d).position) / (2.0 * d);
            assert!((slope - at(t).velocity).norm() < 1e-3, "{name}"); // d² r⃛/6
            let slope = (at(t + d).velocity - at(t - d).velocity) / (2.0 * d);
            assert!((slope - at(t).acceleration).norm() < 1e-5, "{name}");
        }
    }
}

#[test]
fn a_sampled_ellipse_is_recovered_to_the_order_of_the_spline() {
    for (name, v, a, order) in KINDS {
        let error = |pieces| {
            let path = path(sampled(pieces, v, a));
            let off = |i: usize| {
                let t = 2000.0 * i as f64 / 997.0;
                (path.state(t).expect("within").position - kepler().state(t).expect("an ellipse").position)
                    .norm()
            };
            (0..=997).map(off).fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(10), error(20));
        let measured = (coarse / fine).log2();
        println!("{name}: {coarse:.2e} m, {fine:.2e} m, order {measured:.2}");
        assert!((measured - order).abs() < 0.6, "{name}: order {measured}, expected {order}");
    }
}

#[test]
fn polynomials_of_the_degree_of_the_spline_are_reproduced() {
    let times: Vec<f64> = vec![0.0, 0.7, 1.5, 2.0, 3.1];
    let cubic = |t: f64| Vector3::new(t, t * t, t * t * t);
    let quintic = |t: f64| Vector3::new(t.powi(5), t.powi(4) - t, 1.0 + t * t);
    let slope = |t: f64| Vector3::new(5.0 * t.powi(4), 4.0 * t.powi(3) - 1.0, 2.0 * t);
    for n in 2..=5 {
        let times = times[..n].to_vec();
        let given = |f: &dyn Fn(f64) -> Vector3<f64>| times.iter().map(|t| f(*t)).collect::<Vec<_>>();
        let alone = PathPoints { times: times.clone(), positions: given(&cubic), ..PathPoints::default() };
        let fast = PathPoints {
            times: times.clone(),
            positions: given(&quintic),
            velocities: Some(given(&slope)),
            ..PathPoints::default()
        };
        let (alone, fast) = (path(alone), path(fast));
        for t in [0.1, 0.3, 0.65] {
            if n >= 4 {
                assert!((alone.state(t).expect("within").position - cubic(t)).norm() < 1e-13);
            }
            if n >= 3 {
                assert!((fast.state(t).expect("within").position - quintic(t)).norm() < 1e-12);
            }
        }
    }
}

#[test]
fn attitudes_are_met_smooth_and_have_their_rate() {
    let turn =
        |t: f64| UnitQuaternion::from_euler_angles(0.3 * (0.2 * t).sin(), 0.05 * t, 0.2 * (0.3 * t).cos());
    let run = |pieces: usize| {
        let times: Vec<f64> = (0..=pieces).map(|i| 20.0 * i as f64 / pieces as f64).collect();
        let sign = |i: usize| if i % 3 == 1 { -1.0 } else { 1.0 }; // either sign is the same attitude
        let attitudes = times.iter().enumerate().map(|(i, t)| turn(*t).coords * sign(i)).collect();
        let points = PathPoints {
            positions: vec![Vector3::zeros(); times.len()],
            times: times.clone(),
            attitudes: Some(attitudes),
            ..PathPoints::default()
        };
        let path = path(points);
        for t in &times {
            let exact = turn(*t).to_rotation_matrix().into_inner();
            assert!((path.frame(*t).expect("within").rot_ip - exact).norm() < 1e-15);
        }
        for t in &times[1..pieces] {
            let (a, b) = (path.frame(t - 1e-9).expect("within"), path.frame(t + 1e-9).expect("within"));
            assert!((a.rate_p - b.rate_p).norm() < 1e-9, "the rate goes on");
            let angular_acceleration = |t: f64| {
                (path.frame(t + 1e-4).expect("within").rate_p - path.frame(t).expect("within").rate_p) / 1e-4
            };
            assert!(
                (angular_acceleration(t - 1e-4) - angular_acceleration(*t)).norm() < 1e-4,
                "and so does its derivative"
            );
        }
        // R_dot = R [ω]×
        let (t, d) = (7.3, 1e-4);
        let (before, after) = (path.frame(t - d).expect("within"), path.frame(t + d).expect("within"));
        let s: Matrix3<f64> =
            path.frame(t).expect("within").rot_ip.transpose() * (after.rot_ip - before.rot_ip) / (2.0 * d);
        let rate = Vector3::new(s[(2, 1)], s[(0, 2)], s[(1, 0)]);
        assert!((rate - path.frame(t).expect("within").rate_p).norm() < 1e-8);
        (0..=499)
            .map(|i| 20.0 * i as f64 / 499.0)
            .map(|t| {
                (path.frame(t).expect("within").rot_ip - turn(t).to_rotation_matrix().into_inner()).norm()
            })
            .fold(0.0, f64::max)
    };
    let (coarse, fine) = (run(20), run(40));
    println!("attitude: {coarse:.2e}, {fine:.2e}");
    assert!((coarse / fine).log2() > 3.4);
}

#[test]
fn beyond_the_ends_a_path_fails_or_coasts() {
    let points = sampled(8, true, false);
    let strict = path(points.clone());
    for time in [-1e-6, 2000.001, 1e9] {
        let refused = strict.state(time);
        let expected = PathError::TimeOutOfPath { time, start: 0.0, end: 2000.0 };
        assert_eq!(refused, Err(OrbitError::Path(expected)));
    }
    assert!(matches!(strict.state(f64::NAN), Err(OrbitError::NotFinite { .. })));
    let coasting = CustomPath::new(points, None, Ends::Coast).expect("a path");
    let knots = coasting.event_times();
    assert!(knots.contains(&0.0) && knots.contains(&2000.0)); // and the points between, with jumps of the jerk
    let (end, beyond) = (coasting.state(2000.0).expect("an end"), coasting.state(2010.0).expect("coasts"));
    assert_eq!(beyond.velocity, end.velocity);
    assert_eq!(beyond.acceleration, Vector3::zeros());
    assert!((beyond.position - end.position - end.velocity * 10.0).norm() < 1e-8);
}

#[test]
fn invalid_points_of_a_path_are_refused() {
    let good =
        PathPoints { attitudes: Some(vec![Vector4::new(0.0, 0.0, 0.0, 1.0); 5]), ..sampled(4, true, true) };
    type Spoil = fn(&mut PathPoints);
    let cases: [(&str, Spoil); 9] = [
        ("at least 2", |p| {
            *p = PathPoints { times: vec![0.0], positions: vec![Vector3::zeros()], ..PathPoints::default() }
        }),
        ("the array 'positions' has 4 rows; expected 5", |p| p.positions.truncate(4)),
        ("velocities[2] holds NaN", |p| p.velocities.as_mut().expect("given")[2].y = f64::NAN),
        ("times must increase", |p| p.times[3] = p.times[2]),
        ("sort the rows", |p| p.times.swap(1, 2)),
        ("times[4] holds inf", |p| p.times[4] = f64::INFINITY),
        ("accelerations without velocities", |p| p.velocities = None),
        ("attitudes[1] (x, y, z, w) has norm 2", |p| p.attitudes.as_mut().expect("given")[1] *= 2.0),
        ("intermediate points", |p| {
            p.attitudes.as_mut().expect("given")[4] = Vector4::new(1.0, 0.0, 0.0, 0.0)
        }),
    ];
    for (says, spoil) in cases {
        let mut points = good.clone();
        spoil(&mut points);
        let error = CustomPath::new(points, None, Ends::Error).expect_err(says).to_string();
        assert!(error.contains(says), "{error}");
    }
    let error = CustomPath::new(good, Some(-1.0), Ends::Error);
    assert!(matches!(error, Err(OrbitError::NotPositive { name: "mu", .. })));
}
