//! A body in a stream of air or light, and forces summed over many small plates.

use nalgebra::{Matrix3, Rotation3, Vector3};
use onorbit_core::earth::Earth;
use onorbit_core::environment::surfaces::{Covering, Surface, Surfaces};
use onorbit_core::environment::{
    Bodies, BodyState, Effect, EnvironmentError, Reference, Scene, Wrench, Wrenches,
};
use onorbit_core::gravity::Gravity;
use onorbit_core::orbit::{MU_EARTH, OrbitState};

/// Area, m², outward normal, centroid, m.
pub type Plate = (f64, Vector3<f64>, Vector3<f64>);

/// A body that moves in `W`.
pub fn body(rot_wk: Matrix3<f64>, velocity: Vector3<f64>, angular_velocity: Vector3<f64>) -> BodyState {
    BodyState {
        mass: 1.0,
        inertia: Matrix3::identity(),
        com: Vector3::zeros(),
        rot_wk,
        origin: Vector3::zeros(),
        velocity,
        angular_velocity,
    }
}

/// Returns the surface as that of the only body of a robot.
pub fn alone(surface: Surface) -> Surfaces {
    Surfaces::new(vec![Covering { body: 0.into(), surface }], &[1]).expect("one body")
}

/// Returns the wrench of an effect on `bodies` around a reference at `r` with velocity `v`, `time` s after
/// the start of the step.
pub fn wrenches(
    effect: &dyn Effect,
    earth: Option<&Earth>,
    (r, v): (Vector3<f64>, Vector3<f64>),
    bodies: &[BodyState],
) -> Result<Vec<Wrench>, EnvironmentError> {
    let gravity = Gravity::point_mass(MU_EARTH);
    let state = OrbitState { position: r, velocity: v, acceleration: Vector3::zeros() };
    let (mut wrenches, bodies) = (Wrenches::new(&[bodies.len()]), bodies.iter().copied().collect::<Bodies>());
    let reference = Some(Reference { state: &state, gravity: Some(&gravity), in_free_fall: true });
    let act = |scene: &Scene<'_>| effect.add_wrenches(scene, &mut wrenches);
    Scene::with((0.0, 1.0), 0.0, &bodies, reference, earth, act)?;
    Ok(wrenches.iter().collect())
}

/// Returns `Σ f(plate)` where `f` is the force on a plate at its centroid: force and torque about the origin.
pub fn summed(
    plates: &[Plate],
    force: impl Fn(f64, &Vector3<f64>, &Vector3<f64>) -> Vector3<f64>,
) -> (Vector3<f64>, Vector3<f64>) {
    plates.iter().fold((Vector3::zeros(), Vector3::zeros()), |(sum, torque), (area, n, c)| {
        let f = force(*area, n, c);
        (sum + f, torque + c.cross(&f))
    })
}

/// Returns the side of a cylinder along z about `centre`, divided into strips and slices.
pub fn strips(radius: f64, length: f64, centre: Vector3<f64>, count: usize) -> Vec<Plate> {
    let step = std::f64::consts::TAU / count as f64;
    (0..count)
        .map(|k| {
            let (s, c) = ((k as f64 + 0.5) * step).sin_cos();
            let n = Vector3::new(c, s, 0.0);
            (radius * step * length, n, centre + n * radius)
        })
        .collect()
}

/// Returns a sphere about `centre`, divided into small plates.
pub fn ball(radius: f64, centre: Vector3<f64>, count: usize) -> Vec<Plate> {
    let (dz, step) = (2.0 / count as f64, std::f64::consts::TAU / count as f64);
    let mut plates = Vec::new();
    for i in 0..count {
        let z = -1.0 + (i as f64 + 0.5) * dz;
        let p = (1.0 - z * z).sqrt();
        for k in 0..count {
            let (s, c) = ((k as f64 + 0.5) * step).sin_cos();
            let n = Vector3::new(p * c, p * s, z);
            plates.push((radius * radius * dz * step, n, centre + n * radius));
        }
    }
    plates
}

/// Returns attitudes without symmetry.
pub fn attitudes() -> Vec<Matrix3<f64>> {
    let turn = |k: f64| Rotation3::from_euler_angles(0.3 + 1.7 * k, -1.1 + 0.9 * k, 2.2 * k).into_inner();
    (0..6).map(|k| turn(f64::from(k))).collect()
}
