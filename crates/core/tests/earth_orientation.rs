//! Checks the orientation of the Earth against pyerfa and skyfield
//! (`tests/oracles/generate_earth_fixture.py`).

use nalgebra::{Matrix3, Rotation3, Vector3};
use onorbit_core::earth::{Axes, Earth, EarthParameters, Epoch};
use serde_json::Value;

/// 5 mas: 15 cm at the radius of a low orbit. The neglected nutation terms sum to 2 mas.
const TOLERANCE: f64 = 5e-3 / 206_264.8;

fn cases() -> Vec<Value> {
    let text = include_str!("../../../tests/fixtures/earth.json");
    let table: Value = serde_json::from_str(text).expect("the fixture is JSON");
    table["orientation"].as_array().expect("cases").clone()
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn matrix(value: &Value) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| number(&value[i][j]))
}

/// Returns the angle of the rotation between two orientations, rad.
fn apart(a: &Matrix3<f64>, b: &Matrix3<f64>) -> f64 {
    let between = a * b.transpose();
    0.5 * Vector3::new(
        between[(2, 1)] - between[(1, 2)],
        between[(0, 2)] - between[(2, 0)],
        between[(1, 0)] - between[(0, 1)],
    )
    .norm()
}

fn earth(case: &Value, polar_motion: bool) -> Earth {
    let epoch = format!("{} TAI", case["tai"].as_str().expect("a text"));
    let epoch = Epoch::parse(&epoch).expect("an epoch");
    let pole = if polar_motion { [number(&case["xp"]), number(&case["yp"])] } else { [0.0; 2] };
    let ut1_minus_utc = number(&case["ut1_minus_tai"]) - epoch.utc_minus_tai();
    Earth::new(epoch, &EarthParameters::Constant { ut1_minus_utc, polar_motion: pole }).expect("an Earth")
}

#[test]
fn rotation_is_that_of_the_iau() {
    let mut worst: f64 = 0.0;
    for case in cases() {
        let earth = earth(&case, true);
        let rot_fi = earth.rot_fi(0.0);
        worst = worst.max(apart(&rot_fi, &matrix(&case["rot_fi"])));
        assert!((rot_fi * rot_fi.transpose() - Matrix3::identity()).norm() < 1e-15);
        // any omitted term is detected
        for (what, rotation) in case["without"].as_object().expect("rotations") {
            let has_none = what == "polar motion" && number(&case["xp"]) == 0.0;
            let off = apart(&rot_fi, &matrix(rotation));
            assert!(has_none || off > 2.0 * TOLERANCE, "{}: without {what}: {off}", case["tai"]);
        }
    }
    println!("worst {} mas", worst * 206_264.8e3);
    assert!(worst < TOLERANCE, "{worst} rad");
}

#[test]
fn teme_axes_agree_with_skyfield() {
    for case in cases() {
        let gcrf = earth(&case, true);
        let teme = gcrf.in_axes(Axes::Teme);
        let rot_f_teme = teme.rot_fi(0.0);
        // only mean sidereal time of 1982 and polar motion
        assert!(apart(&rot_f_teme, &matrix(&case["rot_f_teme"])) < 1e-9, "{}", case["tai"]);
        let rot_teme_gcrf = rot_f_teme.transpose() * gcrf.rot_fi(0.0);
        let off = apart(&rot_teme_gcrf, &matrix(&case["rot_teme_gcrf"]));
        assert!(off < TOLERANCE, "{}: {} mas", case["tai"], off * 206_264.8e3);
        // the direction of the Sun is independent of the axes
        let there = teme.sun(0.0).expect("a Sun") - rot_teme_gcrf * gcrf.sun(0.0).expect("a Sun");
        assert!(there.norm() < 10.0, "{there}");
    }
}

#[test]
fn the_rotation_agrees_with_the_angular_velocity() {
    for axes in [Axes::Gcrf, Axes::Teme] {
        let earth = earth(&cases()[8], true).in_axes(axes);
        for t in [-4e7, -12.0, 0.0, 3.3e5, 1.8e8] {
            let (before, after) = (earth.rot_fi(t - 50.0), earth.rot_fi(t + 50.0));
            let turn = Rotation3::from_matrix_unchecked(after.transpose() * before).scaled_axis();
            // R_fi(t + h)ᵀ R_fi(t - h) = exp(2h ω) in axes of I, to second order in h
            let rate = turn / 100.0;
            let w = earth.angular_velocity(t);
            assert!((rate - w).norm() < 1e-11, "{axes:?} {t}: {rate} {w}");
            // negative control: a rotation about z only ignores the pole
            let is_pole_noticed = (rate - Vector3::z() * w.norm()).norm() > 1e-9;
            assert!(is_pole_noticed == (axes == Axes::Gcrf), "{axes:?} {t}");
        }
    }
}

#[test]
fn the_rotation_is_continuous_and_a_pure_function_of_time() {
    let (asked, fresh) = (earth(&cases()[8], true), earth(&cases()[8], true));
    let day = 86_400.0;
    // intervals of the pole begin every four days from 1900 on
    for k in 0..2000 {
        let t = 0.01 * day * k as f64;
        let step = apart(&asked.rot_fi(t + 1e-3), &asked.rot_fi(t));
        assert!((step - 7.292_115e-5 * 1e-3).abs() < 1e-12, "{t}: {step}");
    }
    for t in [0.0, 19.0 * day, 7.7 * day] {
        assert_eq!(asked.rot_fi(t), fresh.rot_fi(t));
        assert_eq!(asked.moon(t), fresh.moon(t));
    }
}
