//! Checks secular J₂ rates against Curtis' example 12.2, an integration of the field, and the error of
//! OnOrbitROS.

use nalgebra::Vector3;
use onorbit_core::orbit::{Elements, Kepler, MU_EARTH, Orbit, OrbitError, Phase, SecularJ2, Size};

const J2: f64 = 1.082_63e-3;
const RADIUS: f64 = 6_378_000.0;

fn curtis() -> Kepler {
    let r = Vector3::new(-2384.46, 5729.01, 3050.46) * 1e3;
    let v = Vector3::new(-7.36138, -2.98997, 1.64354) * 1e3;
    Kepler::from_state(r, v, 3.986e14).expect("an orbit")
}

fn secular(e: f64) -> SecularJ2 {
    let elements = Elements {
        inclination: 1.1,
        raan: 0.3,
        argument_of_periapsis: 2.0,
        phase: Phase::MeanAnomaly(0.5),
        epoch: 50.0,
        ..Elements::new(Size::SemiMajorAxis(8e6), e)
    };
    Kepler::new(&elements).and_then(|kepler| kepler.with_secular_j2(J2, RADIUS)).expect("an ellipse")
}

#[test]
fn rates_agree_with_curtis_12_2() {
    let (node, periapsis) = curtis().with_secular_j2(J2, RADIUS).expect("an ellipse").rates();
    let per_hour = |rate: f64| rate.to_degrees() * 3600.0;
    assert!((per_hour(node) / -0.172 - 1.0).abs() < 0.01, "{}", per_hour(node));
    assert!((per_hour(periapsis) / 0.282 - 1.0).abs() < 0.01, "{}", per_hour(periapsis));
    // negative control: with the factor 1/e of OnOrbitROS the rates are eleven times larger
    assert!((per_hour(node) / curtis().eccentricity() / -0.172 - 1.0).abs() > 1.0);
}

#[test]
fn velocity_and_acceleration_are_derivatives_of_the_position() {
    for e in [0.0, 0.1, 0.6] {
        let orbit = secular(e);
        let at = |t: f64| orbit.state(t).expect("a state");
        for t in [50.0, 3000.0, 2e5] {
            let central = |f: &dyn Fn(f64) -> Vector3<f64>| {
                let h = 2.0;
                ((f(t + h) - f(t - h)) * 45.0 - (f(t + 2.0 * h) - f(t - 2.0 * h)) * 9.0
                    + (f(t + 3.0 * h) - f(t - 3.0 * h)))
                    / (60.0 * h)
            };
            let s = at(t);
            let dr = (central(&|t| at(t).position) - s.velocity).norm();
            let dv = (central(&|t| at(t).velocity) - s.acceleration).norm();
            // roundings of the time, 3e-11 s, of 8e6 m and 1e4 m/s over 2 s
            assert!(dr < 2e-7 && dv < 2e-10, "e = {e}, t = {t}: {dr} m/s, {dv} m/s²");
            // the orbit is not in free fall in the field of a point mass
            let g = -s.position * (MU_EARTH / s.position.norm().powi(3));
            assert!((s.acceleration - g).norm() > 1e-4);
        }
    }
    assert!(secular(0.1).gravity().is_none());
}

#[test]
fn at_the_epoch_the_position_is_that_of_kepler() {
    let orbit = secular(0.1);
    let kepler = Kepler::new(&Elements {
        inclination: 1.1,
        raan: 0.3,
        argument_of_periapsis: 2.0,
        phase: Phase::MeanAnomaly(0.5),
        epoch: 50.0,
        ..Elements::new(Size::SemiMajorAxis(8e6), 0.1)
    });
    let there = kepler.expect("an orbit").state(50.0).expect("a state").position;
    assert_eq!(orbit.state(50.0).expect("a state").position, there);
}

/// Returns the mean rates of node and argument of latitude over whole revolutions in the field with J₂,
/// rad/s.
fn integrated(kepler: &Kepler, days: f64) -> f64 {
    let s = kepler.state(0.0).expect("a state");
    let mu = kepler.mu().expect("a planet");
    let field = |r: &Vector3<f64>| {
        let r2 = r.norm_squared();
        let (z2, k) = (5.0 * r.z * r.z / r2, 1.5 * J2 * RADIUS * RADIUS / r2);
        let part = Vector3::new(
            r.x * (1.0 - k * (z2 - 1.0)),
            r.y * (1.0 - k * (z2 - 1.0)),
            r.z * (1.0 - k * (z2 - 3.0)),
        );
        part * (-mu / (r2 * r2.sqrt()))
    };
    // classical Runge-Kutta at 5 s: independent of the crate's integrator and good to metres
    let (mut r, mut v, h) = (s.position, s.velocity, 5.0);
    let node = |r: &Vector3<f64>, v: &Vector3<f64>| {
        let w = r.cross(v);
        w.x.atan2(-w.y)
    };
    let first = node(&r, &v);
    let steps = (days * 86_400.0 / h) as usize;
    for _ in 0..steps {
        let (k1r, k1v) = (v, field(&r));
        let (k2r, k2v) = (v + k1v * (0.5 * h), field(&(r + k1r * (0.5 * h))));
        let (k3r, k3v) = (v + k2v * (0.5 * h), field(&(r + k2r * (0.5 * h))));
        let (k4r, k4v) = (v + k3v * h, field(&(r + k3r * h)));
        r += (k1r + (k2r + k3r) * 2.0 + k4r) * (h / 6.0);
        v += (k1v + (k2v + k3v) * 2.0 + k4v) * (h / 6.0);
    }
    let turned = node(&r, &v) - first;
    turned / (steps as f64 * h)
}

#[test]
fn an_integrated_orbit_has_the_same_node_rate() {
    let orbit = curtis();
    let (node, _) = orbit.with_secular_j2(J2, RADIUS).expect("an ellipse").rates();
    let true_rate = integrated(&orbit, 2.0);
    assert!((true_rate / node - 1.0).abs() < 0.01, "{true_rate} {node}");
}

#[test]
fn open_orbits_and_invalid_planets_are_refused() {
    let open = Kepler::new(&Elements::new(Size::SemiMajorAxis(-8e6), 1.5)).expect("a hyperbola");
    assert!(matches!(open.with_secular_j2(J2, RADIUS), Err(OrbitError::NotClosed { .. })));
    assert!(matches!(
        curtis().with_secular_j2(f64::NAN, RADIUS),
        Err(OrbitError::NotFinite { name: "j2", .. })
    ));
    assert!(matches!(curtis().with_secular_j2(J2, 0.0), Err(OrbitError::NotPositive { name: "radius", .. })));
}
