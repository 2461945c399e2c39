//! Checks that wrenches do not depend on the number of SIMD lanes, for any number of bodies and any surfaces.
#![allow(clippy::unwrap_used)] // set-up that fails should stop

mod common;

use common::Random;
use common::stream::{attitudes, body};
use nalgebra::{Isometry3, Matrix3, Vector3};
use onorbit_core::earth::{Earth, Epoch};
use onorbit_core::environment::atmosphere::ExponentialAtmosphere;
use onorbit_core::environment::surfaces::{Covering, Optics, Surface, Surfaces};
use onorbit_core::environment::{
    Bodies, BodyIndex, BodyState, DifferentialGravity, Drag, Effect, EnvironmentError, GravityGradient,
    RadiationPressure, Reference, Scene, ScenePoint, Wrench, Wrenches,
};
use onorbit_core::gravity::{Gravity, GravityField};
use onorbit_core::model::{Geometry, Inertial, Link, Model, ModelBuilder, Visual};
use onorbit_core::orbit::{MU_EARTH, OrbitState};
use onorbit_core::spatial::InstructionSet;
use std::sync::Arc;

fn hull(shapes: Vec<Geometry>) -> Model {
    let visual = |geometry| Visual { pose: Isometry3::translation(0.1, 0.2, 0.3), geometry, rgba: None };
    let inertial = Inertial { mass: 2.0, com: Vector3::zeros(), inertia: Matrix3::identity() };
    let link =
        Link { visuals: shapes.into_iter().map(visual).collect(), ..Link::new("hull", Some(inertial)) };
    ModelBuilder::new("robot", link).and_then(ModelBuilder::build).unwrap()
}

/// Bodies without surface, with a sphere, a box and a cylinder, a capsule, two boxes, …: neighbours differ in
/// their number of parts.
fn coverings(count: usize) -> Surfaces {
    let cylinder = || Geometry::Cylinder { radius: 0.2, length: 0.7 };
    let of_shapes = |shapes| {
        let optics = Optics::new(0.3, 0.4).unwrap();
        Surface::from_shapes(&hull(shapes), 0, 2.0, optics).unwrap()
    };
    let surface = |k: usize| match k % 5 {
        0 => Surface::cannonball(1.5 + 0.1 * k as f64, 2.2, 1.3).unwrap(),
        1 => of_shapes(vec![Geometry::Box([0.3, 0.4, 0.5]), cylinder()]),
        2 => of_shapes(vec![Geometry::Capsule { radius: 0.1, length: 0.4 }]),
        _ => of_shapes(vec![
            Geometry::Box([1.0, 0.1, 0.2]),
            Geometry::Box([0.1; 3]),
            Geometry::Sphere { radius: 0.2 },
        ]),
    };
    // one in seven has no surface, except the first
    let covered = (0..count).filter(|k| k % 7 != 6);
    Surfaces::new(
        covered.map(|body| Covering { body: body.into(), surface: surface(body) }).collect(),
        &[count],
    )
    .unwrap()
}

/// Positions distributed over `spread` m.
fn bodies(count: usize, spread: f64) -> Vec<BodyState> {
    let mut random = Random::new(count as u64);
    let state = |k: usize| BodyState {
        mass: 1.0 + k as f64,
        inertia: Matrix3::new(2.0, 0.1, 0.2, 0.1, 3.0, 0.3, 0.2, 0.3, 4.0) * (1.0 + k as f64),
        com: random.vector() * spread,
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

/// Returns the wrenches of an effect near a reference in free fall in this gravity.
fn wrenches(
    effect: &dyn Effect,
    (gravity, earth): (&Gravity, &Earth),
    bodies: &[BodyState],
) -> Result<Vec<Wrench>, EnvironmentError> {
    let position = Vector3::new(4.1e6, -4.9e6, 2.2e6);
    let (velocity, acceleration) = (Vector3::new(5.6e3, 3.1e3, -4.0e3), Vector3::zeros());
    let state = OrbitState { position, velocity, acceleration };
    let reference = Reference { state: &state, gravity: Some(gravity), in_free_fall: true };
    let (mut wrenches, bodies) = (Wrenches::new(&[bodies.len()]), bodies.iter().copied().collect::<Bodies>());
    let act = |scene: &Scene<'_>| effect.add_wrenches(scene, &mut wrenches);
    Scene::with((0.0, 1e-3), 0.0, &bodies, Some(reference), Some(earth), act)?;
    Ok(wrenches.iter().collect())
}

fn on_each_level<T>(job: impl Fn() -> T) -> [T; 3] {
    InstructionSet::ALL.map(|level| {
        InstructionSet::limit(level);
        job()
    })
}

const COUNTS: [usize; 13] = [1, 2, 3, 4, 5, 7, 8, 9, 12, 13, 16, 17, 23];

/// Bodies near each other, beyond the range of the expansions of field, light and air, and farther, mixed.
const SPREADS: [f64; 4] = [3.0, 40.0, 200.0, 2e4];

#[test]
fn every_instruction_set_gives_the_same_wrenches() {
    let earth = Earth::about_z(0.3, 7.29e-5).with_epoch(Epoch::parse("2024-01-03T00:00:00 UTC").unwrap());
    let field = |field| Gravity::of_field(Arc::new(field), Some(Arc::new(earth.clone()))).unwrap();
    let gravities = [
        Gravity::point_mass(MU_EARTH),
        field(GravityField::zonal(4).unwrap()),
        field(GravityField::bundled("egm2008", 8, 8).unwrap()),
    ];
    for (count, spread) in COUNTS.iter().flat_map(|count| SPREADS.map(|spread| (*count, spread))) {
        let (bodies, surfaces) = (bodies(count, spread), coverings(count));
        let effects: [&dyn Effect; 4] = [
            &DifferentialGravity::default(),
            &GravityGradient,
            &Drag::new(Arc::new(ExponentialAtmosphere::table()), surfaces.clone()),
            &RadiationPressure::new(surfaces),
        ];
        for (effect, gravity) in effects.iter().flat_map(|effect| gravities.iter().map(move |g| (*effect, g)))
        {
            let [scalar, four, eight] =
                on_each_level(|| wrenches(effect, (gravity, &earth), &bodies).unwrap());
            for lanes in [four, eight] {
                let apart = largest_difference(&scalar, &lanes);
                assert!(apart < 1e-12, "{} on {count} bodies over {spread} m: {apart:e}", effect.name());
            }
            // the wrenches of all bodies differ, so that exchanged bodies would be detected
            let last = scalar.len() - 1;
            let mut changed = scalar.clone();
            changed.swap(0, last);
            assert!(last == 0 || largest_difference(&scalar, &changed) > 1e-6, "{}", effect.name());
        }
    }
    // the error names the body inside the planet, in any lane
    let mut bodies = bodies(11, 3.0);
    bodies[9].com = -Vector3::new(4.1e6, -4.9e6, 2.2e6);
    for error in on_each_level(|| wrenches(&GravityGradient, (&gravities[0], &earth), &bodies).unwrap_err()) {
        assert!(
            matches!(
                error,
                EnvironmentError::InsidePlanet {
                    what: ScenePoint::Body(BodyIndex { system: 0, body: 9 }),
                    ..
                }
            ),
            "{error}"
        );
    }
}
