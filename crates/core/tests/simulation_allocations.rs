//! A step allocates nothing: this binary counts.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // set-up that fails should stop; --nocapture shows the numbers

mod common;

use common::humanoid::{humanoid, start};
use nalgebra::{Matrix3, Vector3};
use onorbit_core::control::{ComputedTorque, ControlError, ControlLaw, Controller, Observation};
use onorbit_core::environment::{BodyWrench, GravityGradient};
use onorbit_core::orbit::{Kepler, MU_EARTH};
use onorbit_core::reference::Hold;
use onorbit_core::simulation::{Integrator, Simulation};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::ops::ControlFlow;
use std::sync::Arc;

thread_local! {
    /// Of this thread: the harness's own allocate when they like.
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    COUNT.with(|count| count.set(count.get() + 1));
}

/// The system's allocator, counted.
struct Counting;

// SAFETY: every call is handed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, p: *mut u8, layout: Layout) {
        unsafe { System.dealloc(p, layout) }
    }
    unsafe fn realloc(&self, p: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        unsafe { System.realloc(p, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

struct Still;

impl Controller for Still {
    fn update(&mut self, _: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError> {
        tau.fill(0.0);
        Ok(())
    }
}

fn simulation(control: usize, integrator: Integrator) -> Simulation {
    let model = humanoid();
    let tool = model.frame("tool").unwrap();
    let (q, v) = (start(&model), vec![0.01; model.nv()]);
    let mut simulation = Simulation::new(Arc::new(model), q, v);
    let (r, v) = (Vector3::new(6_778e3, 0.0, 0.0), Vector3::new(0.0, 7_800.0, 0.0));
    simulation.orbit = Some(Arc::new(Kepler::from_state(r, v, MU_EARTH).unwrap()));
    simulation.effects.push(Arc::new(GravityGradient));
    simulation.effects.push(Arc::new(BodyWrench::new(3, Vector3::x() * 0.01, Vector3::y() * 0.01).unwrap()));
    simulation.tool = Some(tool);
    simulation.integrator = integrator;
    let hold = Hold::new(Matrix3::identity(), Vector3::new(-0.1, -0.2, 0.5)).unwrap();
    simulation.reference = Some(hold.into());
    simulation.reference_start_tolerance = [1.0, 4.0]; // from wherever the tool is
    simulation.control = match control {
        0 => ControlLaw::None,
        1 => ControlLaw::ComputedTorque(Box::new(ComputedTorque::new(tool, 1.0, 2.0))),
        _ => ControlLaw::User(Box::new(Still)),
    };
    simulation
}

/// Allocations of a run of so many steps.
fn allocations(simulation: &mut Simulation, steps: usize) -> usize {
    let before = COUNT.with(Cell::get);
    let trace = simulation.run(steps as f64 * 1e-3, &mut |_| ControlFlow::Continue(())).unwrap();
    let count = COUNT.with(Cell::get) - before;
    assert_eq!(trace.rows(), steps + 1);
    count
}

#[test]
fn allocations_do_not_grow_with_the_number_of_steps() {
    for control in 0..3 {
        for integrator in [Integrator::Rk4, Integrator::SemiImplicitEuler, Integrator::DormandPrince] {
            let mut simulation = simulation(control, integrator);
            let (few, many) = (allocations(&mut simulation, 100), allocations(&mut simulation, 1000));
            println!("control {control}, {integrator:?}: {few} allocations for 100 steps, {many} for 1000");
            assert_eq!(few, many);
        }
    }
}
