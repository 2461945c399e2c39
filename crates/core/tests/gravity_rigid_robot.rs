//! Checks that the wrenches on the bodies of a rigid robot in orbit sum to those on the composite body.
#![allow(missing_docs, clippy::unwrap_used)]

use nalgebra::{Matrix3, Rotation3, Vector3};
use onorbit_core::earth::Earth;
use onorbit_core::environment::{
    Bodies, BodyState, DifferentialGravity, Effect, GravityGradient, Reference, Scene, Wrench, Wrenches,
};
use onorbit_core::gravity::{Gravity, GravityField};
use onorbit_core::orbit::OrbitState;
use std::sync::Arc;

const ORIGIN: [f64; 3] = [-4292653.41, 955168.47, 5139356.57];

/// Five links around the reference, the robot `size` times a metre, its centre of mass at the origin of `W`.
fn robot(size: f64) -> Vec<BodyState> {
    let link = |mass: f64, com: [f64; 3], moments: [f64; 3], turn: [f64; 3]| {
        let com = Vector3::from(com) * size;
        let inertia = Matrix3::from_diagonal(&Vector3::from(moments)) * (mass * size * size);
        let rot_wk = Rotation3::new(Vector3::from(turn)).into_inner();
        let (origin, velocity, angular_velocity) = (com, Vector3::zeros(), Vector3::zeros());
        BodyState { mass, inertia, com, rot_wk, origin, velocity, angular_velocity }
    };
    let mut links = vec![
        link(120.0, [0.1, 0.0, -0.2], [0.2, 0.3, 0.25], [0.1, 0.2, -0.3]),
        link(20.0, [0.7, 0.3, 0.1], [0.01, 0.08, 0.08], [1.1, -0.4, 0.6]),
        link(15.0, [1.2, 0.8, 0.4], [0.01, 0.06, 0.06], [-0.5, 0.9, 1.2]),
        link(25.0, [-0.8, 0.2, 0.9], [0.02, 0.07, 0.06], [2.0, 0.1, 0.3]),
        link(5.0, [-1.3, -0.9, 1.3], [0.005, 0.02, 0.02], [0.3, 2.2, -1.0]),
    ];
    let mass: f64 = links.iter().map(|b| b.mass).sum();
    let com = links.iter().map(|b| b.com * b.mass).sum::<Vector3<f64>>() / mass;
    links.iter_mut().for_each(|b| b.com -= com);
    links
}

/// Torque about the centre of mass of all wrenches.
fn total(bodies: &[BodyState], wrenches: &[Wrench]) -> Vector3<f64> {
    bodies.iter().zip(wrenches).map(|(b, w)| b.com.cross(&w.force) + w.torque).sum()
}

/// The robot as one body, about its centre of mass, `W` axes.
fn composite(bodies: &[BodyState]) -> Matrix3<f64> {
    let of = |b: &BodyState| {
        let c = b.com;
        b.rot_wk * b.inertia * b.rot_wk.transpose()
            + (Matrix3::identity() * c.norm_squared() - c * c.transpose()) * b.mass
    };
    bodies.iter().map(of).sum()
}

/// `T_i = -ε_ijk (I G)_jk`, written with indices.
fn gradient_torque(inertia: &Matrix3<f64>, g: &Matrix3<f64>) -> Vector3<f64> {
    let p = inertia * g;
    -Vector3::new(p[(1, 2)] - p[(2, 1)], p[(2, 0)] - p[(0, 2)], p[(0, 1)] - p[(1, 0)])
}

fn fields() -> [Gravity; 3] {
    let earth = Some(Arc::new(Earth::about_z(0.4, 7.29e-5)));
    let egm = Arc::new(GravityField::bundled("egm2008", 36, 36).unwrap());
    [
        Gravity::point_mass(3.986004415e14),
        Gravity::of_field(Arc::new(GravityField::zonal(6).unwrap()), None).unwrap(),
        Gravity::of_field(egm, earth).unwrap(),
    ]
}

/// Returns the wrenches of the engine's effects; only of `GravityGradient` if `forces` is false.
fn gravity_wrenches(gravity: &Gravity, bodies: &[BodyState], forces: bool) -> Vec<Wrench> {
    let position = Vector3::from(ORIGIN);
    let acceleration = gravity.acceleration(0.0, &position).unwrap();
    let state = OrbitState { position, velocity: Vector3::new(0.0, 5.4e3, 5.4e3), acceleration };
    let reference = Some(Reference { state: &state, gravity: Some(gravity), in_free_fall: true });
    let (mut wrenches, bodies) = (Wrenches::new(&[bodies.len()]), bodies.iter().copied().collect::<Bodies>());
    Scene::with((0.0, 1.0), 0.0, &bodies, reference, None, |scene| {
        GravityGradient.add_wrenches(scene, &mut wrenches).unwrap();
        if forces {
            DifferentialGravity::default().add_wrenches(scene, &mut wrenches).unwrap();
        }
    });
    wrenches.iter().collect()
}

#[test]
fn linearised_forces_and_torques_are_those_of_the_composite_body() {
    for gravity in fields() {
        let (bodies, g) = (robot(1.0), gravity.gradient(0.0, &ORIGIN.into()).unwrap());
        let linear = bodies.iter().map(|b| Wrench {
            force: g * b.com * b.mass,
            torque: gradient_torque(&(b.rot_wk * b.inertia * b.rot_wk.transpose()), &g),
        });
        let linear: Vec<Wrench> = linear.collect();
        let expected = gradient_torque(&composite(&bodies), &g);
        let error = (total(&bodies, &linear) - expected).norm() / expected.norm();
        assert!(error < 1e-12, "{error:e}");
        // negative control: without the forces a third or more is missing
        let torques: Vec<Wrench> = linear.iter().map(|w| Wrench { force: Vector3::zeros(), ..*w }).collect();
        let error = (total(&bodies, &torques) - expected).norm() / expected.norm();
        assert!(error > 0.1, "{error:e}");
    }
}

#[test]
fn the_exact_field_differs_in_proportion_to_the_size_of_the_robot() {
    for (gravity, name) in fields().iter().zip(["point mass", "zonal", "egm2008"]) {
        let mut errors = Vec::new();
        for size in [1.0, 3.0, 9.0] {
            let (bodies, g) = (robot(size), gravity.gradient(0.0, &ORIGIN.into()).unwrap());
            let expected = gradient_torque(&composite(&bodies), &g);
            let error = (total(&bodies, &gravity_wrenches(gravity, &bodies, true)) - expected).norm()
                / expected.norm();
            let bound = 20.0 * 2.2 * size / Vector3::from(ORIGIN).norm();
            assert!(error < bound, "{name} {size}: {error:e} > {bound:e}");
            // negative control: without the forces
            let alone = (total(&bodies, &gravity_wrenches(gravity, &bodies, false)) - expected).norm()
                / expected.norm();
            assert!(alone > 0.1 && alone > 1e4 * bound, "{name}: {alone:e}");
            errors.push(error / size);
        }
        println!("{name}: {errors:?} per metre");
        for error in &errors[1..] {
            assert!((error / errors[0] - 1.0).abs() < 0.05, "{name}: not linear: {errors:?}");
        }
    }
}
