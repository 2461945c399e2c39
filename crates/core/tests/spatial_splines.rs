//! Checks splines: interpolation, continuity, and exactness for polynomials.
#![allow(clippy::unwrap_used, clippy::panic)] // set-up that fails should stop

use onorbit_core::spatial::{Ends, Quat, RotationSpline, Spline, SplineError, Vec3, exp_so3, log_so3};

const TIMES: [f64; 6] = [0.0, 0.4, 1.3, 1.5, 2.9, 3.4];

fn scalar(spline: &Spline, t: f64) -> [f64; 3] {
    let (mut p, mut v, mut a) = ([0.0], [0.0], [0.0]);
    spline.sample(t, &mut p, &mut v, &mut a);
    [p[0], v[0], a[0]]
}

#[test]
fn a_free_spline_reproduces_cubics() {
    let cubic =
        |t: f64| [1.0 - t + 2.0 * t * t - 0.7 * t * t * t, -1.0 + 4.0 * t - 2.1 * t * t, 4.0 - 4.2 * t];
    let values = TIMES.map(|t| cubic(t)[0]);
    let spline = Spline::interpolating(&TIMES, 1, &values, Ends::Free).unwrap();
    for i in 0..=340 {
        let t = f64::from(i) * 0.01;
        for (got, expected) in scalar(&spline, t).iter().zip(cubic(t)) {
            assert!((got - expected).abs() < 1e-12, "at {t}: {got} against {expected}"); // rounding / h²
        }
    }
}

#[test]
fn errors_fall_with_the_fourth_power_of_the_step_and_with_the_sixth_of_known_slopes() {
    let worst = |n: usize, with_slopes: bool| {
        let times: Vec<f64> = (0..=n).map(|k| 3.0 * k as f64 / n as f64).collect();
        let values: Vec<f64> = times.iter().map(|t| t.sin()).collect();
        let slopes: Vec<f64> = times.iter().map(|t| t.cos()).collect();
        let spline = match with_slopes {
            true => Spline::with_slopes(&times, 1, &values, &slopes),
            false => Spline::interpolating(&times, 1, &values, Ends::Free),
        };
        let spline = spline.unwrap();
        (0..3000)
            .map(|i| f64::from(i) * 1e-3)
            .map(|t| (scalar(&spline, t)[0] - t.sin()).abs())
            .fold(0.0, f64::max)
    };
    for (with_slopes, least, power) in [(false, 14.0, 16), (true, 50.0, 64)] {
        let ratio = worst(20, with_slopes) / worst(40, with_slopes);
        assert!(ratio > least, "halving the step gains {ratio}, {power} is the power of the spline");
    }
    assert!(worst(40, true) < 1e-2 * worst(40, false));
}

#[test]
fn slope_and_curvature_are_continuous_and_zero_at_resting_ends() {
    let values = [0.0, 1.0, -0.5, 0.3, 0.3, 2.0];
    for spline in [Spline::interpolating(&TIMES, 1, &values, Ends::Rest), Spline::resting(&TIMES, 1, &values)]
        .map(Result::unwrap)
    {
        for (k, &t) in TIMES.iter().enumerate() {
            let at = scalar(&spline, t);
            assert!((at[0] - values[k]).abs() < 1e-14);
            let (before, after) = (scalar(&spline, t - 1e-9), scalar(&spline, t + 1e-9));
            for i in 0..3 {
                assert!((before[i] - after[i]).abs() < 1e-5, "knot {k}, derivative {i}"); // 2e-9 of a jerk
            }
        }
        assert_eq!(scalar(&spline, -1.0), [0.0, 0.0, 0.0]);
        assert_eq!(scalar(&spline, 9.0), [2.0, 0.0, 0.0]);
    }
}

fn attitudes() -> Vec<Quat<f64>> {
    let turns = [
        [0.0, 0.0, 0.0],
        [1.5, 0.2, -0.4],
        [2.0, 1.0, 0.9],
        [-0.3, 1.1, 2.4],
        [0.4, 3.0, 0.1],
        [1.0, 1.0, 1.0],
    ];
    turns.into_iter().map(|[x, y, z]| exp_so3(Vec3::new(x, y, z))).collect()
}

fn apart(a: Quat<f64>, b: Quat<f64>) -> Vec3<f64> {
    log_so3(a.product(b.conjugate())) // in the axes of the attitudes
}

#[test]
fn attitude_rate_and_acceleration_agree() {
    let given = attitudes();
    let rates: Vec<Vec3<f64>> = (0..6).map(|k| Vec3::new(0.3, f64::from(k) * 0.2, -0.5)).collect();
    let splines = [
        RotationSpline::resting(&TIMES, &given),
        RotationSpline::interpolating(&TIMES, &given, Ends::Rest),
        RotationSpline::interpolating(&TIMES, &given, Ends::Free),
        RotationSpline::with_rates(&TIMES, &given, &rates),
    ];
    let h = 1e-4;
    for (which, spline) in splines.into_iter().map(Result::unwrap).enumerate() {
        for (t, q) in TIMES.iter().zip(&given) {
            assert!(apart(spline.sample(*t).0, *q).norm() < 1e-14);
            let (before, after) = (spline.sample(t - 1e-9), spline.sample(t + 1e-9));
            if *t > 0.0 && *t < 3.4 {
                // C²: 2e-9 s of the acceleration and of the jerk
                assert!((before.1 - after.1).norm() < 1e-6, "{which}: rate jumps at {t}");
                assert!((before.2 - after.2).norm() < 1e-4, "{which}: acceleration jumps at {t}");
            }
        }
        for i in 1..339 {
            let t = f64::from(i) * 0.01 + 0.003;
            let (before, now, after) = (spline.sample(t - h), spline.sample(t), spline.sample(t + h));
            let rate = apart(after.0, before.0) * (0.5 / h);
            let acceleration = (after.1 - before.1) * (0.5 / h);
            let scale = 1.0 + now.2.norm();
            // central differences: h² of the third derivatives, which reach 1e4 in the shortest piece
            assert!((rate - now.1).norm() < 3e-5 * scale, "{which} at {t}");
            assert!((acceleration - now.2).norm() < 3e-4 * scale, "{which} at {t}");
        }
    }
}

#[test]
fn resting_attitudes_take_the_geodesic() {
    let (a, b) = (attitudes()[1], attitudes()[3]);
    let spline = RotationSpline::resting(&[0.0, 2.0], &[a, b]).unwrap();
    let turn = log_so3(a.conjugate().product(b));
    for i in 0..=20 {
        let t = f64::from(i) * 0.1;
        let u = t / 2.0;
        let s = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
        let expected = a.product(exp_so3(turn * s));
        assert!(apart(spline.sample(t).0, expected).norm() < 1e-14);
    }
}

#[test]
fn invalid_points_of_a_spline_are_refused() {
    let free =
        |times: &[f64], values: &[f64]| Spline::interpolating(times, 1, values, Ends::Free).unwrap_err();
    assert_eq!(free(&[0.0], &[1.0]), SplineError::TooFew { got: 1, least: 2 });
    assert_eq!(free(&[0.0, 1.0], &[1.0]), SplineError::WrongLength { name: "values", expected: 2, got: 1 });
    assert_eq!(
        free(&[0.0, 0.0], &[1.0, 1.0]),
        SplineError::NotIncreasing { index: 1, before: 0.0, after: 0.0 }
    );
    assert!(matches!(
        free(&[0.0, f64::NAN], &[1.0, 1.0]),
        SplineError::NotFinite { name: "times", point: 1, .. }
    ));
    assert!(matches!(free(&[0.0, 1.0], &[1.0, f64::INFINITY]), SplineError::NotFinite { point: 1, .. }));
    let half = [exp_so3(Vec3::zero()), exp_so3(Vec3::new(std::f64::consts::PI, 0.0, 0.0))];
    assert_eq!(RotationSpline::resting(&[0.0, 1.0], &half), Err(SplineError::HalfTurn { point: 0 }));
}
