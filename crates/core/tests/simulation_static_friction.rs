//! Checks static friction above the kinetic friction against closed forms: sticking, breaking away and
//! sticking again.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // set-up that fails should stop; --nocapture shows the numbers

mod common;

use common::slider::{INTEGRATORS, REDUCED, driven, moving, run, slider_with};
use nalgebra::Vector3;
use onorbit_core::control::{Control, ControlError, Controller, Law, Observation};
use onorbit_core::environment::BodyWrench;
use onorbit_core::model::{Joint, Model, ModelError};
use onorbit_core::simulation::{Integrator, Simulation, Trace, certify};
use std::sync::Arc;

/// Kinetic and static friction, N.
const KINETIC: f64 = 2.0;
const STATIC: f64 = 3.0;

fn rough(joint: &mut Joint) {
    (joint.friction, joint.static_friction) = (KINETIC, Some(STATIC));
}

#[test]
fn a_slider_is_held_by_the_static_friction_and_slips_against_the_kinetic_one() {
    for integrator in INTEGRATORS {
        let still = moving(slider_with(rough, 0.3), 0.0, integrator, 0.01);
        // between the two frictions it sticks; above the static friction it slips against the kinetic
        // friction
        let mut loaded = driven(still, |t| if t < 1.995 { 0.95 * STATIC } else { 1.05 * STATIC });
        let trace = run(&mut loaded, 3.0);
        let last = trace.rows() - 1;
        for (k, t) in trace.time.iter().enumerate() {
            let (q, u) = (trace.q[8 * k + 7], trace.v[7 * k + 6]);
            if *t <= 2.0 {
                assert!(q == 0.0 && u == 0.0, "{integrator:?} creeps at {t}: {q} {u}"); // exactly
            } else {
                let expected = (1.05 * STATIC - KINETIC) / REDUCED * (t - 2.0);
                assert!((u - expected).abs() < 1e-12, "{integrator:?} {t}: {u} {expected}");
            }
        }
        if integrator != Integrator::SemiImplicitEuler {
            let way = trace.q[8 * last + 7];
            assert!((trace.dissipated[last] - KINETIC * way).abs() < 1e-12);
            assert!(certify(&loaded.systems[0].model, &trace).passed());
        }
    }
    // negative control: with the kinetic friction only it would move at once
    let equal = |joint: &mut Joint| joint.friction = KINETIC;
    let mut loaded = driven(moving(slider_with(equal, 0.3), 0.0, Integrator::Rk4, 0.01), |_| 0.95 * STATIC);
    assert!(run(&mut loaded, 0.1).v[7 + 6] > 0.0);
}

/// A thruster spins the base up until the slider moves, later than with the kinetic friction only.
#[test]
fn static_friction_decides_when_a_slider_breaks_away_within_a_step() {
    let (offset, torque) = (0.3, 0.8);
    // μ ω² d = fs, ω = T t/I with I = Σ I + μ d²
    let inertia = 0.1 * 25.0 + REDUCED * offset * offset;
    let time = (STATIC / (REDUCED * offset)).sqrt() * inertia / torque;
    let mut simulation = moving(slider_with(rough, offset), 0.0, Integrator::Rk4, 0.02);
    simulation.effects.push(Arc::new(BodyWrench::new(0, Vector3::zeros(), Vector3::z() * torque).unwrap()));
    let trace = run(&mut simulation, time + 1.0);
    let off = trace.time.iter().map(|t| (t - time).abs()).fold(f64::INFINITY, f64::min);
    let row = trace.time.iter().position(|t| (t - time).abs() == off).unwrap();
    // it jumps from rest to the acceleration of the difference of the frictions
    let jump = trace.acceleration[7 * row + 6];
    println!("breaks away {off:e} s off, at {jump} m/s²");
    assert!(off < 1e-9 && (jump - (STATIC - KINETIC) / REDUCED).abs() < 1e-3, "{off:e} {jump}");
    let error = certify(&simulation.systems[0].model, &trace).energy_balance_error_rel;
    assert!(error < 1e-8, "{error:e}");
}

/// A spring whose far end moves uniformly.
struct Pull {
    stiffness: f64,
    speed: f64,
}

impl Controller for Pull {
    fn update(&mut self, now: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError> {
        tau[0] = self.stiffness * (self.speed * now.time - now.q[7]);
        Ok(())
    }
}

const STIFFNESS: f64 = 100.0;
const SPEED: f64 = 0.05;

fn pulled(change: impl Fn(&mut Joint), time_step: f64, duration: f64) -> (Simulation, Trace) {
    let mut simulation = moving(slider_with(change, 0.3), 0.0, Integrator::Rk4, time_step);
    simulation.systems[0].controls = vec![Control::on_all_joints(
        &simulation.systems[0].model,
        Law::User(Box::new(Pull { stiffness: STIFFNESS, speed: SPEED }), None),
    )];
    let trace = run(&mut simulation, duration);
    (simulation, trace)
}

/// Returns when the slider breaks away, s.
fn breakaways(trace: &Trace) -> Vec<f64> {
    let rates: Vec<f64> = trace.v.chunks(7).map(|v| v[6]).collect();
    let starts = (1..rates.len()).filter(|&k| rates[k - 1] == 0.0 && rates[k] != 0.0);
    starts.map(|k| trace.time[k - 1]).collect()
}

/// A block on a spring: it sticks for `2 A/V` and slips for `2/ω (π − atan(A ω/V))`, `A = (fs − fk)/k`, `ω² =
/// k/μ`.
#[test]
fn a_block_pulled_by_a_spring_sticks_and_slips_with_the_period_of_the_closed_form() {
    let (a, w) = ((STATIC - KINETIC) / STIFFNESS, (STIFFNESS / REDUCED).sqrt());
    let period = 2.0 * a / SPEED + 2.0 / w * (std::f64::consts::PI - (a * w / SPEED).atan());
    let off = |time_step: f64| {
        let (simulation, trace) = pulled(rough, time_step, 5.5);
        let times = breakaways(&trace);
        let (count, last) = (times.len() - 1, trace.rows() - 1);
        let measured = (times[count] - times[0]) / count as f64;
        assert!(count >= 3);
        // the first slip at fs = k V t
        assert!((times[0] - STATIC / (STIFFNESS * SPEED)).abs() <= 1.01 * time_step);
        // the dissipated energy is the kinetic friction times the distance, and the balance closes
        assert!((trace.dissipated[last] - KINETIC * trace.q[8 * last + 7]).abs() < 1e-11);
        let certificate = certify(&simulation.systems[0].model, &trace);
        assert!(certificate.energy_balance_error_rel < 1e-9, "{certificate:#?}");
        println!("h {time_step}: period {measured} s, {period} s expected");
        (measured / period - 1.0).abs()
    };
    // the spring force is held over each step
    let (coarse, fine) = (off(1e-3), off(1e-4));
    assert!(coarse < 5e-3 && fine < 5e-4, "{coarse:e} {fine:e}");
    // negative control: with a single friction the period is 2π/ω, and the block hardly stops
    let (_, trace) = pulled(|joint| joint.friction = STATIC, 1e-3, 5.5);
    let times = breakaways(&trace);
    let gaps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let swing = std::f64::consts::TAU / w;
    assert!(gaps.iter().all(|gap| (gap / swing - 1.0).abs() < 2e-3), "{gaps:?}");
    assert!((swing / period - 1.0).abs() > 0.05);
}

#[test]
fn static_friction_below_the_kinetic_one_is_refused() {
    let below = |joint: &mut Joint| (joint.friction, joint.static_friction) = (0.3, Some(0.2));
    let error = common::slider::try_slider_with(below, 0.0).unwrap_err();
    assert!(matches!(error, ModelError::StaticBelowKinetic { at_rest: 0.2, moving: 0.3, .. }), "{error}");
    let model: Model = slider_with(|joint| joint.friction = 0.3, 0.0);
    assert_eq!(model.joints()[0].static_friction, 0.3); // unless it is given
}
