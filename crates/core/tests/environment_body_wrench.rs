//! Checks a timed wrench: its frame, point of application, switching times and errors.

use nalgebra::{Matrix3, Rotation3, Vector3};
use onorbit_core::environment::{
    Bodies, BodyState, BodyWrench, Effect, EnvironmentError, Scene, Wrench, Wrenches,
};

/// A body rotated by 90° about z, with the centre of mass off the link's origin.
fn body() -> BodyState {
    BodyState {
        mass: 2.0,
        inertia: Matrix3::identity(),
        com: Vector3::new(1.0, 2.5, 3.0),
        rot_wk: Rotation3::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2).into_inner(),
        origin: Vector3::new(1.0, 2.0, 3.0),
        velocity: Vector3::zeros(),
        angular_velocity: Vector3::zeros(),
    }
}

fn act(effect: &BodyWrench, interval: (f64, f64)) -> Result<[Wrench; 2], EnvironmentError> {
    let mut wrenches = Wrenches::new(&[2]);
    let bodies = Bodies::from_iter([body(), body()]);
    let act = |scene: &Scene<'_>| effect.add_wrenches(scene, &mut wrenches);
    Scene::with(interval, interval.0, &bodies, None, None, act)?;
    Ok([0, 1].map(|k| wrenches.get(k).expect("a body there")))
}

fn close(a: Vector3<f64>, b: Vector3<f64>) -> bool {
    (a - b).norm() < 1e-14 // products of numbers below ten, once rounded
}

#[test]
fn a_body_fixed_force_rotates_with_the_body_and_has_a_moment() {
    let push = BodyWrench::new(1, Vector3::x() * 4.0, Vector3::x()).expect("finite");
    let [idle, pushed] = act(&push, (0.0, 1.0)).expect("a body there");
    assert_eq!(idle, Wrench::default());
    // Link x is W y. The origin is 0.5 m below the centre of mass along y, so the moment is zero.
    assert!(close(pushed.force, Vector3::y() * 4.0));
    assert!(close(pushed.torque, Vector3::y()));
    // at link (0, -2, 0), which is W (2, 0, 0) from the origin: 2 m times 4 N about z
    let [_, pushed] = act(&push.at(Vector3::y() * -2.0).expect("finite"), (0.0, 1.0)).expect("a body there");
    assert!(close(pushed.torque, Vector3::new(0.0, 1.0, 8.0)), "{}", pushed.torque);
}

#[test]
fn a_timed_wrench_is_switched_by_the_middle_of_the_step() {
    let push = BodyWrench::new(0, Vector3::x(), Vector3::zeros()).expect("finite");
    let push = push.during(1.0, 2.0).expect("start before end");
    assert_eq!(push.event_times(), [1.0, 2.0]);
    let is_on = |a, b| act(&push, (a, b)).expect("a body there")[0] != Wrench::default();
    // the steps on either side of each event, although both touch it
    assert_eq!(
        [is_on(0.5, 1.0), is_on(1.0, 1.5), is_on(1.5, 2.0), is_on(2.0, 2.5)],
        [false, true, true, false]
    );
}

#[test]
fn a_wrench_without_an_end_has_one_event() {
    let push = BodyWrench::new(0, Vector3::x(), Vector3::zeros()).expect("finite");
    assert_eq!(push.event_times(), [0.0; 0]);
    assert_eq!(push.during(3.0, f64::INFINITY).expect("start before end").event_times(), [3.0]);
}

#[test]
fn invalid_input_is_refused_with_its_values() {
    let push = BodyWrench::new(2, Vector3::x(), Vector3::zeros()).expect("finite");
    let known = "the robot has bodies 0 to 1; give one of these indices".to_owned();
    assert_eq!(act(&push, (0.0, 1.0)), Err(EnvironmentError::UnknownBody { body: 2.into(), known }));
    for (start, end) in [(2.0, 1.0), (1.0, 1.0), (f64::NAN, 1.0), (0.0, f64::NAN)] {
        assert!(matches!(push.during(start, end), Err(EnvironmentError::EmptyInterval { .. })));
    }
    let error =
        BodyWrench::new(0, Vector3::new(0.0, f64::NAN, 0.0), Vector3::zeros()).expect_err("not finite");
    assert_eq!(error.to_string(), "force holds NaN; expected finite numbers");
    assert!(BodyWrench::new(0, Vector3::x(), Vector3::x() * f64::INFINITY).is_err());
    assert!(push.at(Vector3::x() * f64::NAN).is_err());
}
