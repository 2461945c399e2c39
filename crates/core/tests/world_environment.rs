//! Checks that effects address systems by their numbers in the world, also in the runs of groups, and that errors
//! contain the names of systems.

#![allow(missing_docs, clippy::unwrap_used)]

use nalgebra::{Matrix3, Vector3};
use onorbit_core::environment::atmosphere::ConstantAtmosphere;
use onorbit_core::environment::surfaces::{Covering, Surface, Surfaces};
use onorbit_core::environment::{BodyIndex, BodyWrench, Drag, Effect};
use onorbit_core::model::{Model, neutral};
use onorbit_core::orbit::{Elements, Kepler, Size};
use onorbit_core::simulation::{Simulation, SimulationError};
use onorbit_core::world::{Action, Event, FrameIndex, System, When};
use std::sync::Arc;

/// Three spheres; an event may connect the last two, so that their numbers in their group differ from those
/// in the world.
fn three_spheres() -> Simulation {
    let model = Arc::new(Model::rigid_body(10.0, Matrix3::identity()).unwrap());
    let system = |number: usize| {
        let (mut q, v) = (neutral(&model), vec![0.0; 6]);
        q[1] = 10.0 * number as f64;
        System::new(["a", "b", "c"][number], Arc::clone(&model), q, v)
    };
    let base = |system: usize| FrameIndex { system, frame: 0 };
    let mut simulation = Simulation::of((0..3).map(system).collect());
    let action = Action::Capture { by: base(1), of: base(2), seat: None };
    simulation.events = vec![Event { name: "grasp".into(), when: When::OnCommand, action }];
    simulation.time_step = 0.1;
    simulation
}

fn push(system: usize) -> BodyWrench {
    BodyWrench::new(BodyIndex { system, body: 0 }, Vector3::x(), Vector3::zeros()).unwrap()
}

#[test]
fn a_wrench_moves_the_system_with_its_number_and_no_other() {
    for pushed in 0..3 {
        let mut simulation = three_spheres();
        simulation.effects = vec![Arc::new(push(pushed).during(0.25, 0.55).unwrap())];
        let recording = simulation.run(1.0).unwrap();
        for (number, trace) in recording.systems.iter().enumerate() {
            let last = &trace.v[trace.v.len() - 6..];
            let expected = if number == pushed { 0.3 / 10.0 } else { 0.0 };
            assert!((last[0] - expected).abs() < 1e-15, "{pushed} {number}: {last:?}");
            let is_cut = trace.time.iter().any(|t| (t - 0.25).abs() < 1e-12);
            // steps end at the instants of the wrench only in its group
            assert_eq!(is_cut, (number == 0) == (pushed == 0), "{:?}", trace.time);
        }
    }
}

#[test]
fn an_effect_on_a_system_that_does_not_exist_is_refused() {
    let mut simulation = three_spheres();
    simulation.effects = vec![Arc::new(push(3))];
    let refused = simulation.check();
    assert!(
        matches!(&refused, Err(SimulationError::EffectOnNoSystem { effect, count: 3 }) if effect == "body wrench"),
        "{refused:?}"
    );
}

#[test]
fn a_second_drag_on_a_body_is_refused_on_every_system() {
    let drag_on = |system: usize| -> Arc<dyn Effect> {
        let body = BodyIndex { system, body: 0 };
        let covering = Covering { body, surface: Surface::cannonball(1.0, 2.2, 1.0).unwrap() };
        let surfaces = Surfaces::new(vec![covering], &[1, 1, 1]).unwrap();
        Arc::new(Drag::new(Arc::new(ConstantAtmosphere::new(1e-12).unwrap()), surfaces))
    };
    let mut simulation = three_spheres();
    simulation.orbit = Some(Arc::new(Kepler::new(&Elements::new(Size::SemiMajorAxis(6.8e6), 0.0)).unwrap()));
    simulation.effects = vec![drag_on(1), drag_on(2)];
    simulation.check().unwrap();
    simulation.effects.push(drag_on(2));
    let refused = simulation.check();
    assert!(
        matches!(&refused, Err(SimulationError::EffectTwice { effect, body }) if effect == "drag" && body == "c/base"),
        "{refused:?}"
    );
}

#[test]
fn errors_about_one_of_several_systems_contain_its_name() {
    let mut simulation = three_spheres();
    simulation.systems[1].v[4] = f64::NAN;
    let refused = simulation.check().unwrap_err().to_string();
    assert_eq!(refused, "system 'b': v[4] is NaN; it must be finite");
    let mut simulation = three_spheres();
    let force = BodyIndex { system: 2, body: 0 };
    let force = BodyWrench::new(force, Vector3::x() * 1e300, Vector3::zeros()).unwrap();
    simulation.effects = vec![Arc::new(force)];
    simulation.time_step = 1e9; // the position overflows
    let refused = simulation.run(1e9).unwrap_err().to_string();
    assert!(refused.contains("diverged at t = 0 s: the state or a torque of 'c' is not finite"), "{refused}");
}
