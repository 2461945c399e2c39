//! Impacts of two free spheres against closed forms.
#![allow(clippy::unwrap_used)]

mod common;

use common::touch::{body, contact, side};
use onorbit_core::contact::{ContactLaw, ContactSteps, NormalLaw, dissipation_for};
use onorbit_core::geometry::Shape;
use onorbit_core::simulation::{Integrator, Recording, Simulation};

const RADIUS: f64 = 0.1;
const SPEED: f64 = 0.2;

/// Roots `e` of `d v₀ (1 + e) = ln[(1 + d v₀)/(1 − e d v₀)]` for `d v₀`, from a solution with 30 digits.
const RESTITUTIONS: [(f64, f64); 7] = [
    (0.01, 0.993377454399),
    (0.03, 0.980391402985),
    (0.1, 0.937475579950),
    (0.3, 0.832869792266),
    (1.0, 0.593624260040),
    (3.0, 0.306896798291),
    (10.0, 0.099981624753),
];

/// Returns a simulation of two spheres of which the first moves towards the second.
fn spheres(normal: NormalLaw, masses: [f64; 2]) -> Simulation {
    let inertia = masses.map(|mass| 0.4 * mass * RADIUS * RADIUS);
    let second = [2.0 * RADIUS + 1e-4, 0.0, 0.0];
    let systems = vec![
        body("a", masses[0], inertia[0], [0.0; 3], SPEED),
        body("b", masses[1], inertia[1], second, 0.0),
    ];
    let mut simulation = Simulation::of(systems);
    let [a, b] = [0, 1].map(|system| side(system, 0, Shape::Sphere { radius: RADIUS }));
    simulation.contacts = vec![contact("spheres", [a, b], ContactLaw { normal, friction: None })];
    simulation
}

/// Returns the speed of separation relative to the speed of approach.
fn restitution(recording: &Recording) -> f64 {
    let [a, b] =
        [0, 1].map(|system: usize| recording.systems[system].v.chunks_exact(6).next_back().unwrap()[0]);
    (b - a) / SPEED
}

#[test]
fn restitution_follows_from_the_dissipation() {
    for (p, expected) in RESTITUTIONS {
        for exponent in [1.0, 1.5] {
            for masses in [[2.0, 2.0], [1.0, 7.0]] {
                let dissipation = p / SPEED;
                let normal = NormalLaw::HuntCrossley { stiffness: 1e6, exponent, dissipation };
                let found = restitution(&spheres(normal, masses).run(0.6).unwrap());
                assert!((found - expected).abs() < 5e-9, "{p} {exponent} {masses:?}: {:e}", found - expected);
            }
        }
    }
}

#[test]
fn dissipation_gives_the_restitution() {
    for (p, restitution) in RESTITUTIONS {
        let found = dissipation_for(restitution, SPEED).unwrap() * SPEED;
        assert!((found / p - 1.0).abs() < 2e-10 / p.min(1.0), "{p}: {found}");
    }
    assert_eq!(dissipation_for(1.0, SPEED), Ok(0.0));
}

#[test]
fn impossible_restitutions_are_refused() {
    for restitution in [0.0, -0.1, 1.1, f64::NAN] {
        assert!(dissipation_for(restitution, 1.0).is_err());
    }
    assert!(dissipation_for(0.5, 0.0).is_err());
}

#[test]
fn elastic_impacts_lose_nothing() {
    for exponent in [1.0, 1.5, 2.0] {
        let normal = NormalLaw::HuntCrossley { stiffness: 1e7, exponent, dissipation: 0.0 };
        let found = restitution(&spheres(normal, [2.0, 2.0]).run(0.1).unwrap());
        assert!((found - 1.0).abs() < 2e-10, "{exponent}: {:e}", found - 1.0);
    }
}

#[test]
fn the_adaptive_integrator_resolves_an_impact() {
    let normal = NormalLaw::HuntCrossley { stiffness: 1e6, exponent: 1.5, dissipation: 1.0 / SPEED };
    let mut simulation = spheres(normal, [2.0, 2.0]);
    simulation.integrator = Integrator::DormandPrince;
    simulation.tolerance = 1e-10;
    let found = restitution(&simulation.run(0.2).unwrap());
    assert!((found - 0.593624260040).abs() < 1e-7, "{:e}", found - 0.593624260040);
}

/// Effective mass of 1 kg, `K = 1e7 N/m^1.5`, 0.2 m/s: `x_max = (5 m v₀²/(4 K))^(2/5)`, `F = K x_max^1.5`.
#[test]
fn depth_and_force_are_those_of_hertz() {
    let normal = NormalLaw::HuntCrossley { stiffness: 1e7, exponent: 1.5, dissipation: 0.0 };
    let recording = spheres(normal, [2.0, 2.0]).run(0.02).unwrap();
    let rows = recording.systems[0].contacts[0].values.chunks_exact(19);
    let depth = rows.clone().map(|row| -row[0]).fold(0.0, f64::max);
    let force = rows.map(|row| row[1]).fold(0.0, f64::max);
    let expected = (5.0 * SPEED * SPEED / 4e7_f64).powf(0.4);
    // the largest row is at most half a step, 1/256 of the duration, from the maximum
    assert!((depth / expected - 1.0).abs() < 1e-4, "{:e}", depth / expected - 1.0);
    assert!((force / (1e7 * expected.powf(1.5)) - 1.0).abs() < 1.5e-4);
}

/// A spring and dashpot released when the force reaches zero: with the damping ratio `ζ`,
/// `e = exp(−ζ/√(1 − ζ²) arctan…)`; the values are from the closed form with 12 digits.
#[test]
fn a_spring_and_dashpot_separate_when_the_force_is_zero() {
    for (ratio, expected) in [(0.05, 0.858758101775), (0.1, 0.744079397722), (0.3, 0.450975452893)] {
        let (stiffness, mass) = (1e5_f64, 1.0);
        let damping = 2.0 * ratio * (stiffness * mass).sqrt();
        let normal = NormalLaw::SpringDashpot { stiffness, damping };
        let found = restitution(&spheres(normal, [2.0, 2.0]).run(0.1).unwrap());
        assert!((found - expected).abs() < 1e-8, "{ratio}: {:e}", found - expected);
    }
}

/// Returns the errors of the restitution for several numbers of steps.
fn errors(exponent: f64, is_graded: bool) -> [f64; 3] {
    let normal = NormalLaw::HuntCrossley { stiffness: 1e6, exponent, dissipation: 1.0 / SPEED };
    [32, 64, 128].map(|count| {
        let mut simulation = spheres(normal, [2.0, 2.0]);
        simulation.contact_steps = ContactSteps { count, is_graded, ..ContactSteps::default() };
        simulation.time_step = 0.5;
        (restitution(&simulation.run(1.0).unwrap()) - 0.593624260040).abs()
    })
}

#[test]
fn the_order_is_four_for_every_exponent() {
    for exponent in [1.0, 1.2, 1.5, 2.5] {
        let [first, second, third] = errors(exponent, true);
        assert!(first / second > 14.5 && second / third > 14.5, "{exponent}: {first:e} {second:e} {third:e}");
    }
}

/// Negative control: with equal steps, the unbounded derivatives of `x^1.5` reduce the order to 2.5.
#[test]
fn equal_steps_lower_the_order_for_hertz() {
    let [first, second, third] = errors(1.5, false);
    assert!(first / second < 9.0 && second / third < 9.0, "{first:e} {second:e} {third:e}");
}
