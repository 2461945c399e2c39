//! Checks that the adaptive integrator meets its tolerance, including attitude and rows between steps.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // set-up that fails should stop; --nocapture shows the numbers

mod common;

use common::humanoid::{humanoid, start};
use nalgebra::{Matrix3, Vector3};
use onorbit_core::control::{Control, ControlError, Controller, Law, Observation};
use onorbit_core::environment::{
    BodyWrench, Effect, EnvironmentError, GravityGradient, Scene, Wrench, Wrenches,
};
use onorbit_core::model::{Model, difference, neutral};
use onorbit_core::orbit::{Kepler, MU_EARTH};
use onorbit_core::simulation::{Integrator, Simulation, SimulationError, Trace, certify};
use std::sync::{Arc, Mutex};

const TOLERANCES: [f64; 6] = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9];

fn run(simulation: &mut Simulation, duration: f64) -> Trace {
    simulation.run(duration).unwrap().only()
}

/// A spacecraft of 10 kg that tumbles about no principal axis, one turn in about six seconds.
fn tumbling() -> Simulation {
    let model = Model::rigid_body(10.0, Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.5))).unwrap();
    let q = neutral(&model);
    Simulation::new(Arc::new(model), q, vec![0.1, 0.0, -0.2, 0.7, 0.9, -0.4])
}

/// The humanoid's arm without control, while the torso tumbles.
fn limp() -> Simulation {
    let model = humanoid();
    let (q, mut v) = (start(&model), vec![0.0; model.nv()]);
    v[..6].copy_from_slice(&[0.02, -0.01, 0.03, 0.1, -0.05, 0.08]);
    v[6..].copy_from_slice(&[0.5, -0.4, 0.45, 0.55, -0.35, 0.5, -0.6]);
    Simulation::new(Arc::new(model), q, v)
}

fn last(trace: &Trace, model: &Model) -> Vec<f64> {
    trace.q[trace.q.len() - model.nq()..].to_vec()
}

/// Returns the differences in position, attitude and joints.
fn errors(model: &Model, exact: &[f64], q: &[f64]) -> [f64; 3] {
    let mut delta = vec![0.0; model.nv()];
    difference(exact, q, &mut delta);
    let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    [norm(&delta[..3]), norm(&delta[3..6]), norm(&delta[6..])]
}

fn adaptive(mut simulation: Simulation, tolerance: f64, grid: f64) -> Simulation {
    simulation.integrator = Integrator::DormandPrince;
    (simulation.tolerance, simulation.time_step) = (tolerance, grid);
    simulation
}

/// Counts the evaluations of the forces, and records their steps.
#[derive(Debug, Default)]
struct Counter(Mutex<Vec<(f64, f64)>>);

impl Effect for Counter {
    fn name(&self) -> &str {
        "counter"
    }

    fn add_wrenches(&self, scene: &Scene<'_>, _: &mut Wrenches) -> Result<(), EnvironmentError> {
        self.0.lock().unwrap().push(scene.interval);
        Ok(())
    }
}

impl Counter {
    fn on(simulation: &mut Simulation) -> Arc<Self> {
        let counter = Arc::new(Self::default());
        simulation.effects.push(Arc::clone(&counter) as Arc<dyn Effect>);
        counter
    }

    fn evaluations(&self) -> usize {
        self.0.lock().unwrap().len()
    }
}

/// Name, start, duration in s.
type Case = (&'static str, fn() -> Simulation, f64);

/// One turn of the spacecraft, a swing of the arm: step errors accumulate and are later amplified by the
/// motion. The largest error of twenty rows, not only at the end.
#[test]
fn the_tolerance_is_met_within_a_factor_of_ten_over_five_decades() {
    let cases: [Case; 2] = [("tumbling", tumbling, 8.0), ("limp arm", limp, 5.0)];
    for (name, make, duration) in cases {
        let mut reference = make();
        (reference.time_step, reference.record_every) = (duration / 40_000.0, 2_000);
        let exact = run(&mut reference, duration);
        for tolerance in TOLERANCES {
            let mut simulation = adaptive(make(), tolerance, duration / 20.0);
            let trace = run(&mut simulation, duration);
            let mut shares = [0.0_f64; 3];
            for (exact, q) in exact
                .q
                .chunks(simulation.systems[0].model.nq())
                .zip(trace.q.chunks(simulation.systems[0].model.nq()))
            {
                let found = errors(&simulation.systems[0].model, exact, q);
                (0..3).for_each(|i| shares[i] = shares[i].max(found[i] / tolerance));
            }
            println!("{name}, {tolerance:e}: position, attitude, joints off by {shares:.4?} tolerances");
            // the hardest components meet it both ways: the attitude of the spacecraft, the joints of the arm
            let hardest = shares[1].max(shares[2]);
            assert!((0.1..10.0).contains(&hardest), "{name} {tolerance}: {shares:?}");
            let certificate = certify(&simulation.systems[0].model, &trace);
            assert!(certificate.linear_momentum_drift_rel < 1e-12, "{certificate:?}");
            assert!(certificate.angular_momentum_drift_rel < 1e-12, "{certificate:?}");
            assert!(tolerance > 2e-9 || certificate.passed(), "{certificate:#?}");
        }
    }
}

/// Rows inside long steps are of fourth order, as the steps.
#[test]
fn dense_rows_converge_with_fourth_order_at_least() {
    let make = || tumbling();
    let duration = 4.0;
    let mut reference = make();
    (reference.time_step, reference.record_every) = (1e-4, 100);
    let exact = run(&mut reference, duration);
    let worst = |tolerance: f64| {
        let mut simulation = adaptive(make(), tolerance, 0.01);
        let counter = Counter::on(&mut simulation);
        let trace = run(&mut simulation, duration);
        assert_eq!(trace.rows(), 401);
        let steps = (counter.evaluations() - 401) / 7; // a row has one evaluation, a step seven
        let pairs = exact.q.chunks(7).zip(trace.q.chunks(7));
        let error =
            pairs.map(|(exact, q)| errors(&simulation.systems[0].model, exact, q)[1]).fold(0.0, f64::max);
        // consistency of the rows: momentum, energy, the straight line
        let certificate = certify(&simulation.systems[0].model, &trace);
        println!("{tolerance:e}: {steps} steps, rows off by {error:e} rad, {certificate:?}");
        assert!(certificate.angular_momentum_drift_rel < 1e-12);
        assert!(certificate.energy_balance_error_rel < 100.0 * tolerance);
        (steps as f64, error)
    };
    let (coarse, fine) = (worst(1e-5), worst(1e-9));
    let order = (coarse.1 / fine.1).ln() / (fine.0 / coarse.0).ln();
    println!("order {order}");
    assert!((3.7..6.0).contains(&order), "{order}");
}

/// An eccentric orbit: steps are short where the gravity gradient changes fast.
#[test]
fn steps_follow_the_pace_of_an_eccentric_orbit() {
    let eccentric = |time_step: f64| {
        let mut simulation = tumbling();
        simulation.systems[0].v = vec![0.0, 0.0, 0.0, 0.0, 1e-4, 2e-4];
        let (r, v) = (Vector3::new(6_778e3, 0.0, 0.0), Vector3::new(0.0, 10_300.0, 0.0)); // e = 0.8
        simulation.orbit = Some(Arc::new(Kepler::from_state(r, v, MU_EARTH).unwrap()));
        simulation.effects.push(Arc::new(GravityGradient));
        simulation.time_step = time_step;
        simulation
    };
    let duration = 60_000.0; // about an orbit
    let mut simulation = adaptive(eccentric(600.0), 1e-8, 600.0);
    let counter = Counter::on(&mut simulation);
    let trace = run(&mut simulation, duration);
    // the stages of a step share its interval; single evaluations are look-aheads or rows
    let lengths: Vec<f64> =
        counter.0.lock().unwrap().windows(2).filter(|w| w[0] == w[1]).map(|w| w[0].1 - w[0].0).collect();
    let (shortest, longest) =
        (lengths.iter().copied().fold(f64::INFINITY, f64::min), lengths.iter().copied().fold(0.0, f64::max));
    let evaluations = counter.evaluations();
    let mut reference = eccentric(1.0);
    reference.record_every = 60_000;
    let exact = last(&run(&mut reference, duration), &reference.systems[0].model);
    let found = errors(&reference.systems[0].model, &exact, &last(&trace, &reference.systems[0].model));
    // RK4 of the same accuracy
    let mut even = (0.0, 0);
    for time_step in [60.0, 30.0, 20.0, 15.0, 10.0, 7.5, 5.0] {
        let mut simulation = eccentric(time_step);
        simulation.record_every = 1_000_000;
        let counter = Counter::on(&mut simulation);
        let q = last(&run(&mut simulation, duration), &simulation.systems[0].model);
        even = (errors(&simulation.systems[0].model, &exact, &q)[1], counter.evaluations());
        if even.0 <= found[1] {
            break;
        }
    }
    println!("steps of {shortest} to {longest} s, off by {found:?}; {evaluations} evaluations, RK4 {even:?}");
    assert!(longest > 4.0 * shortest);
    assert!(found[1] < 1e-5);
    assert!(even.1 > 3 * evaluations);
    let certificate = certify(&simulation.systems[0].model, &trace);
    assert!(certificate.passed(), "{certificate:#?}");
}

/// A push that starts and ends off all grids: steps end there, and the impulse is exact.
#[test]
fn events_and_control_ticks_shorten_adaptive_steps() {
    let model = Model::rigid_body(7.0, Matrix3::identity()).unwrap();
    let mut simulation =
        adaptive(Simulation::new(Arc::new(model.clone()), neutral(&model), vec![0.0; 6]), 1e-9, 0.1);
    let force = Vector3::new(3.0, -1.0, 0.5);
    let push = BodyWrench::new(0, force, Vector3::zeros()).unwrap().during(0.1234, 0.456_789).unwrap();
    simulation.effects.push(Arc::new(push));
    let trace = run(&mut simulation, 1.0);
    let gained = Vector3::from_column_slice(&trace.v[trace.v.len() - 6..]);
    assert!((gained - force * ((0.456_789 - 0.1234) / 7.0)).norm() < 1e-15);
    assert_eq!(trace.rows(), 11); // the grid
    assert!(trace.time.iter().enumerate().all(|(k, t)| (t - 0.1 * k as f64).abs() < 1e-12));
}

#[test]
fn a_motion_that_no_step_resolves_is_reported() {
    let mut simulation = adaptive(tumbling(), 1e-9, 0.1);
    for tolerance in [0.0, 1e-16, 0.5, f64::NAN] {
        simulation.tolerance = tolerance;
        let error = simulation.check().unwrap_err();
        assert!(matches!(error, SimulationError::Tolerance { .. }) && error.to_string().contains("1e-13"));
    }
    simulation.tolerance = 1e-9;
    simulation.effects.push(Arc::new(Noise));
    let failure = simulation.run(1.0).unwrap_err();
    assert!(matches!(failure.error, SimulationError::StepTooSmall { .. }), "{failure}");
    assert!(
        failure.to_string().contains("increase the tolerance") && failure.recording.systems[0].rows() > 0
    );
}

/// A torque that changes at every evaluation.
#[derive(Debug)]
struct Noise;

impl Effect for Noise {
    fn name(&self) -> &str {
        "noise"
    }

    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        if scene.time > 0.3 {
            let torque = Vector3::x() * (1e9 * f64::from((scene.time.to_bits() % 7) as u8));
            wrenches.add(0, Wrench { force: Vector3::zeros(), torque })?;
        }
        Ok(())
    }
}

/// At rest under balanced loads there is only rounding error, which must not shorten steps.
#[test]
fn rounding_at_rest_does_not_shorten_the_steps() {
    let model = common::humanoid::humanoid_with(|joint| joint.friction = 2.0);
    let (q, v) = (start(&model), vec![0.0; model.nv()]);
    let mut simulation = adaptive(Simulation::new(Arc::new(model), q, v), 1e-9, 10.0);
    simulation.systems[0].controls =
        vec![Control::on_all_joints(&simulation.systems[0].model, Law::User(Box::new(Load), None))];
    simulation.systems[0].control_period = Some(50.0);
    let counter = Counter::on(&mut simulation);
    let trace = run(&mut simulation, 100.0);
    assert!(trace.v.iter().all(|v| v.abs() < 1e-12));
    println!("{} evaluations", counter.evaluations());
    assert!(counter.evaluations() < 500);
}

/// A torque below the static friction.
struct Load;

impl Controller for Load {
    fn update(&mut self, _: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError> {
        tau.copy_from_slice(&[1.7, -1.3, 0.9, 1.1, -0.3, 0.7, 1.9]);
        Ok(())
    }
}
