//! Benches of one state of a Kepler orbit, and of the gravity effects on a robot with eight bodies.
//!
//! Varied: the conic. Fixed: the robot, one thread. In the benches of the conics, the time advances along the
//! orbit, so that successive calls have different phases.
#![allow(missing_docs)] // criterion's macros make an undocumented function

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{Matrix3, Vector3};
use onorbit_core::environment::{
    Bodies, BodyState, DifferentialGravity, Effect, GravityGradient, Reference, Scene, Wrenches,
};
use onorbit_core::gravity::Gravity;
use onorbit_core::orbit::{Elements, Kepler, Orbit, Size, states};

fn conics() -> [(&'static str, Kepler); 6] {
    let orbit = |size, e| {
        let elements =
            Elements { inclination: 0.9, raan: 1.0, argument_of_periapsis: 2.0, ..Elements::new(size, e) };
        Kepler::new(&elements).expect("a valid orbit")
    };
    [
        ("circle", orbit(Size::SemiMajorAxis(7e6), 0.0)),
        ("ellipse_e0.01", orbit(Size::SemiMajorAxis(7e6), 0.01)),
        ("ellipse_e0.74", orbit(Size::SemiMajorAxis(2.66e7), 0.74)),
        ("ellipse_e0.9999", orbit(Size::SemiLatusRectum(1.4e7), 0.9999)),
        ("parabola", orbit(Size::SemiLatusRectum(1.4e7), 1.0)),
        ("hyperbola_e1.4", orbit(Size::SemiMajorAxis(-2e7), 1.4)),
    ]
}

fn kepler(c: &mut Criterion) {
    let mut group = c.benchmark_group("kepler_state");
    for (name, orbit) in conics() {
        let mut t = 0.0;
        group.bench_function(name, |b| {
            b.iter(|| {
                t = if t > 86_400.0 { 0.0 } else { t + 61.8 };
                orbit.state(black_box(t))
            });
        });
    }
    group.finish();
    let [.., (_, orbit), _, _, _, _] = conics();
    c.bench_function("kepler_lvlh", |b| b.iter(|| orbit.lvlh(black_box(4321.0))));
    let times: Vec<f64> = (0..1000).map(f64::from).collect();
    let (mut r, mut v) = (vec![0.0; 3000], vec![0.0; 3000]);
    c.bench_function("kepler_states_1000", |b| b.iter(|| states(&orbit, black_box(&times), &mut r, &mut v)));
    let s = orbit.state(77.0).expect("a valid time");
    c.bench_function("kepler_from_state", |b| {
        b.iter(|| Kepler::from_state(black_box(s.position), s.velocity, 3.986004418e14));
    });
}

fn effects(c: &mut Criterion) {
    let [(_, orbit), ..] = conics();
    let state = orbit.state(0.0).expect("a valid time");
    let body = BodyState {
        mass: 10.0,
        inertia: Matrix3::new(2.0, 0.1, 0.2, 0.1, 3.0, 0.3, 0.2, 0.3, 4.0),
        com: Vector3::new(0.3, 0.2, 0.1),
        rot_wk: Matrix3::identity(),
        origin: Vector3::zeros(),
        velocity: Vector3::zeros(),
        angular_velocity: Vector3::zeros(),
    };
    let bodies = Bodies::from_iter([body; 8]);
    let mut wrenches = Wrenches::new(&[8]);
    let gravity = orbit.mu().map(Gravity::point_mass);
    let reference = Some(Reference { state: &state, gravity: gravity.as_ref(), in_free_fall: false });
    Scene::with((0.0, 1.0), 0.0, &bodies, reference, None, |scene| {
        c.bench_function("differential_gravity_8_bodies", |b| {
            b.iter(|| DifferentialGravity::default().add_wrenches(black_box(scene), &mut wrenches));
        });
        c.bench_function("gravity_gradient_8_bodies", |b| {
            b.iter(|| GravityGradient.add_wrenches(black_box(scene), &mut wrenches));
        });
    });
}

criterion_group!(benches, kepler, effects);
criterion_main!(benches);
