//! Checks the gravity field against a computation with 100 digits
//! (`tests/oracles/generate_gravity_fixture.py`), and its expansion about a robot.
#![allow(missing_docs, clippy::unwrap_used)]

use nalgebra::{Matrix3, Vector3};
use onorbit_core::earth::Earth;
use onorbit_core::environment::{
    Bodies, BodyState, DifferentialGravity, Effect, GravityGradient, GravityMode, Reference, Scene, Wrenches,
};
use onorbit_core::gravity::{Gravity, GravityError, GravityField, ThirdBody};
use onorbit_core::orbit::OrbitState;
use serde_json::Value;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

fn fixture() -> Value {
    serde_json::from_str(include_str!("../../../tests/fixtures/gravity.json")).unwrap()
}

fn vector(value: &Value) -> Vector3<f64> {
    Vector3::from_fn(|i, _| value[i].as_f64().unwrap())
}

fn egm2008() -> Arc<GravityField> {
    Arc::new(GravityField::bundled("egm2008", 36, 36).unwrap())
}

/// Returns EGM2008 36 × 36 in an Earth that rotates at `rate`.
fn gravity(rate: f64) -> Gravity {
    Gravity::of_field(egm2008(), Some(Arc::new(Earth::about_z(0.0, rate)))).unwrap()
}

#[test]
fn value_and_gradient_agree_with_100_digits_including_the_poles() {
    let field = egm2008();
    let mut worst = (0.0_f64, 0.0_f64);
    for case in fixture()["values"].as_array().unwrap() {
        let (g, tensor) = field.gradient(&vector(&case["r"])).unwrap();
        let expected = vector(&case["acceleration"]);
        let gradient = Matrix3::from_fn(|i, j| case["gradient"][i][j].as_f64().unwrap());
        worst.0 = worst.0.max((g - expected).norm() / expected.norm());
        worst.1 = worst.1.max((tensor - gradient).norm() / gradient.norm());
    }
    println!("{:.1e} {:.1e}", worst.0, worst.1);
    assert!(worst.0 < 1e-14 && worst.1 < 1e-14, "{worst:?}");
}

fn body(com: Vector3<f64>) -> BodyState {
    BodyState {
        mass: 1.0,
        inertia: Matrix3::identity(),
        com,
        rot_wk: Matrix3::identity(),
        origin: com,
        velocity: Vector3::zeros(),
        angular_velocity: Vector3::zeros(),
    }
}

/// Returns the force on a body of 1 kg near a reference at `at`, in a step of `step` s; the reference moves
/// as in a low orbit.
fn force(
    gravity: &Gravity,
    gravity_mode: GravityMode,
    at: (f64, Vector3<f64>),
    b: BodyState,
    step: f64,
) -> Vector3<f64> {
    let velocity = Vector3::from(VELOCITY);
    let state = OrbitState { position: at.1, velocity, acceleration: Vector3::zeros() };
    let reference = Some(Reference { state: &state, gravity: Some(gravity), in_free_fall: false });
    let (mut wrenches, bodies) = (Wrenches::new(&[1]), Bodies::from_iter([b]));
    let act = |scene: &Scene<'_>| DifferentialGravity { gravity_mode }.add_wrenches(scene, &mut wrenches);
    Scene::with((at.0, at.0 + step), at.0, &bodies, reference, None, act).unwrap();
    wrenches.get(0).unwrap().force
}

/// m/s
const VELOCITY: [f64; 3] = [109.649663, -7527.726490, 1484.521489];

#[test]
fn tides_of_the_full_field_are_accurate_from_1_mm_to_10_km() {
    let (table, gravity) = (fixture(), gravity(0.0));
    let origin = vector(&table["origin"]);
    for case in table["tides"].as_array().unwrap() {
        let (offset, expected) = (vector(&case["offset"]), vector(&case["tide"]));
        let got = force(&gravity, GravityMode::Carried, (0.0, origin), body(offset), 1.0);
        let error = (got - expected).norm() / expected.norm();
        let plain = gravity.acceleration(0.0, &(origin + offset)).unwrap()
            - gravity.acceleration(0.0, &origin).unwrap();
        let cancelled = (plain - expected).norm() / expected.norm();
        println!("{:8.1e} m: {error:.1e}, subtracting {cancelled:.1e}", offset.norm());
        // gradient at the midpoint: (5 d/r)²/24 of 1e-3 of the tide, up to 40 m; beyond, differences of 1e-2
        // of the acceleration in its 16th digit
        let tolerance = 2e-13;
        assert!(error < tolerance, "{offset}: {error:e}");
        assert!(
            offset.norm() > 2.0 || cancelled > 1e-10,
            "plain subtraction must lose digits: {cancelled:e}"
        );
    }
}

#[test]
fn the_expansion_is_accurate_in_steps_of_a_millisecond() {
    let gravity = gravity(7.29e-5);
    let (r, v) = (vector(&fixture()["origin"]), Vector3::from(VELOCITY));
    let offset = Vector3::new(1.5, -2.0, 0.5);
    let (mut worst, mut sum, count) = ((0.0_f64, 0.0_f64), 0.0, 2000);
    for k in 0..count {
        let t = f64::from(k) * 1e-3;
        let now = r + v * t;
        let force_in_mode = |motion, offset, step| force(&gravity, motion, (t, now), body(offset), step);
        let exact = gravity.acceleration(t, &(now + offset)).unwrap();
        let error = (force_in_mode(GravityMode::True, offset, 1e-3) - exact).norm();
        worst.0 = worst.0.max(error);
        sum += error * error;
        // expanded at the midpoint, as for long steps: the tide is exact
        let [tide, expected] = [1e-3, 1.0].map(|step| force_in_mode(GravityMode::Carried, offset, step));
        worst.1 = worst.1.max((tide - expected).norm() / expected.norm());
        // a step of 1 s leaves the range of the expansion: the field is evaluated at the robot, to rounding
        assert!((force_in_mode(GravityMode::True, offset, 1.0) - exact).norm() < 2e-13);
    }
    let mean = (sum / f64::from(count)).sqrt();
    println!("acceleration {mean:.1e} rms, at most {:.1e} m/s², tide {:.1e} of itself", worst.0, worst.1);
    assert!(mean < 1e-12 && worst.0 < 2.5e-12 && worst.1 < 1e-7, "{mean:e} {worst:?}");
    // negative control: a field that is constant between grid points
    let slope = gravity.field().unwrap().gradient(&r).unwrap().1;
    assert!((slope * Vector3::repeat(16.0)).norm() > 1e4 * worst.0);
}

#[test]
fn an_expansion_is_independent_of_earlier_queries() {
    let (fresh, used) = (gravity(7.29e-5), gravity(7.29e-5));
    let r = vector(&fixture()["origin"]);
    let at = |gravity: &Gravity, k: f64| {
        let now = (k + 1e-3, r + Vector3::new(7.6 * k + 3.0, 1.0, 2.0));
        force(gravity, GravityMode::True, now, body(Vector3::y()), 1e-3)
    };
    for k in 0..40 {
        let _ = at(&used, f64::from(k) * 0.7);
    }
    assert_eq!(at(&used, 1.4), at(&fresh, 1.4));
}

/// A body that counts how often its position is requested.
#[derive(Debug, Default)]
struct Counted(AtomicUsize);

impl ThirdBody for Counted {
    fn name(&self) -> &str {
        "counted"
    }
    fn mu(&self) -> f64 {
        4.9e12
    }
    fn position(&self, _: f64) -> Result<Vector3<f64>, GravityError> {
        self.0.fetch_add(1, Ordering::Relaxed);
        Ok(Vector3::new(3.8e8, 1e7, 0.0))
    }
}

#[test]
fn a_gradient_beyond_the_expansion_is_computed_once() {
    let moon = Arc::new(Counted::default());
    let gravity = Gravity::point_mass(3.986004415e14).and(Arc::clone(&moon) as Arc<dyn ThirdBody>);
    let (origin, zero) = (vector(&fixture()["origin"]), Vector3::zeros());
    let state = OrbitState { position: origin, velocity: zero, acceleration: zero };
    let reference = Some(Reference { state: &state, gravity: Some(&gravity), in_free_fall: true });
    let asked = |offset: f64| {
        let (mut wrenches, bodies) = (Wrenches::new(&[1]), Bodies::from_iter([body(Vector3::x() * offset)]));
        let before = moon.0.load(Ordering::Relaxed);
        Scene::with((0.0, 1.0), 0.0, &bodies, reference, None, |scene| {
            GravityGradient.add_wrenches(scene, &mut wrenches).unwrap();
        });
        moon.0.load(Ordering::Relaxed) - before
    };
    // about the reference, and again where that expansion ends
    assert_eq!((asked(10.0), asked(1e4)), (1, 2));
}
