//! Checks references: consistent position, velocity and acceleration in every frame, behaviour at the ends,
//! and limits.
#![allow(clippy::unwrap_used, clippy::panic)] // set-up that fails should stop

use nalgebra::{Matrix3, Rotation3, Vector3};
use onorbit_core::orbit::{Elements, Kepler, MU_EARTH, Orbit, OrbitError, OrbitState, Phase, Size};
use onorbit_core::reference::{
    Hold, JointHold, JointPath, JointSample, JointSpline, Line, LineParabola, PoseSpline, RateLimit,
    ReferenceError, ReferenceFrame, Screw, Target, TaskLimits, TaskPath, TaskReference, TaskSample, TimeLaw,
    Timing, joint_start_offset,
};
use onorbit_core::spatial::{Mat3, SplineError, Vec3, log_rotation};
use std::sync::Arc;

fn pose(angles: [f64; 3], at: [f64; 3]) -> Hold {
    let rot: Matrix3<f64> = *Rotation3::from_euler_angles(angles[0], angles[1], angles[2]).matrix();
    Hold::new(rot, at.into()).unwrap()
}

fn poses() -> Vec<Hold> {
    vec![
        pose([0.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
        pose([0.4, 1.0, -0.3], [0.3, 0.1, -0.2]),
        pose([1.2, 0.2, 2.0], [0.4, 0.6, 0.1]),
        pose([-0.5, 0.9, 1.1], [0.1, 0.4, 0.5]),
    ]
}

const LIMITS: TaskLimits = TaskLimits {
    linear: RateLimit { rate: 0.2, acceleration: 0.3 },
    angular: RateLimit { rate: 0.5, acceleration: 0.6 },
};

/// Returns every kind of path, with its name.
fn paths() -> Vec<(&'static str, Arc<dyn TaskPath>)> {
    let (quintic, ramped) = (TimeLaw::quintic(3.0).unwrap(), TimeLaw::ramped(3.0, 0.25).unwrap());
    let start = pose([0.3, -0.6, 0.2], [0.4, -0.1, 0.7]);
    let (center, axis) = (Vector3::new(0.1, 0.2, 0.3), Vector3::new(1.0, -2.0, 0.5));
    let rot: Matrix3<f64> = *Rotation3::from_euler_angles(0.1, 0.2, 0.3).matrix();
    let parabola = LineParabola::new(rot, center, Vector3::x(), Vector3::y(), 3.0).unwrap();
    let times = vec![0.0, 0.8, 1.9, 3.0];
    let waypoints = |timing, stops| PoseSpline::waypoints(&poses(), &timing, stops).unwrap();
    let screw = |law, turns| Screw::new(start.clone(), center, axis, 4.0, 0.3, turns, law).unwrap();
    let velocities: Vec<f64> = (0..24).map(|i| (f64::from(i) * 0.7).sin() * 0.3).collect();
    vec![
        ("hold", Arc::new(start.clone())),
        ("line_parabola", Arc::new(parabola)),
        ("line", Arc::new(Line::new(start.clone(), &poses()[2], quintic))),
        ("line, ramped", Arc::new(Line::new(start.clone(), &poses()[2], ramped))),
        ("line, limits", Arc::new(Line::within(start.clone(), &poses()[2], &LIMITS).unwrap())),
        ("screw", Arc::new(screw(quintic, true))),
        ("screw, held", Arc::new(screw(ramped, false))),
        ("stops", Arc::new(waypoints(Timing::Given(times.clone()), true))),
        ("passes", Arc::new(waypoints(Timing::Given(times.clone()), false))),
        ("stops, limits", Arc::new(waypoints(Timing::Limits(LIMITS), true))),
        ("passes, limits", Arc::new(waypoints(Timing::Limits(LIMITS), false))),
        ("sampled", Arc::new(PoseSpline::sampled(&times, &poses(), None).unwrap())),
        ("sampled, velocities", Arc::new(PoseSpline::sampled(&times, &poses(), Some(&velocities)).unwrap())),
    ]
}

/// An orbit whose plane rotates, so that every component of L's rate changes: a circle of radius `A` in a
/// plane that precesses about z.
#[derive(Debug)]
struct Precessing;

impl Orbit for Precessing {
    fn mu(&self) -> Option<f64> {
        None
    }

    fn state(&self, t: f64) -> Result<OrbitState, OrbitError> {
        // r = Rz(Ωt) (A cos nt, A sin nt cos i, A sin nt sin i); derivatives by those of each factor
        let (a, n, i, w) = (7e6, 0.4, 0.9_f64, 0.07);
        let (s, c) = (n * t).sin_cos();
        let shape = |s: f64, c: f64| Vector3::new(c, s * i.cos(), s * i.sin()) * a;
        let (u, u1, u2) = (shape(s, c), shape(c, -s) * n, shape(s, c) * (-n * n));
        let turn = *Rotation3::from_axis_angle(&Vector3::z_axis(), w * t).matrix();
        let spin = Vector3::z() * w;
        Ok(OrbitState {
            position: turn * u,
            velocity: turn * (spin.cross(&u) + u1),
            acceleration: turn * (spin.cross(&spin.cross(&u)) + spin.cross(&u1) * 2.0 + u2),
        })
    }
}

fn frames() -> Vec<(&'static str, ReferenceFrame)> {
    let elements = Elements {
        size: Size::SemiMajorAxis(9e6),
        eccentricity: 0.25,
        inclination: 0.9,
        raan: 0.4,
        argument_of_periapsis: 1.0,
        phase: Phase::TrueAnomaly(0.8),
        mu: 1e5 * MU_EARTH, // 300 times faster than around the Earth, so that the frame terms matter
        epoch: 0.0,
    };
    let rot: Matrix3<f64> = *Rotation3::from_euler_angles(0.4, -0.2, 1.3).matrix();
    let spin = Vector3::new(0.2, -0.3, 0.5);
    let target = Target::new(rot, Vector3::new(3.0, 1.0, -2.0), Vector3::new(0.1, 0.0, -0.2), spin).unwrap();
    vec![
        ("world", ReferenceFrame::World),
        ("lvlh, Kepler", ReferenceFrame::Lvlh(Arc::new(Kepler::new(&elements).unwrap()))),
        ("lvlh, precessing", ReferenceFrame::Lvlh(Arc::new(Precessing))),
        ("base", ReferenceFrame::Base),
        ("target", ReferenceFrame::Target(target)),
    ]
}

/// Returns the first derivative by central differences of sixth order.
fn slope(f: impl Fn(f64) -> Vec3<f64>, t: f64, h: f64) -> Vec3<f64> {
    let pair = |k: f64| (f(t + k * h) - f(t - k * h)) * (1.0 / (60.0 * h));
    pair(1.0) * 45.0 - pair(2.0) * 9.0 + pair(3.0)
}

/// Returns the largest difference of velocity and d(pose)/dt, and of acceleration and d(velocity)/dt.
fn disagreement(sample: impl Fn(f64) -> TaskSample<f64>, duration: f64) -> [f64; 4] {
    let (h, mut worst) = (1e-3, [0.0_f64; 4]);
    for i in 1..60 {
        // pieces join at 0.25, 0.75 (ramps) and at the waypoints, which the differences avoid
        let t = duration * (f64::from(i) + 0.37) / 61.0;
        let now = sample(t);
        let turned = |s: f64| log_rotation(&(sample(s).rot_wd * now.rot_wd.transpose()));
        let errors = [
            slope(|s| sample(s).pos_w, t, h) - now.velocity.linear,
            slope(turned, t, h) - now.velocity.angular,
            slope(|s| sample(s).velocity.linear, t, h) - now.acceleration.linear,
            slope(|s| sample(s).velocity.angular, t, h) - now.acceleration.angular,
        ];
        errors.iter().zip(&mut worst).for_each(|(e, worst)| *worst = worst.max(e.norm()));
    }
    worst
}

#[test]
fn velocity_and_acceleration_are_derivatives_in_every_kind_and_frame() {
    for (kind, path) in paths() {
        for (name, frame) in frames() {
            let reference = TaskReference { path: Arc::clone(&path), frame };
            let duration = if path.duration() == 0.0 { 3.0 } else { path.duration() };
            let start = 11.0;
            let worst = disagreement(|t| reference.sample(start + t, start).unwrap(), duration);
            // h = 1 ms: rounding 1e-14/h; the sixth-order error is far below
            assert!(worst.iter().all(|x| *x < 1e-10), "{kind} in {name}: {worst:?}");
        }
    }
}

#[test]
fn an_omitted_frame_term_is_detected() {
    // negative controls: without the Coriolis, centripetal or Euler term the same measure fails
    let (_, frame) = frames().remove(2);
    let ReferenceFrame::Lvlh(orbit) = &frame else { panic!("an orbital frame") };
    let reference = TaskReference { path: Arc::clone(&paths()[2].1), frame: frame.clone() };
    for term in 0..3 {
        let spoiled = |t: f64| {
            let mut now = reference.sample(t, 0.0).unwrap();
            let (inner, l) = (reference.path.sample(t), orbit.lvlh(t).unwrap());
            let rot = Mat3::from(l.rot_il);
            let rate = |t: f64| {
                let l = orbit.lvlh(t).unwrap();
                Vec3::from(l.rot_il * l.rate_l)
            };
            let (w, x) = (rate(t), rot * inner.pos_w);
            let missing = match term {
                0 => w.cross(rot * inner.velocity.linear) * 2.0,
                1 => w.cross(w.cross(x)),
                _ => slope(rate, t, 1e-3).cross(x),
            };
            now.acceleration.linear -= missing;
            now
        };
        assert!(disagreement(spoiled, 3.0)[2] > 1e-3, "term {term} is not seen");
    }
}

#[test]
fn paths_start_and_end_where_they_should_and_hold_there() {
    let ends: [(usize, usize, usize); 4] = [(7, 0, 3), (8, 0, 3), (9, 0, 3), (10, 0, 3)];
    for (path, first, last) in ends {
        let (name, path) = &paths()[path];
        let end = path.duration();
        for (t, pose) in [(0.0, first), (-5.0, first), (end, last), (end + 5.0, last)] {
            let (now, given) = (path.sample(t), poses()[pose].sample(0.0));
            assert!((now.pos_w - given.pos_w).norm() < 1e-14, "{name} at {t}");
            assert!(log_rotation(&(now.rot_wd * given.rot_wd.transpose())).norm() < 1e-14, "{name} at {t}");
            for motion in [now.velocity, now.acceleration] {
                assert!(motion.linear.norm() + motion.angular.norm() < 1e-12, "{name} at {t} rests");
            }
        }
    }
    let line = &paths()[2].1;
    let (half, goal) = (line.sample(1.5), poses()[2].sample(0.0));
    let (first, end) = (line.sample(0.0), line.sample(3.0));
    assert!((end.pos_w - goal.pos_w).norm() < 1e-15);
    // on the geodesic, half of the rotation at half of the time
    let turn = |a: &TaskSample<f64>, b: &TaskSample<f64>| log_rotation(&(b.rot_wd * a.rot_wd.transpose()));
    assert!((turn(&first, &half) * 2.0 - turn(&first, &end)).norm() < 1e-14);
}

#[test]
fn a_circle_keeps_its_distance_and_a_screw_is_the_exponential_of_its_twist() {
    let (center, axis) = (Vector3::new(0.1, 0.2, 0.3), Vector3::new(1.0, -2.0, 0.5));
    let start = pose([0.3, -0.6, 0.2], [0.4, -0.1, 0.7]);
    let law = TimeLaw::quintic(2.0).unwrap();
    let screw = |advance| Screw::new(start.clone(), center, axis, 7.0, advance, true, law).unwrap();
    let unit = axis.normalize();
    let (circle, screw) = (screw(0.0), screw(0.5));
    let first = circle.sample(0.0).pos_w.to_nalgebra() - center;
    for i in 0..=20 {
        let t = f64::from(i) * 0.1;
        let (arm, s) = (circle.sample(t).pos_w.to_nalgebra() - center, law.at(t).0);
        assert!((arm.norm() - first.norm()).abs() < 1e-14 && (arm - first).dot(&unit).abs() < 1e-14);
        // exp of ξ = (−ω × c + d u, ω) by the series of a 4 × 4 matrix
        let omega = unit * (7.0 * s);
        let linear = center.cross(&omega) + unit * (0.5 * s);
        let mut xi = nalgebra::Matrix4::zeros();
        xi.fixed_view_mut::<3, 3>(0, 0).copy_from(&omega.cross_matrix());
        xi.fixed_view_mut::<3, 1>(0, 3).copy_from(&linear);
        let pose = |hold: &TaskSample<f64>| nalgebra::Matrix4::from_row_slice(&hold.pose_rows());
        let expected = xi.exp() * pose(&start.sample(0.0));
        assert!((pose(&screw.sample(t)) - expected).amax() < 1e-12);
    }
}

#[test]
fn limits_are_respected_and_nearly_reached() {
    let reached = |path: &dyn TaskPath, within: (f64, f64)| {
        let (mut worst, end) = (0.0_f64, path.duration());
        for i in 0..=20_011 {
            let now = path.sample(end * f64::from(i) / 20_011.0);
            let shares = [
                now.velocity.linear.norm() / LIMITS.linear.rate,
                now.acceleration.linear.norm() / LIMITS.linear.acceleration,
                now.velocity.angular.norm() / LIMITS.angular.rate,
                now.acceleration.angular.norm() / LIMITS.angular.acceleration,
            ];
            worst = shares.into_iter().fold(worst, f64::max);
        }
        assert!(worst > within.0 && worst < within.1, "{worst} of the limit is reached");
    };
    let all = paths();
    for name in ["line, limits", "stops, limits", "passes, limits"] {
        let path = &all.iter().find(|(kind, _)| *kind == name).unwrap().1;
        reached(&**path, (0.998, 1.0 + 1e-9));
    }
    let start = pose([0.3, -0.6, 0.2], [0.4, -0.1, 0.7]);
    for ramp in [None, Some(0.1), Some(0.5)] {
        let law = TimeLaw::quintic(1.0).unwrap();
        let circle = Screw::new(start.clone(), Vector3::zeros(), Vector3::z(), 3.0, 0.0, true, law).unwrap();
        let law = TimeLaw::within(&LIMITS, ramp, |law| circle.with_law(law)).unwrap();
        reached(&circle.with_law(law), (0.998, 1.0 + 1e-9));
    }
}

#[test]
fn joints_respect_their_limits_and_arrive_together() {
    let points = [0.0, 0.0, 0.0, 1.0, -0.5, 0.1, 0.4, 0.5, 0.3];
    let limits = vec![
        RateLimit { rate: 0.3, acceleration: 0.2 },
        RateLimit { rate: 0.2, acceleration: f64::INFINITY },
        RateLimit::NONE,
    ];
    let mut now = JointSample::new(3);
    for stops in [true, false] {
        let path = JointSpline::waypoints(3, &points, &Timing::Limits(limits.clone()), stops).unwrap();
        let (mut worst, end, h) = (0.0_f64, path.duration(), 1e-4);
        for i in 0..=9973 {
            let t = end * f64::from(i) / 9973.0;
            path.sample(t, &mut now);
            for (j, limit) in limits.iter().enumerate() {
                worst = worst.max(now.v[j].abs() / limit.rate).max(now.a[j].abs() / limit.acceleration);
            }
            let (v, a) = (now.v.clone(), now.a.clone());
            let mut at = |t: f64| {
                path.sample(t, &mut now);
                (now.q.clone(), now.v.clone())
            };
            let (before, after) = (at(t - h), at(t + h));
            for j in 0..3 {
                // central differences: h² of a third derivative below 10
                assert!(((after.0[j] - before.0[j]) * (0.5 / h) - v[j]).abs() < 1e-4 + 1e-8);
                assert!(i == 0 || i == 9973 || ((after.1[j] - before.1[j]) * (0.5 / h) - a[j]).abs() < 2e-3);
            }
        }
        assert!(worst > 0.998 && worst < 1.0 + 1e-9, "{worst} of the limits is reached, stops: {stops}");
        path.sample(end, &mut now);
        assert_eq!((&now.q[..], &now.v[..]), (&points[6..], &[0.0; 3][..]));
    }
    let (joint, offset) = joint_start_offset(&JointHold::new(vec![1.0, 2.0]).unwrap(), &[1.1, 1.5]);
    assert!(joint == 1 && (offset - 0.5).abs() < 1e-15);
}

#[test]
fn one_joint_moves_after_the_other() {
    let timing = Timing::Given(vec![0.0, 2.0, 4.0]);
    let path = JointSpline::one_by_one(&[0.1, 0.2, 0.3], &[(2, 1.0), (0, -1.0)], &timing).unwrap();
    let mut now = JointSample::new(3);
    path.sample(1.0, &mut now);
    assert_eq!((now.q[0], now.q[1], now.v[0], now.v[1]), (0.1, 0.2, 0.0, 0.0));
    assert!((now.q[2] - 0.65).abs() < 1e-15 && (now.v[2] - 1.875 * 0.7 / 2.0).abs() < 1e-15);
    path.sample(4.0, &mut now);
    assert_eq!(now.q, [-1.0, 0.2, 1.0]);
    let error = JointSpline::one_by_one(&[0.0], &[(1, 1.0)], &Timing::Given(vec![0.0, 1.0])).unwrap_err();
    assert_eq!(error, ReferenceError::NoJoint { joint: 1, count: 1 });
}

#[test]
fn samples_of_a_motion_reproduce_it() {
    let screw = &paths()[5].1;
    let worst = |n: u32, with_velocities: bool| {
        let times: Vec<f64> = (0..=n).map(|k| 3.0 * f64::from(k) / f64::from(n)).collect();
        let (mut poses, mut velocities) = (Vec::new(), Vec::new());
        for now in times.iter().map(|t| screw.sample(*t)) {
            poses.push(Hold::new(now.rot_wd.to_nalgebra(), now.pos_w.to_nalgebra()).unwrap());
            let mut row = [0.0; 6];
            now.velocity.write(&mut row);
            velocities.extend(row);
        }
        let velocities = with_velocities.then_some(&velocities[..]);
        let path = PoseSpline::sampled(&times, &poses, velocities).unwrap();
        let apart = |t: f64| {
            let (a, b) = (path.sample(t), screw.sample(t));
            (a.pos_w - b.pos_w).norm() + log_rotation(&(a.rot_wd * b.rot_wd.transpose())).norm()
        };
        (0..3000).map(|i| apart(f64::from(i) * 1e-3)).fold(0.0, f64::max)
    };
    for with_velocities in [false, true] {
        let (coarse, fine) = (worst(20, with_velocities), worst(40, with_velocities));
        assert!(coarse / fine > 12.0 && fine < 1e-3, "fourth order: {coarse} then {fine}");
    }
}

#[test]
fn the_offset_at_the_start_is_in_metres_and_radians() {
    let reference = TaskReference::from(poses()[0].clone());
    let away = pose([0.0, 0.0, 0.3], [0.0, 0.4, 0.3]).sample(0.0);
    let (metres, radians) = reference.start_offset(&away.rot_wd, away.pos_w, 0.0).unwrap();
    assert!((metres - 0.5).abs() < 1e-15 && (radians - 0.3).abs() < 1e-15);
}

#[test]
fn invalid_references_are_refused() {
    let start = poses()[0].clone();
    let given =
        |times: &[f64]| PoseSpline::waypoints(&poses(), &Timing::Given(times.to_vec()), true).unwrap_err();
    let spline = |error| ReferenceError::Spline(error);
    assert_eq!(
        given(&[0.0, 1.0]),
        spline(SplineError::WrongLength { name: "attitudes", expected: 8, got: 16 })
    );
    let order = SplineError::NotIncreasing { index: 2, before: 1.0, after: 0.5 };
    assert_eq!(given(&[0.0, 1.0, 0.5, 2.0]), spline(order));
    let few = PoseSpline::sampled(&[0.0], &poses()[..1], None).unwrap_err();
    assert_eq!(few, spline(SplineError::TooFew { got: 1, least: 2 }));
    let short = PoseSpline::sampled(&[0.0, 1.0], &poses()[..2], Some(&[0.0; 6])).unwrap_err();
    assert_eq!(short, ReferenceError::WrongLength { name: "velocities", expected: 12, got: 6 });
    let same = [start.clone(), start.clone()];
    let error = PoseSpline::waypoints(&same, &Timing::Limits(LIMITS), true).unwrap_err();
    assert_eq!(error, ReferenceError::SamePoint { point: 0 });
    assert_eq!(Line::within(start.clone(), &start, &LIMITS), Err(ReferenceError::NoLimit));
    let within = |rate: f64, ramp: Option<f64>| {
        let limit = RateLimit { rate, ..RateLimit::NONE };
        let limits = TaskLimits { linear: limit, angular: limit };
        TimeLaw::within(&limits, ramp, |law| Line::new(start.clone(), &poses()[1], law))
    };
    for ramp in [None, Some(0.2)] {
        assert!(matches!(within(1e20, ramp), Err(ReferenceError::DurationNotPositive { .. })));
        let error = within(1e-309, ramp);
        let is_infinite = |error: &ReferenceError| match error {
            ReferenceError::NotFinite { name, value } => *name == "duration" && *value == f64::INFINITY,
            _ => false,
        };
        assert!(error.as_ref().is_err_and(is_infinite), "{error:?}");
    }
    let negative = TaskLimits { linear: RateLimit { rate: -1.0, ..RateLimit::NONE }, ..LIMITS };
    let error = Line::within(start.clone(), &poses()[1], &negative).unwrap_err();
    assert_eq!(error, ReferenceError::LimitNotPositive { name: "speed".to_owned(), value: -1.0 });
    assert_eq!(TimeLaw::quintic(0.0), Err(ReferenceError::DurationNotPositive { value: 0.0 }));
    let is_nan = |error: &ReferenceError, of: &str| match error {
        ReferenceError::NotFinite { name, value } => *name == of && value.is_nan(),
        _ => false,
    };
    assert!(is_nan(&TimeLaw::quintic(f64::NAN).unwrap_err(), "duration"));
    assert_eq!(TimeLaw::ramped(1.0, 0.6), Err(ReferenceError::Ramp { value: 0.6 }));
    let law = TimeLaw::quintic(1.0).unwrap();
    let screw = |axis| Screw::new(start.clone(), Vector3::zeros(), axis, 1.0, 0.0, true, law).unwrap_err();
    assert_eq!(screw(Vector3::zeros()), ReferenceError::NoAxis { length: 0.0 });
    assert!(is_nan(&screw(Vector3::x() * f64::NAN), "axis"));
    let mirror = Hold::new(-Matrix3::identity(), Vector3::zeros()).unwrap_err();
    assert_eq!(mirror, ReferenceError::NotARotation { error: 2.0 });
    let target =
        |v: Vector3<f64>| Target::new(Matrix3::identity(), v * 0.0 + Vector3::x(), v, Vector3::zeros());
    assert!(matches!(target(Vector3::new(f64::NAN, 0.0, 0.0)), Err(ReferenceError::NotFinite { .. })));
    assert!(is_nan(&JointHold::new(vec![f64::NAN]).unwrap_err(), "q"));
    let limits =
        JointSpline::waypoints(2, &[0.0; 4], &Timing::Limits(vec![RateLimit::NONE]), true).unwrap_err();
    assert_eq!(limits, ReferenceError::WrongLength { name: "limits", expected: 2, got: 1 });
}
