//! Benches of a planet's field, and of the gravity effects on a robot with eight bodies.
//!
//! Varied: the model and its degree. Fixed: a position in a low orbit, one thread. In the benches of the
//! field, the position changes slightly at every call. The benches of the effects evaluate one scene
//! repeatedly, so a single expansion of the field serves all bodies and calls.
#![allow(missing_docs)] // criterion's macros make an undocumented function

use std::hint::black_box;
use std::sync::Arc;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{Matrix3, Vector3};
use onorbit_core::earth::Earth;
use onorbit_core::environment::{
    Bodies, BodyState, DifferentialGravity, Effect, GravityGradient, Reference, Scene, Wrenches,
};
use onorbit_core::gravity::{Gravity, GravityField};
use onorbit_core::orbit::OrbitState;

const PLACE: [f64; 3] = [-4292653.41, 955168.47, 5139356.57];

fn fields() -> Vec<(&'static str, GravityField)> {
    let egm = |degree| GravityField::bundled("egm2008", degree, degree).expect("bundled");
    let zonal = |degree| GravityField::zonal(degree).expect("bundled");
    vec![("j2", zonal(2)), ("j2_to_j6", zonal(6)), ("8x8", egm(8)), ("36x36", egm(36)), ("70x70", egm(70))]
}

fn field(c: &mut Criterion) {
    for (name, field) in fields() {
        let mut r = Vector3::from(PLACE);
        c.bench_function(&format!("field_{name}"), |b| {
            b.iter(|| {
                r.x += 1e-3;
                field.acceleration(black_box(&r))
            });
        });
        c.bench_function(&format!("field_gradient_{name}"), |b| {
            b.iter(|| {
                r.x += 1e-3;
                field.gradient(black_box(&r))
            });
        });
    }
}

fn effects(c: &mut Criterion) {
    let com = Vector3::new(0.3, 0.2, 0.1);
    let body = BodyState {
        mass: 10.0,
        inertia: Matrix3::new(2.0, 0.1, 0.2, 0.1, 3.0, 0.3, 0.2, 0.3, 4.0),
        com,
        rot_wk: Matrix3::identity(),
        origin: com,
        velocity: Vector3::zeros(),
        angular_velocity: Vector3::zeros(),
    };
    let bodies = Bodies::from_iter([body; 8]);
    let mut wrenches = Wrenches::new(&[8]);
    for (name, field) in fields() {
        let earth = Some(Arc::new(Earth::about_z(0.0, 7.292e-5)));
        let gravity = Gravity::of_field(Arc::new(field), earth).expect("an earth");
        let (position, zero) = (Vector3::from(PLACE), Vector3::zeros());
        let state = OrbitState { position, velocity: zero, acceleration: zero };
        let reference = Some(Reference { state: &state, gravity: Some(&gravity), in_free_fall: false });
        Scene::with((0.0, 1e-3), 5e-4, &bodies, reference, None, |scene| {
            c.bench_function(&format!("gravity_8_bodies_{name}_known"), |b| {
                b.iter(|| {
                    DifferentialGravity::default().add_wrenches(black_box(scene), &mut wrenches)?;
                    GravityGradient.add_wrenches(black_box(scene), &mut wrenches)
                });
            });
        });
    }
}

criterion_group!(benches, field, effects);
criterion_main!(benches);
