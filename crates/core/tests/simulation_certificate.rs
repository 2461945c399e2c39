//! The certificate: green on honest runs, red on those that are not.
#![allow(clippy::unwrap_used)] // a test that cannot set up should stop

mod common;

use common::{Random, random_model, random_state};
use onorbit_core::simulation::{Simulation, certify};
use std::ops::ControlFlow;
use std::sync::Arc;

#[test]
fn honest_free_motion_of_random_robots_is_green() {
    for seed in 0..6 {
        let model = Arc::new(random_model(seed, 8));
        let (q, v) = random_state(&model, &mut Random::new(seed));
        let mut simulation = Simulation::new(Arc::clone(&model), q, v);
        let trace = simulation.run(2.0, &mut |_| ControlFlow::Continue(())).unwrap();
        let certificate = certify(&model, &trace);
        println!("{seed} {:#?}", certificate);
        assert!(certificate.passed(), "seed {seed}: {certificate:#?}");
    }
}
