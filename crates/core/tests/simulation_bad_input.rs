//! Checks the errors of invalid simulations.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // set-up that fails should stop; --nocapture shows the numbers

mod common;

use common::humanoid::{humanoid, start};
use nalgebra::{Matrix3, Vector3};
use onorbit_core::control::{ComputedTorque, Control, ControlError, Law};
use onorbit_core::environment::atmosphere::ConstantAtmosphere;
use onorbit_core::environment::surfaces::{Covering, Surface, Surfaces};
use onorbit_core::environment::{
    BodyWrench, DifferentialGravity, Drag, Effect, EnvironmentError, GravityGradient, RadiationPressure,
    ScenePoint,
};
use onorbit_core::model::{Model, neutral};
use onorbit_core::orbit::{Elements, Kepler, MU_EARTH, Orbit, Phase, Size};
use onorbit_core::reference::Hold;
use onorbit_core::simulation::{Simulation, SimulationError};
use std::sync::Arc;

fn sound() -> Simulation {
    let model = humanoid();
    let (q, v) = (start(&model), vec![0.0; model.nv()]);
    Simulation::new(Arc::new(model), q, v)
}

/// Returns the error of a simulation after `spoil`; no row may have been recorded.
fn refused(spoil: impl FnOnce(&mut Simulation)) -> SimulationError {
    let mut simulation = sound();
    spoil(&mut simulation);
    let failure = simulation.run(1.0).unwrap_err();
    assert_eq!(failure.recording.rows(), 0);
    println!("{failure}");
    failure.error
}

fn tracking(simulation: &mut Simulation) -> usize {
    let tool = simulation.systems[0].model.frame("tool").unwrap();
    let hold = Hold::new(Matrix3::identity(), Vector3::zeros()).unwrap();
    simulation.systems[0].reference = Some(hold.into());
    simulation.systems[0].reference_start_tolerance = [1.0, 4.0]; // from the present pose of the tool
    simulation.systems[0].tool = Some(tool);
    tool
}

/// Makes the reference of the run that of a law on all joints.
fn track_alone(simulation: &mut Simulation, law: ComputedTorque) {
    let law = Law::TaskComputedTorque(Box::new(law), simulation.systems[0].reference.take().unwrap());
    simulation.systems[0].controls = vec![Control::on_all_joints(&simulation.systems[0].model, law)];
}

#[test]
fn states_of_the_wrong_length_or_that_are_no_numbers() {
    let is = |error, wanted: (&str, usize, usize)| matches!(error, SimulationError::WrongLength { name, expected, got } if (name, expected, got) == wanted);
    assert!(is(refused(|s| s.systems[0].q.truncate(13)), ("q", 14, 13)));
    assert!(is(refused(|s| s.systems[0].v.push(0.0)), ("v", 13, 14)));
    for value in [f64::NAN, f64::INFINITY] {
        let error = refused(|s| s.systems[0].q[9] = value);
        assert!(matches!(error, SimulationError::NotFinite { name: "q", index: 9, .. }));
        let error = refused(|s| s.systems[0].v[2] = value);
        assert!(matches!(error, SimulationError::NotFinite { name: "v", index: 2, .. }));
    }
}

#[test]
fn a_quaternion_off_unit_norm() {
    assert!(matches!(refused(|s| s.systems[0].q[6] = 1.000_002), SimulationError::QuaternionNorm { .. }));
    assert!(matches!(refused(|s| s.systems[0].q[6] = 0.0), SimulationError::QuaternionNorm { norm: 0.0 }));
    let mut nearly = sound();
    nearly.systems[0].q[6] = 1.000_000_5;
    let trace = nearly.run(0.01).unwrap().only();
    assert!((trace.q[6] - 1.0).abs() < 1e-15); // normalized
}

#[test]
fn steps_periods_and_durations_that_are_not_positive() {
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = refused(|s| s.time_step = value);
        assert!(matches!(error, SimulationError::NotPositive { name: "time_step", .. }));
        let error = refused(|s| s.systems[0].control_period = Some(value));
        assert!(matches!(error, SimulationError::NotPositive { name: "control_period", .. }));
        let failure = sound().run(value).unwrap_err();
        assert!(matches!(failure.error, SimulationError::NotPositive { name: "duration", .. }));
    }
    assert!(matches!(refused(|s| s.record_every = 0), SimulationError::RecordEvery));
}

#[test]
fn absurd_steps_and_states_are_refused_with_their_limit() {
    let says = |spoil: fn(&mut Simulation), words: &str| {
        let message = refused(spoil).to_string();
        assert!(message.contains(words), "{message}");
    };
    says(|s| s.time_step = 1e-300, "time_step is 1e-300 s; it must be between 1e-12 and 1e9 s");
    says(
        |s| s.systems[0].v[3] = 1e200,
        "v[3], the angular velocity of the base about x, is 1e200 rad/s; its magnitude must be below 1e9 rad/s",
    );
    says(|s| s.systems[0].v[1] = -3e8, "v[1], the velocity of the base along y, is -300000000 m/s");
    says(|s| s.systems[0].v[6] = 1e10, "the rate of joint");
    says(|s| s.systems[0].q[2] = 1e300, "q[2], the position of the base along z, is 1e300 m");
    says(|s| s.systems[0].q[7] = -1e300, "q[7], the position of joint '");
    let mut fast = sound();
    (fast.systems[0].v[0], fast.time_step) = (1e8, 1e-12);
    fast.check().unwrap(); // control: fast, but accepted
}

#[test]
fn more_rows_than_memory_holds() {
    let failure = sound().run(1e15).unwrap_err();
    assert!(matches!(failure.error, SimulationError::TooManyRows { .. }), "{failure}");
}

#[test]
fn effects_without_what_they_need() {
    let error = refused(|s| s.effects.push(Arc::new(GravityGradient)));
    assert!(matches!(error, SimulationError::NeedsOrbit { .. }));
    let push = BodyWrench::new(8, Vector3::x(), Vector3::zeros()).unwrap();
    let error = refused(|s| s.effects.push(Arc::new(push)));
    let SimulationError::Environment { source, .. } = error else { panic!("{error}") };
    let known = "the robot has bodies 0 to 7; give one of these indices".to_owned();
    assert_eq!(source, EnvironmentError::UnknownBody { body: 8.into(), known });
}

#[test]
fn laws_and_references_without_each_other() {
    let error = refused(|s| {
        tracking(s);
        s.systems[0].tool = None;
    });
    assert!(matches!(error, SimulationError::NeedsTool));
    let error = refused(|s| {
        let tool = tracking(s);
        track_alone(s, ComputedTorque::new(tool, 100.0, 20.0));
        s.systems[0].tool = None;
    });
    assert!(matches!(error, SimulationError::NeedsTool));
    let error = refused(|s| {
        let tool = tracking(s);
        track_alone(s, ComputedTorque::new(tool, 100.0, 20.0));
        s.systems[0].tool = Some(0);
    });
    assert!(matches!(error, SimulationError::OtherTool { .. }), "{error}");
}

#[test]
fn gains_and_frames_that_cannot_work() {
    let law = |change: fn(&mut ComputedTorque)| {
        let error = refused(|s| {
            let mut law = ComputedTorque::new(tracking(s), 100.0, 20.0);
            change(&mut law);
            track_alone(s, law);
        });
        match error {
            SimulationError::Control(ControlError::OfControl { source, .. }) => *source,
            other => panic!("{other}"),
        }
    };
    let is_finite_error = |error| matches!(error, ControlError::NotFinite { .. });
    assert!(is_finite_error(law(|law| law.kp[3] = f64::NAN)));
    assert!(is_finite_error(law(|law| law.damping = f64::INFINITY)));
    let is_negative = |error| matches!(error, ControlError::Negative { .. });
    assert!(is_negative(law(|law| law.kd[7] = -1.0)));
    assert!(is_negative(law(|law| law.null_space_damping = -1.0)));
    let error = law(|law| law.frame = 0); // the torso itself
    assert!(matches!(error, ControlError::TooFewJoints { joints: 0, .. }));
}

/// Regression: unchecked indices caused a panic.
#[test]
fn frames_the_robot_does_not_have() {
    let error = refused(|s| s.systems[0].tool = Some(99));
    assert!(matches!(error, SimulationError::UnknownFrame { frame: 99, .. }), "{error}");
    let error = refused(|s| {
        tracking(s);
        track_alone(s, ComputedTorque::new(99, 1.0, 1.0));
    });
    assert!(matches!(error, SimulationError::UnknownFrame { frame: 99, .. }), "{error}");
}

#[test]
fn a_reference_with_an_offset_at_the_start_is_reported() {
    let error = refused(|s| {
        tracking(s);
        s.systems[0].reference_start_tolerance = [0.05, 0.1];
    });
    let SimulationError::ReferenceStartsAway { position, angle, .. } = error else { panic!("{error}") };
    assert!(position > 0.05 || angle > 0.1);
}

fn kepler(size: f64, eccentricity: f64, mu: f64) -> Option<Arc<dyn Orbit>> {
    let elements = Elements { mu, ..Elements::new(Size::SemiMajorAxis(size), eccentricity) };
    Some(Arc::new(Kepler::new(&elements).unwrap()))
}

#[test]
fn an_effect_given_twice_is_refused() {
    let twice = |effects: Vec<Arc<dyn Effect>>| {
        refused(|s| {
            s.orbit = kepler(7e6, 0.0, MU_EARTH);
            s.effects = effects;
        })
    };
    let is = |error: SimulationError, name: &str| matches!(&error, SimulationError::EffectTwice { effect, .. } if effect == name);
    assert!(is(twice(vec![Arc::new(GravityGradient), Arc::new(GravityGradient)]), "gravity gradient"));
    // gravity is part of the orbit
    assert!(is(twice(vec![Arc::new(DifferentialGravity::default())]), "gravity"));
    let ball = |body: usize| {
        let surface = Surface::cannonball(1.0, 2.2, 1.3).unwrap();
        Surfaces::new(
            vec![Covering { body: body.into(), surface }],
            &[sound().systems[0].model.nodes().len()],
        )
        .unwrap()
    };
    let air = || Arc::new(ConstantAtmosphere::new(1e-12).unwrap());
    let drag = |body| -> Arc<dyn Effect> { Arc::new(Drag::new(air(), ball(body))) };
    let light = |body| -> Arc<dyn Effect> { Arc::new(RadiationPressure::new(ball(body))) };
    assert!(is(twice(vec![drag(0), light(0), drag(0)]), "drag"));
    assert!(is(twice(vec![light(3), light(3)]), "radiation pressure"));
    // other bodies, another effect, and any number of wrenches
    let mut simulation = sound();
    simulation.orbit = kepler(7e6, 0.0, MU_EARTH);
    let push = || Arc::new(BodyWrench::new(0, Vector3::x(), Vector3::zeros()).unwrap());
    simulation.effects =
        vec![drag(0), drag(1), light(0), light(2), push(), push(), Arc::new(GravityGradient)];
    simulation.check().unwrap();
}

/// At the perigee of an ellipse through the Earth, without an effect that would detect the ground.
#[test]
fn a_run_that_reaches_the_ground_ends_there() {
    let fly = |mu: f64| {
        let model = Arc::new(Model::rigid_body(10.0, Matrix3::identity()).unwrap());
        let (q, v) = (neutral(&model), vec![0.0; 6]);
        let mut simulation = Simulation::new(model, q, v);
        simulation.time_step = 1.0;
        simulation.orbit = kepler(7e6, 0.1, mu);
        simulation.run(3000.0)
    };
    let failure = fly(MU_EARTH).unwrap_err();
    println!("{failure}");
    assert!(failure.error.to_string().contains("below ground"));
    let SimulationError::Environment { time, source } = &failure.error else { panic!("{failure}") };
    let EnvironmentError::InsidePlanet { what: ScenePoint::Reference, distance, minimum, .. } = source else {
        panic!("{source}")
    };
    assert_eq!(*time, 0.0); // the perigee is the start
    assert!(*distance == 6.3e6 && *minimum == 0.996 * 6_378_137.0, "{distance} {minimum}");
    // a denser planet of another mass may be as small
    assert_eq!(fly(1.1 * MU_EARTH).unwrap().rows(), 3001);
}

/// The same from above: the run ends at the ground and keeps its rows.
#[test]
fn the_rows_before_the_ground_are_kept() {
    let model = Arc::new(Model::rigid_body(10.0, Matrix3::identity()).unwrap());
    let mut simulation = Simulation::new(Arc::clone(&model), neutral(&model), vec![0.0; 6]);
    let start = Elements { phase: Phase::TrueAnomaly(-1.0), ..Elements::new(Size::SemiMajorAxis(7e6), 0.1) };
    let orbit = Kepler::new(&start).unwrap();
    simulation.orbit = Some(Arc::new(orbit));
    simulation.time_step = 1.0;
    let failure = simulation.run(3000.0).unwrap_err();
    let SimulationError::Environment { time, .. } = failure.error else { panic!("{failure}") };
    let height = |t: f64| orbit.state(t).unwrap().position.norm() - 0.996 * 6_378_137.0;
    assert!(height(time) < 0.0 && height(time - 1.0) > 0.0, "{time} s");
    assert!((failure.recording.systems[0].time.last().unwrap() - time).abs() <= 1.0);
}
