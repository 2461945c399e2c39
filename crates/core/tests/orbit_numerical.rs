//! Checks the integrated orbit against the closed form of two bodies, and its errors.

use nalgebra::Vector3;
use onorbit_core::gravity::Gravity;
use onorbit_core::orbit::{Elements, Kepler, MU_EARTH, Numerical, Orbit, OrbitError, Phase, Size};
use std::sync::Arc;

fn both(elements: Elements) -> (Kepler, Numerical) {
    let kepler = Kepler::new(&elements).expect("an orbit");
    let s = kepler.state(100.0).expect("a state");
    let gravity = Arc::new(Gravity::point_mass(elements.mu));
    let numerical = Numerical::new(s.position, s.velocity, 100.0, gravity).expect("above ground");
    (kepler, numerical)
}

fn ellipse(a: f64, e: f64) -> Elements {
    let base = Elements::new(Size::SemiMajorAxis(a), e);
    Elements {
        inclination: 0.9,
        raan: 0.3,
        argument_of_periapsis: 2.0,
        phase: Phase::MeanAnomaly(-2.0),
        ..base
    }
}

#[test]
fn an_integrated_two_body_orbit_agrees_with_kepler_on_every_conic() {
    // for high eccentricity the rounding of the initial state is amplified most
    for (elements, tolerance) in [
        (ellipse(7e6, 0.0), 2e-6),
        (ellipse(26.6e6, 0.74), 1e-4),
        (ellipse(200e6, 0.96), 1e-2),
        (Elements { phase: Phase::PeriapsisTime(3600.0), ..ellipse(-9e6, 1.8) }, 1e-5),
    ] {
        let (kepler, numerical) = both(elements);
        for k in -20..=20 {
            let t = 100.0 + 4320.0 * f64::from(k);
            let (a, b) = (kepler.state(t).expect("a state"), numerical.state(t).expect("a state"));
            let away = (a.position - b.position).norm();
            assert!(away < tolerance, "{elements:?} at {t} s: {away} m");
            assert!((a.acceleration - b.acceleration).norm() < 1e-11 + 1e-5 * away);
        }
    }
}

#[test]
fn an_integrated_orbit_names_its_field() {
    let gravity = Arc::new(Gravity::point_mass(MU_EARTH));
    let (r, v) = (Vector3::x() * 7e6, Vector3::y() * 7.5e3);
    let numerical = Numerical::new(r, v, 0.0, Arc::clone(&gravity)).expect("above ground");
    assert!(numerical.gravity().is_some_and(|field| Arc::ptr_eq(field, &gravity)));
    assert!(Kepler::from_state(r, v, MU_EARTH).expect("an orbit").gravity().is_none());
    assert_eq!(numerical.mu(), Some(MU_EARTH));
}

#[test]
fn an_orbit_that_enters_the_planet_reports_the_time() {
    let (kepler, numerical) = both(ellipse(7e6, 0.6));
    let failure = (0..10_000).map(f64::from).find_map(|t| numerical.state(t).err()).expect("it falls");
    let OrbitError::BelowSurface { time, distance, minimum } = failure.clone() else {
        panic!("{failure}");
    };
    let there = kepler.state(time).expect("a state").position.norm();
    assert!(distance < minimum && minimum - there < 1.0, "{there} {minimum}");
    // later times give the same error, earlier ones remain valid
    assert_eq!(numerical.state(1e6).expect_err("it fell"), failure);
    assert!(numerical.state(time - 1.0).is_ok());
}

#[test]
fn senseless_input_is_refused() {
    let gravity = || Arc::new(Gravity::point_mass(MU_EARTH));
    let (r, v) = (Vector3::x() * 7e6, Vector3::y() * 7.5e3);
    let new = |r, v, t| Numerical::new(r, v, t, gravity()).expect_err("refused");
    assert!(matches!(new(r * f64::NAN, v, 0.0), OrbitError::NotFinite { name: "position", .. }));
    assert!(matches!(new(r, v * f64::INFINITY, 0.0), OrbitError::NotFinite { name: "velocity", .. }));
    assert!(matches!(new(r, v, f64::NAN), OrbitError::NotFinite { .. }));
    assert!(matches!(new(r * 0.3, v, 0.0), OrbitError::BeginsBelowSurface { .. }));
    let orbit = Numerical::new(r, v, 0.0, gravity()).expect("above ground");
    assert!(matches!(orbit.state(f64::NAN), Err(OrbitError::NotFinite { name: "time", .. })));
    assert!(matches!(orbit.state(1e15), Err(OrbitError::TooManySteps { .. })));
    // the resolution of the time at 1e20 s is 4 h: no step is short enough
    let late = Numerical::new(r, v, 1e20, gravity()).expect("above ground");
    let refused = late.state(2e20).expect_err("too late");
    assert!(matches!(refused, OrbitError::StepTooShort { .. }), "{refused:?}");
    assert!(
        refused.to_string().contains("requires a step of 0 s, but steps must be longer than 9.27"),
        "{refused}"
    );
}
