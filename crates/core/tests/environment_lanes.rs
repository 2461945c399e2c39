//! Bodies side by side: the same wrenches on any lanes, however many bodies there are and however they are covered.
#![allow(clippy::unwrap_used)] // set-up that fails should stop

mod common;

use common::Random;
use common::stream::{attitudes, body, wrenches};
use nalgebra::{Isometry3, Matrix3, Vector3};
use onorbit_core::earth::{Earth, Epoch};
use onorbit_core::environment::atmosphere::ExponentialAtmosphere;
use onorbit_core::environment::surfaces::{Covering, Optics, Surface, Surfaces};
use onorbit_core::environment::{
    BodyState, DifferentialGravity, Drag, Effect, GravityGradient, RadiationPressure, Wrench,
};
use onorbit_core::model::{Geometry, Inertial, Link, Model, ModelBuilder, Visual};
use onorbit_core::spatial::InstructionSet;
use std::sync::Arc;

fn hull(shapes: Vec<Geometry>) -> Model {
    let visual = |geometry| Visual { pose: Isometry3::translation(0.1, 0.2, 0.3), geometry, rgba: None };
    let inertial = Inertial { mass: 2.0, com: Vector3::zeros(), inertia: Matrix3::identity() };
    let link =
        Link { visuals: shapes.into_iter().map(visual).collect(), ..Link::new("hull", Some(inertial)) };
    ModelBuilder::new("robot", link).and_then(ModelBuilder::build).unwrap()
}

/// Bodies with nothing, a ball, a box and a cylinder, a capsule, two boxes, ...: no two neighbours have as many parts.
fn coverings(count: usize) -> Surfaces {
    let tube = || Geometry::Cylinder { radius: 0.2, length: 0.7 };
    let of_shapes = |shapes| {
        let optics = Optics::new(0.3, 0.4).unwrap();
        Surface::from_shapes(&hull(shapes), 0, 2.0, optics).unwrap()
    };
    let surface = |k: usize| match k % 5 {
        0 => Surface::cannonball(1.5 + 0.1 * k as f64, 2.2, 1.3).unwrap(),
        1 => of_shapes(vec![Geometry::Box([0.3, 0.4, 0.5]), tube()]),
        2 => of_shapes(vec![Geometry::Capsule { radius: 0.1, length: 0.4 }]),
        _ => of_shapes(vec![
            Geometry::Box([1.0, 0.1, 0.2]),
            Geometry::Box([0.1; 3]),
            Geometry::Sphere { radius: 0.2 },
        ]),
    };
    // one in seven stays bare, but for the first
    let covered = (0..count).filter(|k| k % 7 != 6);
    Surfaces::new(covered.map(|body| Covering { body, surface: surface(body) }).collect(), count).unwrap()
}

fn bodies(count: usize) -> Vec<BodyState> {
    let mut random = Random::new(count as u64);
    let state = |k: usize| BodyState {
        mass: 1.0 + k as f64,
        inertia: Matrix3::new(2.0, 0.1, 0.2, 0.1, 3.0, 0.3, 0.2, 0.3, 4.0) * (1.0 + k as f64),
        com: random.vector() * 3.0,
        ..body(attitudes()[k % 6], random.vector(), random.vector() * 0.1)
    };
    (0..count).map(state).collect()
}

fn largest_difference(a: &[Wrench], b: &[Wrench]) -> f64 {
    let size =
        |of: fn(&Wrench) -> Vector3<f64>| a.iter().map(|w| of(w).norm()).fold(f64::MIN_POSITIVE, f64::max);
    let (force, torque) = (size(|w| w.force), size(|w| w.torque));
    let apart = |(a, b): (&Wrench, &Wrench)| {
        ((a.force - b.force).norm() / force).max((a.torque - b.torque).norm() / torque)
    };
    a.iter().zip(b).map(apart).fold(0.0, f64::max)
}

#[test]
fn every_instruction_set_gives_the_same_wrenches() {
    let earth = Earth::about_z(0.3, 7.29e-5).with_epoch(Epoch::parse("2024-01-03T00:00:00 UTC").unwrap());
    let at = (Vector3::new(4.1e6, -4.9e6, 2.2e6), Vector3::new(5.6e3, 3.1e3, -4.0e3));
    for count in [1, 2, 3, 4, 5, 7, 8, 9, 12, 13, 16, 17, 23] {
        let (bodies, surfaces) = (bodies(count), coverings(count));
        let effects: [&dyn Effect; 4] = [
            &DifferentialGravity::default(),
            &GravityGradient,
            &Drag::new(Arc::new(ExponentialAtmosphere::table()), surfaces.clone()),
            &RadiationPressure::new(surfaces).with_shadow(None).unwrap(),
        ];
        for effect in effects {
            let on = |level| {
                InstructionSet::limit(level);
                wrenches(effect, Some(&earth), at, &bodies).unwrap()
            };
            let [one_by_one, four, eight] = InstructionSet::ALL.map(on);
            for lanes in [four, eight] {
                let apart = largest_difference(&one_by_one, &lanes);
                assert!(apart < 1e-13, "{} on {count} bodies: {apart:e}", effect.name());
            }
            // every body has a wrench of its own: two changed places would be seen
            let last = one_by_one.len() - 1;
            let mut changed = one_by_one.clone();
            changed.swap(0, last);
            assert!(last == 0 || largest_difference(&one_by_one, &changed) > 1e-6, "{}", effect.name());
        }
    }
}
