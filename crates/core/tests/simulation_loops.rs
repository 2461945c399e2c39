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

/// Returns a four-bar linkage on a floating base: two cranks of 0.3 m, 0.5 m apart, and a coupler of 0.5 m.
fn four_bar(change: impl Fn(&mut Loop)) -> Model {
    let inertial =
        Inertial { mass: 4.0, com: Vector3::zeros(), inertia: Matrix3::from_diagonal(&Vector3::new(0.3, 0.4, 0.5)) };
    let mut builder = ModelBuilder::new("four_bar", Link::new("base", Some(inertial))).unwrap();
    let joint = |name: &str, x: f64, y: f64| {
        Joint::new(name, JointKind::Revolute(Vector3::z()), Isometry3::translation(x, y, 0.0))
    };
    builder.add("base", joint("left", 0.1, 0.2), rod("left_crank", 0.5, 0.3)).unwrap();
    builder.add("left_crank", joint("knee", 0.3, 0.0), rod("coupler", 0.8, 0.5)).unwrap();
    builder.add("base", joint("right", 0.6, 0.2), rod("right_crank", 0.6, 0.3)).unwrap();
    let tip = |x: f64| Isometry3::translation(x, 0.0, 0.0);
    let mut closing = Loop {
        name: "closing".to_owned(),
        kind: LoopKind::Revolute,
        frames: ["coupler".to_owned(), "right_crank".to_owned()],
        poses: [tip(0.5), tip(0.3)],
        length: None,
        project: false,
    };
    change(&mut closing);
    builder.close(closing).unwrap();
    builder.build().unwrap()
}

/// Returns a state of the parallelogram with both cranks at `angle` and turning with `rate`.
fn state(angle: f64, rate: f64) -> [Vec<f64>; 2] {
    let q = vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, angle, -angle, angle];
    let v = vec![0.01, -0.02, 0.03, 0.2, -0.1, 0.3, rate, -rate, rate];
    [q, v]
}

fn run(model: Model, [q, v]: [Vec<f64>; 2], time_step: f64, duration: f64) -> Trace {
    let mut simulation = Simulation::new(Arc::new(model), q, v);
    simulation.time_step = time_step;
    simulation.record_every = 10;
    simulation.run(duration).unwrap().into_trace()
}

/// Returns the difference of the kinetic energies of the last and the first row, relative to the first.
fn energy_error(trace: &Trace) -> f64 {
    let (first, last) = (trace.kinetic_energy[0], trace.kinetic_energy.last().unwrap());
    (last - first).abs() / first
}

#[test]
fn a_loop_stays_closed_and_keeps_momentum_and_energy() {
    let trace = run(four_bar(|_| {}), state(1.0, 0.8), 1e-3, 5.0);
    let angles: Vec<&[f64]> = trace.q.chunks_exact(10).map(|q| &q[7..]).collect();
    for q in &angles {
        // a parallelogram: the coupler keeps its direction
        assert!((q[0] - q[2]).abs() < 1e-13 && (q[0] + q[1]).abs() < 1e-13, "{q:?}");
    }
    assert!((angles.last().unwrap()[0] - angles[0][0]).abs() > 0.5, "the linkage moves");
    let momentum: Vec<&[f64]> = trace.momentum.chunks_exact(6).collect();
    for h in &momentum {
        let error = h.iter().zip(momentum[0]).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        assert!(error < 1e-14, "{error:.1e}");
    }
    assert!(energy_error(&trace) < 1e-11, "{:.1e}", energy_error(&trace));
}
