//! Checks relative motion against Vallado's and CelesTrak's numbers, Kepler's closed form, and round trips.

use nalgebra::{Vector3, Vector6};
use onorbit_core::orbit::relative::{
    LocalFrame, deputy_state, from_local, hill_transition, intercept_velocity, relative_elements, to_local,
};
use onorbit_core::orbit::{Elements, Kepler, MU_EARTH, Orbit, OrbitError, OrbitState, Phase, Size};

/// Vallado's circular orbit at 590 km.
fn vallado() -> f64 {
    let a: f64 = (6378.1363 + 590.0) * 1e3;
    (398_600.441_5e9 / a.powi(3)).sqrt()
}

fn circle(e: f64) -> Kepler {
    let elements = Elements {
        inclination: 0.9,
        raan: 0.4,
        phase: Phase::MeanAnomaly(0.3),
        ..Elements::new(Size::SemiMajorAxis(7e6), e)
    };
    Kepler::new(&elements).expect("an orbit")
}

fn seen(chief: &OrbitState, deputy: &OrbitState) -> Vector6<f64> {
    let [r, v] = to_local(chief, LocalFrame::Lvlh, &deputy.position, &deputy.velocity).expect("a frame");
    Vector6::new(r.x, r.y, r.z, v.x, v.y, v.z)
}

#[test]
fn vallados_example_6_14_to_its_digits() {
    let start = Vector6::new(0.0, 0.0, 0.0, -0.1, -0.04, -0.02);
    let end = hill_transition(vallado(), 300.0).expect("finite") * start;
    let printed = Vector6::new(
        -33.345_724_432_187_964,
        -1.473_560_307_487_475,
        -5.894_530_311_607_677,
        -0.120_337_093_866_688,
        0.032_387_584_447_866,
        -0.018_949_031_717_993,
    );
    assert!((end - printed).amax() < 1e-12, "{}", end - printed);
}

#[test]
fn an_intercept_is_the_one_that_celestrak_computes() {
    let r = Vector3::new(-70.933, 20.357, -11.17);
    let v = intercept_velocity(vallado(), &r, 300.0).expect("reachable");
    let printed = Vector3::new(0.274_190_838_333, 0.013_466_718_841_345, 0.035_907_981_315);
    assert!((v - printed).amax() < 1e-10, "{v}");
    let end = hill_transition(vallado(), 300.0).expect("finite") * Vector6::new(r.x, r.y, r.z, v.x, v.y, v.z);
    assert!(end.fixed_rows::<3>(0).amax() < 1e-12);
    let half = std::f64::consts::PI / vallado();
    assert!(matches!(intercept_velocity(vallado(), &r, half), Err(OrbitError::NoIntercept { .. })));
}

#[test]
fn transitions_follow_each_other_and_start_at_rest() {
    let (n, at) = (vallado(), |t| hill_transition(vallado(), t).expect("finite"));
    assert_eq!(at(0.0), nalgebra::Matrix6::identity());
    // in units in which lengths and lengths times n are comparable
    let scale = Vector6::new(1.0, 1.0, 1.0, n, n, n);
    let fault = at(500.0) * at(900.0) - at(1400.0);
    let fault = nalgebra::Matrix6::from_diagonal(&scale.map(|x| 1.0 / x))
        * fault
        * nalgebra::Matrix6::from_diagonal(&scale);
    assert!(fault.amax() < 1e-14, "{fault}");
}

#[test]
fn against_kepler_the_error_is_of_second_order_in_the_separation() {
    let fault = |size: f64, e: f64| {
        let chief = circle(e);
        let (n, t) = ((MU_EARTH / 7e6f64.powi(3)).sqrt(), 2500.0);
        let s = chief.state(0.0).expect("a state");
        let start = Vector6::new(1.0, -0.6, 0.8, 3e-4, -2e-3, 1e-3) * size;
        let (rho, rho_dot) = (start.fixed_rows::<3>(0).into(), start.fixed_rows::<3>(3).into());
        let [r, v] = from_local(&s, LocalFrame::Lvlh, &rho, &rho_dot).expect("a frame");
        let deputy = Kepler::from_state(r, v, MU_EARTH).expect("an orbit");
        let true_end = seen(&chief.state(t).expect("a state"), &deputy.state(t).expect("a state"));
        let end = hill_transition(n, t).expect("finite") * start;
        (end - true_end).fixed_rows::<3>(0).norm()
    };
    let (near, far) = (fault(100.0, 0.0), fault(1000.0, 0.0));
    assert!((far / near - 100.0).abs() < 2.0, "{near} m and {far} m");
    // negative control: on an ellipse, where the theory does not hold, the error is of first order
    let (near, far) = (fault(100.0, 0.05), fault(1000.0, 0.05));
    assert!((far / near - 10.0).abs() < 1.0, "{near} m and {far} m");
}

#[test]
fn local_coordinates_are_consistent_and_invertible() {
    let (chief, deputy) = (
        circle(0.2),
        Kepler::new(&Elements { inclination: 0.95, ..circle(0.21).elements() }).expect("an orbit"),
    );
    for frame in [LocalFrame::Lvlh, LocalFrame::Nadir] {
        let at = |t: f64| {
            let (c, d) = (chief.state(t).expect("a state"), deputy.state(t).expect("a state"));
            (c, d, to_local(&c, frame, &d.position, &d.velocity).expect("a frame"))
        };
        let (c, d, [rho, rho_dot]) = at(700.0);
        // the rate is the derivative of the local position, including the rotation of the frame: central
        // differences, h⁴ of 1 s
        let slope = ((at(701.0).2[0] - at(699.0).2[0]) * 8.0 - (at(702.0).2[0] - at(698.0).2[0])) / 12.0;
        assert!((slope - rho_dot).norm() < 1e-6, "{}", slope - rho_dot);
        // negative control: without ω × ρ the error is tens of m/s
        if frame == LocalFrame::Lvlh {
            let rot_il = onorbit_core::orbit::Lvlh::of(&c).expect("a frame").rot_il;
            assert!((slope - rot_il.tr_mul(&(d.velocity - c.velocity))).norm() > 10.0);
        }
        let [r, v] = from_local(&c, frame, &rho, &rho_dot).expect("a frame");
        assert!((r - d.position).norm() < 1e-12 * d.position.norm());
        assert!((v - d.velocity).norm() < 1e-12 * d.velocity.norm());
    }
    // both frames have one origin: (x, y, z) of one is (y, -z, -x) of the other
    let (c, d) = (chief.state(0.0).expect("a state"), deputy.state(0.0).expect("a state"));
    let [l, _] = to_local(&c, LocalFrame::Lvlh, &d.position, &d.velocity).expect("a frame");
    let [n, _] = to_local(&c, LocalFrame::Nadir, &d.position, &d.velocity).expect("a frame");
    assert!((n - Vector3::new(l.y, -l.z, -l.x)).norm() < 1e-9);
}

#[test]
fn relative_elements_are_invertible_and_have_their_meaning() {
    for e in [0.0, 1e-7, 0.1, 0.7] {
        let s = circle(e).state(0.0).expect("a state");
        let chief = [&s.position, &s.velocity];
        for given in [
            Vector6::new(1e-5, -2e-5, 3e-5, -1e-5, 2e-5, -4e-5),
            Vector6::new(1e-2, 0.3, -2e-2, 3e-2, 0.1, -0.2),
            Vector6::zeros(),
        ] {
            let [r, v] = deputy_state(chief, &given, MU_EARTH).expect("an orbit");
            let back = relative_elements(chief, [&r, &v], MU_EARTH).expect("elements");
            assert!((back - given).amax() < 1e-12 / (1.0 - e), "e = {e}: {}", back - given);
        }
    }
    // a δi of (0, δiy) on a circle: cross-track amplitude a δi, D'Amico's eq. 2.17
    let (chief, a) = (circle(0.0), 7e6);
    let s = chief.state(0.0).expect("a state");
    let given = Vector6::new(0.0, 0.0, 2e-5, 0.0, 0.0, 1e-5);
    let [r, v] = deputy_state([&s.position, &s.velocity], &given, MU_EARTH).expect("an orbit");
    let deputy = Kepler::from_state(r, v, MU_EARTH).expect("an orbit");
    let track: Vec<_> = (0..200)
        .map(|k| 30.0 * f64::from(k))
        .map(|t| seen(&chief.state(t).expect("a state"), &deputy.state(t).expect("a state")))
        .collect();
    let peak = |axis: usize| track.iter().map(|x| x[axis].abs()).fold(0.0, f64::max);
    // a δe radially, twice that along track, a δi across, to second order
    for (axis, expected) in [(0, a * 2e-5), (1, 2.0 * a * 2e-5), (2, a * 1e-5)] {
        assert!((peak(axis) / expected - 1.0).abs() < 1e-3, "axis {axis}: {} m, {expected} m", peak(axis));
    }
}

#[test]
fn orbits_without_relative_elements_are_refused() {
    let s = circle(0.1).state(0.0).expect("a state");
    let flat = Kepler::new(&Elements::new(Size::SemiMajorAxis(7e6), 0.1)).expect("an orbit");
    let flat = flat.state(0.0).expect("a state");
    let of = |c: &OrbitState, v: Vector3<f64>| {
        relative_elements([&c.position, &c.velocity], [&c.position, &v], MU_EARTH).expect_err("refused")
    };
    assert!(matches!(of(&flat, flat.velocity), OrbitError::Equatorial { .. }));
    assert!(matches!(of(&s, s.velocity * 2.0), OrbitError::NotClosed { .. }));
    assert!(matches!(hill_transition(0.0, 1.0), Err(OrbitError::NotPositive { .. })));
    assert!(matches!(hill_transition(1e-3, f64::NAN), Err(OrbitError::NotFinite { .. })));
}
