//! Friction of contacts against closed forms: sliding to rolling, break-away, return after a pulse.
#![allow(clippy::unwrap_used)]

mod common;

use common::touch::{body, contact, side};
use nalgebra::Vector3;
use onorbit_core::contact::{ContactLaw, Friction, NormalLaw};
use onorbit_core::environment::{Effect, EnvironmentError, Scene, Wrench, Wrenches};
use onorbit_core::geometry::Shape;
use onorbit_core::simulation::{Recording, Simulation};
use std::f64::consts::{FRAC_1_SQRT_2, PI};
use std::sync::Arc;

const RADIUS: f64 = 0.1;
const MASS: f64 = 1.0;
const G: f64 = 9.81;
/// Mass of bodies that do not move, kg, and their moment of inertia, kg m².
const FIXED: f64 = 1e15;

/// Returns a sphere with this moment of inertia, kg m², on a fixed plane at the depth at which its weight is
/// balanced.
fn on_plane(inertia: f64, speed: f64, law: ContactLaw, force: fn(f64) -> Vector3<f64>) -> Simulation {
    let depth = MASS * G / law.normal.stiffness();
    let ball = body("ball", MASS, inertia, [0.0, 0.0, RADIUS - depth], speed);
    let mut simulation = Simulation::of(vec![body("plane", FIXED, FIXED, [0.0; 3], 0.0), ball]);
    let sides = [side(0, 0, Shape::HalfSpace), side(1, 0, Shape::Sphere { radius: RADIUS })];
    simulation.contacts = vec![contact("floor", sides, law)];
    simulation.effects = vec![Arc::new(WorldForce(force))];
    simulation
}

/// Returns the velocity of the centre of mass of the ball in row `k`, in W.
fn velocity(recording: &Recording, k: usize) -> Vector3<f64> {
    Vector3::from_column_slice(&recording.systems[1].momentum[6 * k..6 * k + 3]) / MASS
}

/// Returns the position of the ball in row `k`, in W.
fn position(recording: &Recording, k: usize) -> Vector3<f64> {
    Vector3::from_column_slice(&recording.systems[1].q[7 * k..7 * k + 3])
}

/// Force on the light bodies in axes of W, N, as a function of time.
#[derive(Debug)]
struct WorldForce(fn(f64) -> Vector3<f64>);

impl Effect for WorldForce {
    fn name(&self) -> &str {
        "world_force"
    }

    fn add_wrenches(&self, scene: &Scene<'_>, out: &mut Wrenches) -> Result<(), EnvironmentError> {
        for (index, _) in scene.bodies.iter().filter(|(_, body)| body.mass < FIXED) {
            out.add(index, Wrench { force: (self.0)(scene.time), torque: Vector3::zeros() })?;
        }
        Ok(())
    }
}

fn law(friction: Friction) -> ContactLaw {
    let normal = NormalLaw::HuntCrossley { stiffness: 1e6, exponent: 1.0, dissipation: 10.0 };
    ContactLaw { normal, friction: Some(friction) }
}

const FRICTION: Friction = Friction {
    static_coefficient: 0.3,
    kinetic_coefficient: 0.3,
    stiffness: 1e6,
    damping: None,
    torsional: 0.0,
};

/// Friction in row `k`, N.
fn friction(recording: &Recording, k: usize) -> f64 {
    let row = &recording.systems[0].contacts[0].values[19 * k..19 * k + 19];
    row[1].hypot(row[2])
}

/// A solid sphere at 1 m/s rolls at 5/7 m/s after `2 v₀/(7 μ g)` and `12 v₀²/(49 μ g)`.
#[test]
fn sliding_turns_into_rolling() {
    let inertia = 0.4 * MASS * RADIUS * RADIUS;
    let mut simulation = on_plane(inertia, 1.0, law(FRICTION), |_| Vector3::new(0.0, 0.0, -MASS * G));
    let recording = simulation.run(1.0).unwrap();
    let duration = 2.0 / (7.0 * 0.3 * G);
    let times = &recording.systems[1].time;
    let k = times.iter().position(|t| *t >= duration).unwrap();
    let x = position(&recording, k)[0] - (times[k] - duration) * 5.0 / 7.0;
    let end = velocity(&recording, recording.rows() - 1)[0];
    assert!((x / 0.083213713620 - 1.0).abs() < 1e-6, "{:e}", x / 0.083213713620 - 1.0);
    assert!((end * 1.4 - 1.0).abs() < 1e-4, "{:e}", end * 1.4 - 1.0);
}

/// A body that cannot turn breaks away when a slowly growing force reaches the cone; while it slides,
/// friction has its kinetic value.
#[test]
fn a_pressed_body_breaks_away_at_the_cone() {
    let law = law(Friction { static_coefficient: 0.5, ..FRICTION });
    let ramp = |t: f64| Vector3::new(G * t, 0.0, -MASS * G);
    let recording = on_plane(1e12, 0.0, law, ramp).run(0.6).unwrap();
    let (weight, last) = (MASS * G, recording.rows() - 1);
    let slips =
        (0..=last).find(|k| recording.systems[1].time[*k] > 0.1 && velocity(&recording, *k)[0] > 1e-4);
    let sticks = (0..slips.unwrap()).map(|k| friction(&recording, k)).fold(0.0, f64::max);
    let time = recording.systems[1].time[slips.unwrap()];
    assert!((sticks / (0.5 * weight) - 1.0).abs() < 3e-4, "{:e}", sticks / (0.5 * weight) - 1.0);
    assert!((time - 0.5).abs() < 2e-3, "{time}");
    let sliding = friction(&recording, last) / (0.3 * weight) - 1.0;
    assert!(sliding.abs() < 1e-6, "{sliding:e}");
}

/// Deflection and elastic energy have no jump where a body that slides to rest, or breaks away, begins or
/// ceases to slip: the dissipated energy never decreases, and no step loses more than sliding over its
/// length.
#[test]
fn stick_and_slip_change_the_energies_continuously() {
    let sliding: fn(f64) -> Vector3<f64> = |_| Vector3::new(0.0, 0.0, -MASS * G);
    let ramp: fn(f64) -> Vector3<f64> = |t| Vector3::new(G * t, 0.0, -MASS * G);
    for (coefficient, speed, force) in [(0.3, 0.02, sliding), (0.5, 0.02, sliding), (0.3, 0.0, ramp)] {
        let law = law(Friction { static_coefficient: coefficient, ..FRICTION });
        let recording = on_plane(1e12, speed, law, force).run(0.4).unwrap();
        let column = &recording.systems[0].contacts[0].values;
        let times = &recording.systems[1].time;
        for k in 1..recording.rows() {
            let [before, now] = [&column[19 * (k - 1)..], &column[19 * k..]];
            let path = before[10].max(now[10]) * (times[k] - times[k - 1]);
            let lost = now[13] - before[13];
            assert!(
                lost > -1e-13 && lost <= 0.5 * MASS * G * path + 1e-13,
                "{coefficient} {speed}: {lost:e} J"
            );
            assert!(
                (now[12] - before[12]).abs() <= 0.5 * MASS * G * path + 1e-8,
                "{:e} J",
                now[12] - before[12]
            );
        }
    }
}

#[test]
fn a_body_returns_to_its_place_after_a_pulse_inside_the_cone() {
    let pulse = |t: f64| {
        let along = if t > 0.1 && t < 0.3 { 0.24 * MASS * G * (PI * (t - 0.1) / 0.2).sin() } else { 0.0 };
        Vector3::new(along, 0.0, -MASS * G)
    };
    let recording = on_plane(1e12, 0.0, law(FRICTION), pulse).run(1.0).unwrap();
    let furthest = (0..recording.rows()).map(|k| position(&recording, k)[0]).fold(0.0, f64::max);
    let left = position(&recording, recording.rows() - 1)[0];
    assert!(furthest > 1e-6 && left.abs() < 1e-12, "{furthest:e} {left:e}");
}

/// A sphere that spins on the plane comes to rest by torsional friction with the moment `τ N`.
#[test]
fn torsional_friction_stops_a_spin() {
    let law = law(Friction { torsional: 0.002, ..FRICTION });
    let inertia = 0.4 * MASS * RADIUS * RADIUS;
    let mut simulation = on_plane(inertia, 0.0, law, |_| Vector3::new(0.0, 0.0, -MASS * G));
    simulation.systems[1].v[5] = 2.0;
    let recording = simulation.run(3.0).unwrap();
    let spin = |k: usize| recording.systems[1].v[6 * k + 5];
    let k = recording.systems[1].time.iter().position(|t| *t >= 0.2).unwrap();
    let expected = 2.0 - 0.002 * MASS * G / inertia * recording.systems[1].time[k];
    assert!((spin(k) - expected).abs() < 1e-9, "{:e}", spin(k) - expected);
    assert!(spin(recording.rows() - 1).abs() < 1e-9);
}

/// Returns the drift, m/s, of a capsule of 45 g that two fixed pads press with 12 N, under a tangential load
/// with a period of 0.1 s, over the second half of 1 s.
fn drift(load: fn(f64) -> Vector3<f64>) -> f64 {
    let (radius, stiffness) = (0.004, 1e5);
    let depth = 12.0 / stiffness;
    let lower = body("lower", FIXED, FIXED, [0.0, 0.0, depth - radius], 0.0);
    let mut upper = body("upper", FIXED, FIXED, [0.0, 0.0, radius - depth], 0.0);
    upper.q[3..].copy_from_slice(&[1.0, 0.0, 0.0, 0.0]); // its half-space is above
    let mut capsule = body("capsule", 0.045, 1e-5, [0.0; 3], 0.0);
    capsule.q[3..].copy_from_slice(&[0.0, FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2]);
    let mut simulation = Simulation::of(vec![lower, upper, capsule]);
    let normal = NormalLaw::HuntCrossley { stiffness, exponent: 1.0, dissipation: 10.0 };
    let friction = Friction { static_coefficient: 0.7, kinetic_coefficient: 0.7, stiffness: 1e5, ..FRICTION };
    let law = ContactLaw { normal, friction: Some(friction) };
    let held = || side(2, 0, Shape::Capsule { radius, half_length: 0.02 });
    simulation.contacts = [0, 1]
        .map(|pad| contact(["lower", "upper"][pad], [side(pad, 0, Shape::HalfSpace), held()], law))
        .to_vec();
    simulation.effects = vec![Arc::new(WorldForce(load))];
    let recording = simulation.run(1.0).unwrap();
    let trace = &recording.systems[2];
    let (k, last) = (trace.time.iter().position(|t| *t >= 0.5).unwrap(), trace.rows() - 1);
    (trace.q[7 * last] - trace.q[7 * k]) / (trace.time[last] - trace.time[k])
}

/// MuJoCo creeps at 178 to 2652 µm/s in this grasp, and the LuGre model under the oscillating loads.
#[test]
fn a_held_capsule_does_not_creep() {
    let loads: [fn(f64) -> Vector3<f64>; 3] = [
        |_| Vector3::new(0.44, 0.0, 0.0),
        |t| Vector3::new(0.44 + 0.2 * (20.0 * PI * t).sin(), 0.0, 0.0),
        |t| Vector3::new(8.0 * (20.0 * PI * t).sin(), 0.0, 0.0),
    ];
    for load in loads {
        let drift = drift(load);
        assert!(drift.abs() < 1e-12, "{drift:e}");
    }
}

/// Negative control: beyond the cone the capsule slides.
#[test]
fn a_capsule_slides_under_a_load_beyond_the_cone() {
    assert!(drift(|_| Vector3::new(17.0, 0.0, 0.0)) > 0.01);
}
