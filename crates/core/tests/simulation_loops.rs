//! Simulations of robots with closed loops: drift, momentum and energy.
#![allow(clippy::unwrap_used)] // a test that cannot set up should stop

use nalgebra::{Isometry3, Matrix3, Vector3};
use onorbit_core::model::{Inertial, Joint, JointKind, Link, Loop, LoopKind, Mimic, Model, ModelBuilder};
use onorbit_core::simulation::{Simulation, SimulationError, Trace};
use std::sync::Arc;

/// Returns a body with this mass, whose inertia is that of a rod of this length along x from the origin.
fn rod(name: &str, mass: f64, length: f64) -> Link {
    let across = mass * length * length / 12.0;
    let inertia = Matrix3::from_diagonal(&Vector3::new(0.01 * across, across, across));
    Link::new(name, Some(Inertial { mass, com: Vector3::new(length / 2.0, 0.0, 0.0), inertia }))
}

/// Lengths of a four-bar linkage, m: left crank, coupler, right crank, and the distance of the pivots.
type Lengths = [f64; 4];
/// The left crank can turn fully.
const CRANK_ROCKER: Lengths = [0.2, 0.5, 0.4, 0.5];
/// All links can lie on one line, which is a singular configuration.
const PARALLELOGRAM: Lengths = [0.3, 0.5, 0.3, 0.5];

/// Returns a four-bar linkage in the x-y plane of a floating base.
fn four_bar([left, coupler, right, apart]: Lengths, change: impl Fn(&mut Loop)) -> Model {
    let inertia = Matrix3::from_diagonal(&Vector3::new(0.3, 0.4, 0.5));
    let inertial = Inertial { mass: 4.0, com: Vector3::zeros(), inertia };
    let mut builder = ModelBuilder::new("four_bar", Link::new("base", Some(inertial))).unwrap();
    let joint = |name: &str, x: f64, y: f64| {
        Joint::new(name, JointKind::Revolute(Vector3::z()), Isometry3::translation(x, y, 0.0))
    };
    builder.add("base", joint("left", 0.1, 0.2), rod("left_crank", 0.5, left)).unwrap();
    builder.add("left_crank", joint("knee", left, 0.0), rod("coupler", 0.8, coupler)).unwrap();
    builder.add("base", joint("right", 0.1 + apart, 0.2), rod("right_crank", 0.6, right)).unwrap();
    let tip = |x: f64| Isometry3::translation(x, 0.0, 0.0);
    let mut closing = Loop {
        name: "closing".to_owned(),
        kind: LoopKind::Revolute,
        frames: ["coupler".to_owned(), "right_crank".to_owned()],
        poses: [tip(coupler), tip(right)],
        length: None,
        project: true,
    };
    change(&mut closing);
    builder.close(closing).unwrap();
    builder.build().unwrap()
}

/// Returns a state with these joint positions in which the left crank turns with `rate`.
fn state(joints: [f64; 3], rate: f64) -> [Vec<f64>; 2] {
    let mut q = vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    q.extend(joints);
    let v = vec![0.01, -0.02, 0.03, 0.2, -0.1, 0.3, rate, 0.0, 0.0];
    [q, v]
}

/// Returns the distance between the tips of the coupler and of the right crank, m.
fn opening([left, coupler, right, apart]: Lengths, joints: &[f64]) -> f64 {
    let (a, b, c) = (joints[0], joints[0] + joints[1], joints[2]);
    let x = left * a.cos() + coupler * b.cos() - apart - right * c.cos();
    let y = left * a.sin() + coupler * b.sin() - right * c.sin();
    x.hypot(y)
}

fn run(model: Model, [q, v]: [Vec<f64>; 2], time_step: f64, duration: f64) -> Trace {
    let mut simulation = Simulation::new(Arc::new(model), q, v);
    simulation.time_step = time_step;
    simulation.record_every = 10;
    simulation.run(duration).unwrap().only()
}

/// Returns the difference of the kinetic energies of the last and the first row, relative to the first.
fn energy_error(trace: &Trace) -> f64 {
    let (first, last) = (trace.kinetic_energy[0], trace.kinetic_energy.last().unwrap());
    (last - first).abs() / first
}

/// Returns the largest change of the momentum, linear and angular, relative to its largest component.
fn momentum_error(trace: &Trace) -> f64 {
    let rows: Vec<&[f64]> = trace.momentum.chunks_exact(6).collect();
    let scale = rows[0].iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let change = |h: &&[f64]| h.iter().zip(rows[0]).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    rows.iter().map(change).fold(0.0, f64::max) / scale
}

/// Returns the largest opening of the loop in any row, m.
fn largest_opening(lengths: Lengths, trace: &Trace) -> f64 {
    trace.q.chunks_exact(10).map(|q| opening(lengths, &q[7..])).fold(0.0, f64::max)
}

const START: [f64; 3] = [1.0, 0.1, 1.4];

#[test]
fn a_loop_stays_closed_and_keeps_momentum_and_energy() {
    let trace = run(four_bar(CRANK_ROCKER, |_| {}), state(START, 2.0), 1e-3, 10.0);
    let angles = || trace.q.chunks_exact(10).map(|q| q[7]);
    let range = angles().fold(f64::MIN, f64::max) - angles().fold(f64::MAX, f64::min);
    assert!(range > 1.0, "the crank turns by {range:.2} rad");
    let [open, momentum] = [largest_opening(CRANK_ROCKER, &trace), momentum_error(&trace)];
    assert!(open < 1e-14 && momentum < 1e-13, "{open:.1e} m, {momentum:.1e}");
    assert!(energy_error(&trace) < 1e-10, "{:.1e}", energy_error(&trace));
}

#[test]
fn the_energy_error_has_order_four() {
    let error = |h: f64| energy_error(&run(four_bar(CRANK_ROCKER, |_| {}), state(START, 2.0), h, 4.0));
    let errors = [error(0.02), error(0.01), error(0.005)];
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((3.6..5.6).contains(&order), "{order:.2} {errors:?}");
    }
}

#[test]
fn a_singular_configuration_is_survived() {
    let trace = run(four_bar(PARALLELOGRAM, |_| {}), state([1.0, -1.0, 1.0], 0.8), 1e-3, 8.0);
    let angles: Vec<f64> = trace.q.chunks_exact(10).map(|q| q[7]).collect();
    assert!(angles.iter().any(|a| *a < 0.0), "all links have been on one line");
    assert!(largest_opening(PARALLELOGRAM, &trace) < 1e-12, "{:.1e}", largest_opening(PARALLELOGRAM, &trace));
    assert!(momentum_error(&trace) < 1e-13, "{:.1e}", momentum_error(&trace));
}

#[test]
fn a_start_that_opens_the_loop_is_an_error() {
    let model = || Arc::new(four_bar(PARALLELOGRAM, |closing| closing.project = false));
    let [q, v] = state([1.0, -0.9, 1.0], 0.0);
    let error = Simulation::new(model(), q, v).check().unwrap_err();
    assert!(matches!(&error, SimulationError::OpenLoop { name, is_moving: false, .. } if name == "closing"));
    let [q, v] = state([1.0, -1.0, 1.0], 0.8);
    let error = Simulation::new(model(), q, v).check().unwrap_err();
    assert!(matches!(&error, SimulationError::OpenLoop { is_moving: true, .. }), "{error}");
    let too_short = Arc::new(four_bar([0.1, 0.1, 0.1, 0.5], |_| {}));
    let [q, v] = state([1.0, -1.0, 1.0], 0.0);
    let error = Simulation::new(too_short, q, v).check().unwrap_err();
    assert!(error.to_string().contains("'closing' stays open by"), "{error}");
}

#[test]
fn a_mimic_joint_follows_its_leader() {
    let model = four_bar(CRANK_ROCKER, |_| {});
    let mut builder = ModelBuilder::from_description(model.description().clone()).unwrap();
    let mut joint =
        Joint::new("finger", JointKind::Revolute(Vector3::y()), Isometry3::translation(-0.2, 0.0, 0.0));
    joint.mimic = Some(Mimic { leader: "left".to_owned(), ratio: -2.0, offset: 0.3 });
    builder.add("base", joint, rod("finger", 0.3, 0.2)).unwrap();
    let [mut q, mut v] = state(START, 2.0);
    q.push(0.0);
    v.push(0.0);
    let trace = run(builder.build().unwrap(), [q, v], 1e-3, 5.0);
    for q in trace.q.chunks_exact(11) {
        assert!((q[10] - (-2.0 * q[7] + 0.3)).abs() < 1e-14, "{q:?}");
    }
    assert!(momentum_error(&trace) < 1e-13 && energy_error(&trace) < 1e-9, "{:.1e}", energy_error(&trace));
}
