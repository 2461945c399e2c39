//! Checks an external engine: it receives state, torques and environment, and returns the states of the run.
#![allow(clippy::unwrap_used)]

mod common;

use common::slider::{BASE, SLIDER, moving, slider};
use nalgebra::Vector3;
use onorbit_core::environment::BodyWrench;
use onorbit_core::simulation::{
    Engine, EnvironmentQuery, Exchange, Integrator, Simulation, SimulationError, StepInput, StepOutput, Trace,
};
use std::sync::Arc;

const FORCE: f64 = 3.0;

/// The slider in closed form: each mass is accelerated along x by its forces, without rotation.
struct ClosedForm {
    outside: EnvironmentQuery,
    steps: usize,
    fails_at: Option<usize>,
}

impl Engine for ClosedForm {
    fn step(&mut self, now: &StepInput<'_>, crossed: &mut StepOutput) -> Result<(), SimulationError> {
        if self.fails_at == Some(self.steps) {
            return Err(SimulationError::Engine("no more".into()));
        }
        self.steps += 1;
        let mut wrenches = [0.0; 12];
        self.outside.wrenches(now.interval.0, now.interval, (now.q, now.v), &mut wrenches)?;
        assert_eq!(wrenches.iter().filter(|x| **x != 0.0).count(), usize::from(wrenches[0] != 0.0));
        let (h, base, rate) = (now.interval.1 - now.interval.0, wrenches[0] / BASE, -wrenches[0] / BASE);
        crossed.q.copy_from_slice(now.q);
        crossed.v.copy_from_slice(now.v);
        crossed.acceleration.fill(0.0);
        (crossed.acceleration[0], crossed.acceleration[6]) = (base, rate);
        let moved = h * now.v[0] + 0.5 * h * h * base;
        (crossed.q[0], crossed.v[0]) = (now.q[0] + moved, now.v[0] + h * base);
        crossed.q[7] += h * now.v[6] + 0.5 * h * h * rate;
        crossed.v[6] += h * rate;
        let impulse = [h * wrenches[0], 0.0, 0.0, 0.0, 0.0, 0.0];
        crossed.systems[0] = Exchange { impulse, work: wrenches[0] * moved, ..Exchange::default() };
        Ok(())
    }
}

/// A push on the base for a second; the block slides without friction.
fn pushed(fails_at: Option<usize>) -> Simulation {
    let mut simulation = moving(slider(0.0, 0.0, None, 0.0), 0.2, Integrator::Rk4, 0.3);
    let push = BodyWrench::new(0, Vector3::x() * FORCE, Vector3::zeros()).and_then(|w| w.during(0.5, 1.5));
    simulation.effects = vec![Arc::new(push.unwrap())];
    let outside = simulation.outside();
    simulation.engine = Some(Box::new(ClosedForm { outside, steps: 0, fails_at }));
    simulation
}

fn run(simulation: &mut Simulation) -> Trace {
    simulation.run(3.0).expect("a run").only()
}

#[test]
fn a_run_with_another_engine_is_certified() {
    let mut simulation = pushed(None);
    let trace = run(&mut simulation);
    let model = Arc::clone(&simulation.systems[0].model);
    let (last, mass) = (trace.rows() - 1, BASE + SLIDER);
    // the initial momentum is that of the block, m r, plus one second of the force
    let momentum = SLIDER * 0.2 + FORCE;
    assert!((trace.momentum[6 * last] - momentum).abs() < 1e-13);
    assert!((trace.impulse[6 * last] - FORCE).abs() < 1e-13);
    let com = trace.center_of_mass[3 * last];
    let expected = (SLIDER * 0.2 * 3.0 + FORCE * (0.5 + 1.5)) / mass; // ½ F s² / m, then F s / m for 1.5 s
    assert!((com - expected).abs() < 1e-13, "{com} {expected}");
    let certificate = onorbit_core::simulation::certify(&model, &trace);
    assert!(certificate.passed(), "{certificate:?}");
    assert!(certificate.attitude_step_doubling_rad.is_none()); // the steps of another engine are unknown
    // it agrees with our own run
    simulation.engine = None;
    let ours = run(&mut simulation);
    assert_eq!(ours.time, trace.time);
    assert!(ours.q.iter().zip(&trace.q).all(|(a, b)| (a - b).abs() < 1e-13));
    assert!(ours.acceleration.iter().zip(&trace.acceleration).all(|(a, b)| (a - b).abs() < 1e-13));
    assert!(ours.work.iter().zip(&trace.work).all(|(a, b)| (a - b).abs() < 1e-13));
}

#[test]
fn an_error_of_the_engine_leaves_complete_rows() {
    let mut simulation = pushed(Some(4));
    let failure = simulation.run(3.0).unwrap_err();
    assert!(matches!(failure.error, SimulationError::Engine(_)), "{failure}");
    assert_eq!(failure.recording.systems[0].rows(), 4);
    let widths = [("q", 8), ("v", 7), ("acceleration", 7), ("momentum", 6)];
    for (name, column) in failure.recording.systems[0].columns() {
        if let Some((_, width)) = widths.iter().find(|(known, _)| *known == name) {
            assert_eq!(column.len(), 4 * width, "{name}");
        }
    }
}

#[test]
fn without_the_impulse_of_the_engine_the_certificate_fails() {
    struct Silent(ClosedForm);
    impl Engine for Silent {
        fn step(&mut self, now: &StepInput<'_>, crossed: &mut StepOutput) -> Result<(), SimulationError> {
            self.0.step(now, crossed)?;
            crossed.systems[0].impulse = [0.0; 6];
            Ok(())
        }
    }
    let mut simulation = pushed(None);
    let outside = simulation.outside();
    simulation.engine = Some(Box::new(Silent(ClosedForm { outside, steps: 0, fails_at: None })));
    let trace = run(&mut simulation);
    assert!(!onorbit_core::simulation::certify(&simulation.systems[0].model, &trace).passed());
}
