//! Checks compliance control: its static balance against a closed form, and that its energy decreases.
#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test

mod common;

use common::humanoid::{humanoid, start};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use onorbit_core::control::{Compliance, ComputedTorque, Control, Law};
use onorbit_core::dynamics::{Data, frame_pose, positions};
use onorbit_core::environment::{Effect, EnvironmentError, Scene, Wrench, Wrenches};
use onorbit_core::reference::{Hold, ReferenceFrame, TaskReference};
use onorbit_core::simulation::{Simulation, Trace};
use std::sync::Arc;

/// Stiffness, N/m and N m/rad.
const LINEAR: f64 = 40.0;
const ANGULAR: f64 = 0.4;

/// Returns the humanoid with its tool on a spring, damped or not (1 or 0), to `offset` (m) from the start.
fn spring(frame: ReferenceFrame, offset: Vector3<f64>, damping: f64) -> Simulation {
    let model = humanoid();
    let (q, tool) = (start(&model), model.frame("tool").unwrap());
    let mut data = Data::<f64>::new(&model);
    positions(&model, &mut data, &q);
    let pose = frame_pose(&model, &data, &q, tool);
    let hold = Hold::new(pose.rot_wf.to_nalgebra(), pose.pos_w.to_nalgebra() + offset).unwrap();
    let six = |linear: f64, angular: f64| {
        ComputedTorque::diagonal([linear, linear, linear, angular, angular, angular])
    };
    // for a wrist of 1e-4 kg m², held torques are stable up to a damping of about 2 I/h
    let law = Compliance {
        frame: tool,
        stiffness: six(LINEAR, ANGULAR),
        damping: six(10.0 * damping, 0.05 * damping),
        null_space_damping: 0.05 * damping,
    };
    let reference = TaskReference { path: Arc::new(hold), frame };
    let v = vec![0.0; model.nv()];
    let mut simulation = Simulation::new(Arc::new(model), q, v);
    (simulation.systems[0].tool, simulation.time_step) = (Some(tool), 2e-4);
    simulation.systems[0].reference_start_tolerance[0] = 0.1; // m: the initial extension of the spring
    let law = Law::Compliance(Box::new(law), reference);
    simulation.systems[0].controls = vec![Control::new("arm", (0..7).collect(), law)];
    simulation
}

fn run(mut simulation: Simulation, duration: f64) -> Trace {
    simulation.run(duration).unwrap().only()
}

/// Returns `T + ½ eᵀ K e` at every row, J.
fn energy(trace: &Trace) -> Vec<f64> {
    let spring = |row: usize| {
        let e = &trace.tracking[0].values[6 * row..6 * row + 6];
        let part = |e: &[f64]| e.iter().map(|x| x * x).sum::<f64>();
        0.5 * (LINEAR * part(&e[..3]) + ANGULAR * part(&e[3..]))
    };
    trace.kinetic_energy.iter().enumerate().map(|(row, kinetic)| kinetic + spring(row)).collect()
}

#[test]
fn with_damping_the_energy_of_robot_and_spring_decreases() {
    for frame in [ReferenceFrame::World, ReferenceFrame::Base] {
        let mut simulation = spring(frame.clone(), Vector3::new(0.05, -0.03, 0.04), 1.0);
        if matches!(frame, ReferenceFrame::Base) {
            simulation.systems[0].v[..6].copy_from_slice(&[0.05, 0.0, -0.02, 0.1, -0.2, 0.1]); // for any momentum
        }
        let energy = energy(&run(simulation, 4.0));
        let (first, last) = (energy[0], energy[energy.len() - 1]);
        for pair in energy.windows(2) {
            // holding the torque over a step may add (τ̇ h²) q̇, 1e-6 of the total
            assert!(pair[1] <= pair[0] + 1e-6 * first, "{pair:?} of {first}");
        }
        assert!(matches!(frame, ReferenceFrame::Base) || last < 0.02 * first, "{last} of {first}");
    }
}

#[test]
fn without_damping_the_energy_is_conserved() {
    let off = |time_step: f64| {
        let mut simulation = spring(ReferenceFrame::World, Vector3::new(0.02, -0.01, 0.015), 0.0);
        simulation.time_step = time_step;
        let energy = energy(&run(simulation, 0.5));
        energy.iter().fold(0.0_f64, |off, e| off.max((e - energy[0]).abs())) / energy[0]
    };
    // a held torque lags by half a step: the energy that it adds is proportional to the step
    let (coarse, fine) = (off(2e-4), off(1e-4));
    assert!(fine < 0.03 && (coarse / fine - 2.0).abs() < 0.15, "{coarse} {fine}");
}

/// A force on the centre of mass of a body and the opposite force on the base, on the same line: no net
/// wrench.
#[derive(Debug)]
struct Embedded {
    body: usize,
    force: Vector3<f64>,
}

impl Effect for Embedded {
    fn name(&self) -> &str {
        "pair"
    }
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        let com = |body| scene.bodies.get(body).expect("a body of the robot").com;
        let (force, arm) = (self.force, com(self.body) - com(0));
        wrenches.add(self.body, Wrench { force, torque: Vector3::zeros() })?;
        wrenches.add(0, Wrench { force: -force, torque: -arm.cross(&force) })
    }
}

#[test]
fn at_rest_the_spring_deflects_by_the_load_over_its_stiffness() {
    let mut simulation = spring(ReferenceFrame::Base, Vector3::zeros(), 1.0);
    let model = Arc::clone(&simulation.systems[0].model);
    let tool = model.frame("tool").unwrap();
    let (body, force) = (model.frames()[tool].body, Vector3::new(0.2, -0.1, 0.15));
    simulation.effects.push(Arc::new(Embedded { body, force }));
    let trace = run(simulation, 20.0);
    let q = &trace.q[(trace.rows() - 1) * model.nq()..];
    let mut data = Data::<f64>::new(&model);
    positions(&model, &mut data, q);
    let pose = frame_pose(&model, &data, q, tool);
    let turn = UnitQuaternion::from_quaternion(Quaternion::new(q[6], q[3], q[4], q[5])).inverse();
    // K e = −(F, r × F), in base axes, r from the tool's origin to the point of the force
    let force = turn * force;
    let origin = turn * (pose.pos_w.to_nalgebra() - Vector3::new(q[0], q[1], q[2]));
    let moment = (data.bodies[body].com_b().to_nalgebra() - origin).cross(&force);
    let e = &trace.tracking[0].values[trace.tracking[0].values.len() - 6..];
    for (i, load) in force.iter().chain(moment.iter()).enumerate() {
        let stiffness = if i < 3 { LINEAR } else { ANGULAR };
        // remaining motion after 20 s
        assert!((e[i] + load / stiffness).abs() < 1e-4, "{i}: {} {}", e[i], -load / stiffness);
    }
    assert!(force.norm() / LINEAR > 5e-3, "the spring is compressed");
}
