//! Checks the invariants of a free robot: momentum, energy, the straight path of its centre of mass, and the
//! Jacobi integral.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // set-up that fails should stop; --nocapture shows the numbers

mod common;

use common::humanoid::{humanoid, humanoid_with, start};
use nalgebra::{Matrix3, Vector3};
use onorbit_core::control::{Control, ControlError, Controller, Law, Observation};
use onorbit_core::dynamics::{Data, kinematics};
use onorbit_core::environment::GravityGradient;
use onorbit_core::model::Model;
use onorbit_core::orbit::{Kepler, MU_EARTH, Orbit};
use onorbit_core::simulation::{Simulation, Trace, certify};
use onorbit_core::spatial::Quat;
use std::sync::Arc;

/// A tumbling torso with an arm that swings at about 1 rad/s.
fn swinging(model: Model) -> Simulation {
    let (q, mut v) = (start(&model), vec![0.0; model.nv()]);
    v[..6].copy_from_slice(&[0.02, -0.01, 0.03, 0.1, -0.05, 0.08]);
    v[6..].copy_from_slice(&[1.0, -0.8, 0.9, 1.1, -0.7, 1.0, -1.2]);
    Simulation::new(Arc::new(model), q, v)
}

fn run(simulation: &mut Simulation, duration: f64) -> Trace {
    simulation.run(duration).unwrap().only()
}

/// The arm starts at half that rate: the light, chaotic wrist still reaches 10 rad/s and more. 2 s in a debug
/// build.
#[test]
fn a_hundred_seconds_of_free_motion_keep_momentum_energy_and_the_straight_line() {
    let mut simulation = swinging(humanoid());
    simulation.systems[0].v.iter_mut().for_each(|v| *v *= 0.5);
    let trace = run(&mut simulation, 100.0);
    assert_eq!(trace.rows(), 100_001);
    let certificate = certify(&simulation.systems[0].model, &trace);
    println!("{certificate:#?}");
    assert!(certificate.passed());
    assert!(certificate.linear_momentum_drift_rel < 1e-12);
    assert!(certificate.angular_momentum_drift_rel < 1e-12);
    assert!(certificate.energy_balance_error_rel < 1e-8);
    // the centre of mass stays within 1e-7 m of its straight line
    let mass = simulation.systems[0].model.mass();
    let at = |column: &[f64], k: usize, width: usize| {
        Vector3::from_column_slice(&column[k * width..k * width + 3])
    };
    let (c0, v0) = (at(&trace.center_of_mass, 0, 3), at(&trace.momentum, 0, 6) / mass);
    let off = (0..trace.rows())
        .map(|k| (at(&trace.center_of_mass, k, 3) - c0 - v0 * trace.time[k]).norm())
        .fold(0.0, f64::max);
    println!("centre of mass off its line: {off:e} m");
    assert!(off < 1e-7);
}

/// Dampers dissipate energy, and `work` records how much.
#[test]
fn damping_and_friction_dissipate_the_recorded_work() {
    // the wrist is light: with the damping of the shoulder it would be too stiff for RK4 at 1 ms; friction
    // reverses within a step: first order there
    let dampings = [(0.3, 0.0, 1e-10), (0.0, 0.05, 1e-4)];
    for (damping, friction, tolerance) in dampings {
        let model = humanoid_with(|joint| {
            let is_wrist = matches!(joint.name.as_str(), "arm_5" | "arm_6" | "arm_7");
            let share = if is_wrist { 0.003 } else { 1.0 };
            (joint.damping, joint.friction) = (damping * share, friction * share);
        });
        let mut simulation = swinging(model);
        let trace = run(&mut simulation, 8.0);
        let energy = &trace.kinetic_energy;
        let lost = energy[0] - energy[trace.rows() - 1];
        let open = (energy[trace.rows() - 1] - energy[0] - trace.work[trace.rows() - 1]).abs();
        println!("damping {damping}, friction {friction}: lost {lost} J of {}, open {open:e} J", energy[0]);
        assert!(lost > 0.3 * energy[0]);
        assert!(open < tolerance * energy[0]);
        assert!(energy.windows(2).all(|e| e[1] <= e[0] + 1e-9 * energy[0]));
        // internal torques do not change the momentum
        let certificate = certify(&simulation.systems[0].model, &trace);
        assert!(
            certificate.linear_momentum_drift_rel < 1e-12 && certificate.angular_momentum_drift_rel < 1e-12
        );
    }
}

/// Torque amplitudes, N m: smaller for light links.
const SWING: [f64; 7] = [0.01, 0.01, 3e-3, 3e-3, 1e-5, 1e-5, 1e-5];

/// Torques that swing the arm, held over each step.
struct Swing;

impl Controller for Swing {
    fn update(&mut self, now: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError> {
        for (j, tau) in tau.iter_mut().enumerate() {
            *tau = SWING[j] * (now.time * (0.5 + 0.1 * j as f64)).cos();
        }
        Ok(())
    }
}

/// `Σ ½m|ρ̇−n×ρ|² + ½n²ρ_z²m − m n²R²X + ½(ω−n)·I(ω−n) − ½n·In [+ (3μ/2r³) r̂·I r̂]`, J: the energy in the
/// frame that rotates with a circular orbit. `X = (s−1)²(s+2)/2s`, `s² = 1 + (2R u + ρ²)/R²`, `u = R̂·ρ`:
/// tide and centrifugal potential together, without cancellation.
fn jacobi(model: &Model, orbit: &Kepler, trace: &Trace, k: usize, gradient: bool) -> f64 {
    let (q, v) =
        (&trace.q[k * model.nq()..(k + 1) * model.nq()], &trace.v[k * model.nv()..(k + 1) * model.nv()]);
    let mut data = Data::new(model);
    kinematics(model, &mut data, q, v);
    let rot_wb: Matrix3<f64> = Quat::from_xyzw(&q[3..]).matrix().to_nalgebra();
    let reference = orbit.state(trace.time[k]).unwrap();
    let (radius, origin) = (reference.position.norm(), Vector3::from_column_slice(q));
    let n = reference.position.cross(&reference.velocity) / (radius * radius);
    let rate_squared = n.norm_squared();
    let mut sum = 0.0;
    for (node, body) in model.nodes().iter().zip(&data.bodies) {
        let rho = rot_wb * body.com_b().to_nalgebra() + origin;
        let rate = rot_wb * body.velocity.at(body.inertia.com).to_nalgebra() - n.cross(&rho);
        let up = reference.position / radius;
        let shift = (2.0 * radius * up.dot(&rho) + rho.norm_squared()) / (radius * radius);
        let s = (1.0 + shift).sqrt();
        let s_1 = shift / (1.0 + s);
        let x = s_1 * s_1 * (s + 2.0) / (2.0 * s);
        let z2 = n.dot(&rho).powi(2); // n² ρ_z²
        sum += node.mass * (0.5 * rate.norm_squared() + 0.5 * z2 - rate_squared * radius * radius * x);
        let rot = rot_wb * body.rot_bk.to_nalgebra();
        let inertia = rot * node.about_com.to_nalgebra() * rot.transpose();
        let spin = rot_wb * body.velocity.angular.to_nalgebra() - n;
        sum += 0.5 * spin.dot(&(inertia * spin)) - 0.5 * n.dot(&(inertia * n));
        if gradient {
            let r = reference.position + rho;
            let r_hat = r.normalize();
            sum += 1.5 * MU_EARTH / r.norm().powi(3) * r_hat.dot(&(inertia * r_hat));
        }
    }
    sum
}

/// On a circular orbit only the joint torques change the Jacobi integral. 1 s in a debug build.
#[test]
fn the_jacobi_integral_changes_by_the_work_of_the_joints_alone() {
    let radius = 6_778e3;
    let speed = (MU_EARTH / radius).sqrt();
    let tilt = 51.6_f64.to_radians();
    let velocity = Vector3::new(0.0, speed * tilt.cos(), speed * tilt.sin());
    let orbit = Kepler::from_state(Vector3::x() * radius, velocity, MU_EARTH).unwrap();
    for (gradient, driven) in [(false, false), (true, false), (true, true)] {
        let mut simulation = swinging(humanoid());
        simulation.systems[0].q[..3].copy_from_slice(&[20.0, -30.0, 10.0]); // where tides are not small
        simulation.systems[0].v.iter_mut().for_each(|v| *v *= 0.1);
        simulation.orbit = Some(Arc::new(orbit));
        if gradient {
            simulation.effects.push(Arc::new(GravityGradient));
        }
        if driven {
            simulation.systems[0].controls =
                vec![Control::on_all_joints(&simulation.systems[0].model, Law::User(Box::new(Swing), None))];
        }
        // a driven arm is chaotic: its energy error varies by a factor of ten with the last bit
        simulation.time_step = if driven { 0.002 } else { 0.005 };
        let trace = run(&mut simulation, 300.0);
        let model = Arc::clone(&simulation.systems[0].model);
        assert!(certify(&model, &trace).passed(), "{:#?}", certify(&model, &trace));
        // a held torque does exactly the work τ·Δq
        let (mut work, mut worst) = (0.0, 0.0_f64);
        let first = jacobi(&model, &orbit, &trace, 0, gradient);
        let mut scale = trace.kinetic_energy[0];
        for k in 1..trace.rows() {
            let joints = |k: usize| &trace.q[k * 14 + 7..(k + 1) * 14];
            let done: f64 =
                (0..7).map(|j| trace.tau[(k - 1) * 7 + j] * (joints(k)[j] - joints(k - 1)[j])).sum();
            work += done;
            scale += done.abs();
            if k % 200 == 0 {
                worst = worst.max((jacobi(&model, &orbit, &trace, k, gradient) - first - work).abs());
            }
        }
        let external = trace.work[trace.rows() - 1] - work;
        println!(
            "gradient {gradient}, driven {driven}: open {:e} of {scale} J; joints {work} J, tides {external} J",
            worst
        );
        // RK4; with the gravity-gradient torque, also the neglected second-order force: 1.5 n² I · 3 Δr/R is
        // 6e-10 J here
        assert!(worst < if gradient { 1e-8 } else { 1e-9 } * scale);
        assert!(external.abs() > 1e-4 * scale); // negative control: without the potential of the tide
    }
}
