//! Checks Sun, Moon and their gravity against JPL's DE421 and closed forms
//! (`tests/oracles/generate_earth_fixture.py`).

use nalgebra::Vector3;
use onorbit_core::earth::{Axes, Earth, EarthError, EarthParameters, Epoch, SpiceKernel, SpiceSegment};
use onorbit_core::gravity::{Gravity, GravityError, Luminary, ThirdBody};
use serde_json::Value;
use std::sync::Arc;

const ARC_SECOND: f64 = std::f64::consts::PI / 648_000.0;

fn fixture(name: &str) -> Vec<Value> {
    let text = include_str!("../../../tests/fixtures/earth.json");
    let table: Value = serde_json::from_str(text).expect("the fixture is JSON");
    table[name].as_array().expect("cases").clone()
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn vector(value: &Value) -> Vector3<f64> {
    Vector3::from_fn(|i, _| number(&value[i]))
}

fn earth(epoch: &str) -> Earth {
    let epoch = Epoch::parse(epoch).expect("an epoch");
    Earth::new(epoch, &EarthParameters::default()).expect("an Earth")
}

#[test]
fn sun_and_moon_agree_with_de421() {
    // largest errors of 200 000 random instants of 1990-2050: 1.7″ and 4e-6 (Sun), 9″ and 3e-5 (Moon)
    let earth = earth("2000-01-01T12:00:00 TT");
    for case in fixture("sky") {
        let t = number(&case["tdb_days"]) * 86_400.0;
        let of = |ours: Vector3<f64>, theirs: &Value| {
            let theirs = vector(theirs) * 1e3;
            (ours.angle(&theirs) / ARC_SECOND, (ours.norm() / theirs.norm() - 1.0).abs())
        };
        let (angle, distance) = of(earth.sun(t).expect("a Sun"), &case["sun_km"]);
        assert!(angle < 2.0 && distance < 4e-6, "Sun, {t}: {angle}″ {distance}");
        let (angle, distance) = of(earth.moon(t).expect("a Moon"), &case["moon_km"]);
        assert!(angle < 10.0 && distance < 3e-5, "Moon, {t}: {angle}″ {distance}");
        // negative control: axes of date instead of GCRF
        let elsewhere = earth.in_axes(Axes::Teme).sun(t).expect("a Sun");
        assert!(t.abs() < 3e7 || of(elsewhere, &case["sun_km"]).0 > 30.0);
    }
}

#[test]
fn interpolated_sun_and_moon_are_continuous() {
    let earth = earth("2024-03-01T12:00:00 UTC");
    let (mut sun, mut moon): (f64, f64) = (0.0, 0.0);
    for k in 0..20_000 {
        let t = f64::from(k) * 60.0;
        // third differences over 30 s are ω³ r h³ = 2e-4 m; a jump would exceed them
        let jerk = |at: &dyn Fn(f64) -> Vector3<f64>| {
            (at(t + 90.0) - (at(t + 60.0) - at(t + 30.0)) * 3.0 - at(t)).norm()
        };
        sun = sun.max(jerk(&|t| earth.sun(t).expect("a Sun")));
        moon = moon.max(jerk(&|t| earth.moon(t).expect("a Moon")));
    }
    println!("steps {sun} {moon}");
    assert!(sun < 1.0 && moon < 0.01, "{sun} m, {moon} m");
}

#[test]
fn sun_and_moon_need_an_epoch() {
    let earth = Earth::about_z(0.0, 7.3e-5);
    assert!(matches!(earth.sun(0.0), Err(EarthError::NeedsEpoch { what: "the position of the Sun" })));
    assert!(matches!(earth.utc(0.0), Err(EarthError::NeedsEpoch { .. })));
    let gravity = Gravity::point_mass(3.986e14).with(Luminary::Moon, &Arc::new(earth.clone()));
    assert!(matches!(gravity, Err(GravityError::Earth(EarthError::NeedsEpoch { .. }))));
    let dated = earth.with_epoch(Epoch::parse("2024-03-01T12:00:00 UTC").expect("an epoch"));
    assert!(dated.sun(0.0).is_ok_and(|sun| (sun.norm() / 1.483e11 - 1.0).abs() < 1e-3));
    assert!(matches!(dated.moon(4e9), Err(EarthError::OutsideSpan { .. })));
    assert!(matches!(dated.moon(f64::NAN), Err(EarthError::OutsideSpan { .. })));
}

/// A third body at rest.
#[derive(Debug)]
struct Still(f64, Vector3<f64>);

impl ThirdBody for Still {
    fn name(&self) -> &'static str {
        "a body that stands still"
    }
    fn mu(&self) -> f64 {
        self.0
    }
    fn position(&self, _: f64) -> Result<Vector3<f64>, GravityError> {
        Ok(self.1)
    }
}

#[test]
fn tides_of_third_bodies_are_free_of_cancellation() {
    let mut naive_worst: f64 = 0.0;
    for case in fixture("tides") {
        let (mu, s, r) = (number(&case["mu"]), vector(&case["body"]), vector(&case["r"]));
        let gravity = |r: &Vector3<f64>| {
            // a planet so light that only the tide of the third body remains
            let gravity = Gravity::point_mass(1e-40).and(Arc::new(Still(mu, s)));
            (gravity.acceleration(0.0, r).expect("a tide"), gravity.gradient(0.0, r).expect("its gradient"))
        };
        let expected = vector(&case["tide"]);
        let (tide, gradient) = gravity(&r);
        let error = (tide - expected).norm() / expected.norm();
        assert!(error < 2e-15, "{case}: {error}");
        let away = s - r;
        let naive = (away / away.norm().powi(3) - s / s.norm().powi(3)) * mu;
        naive_worst = naive_worst.max((naive - expected).norm() / expected.norm());
        // gradient by differences of the tide
        let h = 1e-4 * s.norm();
        for axis in 0..3 {
            let step = Vector3::ith(axis, h);
            let slope = (gravity(&(r + step)).0 - gravity(&(r - step)).0) / (2.0 * h);
            let off = (slope - gradient.column(axis)).norm() / gradient.norm();
            assert!(off < 1e-6, "{case}: {off}");
        }
    }
    assert!(naive_worst > 1e-9, "subtracting the two pulls would not do: {naive_worst}");
}

#[test]
fn a_third_body_given_twice_is_refused() {
    let earth = Arc::new(earth("2024-03-01T12:00:00 UTC"));
    let gravity = Gravity::point_mass(3.986e14).with(Luminary::Sun, &earth).expect("a Sun");
    let both = gravity.clone().with(Luminary::Moon, &earth).expect("and a Moon");
    assert_eq!(both.third_bodies().len(), 2);
    assert!(matches!(gravity.with(Luminary::Sun, &earth), Err(GravityError::BodyTwice { name: "sun" })));
}

#[test]
fn segments_of_kernels_are_summed_within_their_span() {
    // the Sun moves uniformly along x, the Moon is at rest on z; intervals of 20 days from one day before
    let length = 20.0 * 86_400.0;
    let series = |sign: f64, pieces: &[[f64; 6]]| SpiceSegment {
        sign,
        start: -86_400.0,
        length,
        count: 2,
        coefficients: (0..3)
            .flat_map(|axis| pieces.iter().flat_map(move |p| p[2 * axis..2 * axis + 2].to_vec()))
            .collect(),
    };
    let sun = [[10.0, 10.0, 0.0, 0.0, 0.0, 0.0], [30.0, 10.0, 0.0, 0.0, 0.0, 0.0]];
    let moon = [[0.0, 0.0, 0.0, 0.0, 5.0, 0.0]; 2];
    let shared = [[0.0, 0.0, 1.0, 0.0, 0.0, 0.0]; 2];
    let kernel = SpiceKernel::new(vec![series(1.0, &sun), series(-1.0, &shared)], vec![series(1.0, &moon)])
        .expect("a kernel");
    let plain = earth("2000-01-01T12:00:00 TT");
    let earth = plain.clone().with_kernel(kernel.clone()).expect("covered");
    for days in [0.0, 3.3, 18.999, 19.0, 31.0, 38.9] {
        let t = days * 86_400.0;
        // 20 km in 20 days
        let expected = Vector3::new(1e3 * (days + 1.0), -1e3, 0.0);
        assert!((earth.sun(t).expect("a Sun") - expected).norm() < 1e-9, "{days}");
        assert!((earth.moon(t).expect("a Moon") - Vector3::z() * 5e3).norm() < 1e-9);
    }
    let said = earth.sun(40.0 * 86_400.0).expect_err("after its end").to_string();
    assert!(said.contains("2000-02-09"), "{said}");
    assert!(matches!(earth.sun(-86_401.0), Err(EarthError::OutsideSpan { .. })));
    let later =
        Earth::new(Epoch::parse("2024-03-01T12:00:00 UTC").expect("an epoch"), &EarthParameters::default());
    assert!(matches!(later.expect("an Earth").with_kernel(kernel), Err(EarthError::OutsideSpan { .. })));
    let torn = SpiceSegment { coefficients: vec![0.0; 7], ..series(1.0, &sun) };
    assert!(matches!(
        SpiceKernel::new(vec![torn], Vec::new()),
        Err(EarthError::SegmentLength { got: 7, .. })
    ));
}

#[test]
fn numbers_of_a_kernel_that_overflow_positions_are_refused() {
    let good = || SpiceSegment {
        sign: 1.0,
        start: 0.0,
        length: 86_400.0,
        count: 2,
        coefficients: vec![1.4e8, 1e5, 1e6, 0.0, -1e6, 0.0],
    };
    let refused = |segment: SpiceSegment| match SpiceKernel::new(vec![good(), segment], vec![good()]) {
        Err(error @ EarthError::Segment { .. }) => error.to_string(),
        other => panic!("{other:?}"),
    };
    let far = |value: f64| vec![1.4e8, 1e5, 1e6, value, -1e6, 0.0]; // finite, but the Sun was at NaN
    for (segment, said) in [
        (
            SpiceSegment { coefficients: far(1e308), ..good() },
            "a coefficient, in km, of a segment of the kernel is 1e308",
        ),
        (SpiceSegment { coefficients: far(-2e12), ..good() }, "at most 1e12 km"),
        (SpiceSegment { sign: 1e308, ..good() }, "1 or -1"),
        (
            SpiceSegment { length: 0.0, ..good() },
            "the length of an interval, in s, of a segment of the kernel is 0",
        ),
        (SpiceSegment { length: -86_400.0, ..good() }, "positive"),
    ] {
        let text = refused(segment);
        assert!(text.contains(said), "{text}");
    }
    assert!(SpiceKernel::new(vec![good()], vec![good()]).is_ok());
}
