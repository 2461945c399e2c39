//! Checks Kepler orbits by round trips and laws of motion over random orbits, and their errors.

use nalgebra::Vector3;
use onorbit_core::orbit::{Elements, Kepler, MU_EARTH, Orbit, OrbitError, OrbitState, Phase, Size};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// Eccentricities of every kind; those near 0 and 1 are drawn on a logarithmic scale.
fn eccentricity() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(0.0),
        Just(1.0),
        0.0..0.95,
        1.05..20.0,
        (-16.0..-1.5f64).prop_map(|x| 10f64.powf(x)),
        (-16.0..-1.5f64).prop_map(|x| 1.0 - 10f64.powf(x)),
        (-15.5..-1.5f64).prop_map(|x| 1.0 + 10f64.powf(x)),
    ]
}

/// Inclinations including exactly and nearly equatorial ones, prograde and retrograde.
fn inclination() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(0.0),
        Just(PI),
        0.0..PI,
        (-16.0..-3.0f64).prop_map(|x| 10f64.powf(x)),
        (-15.0..-3.0f64).prop_map(|x| PI - 10f64.powf(x))
    ]
}

fn orbit() -> impl Strategy<Value = Kepler> {
    (7e6..5e7f64, eccentricity(), inclination(), 0.0..TAU, 0.0..TAU, -0.95..0.95f64).prop_map(
        |(p, e, inclination, raan, argument_of_periapsis, turn)| {
            let asymptote = if e < 1.0 { PI } else { (-1.0 / e).acos() };
            let phase = Phase::TrueAnomaly(turn * asymptote);
            let size = Size::SemiLatusRectum(p);
            let elements =
                Elements { inclination, raan, argument_of_periapsis, phase, ..Elements::new(size, e) };
            Kepler::new(&elements).expect("drawn within range")
        },
    )
}

fn at(orbit: &Kepler, t: f64) -> OrbitState {
    orbit.state(t).expect("a valid time")
}

/// Returns the distance of two orbits `t` s after the epoch, relative to their distance from the planet.
fn apart(a: &Kepler, b: &Kepler, t: f64) -> f64 {
    let (a, b) = (at(a, t), at(b, t));
    let position = (a.position - b.position).norm() / a.position.norm();
    position.max((a.velocity - b.velocity).norm() / a.velocity.norm())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, rng_seed: proptest::test_runner::RngSeed::Fixed(2), failure_persistence: None, ..ProptestConfig::default() })]

    /// On lanes as one at a time, bit for bit, since a resumed run evaluates single instants.
    #[test]
    fn two_states_are_those_of_one_at_a_time(orbit in orbit(), t in -1e6..1e6f64, step in 1e-4..1e3f64) {
        if let Some(two) = orbit.two_states([t, t + step]) {
            prop_assert_eq!(two, [orbit.state(t).unwrap(), orbit.state(t + step).unwrap()]);
        }
        prop_assert!(orbit.two_states([t, f64::NAN]).is_none() && orbit.two_states([f64::INFINITY, t]).is_none());
    }

    #[test]
    fn a_state_gives_its_orbit_back(orbit in orbit()) {
        let s = at(&orbit, 0.0);
        let back = Kepler::from_state(s.position, s.velocity, MU_EARTH).expect("regular");
        // at the epoch several roundings; later their effect on the mean motion, which for elongated and fast
        // orbits is larger by up to (v²/2)/(μ/2a), about 1/|1 - e|, so a short time is used
        prop_assert!(apart(&orbit, &back, 0.0) < 16.0 * f64::EPSILON, "{}", apart(&orbit, &back, 0.0));
        prop_assert!(apart(&orbit, &back, 600.0) < 256.0 * f64::EPSILON, "{}", apart(&orbit, &back, 600.0));
        // e is cos and sin of ν times e, each to a few roundings of one
        prop_assert!((back.eccentricity() - orbit.eccentricity()).abs() < 32.0 * f64::EPSILON * (1.0 + orbit.eccentricity()));
        let ratio = back.semi_latus_rectum() / orbit.semi_latus_rectum();
        prop_assert!((ratio - 1.0).abs() < 64.0 * f64::EPSILON, "{}", ratio - 1.0);
    }

    #[test]
    fn elements_give_their_orbit_back(orbit in orbit()) {
        let back = Kepler::new(&orbit.elements()).expect("elements of an orbit");
        for t in [0.0, 600.0, -3000.0] {
            // Angles up to 2π and, next to NEAR_PARABOLIC = 0.01, a hundredfold loss in a = q/(1 - e).
            let apart = apart(&orbit, &back, t);
            prop_assert!(apart < 1000.0 * f64::EPSILON, "{apart:.1e} at {t} s: {:?}", orbit.elements());
        }
    }

    #[test]
    fn energy_and_angular_momentum_stay(orbit in orbit(), t in -1e5..1e5f64) {
        let s = at(&orbit, t);
        let (v2, r) = (s.velocity.norm_squared(), s.position.norm());
        let energy = 0.5 * v2 - MU_EARTH / r;
        let expected = -0.5 * MU_EARTH / orbit.semi_major_axis();
        // the sum of two larger numbers: the tolerance is relative to these
        prop_assert!((energy - expected).abs() < 16.0 * f64::EPSILON * (0.5 * v2 + MU_EARTH / r));
        let h = s.position.cross(&s.velocity);
        let expected = (MU_EARTH * orbit.semi_latus_rectum()).sqrt();
        prop_assert!((h.norm() - expected).abs() < 16.0 * f64::EPSILON * r * v2.sqrt());
    }

    #[test]
    fn derivatives_follow_one_another(orbit in orbit(), t in -3e4..3e4f64) {
        // Fourth-order central differences over a step short against r/v.
        let s = at(&orbit, t);
        let d = 1e-3 * s.position.norm() / s.velocity.norm();
        let slope = |f: fn(OrbitState) -> Vector3<f64>| {
            let f = |k: f64| f(at(&orbit, t + k * d));
            ((f(1.0) - f(-1.0)) * 8.0 - (f(2.0) - f(-2.0))) / (12.0 * d)
        };
        // Times are rounded to 4e-12 s and values to 1e-16: 1e-13 over d; remainder 1e-12/30 of the fifth derivative.
        let dr = slope(|s| s.position) - s.velocity;
        prop_assert!(dr.norm() < 1e-10 * s.velocity.norm(), "{}", dr.norm() / s.velocity.norm());
        let dv = slope(|s| s.velocity) - s.acceleration;
        let scale = s.acceleration.norm() + s.velocity.norm() / d * 1e-3;
        prop_assert!(dv.norm() < 1e-10 * scale, "{}", dv.norm() / scale);
    }
}

#[test]
fn a_hyperbola_is_accurate_far_out_on_its_asymptotes() {
    let elements = Elements { inclination: 0.7, raan: 1.0, ..Elements::new(Size::SemiMajorAxis(-2e7), 1.4) };
    let orbit = Kepler::new(&elements).expect("a hyperbola");
    for t in [-1e9, -1e7, 1e7, 1e9] {
        let s = at(&orbit, t);
        let back = at(&Kepler::from_state(s.position, s.velocity, MU_EARTH).expect("regular"), 0.0);
        // 4e9 km away; the round trip has the rounding error of positions near the planet
        assert!((back.position - s.position).norm() < 16.0 * f64::EPSILON * s.position.norm());
        assert!((back.velocity - s.velocity).norm() < 16.0 * f64::EPSILON * s.velocity.norm());
    }
}

#[test]
fn degenerate_orbits_have_the_conventional_elements() {
    let base = Elements { phase: Phase::TrueAnomaly(0.5), ..Elements::new(Size::SemiMajorAxis(7e6), 0.1) };
    let equatorial = Elements { raan: 1.0, argument_of_periapsis: 2.0, ..base };
    let read = Kepler::new(&equatorial).expect("an ellipse").elements();
    // The node is the x axis, so that the periapsis is at the sum; two roundings of it.
    assert_eq!((read.raan, read.inclination), (0.0, 0.0));
    assert!((read.argument_of_periapsis - 3.0).abs() < 1e-15);
    let retrograde = Kepler::new(&Elements { inclination: PI, ..equatorial }).expect("an ellipse").elements();
    assert!((retrograde.inclination - PI).abs() < 1e-15);
    let circle = Kepler::new(&Elements { eccentricity: 0.0, ..equatorial }).expect("a circle");
    let s = at(&circle, 0.0);
    // Longitude 1 + 2 + 0.5
    assert!((s.position - Vector3::new(3.5f64.cos(), 3.5f64.sin(), 0.0) * 7e6).norm() < 1e-8);
    let back = Kepler::from_state(s.position, s.velocity, MU_EARTH).expect("a circle");
    assert!(back.eccentricity() < 1e-15, "{}", back.eccentricity());
}

#[test]
fn whole_turns_of_the_mean_anomaly_change_nothing() {
    let with = |m| {
        let e = Elements { phase: Phase::MeanAnomaly(m), ..Elements::new(Size::SemiMajorAxis(7e6), 0.4) };
        at(&Kepler::new(&e).expect("an ellipse"), 0.0).position
    };
    // 1 + 200 π as a double is off by up to 5.7e-14 rad, which at most 1e4 km turns into 1e-6 m.
    assert!((with(1.0) - with(1.0 + 100.0 * TAU)).norm() < 1e-6);
}

#[test]
fn phases_agree_with_one_another() {
    for (size, e) in [
        (Size::SemiMajorAxis(7e6), 0.3),
        (Size::SemiMajorAxis(-7e6), 1.5),
        (Size::SemiLatusRectum(1.4e7), 1.0),
    ] {
        let make =
            |phase, epoch| Kepler::new(&Elements { phase, epoch, ..Elements::new(size, e) }).expect("valid");
        let true_anomaly = make(Phase::TrueAnomaly(0.0), 100.0);
        assert!(apart(&true_anomaly, &make(Phase::PeriapsisTime(100.0), 0.0), 900.0) < f64::EPSILON);
        assert!(
            (at(&true_anomaly, 100.0).position - Vector3::x() * true_anomaly.periapsis_distance()).norm()
                < 1e-8
        );
        if e != 1.0 {
            let n = (MU_EARTH / 7e6f64.powi(3)).sqrt();
            // n t and its inverse, one rounding each of at most 1 rad
            assert!(apart(&true_anomaly, &make(Phase::MeanAnomaly(-100.0 * n), 0.0), 900.0) < 1e-15);
        }
    }
}

fn refused(change: impl Fn(&mut Elements)) -> OrbitError {
    let mut elements = Elements::new(Size::SemiMajorAxis(7e6), 0.1);
    change(&mut elements);
    Kepler::new(&elements).expect_err("must be refused")
}

#[test]
fn invalid_elements_are_refused_with_their_values() {
    use OrbitError as E;
    let (a, open) = (7e6, 1.5);
    assert_eq!(refused(|e| e.eccentricity = open), E::AxisSign { semi_major_axis: a, eccentricity: open });
    assert_eq!(
        refused(|e| e.size = Size::SemiMajorAxis(-a)),
        E::AxisSign { semi_major_axis: -a, eccentricity: 0.1 }
    );
    assert_eq!(
        refused(|e| e.size = Size::SemiMajorAxis(0.0)),
        E::AxisSign { semi_major_axis: 0.0, eccentricity: 0.1 }
    );
    assert_eq!(refused(|e| e.eccentricity = 1.0), E::ParabolaHasNoAxis { semi_major_axis: a });
    assert_eq!(refused(|e| e.eccentricity = -0.1), E::NegativeEccentricity { value: -0.1 });
    assert_eq!(refused(|e| e.mu = 0.0), E::NotPositive { name: "mu", value: 0.0 });
    assert_eq!(
        refused(|e| e.size = Size::SemiLatusRectum(-1.0)),
        E::NotPositive { name: "semi-latus rectum", value: -1.0 }
    );
    assert_eq!(refused(|e| e.inclination = 51.6), E::Inclination { value: 51.6 });
    assert_eq!(refused(|e| e.inclination = -0.1), E::Inclination { value: -0.1 });
    assert!(matches!(
        refused(|e| e.size = Size::SemiMajorAxis(1e200)),
        E::TooLarge { name: "semi-major axis", .. }
    ));
    let parabola =
        |phase| refused(|e| (e.size, e.eccentricity, e.phase) = (Size::SemiLatusRectum(a), 1.0, phase));
    assert_eq!(parabola(Phase::MeanAnomaly(0.2)), E::ParabolaHasNoMeanAnomaly { value: 0.2 });
    assert_eq!(
        parabola(Phase::TrueAnomaly(PI)),
        E::BeyondAsymptote { value: PI, eccentricity: 1.0, limit: PI }
    );
    let beyond = refused(|e| {
        (e.size, e.eccentricity, e.phase) = (Size::SemiMajorAxis(-a), 2.0, Phase::TrueAnomaly(2.2))
    });
    assert!(matches!(beyond, E::BeyondAsymptote { .. }), "{beyond}");
    let nan = f64::NAN;
    for error in [
        refused(|e| e.eccentricity = nan),
        refused(|e| e.size = Size::SemiMajorAxis(nan)),
        refused(|e| e.mu = nan),
        refused(|e| e.raan = nan),
        refused(|e| e.argument_of_periapsis = nan),
        refused(|e| e.inclination = nan),
        refused(|e| e.epoch = nan),
        refused(|e| e.phase = Phase::MeanAnomaly(nan)),
        refused(|e| e.phase = Phase::TrueAnomaly(nan)),
        refused(|e| e.phase = Phase::PeriapsisTime(f64::INFINITY)),
    ] {
        assert!(matches!(error, E::NotFinite { .. }), "{error}");
    }
    // the number of turns of such an angle is not an integer in f64: the state was NaN
    for phase in [4.3e56, -4.3e17, 1.1e15].map(|m| [Phase::MeanAnomaly(m), Phase::TrueAnomaly(m)]).concat() {
        let error = refused(|e| e.phase = phase);
        assert!(matches!(error, E::OutOfRange { .. }) && error.to_string().contains("1e15 rad"), "{error}");
    }
    let message = refused(|e| e.eccentricity = open).to_string();
    assert!(message.contains("7000000") && message.contains("1.5"), "{message}");
}

#[test]
fn invalid_states_are_refused() {
    let (x, y) = (Vector3::x() * 7e6, Vector3::y() * 7e3);
    let from = |r, v, mu| Kepler::from_state(r, v, mu).expect_err("must be refused");
    for (r, v) in [(x, x * 1e-3), (x, Vector3::zeros()), (Vector3::zeros(), y)] {
        let error = from(r, v, MU_EARTH);
        assert!(
            matches!(error, OrbitError::Rectilinear { .. }) && !error.to_string().contains("NaN"),
            "{error}"
        );
    }
    assert!(matches!(from(x, y, -1.0), OrbitError::NotPositive { name: "mu", .. }));
    assert!(matches!(from(x * f64::NAN, y, 1.0), OrbitError::NotFinite { name: "position", .. }));
    assert!(matches!(from(x, y * f64::INFINITY, 1.0), OrbitError::NotFinite { name: "velocity", .. }));
    assert!(matches!(from(x * 1e200, y, 1.0), OrbitError::TooLarge { name: "position", .. }));
}

#[test]
fn times_beyond_the_resolution_are_refused() {
    let ellipse = Kepler::new(&Elements::new(Size::SemiMajorAxis(7e6), 0.1)).expect("valid");
    let parabola = Kepler::new(&Elements::new(Size::SemiLatusRectum(7e6), 1.0)).expect("valid");
    for orbit in [ellipse, parabola] {
        assert!(matches!(orbit.state(f64::NAN), Err(OrbitError::NotFinite { name: "time", .. })));
        assert!(matches!(orbit.state(f64::INFINITY), Err(OrbitError::NotFinite { name: "time", .. })));
        assert!(matches!(orbit.state(1e19), Err(OrbitError::TimeOutOfRange { .. })));
        assert!(orbit.state(1e11).is_ok());
    }
}
