//! Checks local orbital frames: their angular velocity is the derivative of their attitude.
#![allow(clippy::print_stdout)] // shows what was measured when a test fails
#![allow(clippy::excessive_precision)] // tables stand as their sources print them

use nalgebra::{Matrix3, Vector3};
use onorbit_core::orbit::{Elements, Kepler, Lvlh, Nadir, Orbit, OrbitError, OrbitState, Size};

/// An orbit that is no solution of gravity: a circle with an oscillation along z at another frequency.
#[derive(Debug)]
struct Wavy;

impl Orbit for Wavy {
    fn mu(&self) -> Option<f64> {
        None
    }

    fn state(&self, t: f64) -> Result<OrbitState, OrbitError> {
        let (r, n, a, k) = (7e6, 1e-3, 5e5, 3.1e-3);
        let ((s, c), (sz, cz)) = ((n * t).sin_cos(), (k * t).sin_cos());
        Ok(OrbitState {
            position: Vector3::new(r * c, r * s, a * sz),
            velocity: Vector3::new(-r * n * s, r * n * c, a * k * cz),
            acceleration: Vector3::new(-r * n * n * c, -r * n * n * s, -a * k * k * sz),
        })
    }
}

/// Returns the rate in the frame's axes from attitudes `d` s to either side: `[ω]× = Rᵀ Ṙ`.
fn differenced(attitude: impl Fn(f64) -> Matrix3<f64>, t: f64) -> Vector3<f64> {
    let d = 0.5;
    // Fourth-order central difference
    let rate = ((attitude(t + d) - attitude(t - d)) * 8.0 - (attitude(t + 2.0 * d) - attitude(t - 2.0 * d)))
        / (12.0 * d);
    let s = attitude(t).transpose() * rate;
    Vector3::new(s[(2, 1)] - s[(1, 2)], s[(0, 2)] - s[(2, 0)], s[(1, 0)] - s[(0, 1)]) * 0.5
}

fn lvlh(orbit: &dyn Orbit, t: f64) -> Lvlh {
    orbit.lvlh(t).expect("a regular reference")
}

fn orbits() -> [(&'static str, Box<dyn Orbit>); 3] {
    let kepler = |size, e| {
        let elements =
            Elements { inclination: 1.1, raan: 0.4, argument_of_periapsis: 2.0, ..Elements::new(size, e) };
        Box::new(Kepler::new(&elements).expect("a valid orbit"))
    };
    [
        ("ellipse", kepler(Size::SemiMajorAxis(9e6), 0.25)),
        ("hyperbola", kepler(Size::SemiMajorAxis(-2e7), 1.4)),
        ("wavy", Box::new(Wavy)),
    ]
}

// attitudes are good to 2e-16, differenced over 0.5 s: about 5e-16 rad/s; the fourth-order remainder ω⁵ d⁴ is
// below 1e-16; rates are 1e-3
const RATE_TOLERANCE: f64 = 2e-15;

#[test]
fn rate_is_the_derivative_of_the_attitude() {
    for (name, orbit) in orbits() {
        for t in [0.0, 300.0, 1234.0, 4000.0] {
            let l = lvlh(&*orbit, t);
            let error = (differenced(|t| lvlh(&*orbit, t).rot_il, t) - l.rate_l).norm();
            println!("{name} at {t} s: {error:.1e} rad/s");
            assert!(error < RATE_TOLERANCE, "{name} at {t} s: {error}");
            let nadir = |t| Nadir::of(&orbit.state(t).expect("a valid time")).expect("a regular reference");
            let error = (differenced(|t| nadir(t).rot_in, t) - nadir(t).rate_n).norm();
            assert!(error < RATE_TOLERANCE, "{name} at {t} s, nadir: {error}");
        }
    }
}

#[test]
fn rate_without_its_radial_part_is_wrong_off_a_kepler_orbit() {
    let l = lvlh(&Wavy, 300.0);
    let along_z = Vector3::z() * l.rate_l.z;
    let error = (differenced(|t| lvlh(&Wavy, t).rot_il, 300.0) - along_z).norm();
    assert!(error > 1e-4, "{error}");
}

#[test]
fn frames_are_right_handed_rotations() {
    for (_, orbit) in orbits() {
        let l = lvlh(&*orbit, 777.0);
        let n = Nadir::from(&l);
        for rot in [l.rot_il, n.rot_in] {
            // unit vectors, one rounding per component
            assert!((rot.transpose() * rot - Matrix3::identity()).norm() < 1e-15);
            assert!((rot.determinant() - 1.0).abs() < 1e-15);
        }
        assert_eq!(n.rot_in.column(2), -l.rot_il.column(0));
    }
}

#[test]
fn nadir_frame_agrees_with_nasa_cases() {
    // NASA/TM-2015-218675, typical orbit: LVLH rate (0, -1.134454274550824e-3, 0) rad/s; the attitude of
    // run 2 is 11.6 degrees of pitch from LVLH, its y axis is that of LVLH.
    let r = Vector3::new(-4292653.41, 955168.47, 5139356.57);
    let v = Vector3::new(109.649663, -7527.726490, 1484.521489);
    let orbit = Kepler::from_state(r, v, 3.986004415e14).expect("an ellipse");
    let n = Nadir::of(&orbit.state(0.0).expect("a valid time")).expect("a regular reference");
    // 13 digits of the published rate
    assert!((n.rate_n - Vector3::y() * -1.134454274550824e-3).norm() < 1e-15, "{}", n.rate_n);
    let y = Vector3::new(-0.772691975098125, -0.1336331223242703, -0.6205556383087864);
    assert!((n.rot_in.column(1) - y).norm() < 1e-12, "{}", n.rot_in);
}
