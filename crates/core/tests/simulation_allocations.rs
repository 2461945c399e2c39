//! Checks that a step allocates nothing; this binary counts allocations.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // set-up that fails should stop; --nocapture shows the numbers

mod common;

use common::humanoid::{humanoid, humanoid_with_grippers, start};
use nalgebra::{Matrix3, Vector3};
use onorbit_core::control::{
    Compliance, ComputedTorque, Control, ControlError, Controller, Goal, Interface, InternalForce,
    JointComputedTorque, JointPid, Law, Observation,
};
use onorbit_core::dynamics::derivatives::{
    Derivatives, forward_dynamics_derivatives, free_floating_derivatives, inverse_dynamics_derivatives,
};
use onorbit_core::dynamics::{Data, FrameWrench};
use onorbit_core::environment::{BodyWrench, GravityGradient};
use onorbit_core::model::Model;
use onorbit_core::orbit::{Kepler, MU_EARTH};
use onorbit_core::reference::{Hold, JointHold};
use onorbit_core::simulation::{Integrator, Simulation};
use onorbit_core::spatial::Force;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;

thread_local! {
    /// Allocations of this thread; those of the test harness are not counted.
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    COUNT.with(|count| count.set(count.get() + 1));
}

/// The system's allocator, with a counter.
struct Counting;

// SAFETY: every call is forwarded to the system's allocator.
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

/// Returns every kind of law on one arm, with an undecided goal.
fn every_law(tool: usize, hold: &Hold) -> Vec<Control> {
    let joint = |q: f64| Arc::new(JointHold::new(vec![q]).unwrap());
    let compliance = Compliance {
        frame: tool,
        stiffness: ComputedTorque::diagonal([1.0; 6]),
        damping: ComputedTorque::diagonal([0.1; 6]),
        null_space_damping: 0.01,
    };
    let mut pid =
        Control::new("pid", vec![0], Law::Pid(JointPid::new(Interface::Position, 1.0, 0.1, 0.1), joint(0.6)));
    (pid.goal, pid.starts_at_present) = (Some(Goal::within(0.0)), true);
    let soft = Law::Compliance(Box::new(compliance), hold.clone().into());
    vec![
        pid,
        Control::new(
            "joint",
            vec![1],
            Law::JointComputedTorque(JointComputedTorque::new(1.0, 2.0), joint(-2.3)),
        ),
        Control::new("soft", vec![2, 3], soft),
        Control::new("user", vec![4], Law::User(Box::new(Still), Some((tool, hold.clone().into())))),
    ]
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
    simulation.systems[0].tool = Some(tool);
    simulation.integrator = integrator;
    let hold = Hold::new(Matrix3::identity(), Vector3::new(-0.1, -0.2, 0.5)).unwrap();
    simulation.systems[0].reference_start_tolerance = [1.0, 4.0]; // from the present pose of the tool
    simulation.systems[0].controls = match control {
        0 => {
            simulation.systems[0].reference = Some(hold.into());
            Vec::new()
        }
        1 => {
            let law = Law::TaskComputedTorque(Box::new(ComputedTorque::new(tool, 1.0, 2.0)), hold.into());
            vec![Control::on_all_joints(&simulation.systems[0].model, law)]
        }
        2 => {
            let law = Law::User(Box::new(Still), Some((tool, hold.into())));
            vec![Control::on_all_joints(&simulation.systems[0].model, law)]
        }
        3 => every_law(tool, &hold),
        _ => {
            let law = Law::TaskComputedTorque(Box::new(ComputedTorque::new(tool, 1.0, 2.0)), hold.into());
            vec![Control::new("task", (0..6).collect(), law)]
        }
    };
    simulation
}

/// Returns the allocations of a run of this many steps.
fn allocations(simulation: &mut Simulation, steps: usize) -> usize {
    let before = COUNT.with(Cell::get);
    let trace = simulation.run(steps as f64 * 1e-3).unwrap().only();
    let count = COUNT.with(Cell::get) - before;
    assert_eq!(trace.rows(), steps + 1);
    count
}

#[test]
fn allocations_do_not_grow_with_the_number_of_steps() {
    for control in 0..5 {
        for integrator in [Integrator::Rk4, Integrator::SemiImplicitEuler, Integrator::DormandPrince] {
            let mut simulation = simulation(control, integrator);
            let (few, many) = (allocations(&mut simulation, 100), allocations(&mut simulation, 1000));
            println!("control {control}, {integrator:?}: {few} allocations for 100 steps, {many} for 1000");
            assert_eq!(few, many);
        }
    }
}

/// Returns the controls of the humanoid with grippers, as many as possible of which use the solver for closed
/// loops.
fn looped_controls(case: usize, model: &Model) -> Vec<Control> {
    let tool = model.frame("tool").unwrap();
    let hold = Hold::new(Matrix3::identity(), Vector3::new(-0.1, -0.2, 0.5)).unwrap();
    let task = || Law::TaskComputedTorque(Box::new(ComputedTorque::new(tool, 1.0, 2.0)), hold.clone().into());
    let of_joints = |q: Vec<f64>| {
        Law::JointComputedTorque(JointComputedTorque::new(1.0, 2.0), Arc::new(JointHold::new(q).unwrap()))
    };
    match case {
        0 => Vec::new(),
        1 => vec![Control::on_all_joints(model, task())],
        2 => {
            let mut control = Control::on_all_joints(model, of_joints(start(model)[7..].to_vec()));
            let force = Some([0.5, -0.5, 0.0]);
            control.internal_forces =
                vec![InternalForce { closure: "closing".to_owned(), force, moment: None }];
            vec![control]
        }
        3 => {
            let compliance = Compliance {
                frame: tool,
                stiffness: ComputedTorque::diagonal([1.0; 6]),
                damping: ComputedTorque::diagonal([0.1; 6]),
                null_space_damping: 0.01,
            };
            let soft = Law::Compliance(Box::new(compliance), hold.clone().into());
            vec![
                Control::new("soft", (0..7).collect(), soft),
                Control::new("jaw", vec![10], of_joints(vec![0.01])),
            ]
        }
        _ => {
            let position = Arc::new(JointHold::new(vec![0.02]).unwrap());
            let pid = Law::Pid(JointPid::new(Interface::Position, 1.0, 0.1, 0.1), position);
            vec![
                Control::new("arm", (0..7).collect(), task()),
                Control::new("crank", vec![7], of_joints(vec![1.0])),
                Control::new("jaw", vec![10], pid),
            ]
        }
    }
}

#[test]
fn a_step_with_closed_loops_allocates_nothing() {
    let model = Arc::new(humanoid_with_grippers());
    let mut q = start(&model);
    q[14..17].copy_from_slice(&[1.0, -0.8, 1.3]); // the loop is closed at the start
    let mut v = vec![0.01; model.nv()];
    v[13..].fill(0.0);
    for case in 0..5 {
        for integrator in [Integrator::Rk4, Integrator::SemiImplicitEuler] {
            let mut simulation = Simulation::new(Arc::clone(&model), q.clone(), v.clone());
            simulation.integrator = integrator;
            simulation.systems[0].reference_start_tolerance = [10.0, 4.0];
            simulation.systems[0].tool = Some(model.frame("tool").unwrap());
            simulation.systems[0].controls = looped_controls(case, &model);
            let mut counts = [0; 2];
            for (count, steps) in counts.iter_mut().zip([100, 1000]) {
                let before = COUNT.with(Cell::get);
                let trace = simulation.run(steps as f64 * 1e-3).unwrap().only();
                *count = COUNT.with(Cell::get) - before;
                assert_eq!(trace.rows(), steps + 1);
            }
            let [few, many] = counts;
            println!("case {case}, {integrator:?}: {few} allocations for 100 steps, {many} for 1000");
            assert_eq!(few, many);
        }
    }
}

#[test]
fn derivatives_allocate_nothing() {
    let model = humanoid();
    let (q, v, n, nv) = (start(&model), vec![0.1; model.nv()], model.joint_count(), model.nv());
    let (mut data, mut work) = (Data::new(&model), Derivatives::new(&model));
    let wrench = [FrameWrench { frame: 3, wrench: Force::from_slice(&[1.0; 6]) }];
    let mut out = [nv, nv, nv, n, n, 6, 6, 6].map(|rows| vec![0.0; rows * nv]);
    let [a, b, c, d, e, f, g, h] = &mut out;
    let before = COUNT.with(Cell::get);
    inverse_dynamics_derivatives(&model, &mut data, &mut work, &q, &v, &v, &wrench, [a, b, c]);
    forward_dynamics_derivatives(&model, &mut data, &mut work, &q, &v, &v, &wrench, [a, b, c]);
    let out = [&mut d[..], e, f, g, h];
    free_floating_derivatives(&model, &mut data, &mut work, &q, &v, &v[6..], 3, &wrench, out);
    assert_eq!(COUNT.with(Cell::get), before);
}
