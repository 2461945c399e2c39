//! Checks radiation pressure on surfaces against closed forms and sums over small plates.
#![allow(clippy::print_stdout)] // shows what was measured when a test fails

mod common;

use common::stream::{Plate, alone, attitudes, ball, body, strips, summed, wrenches};
use nalgebra::{Isometry3, Matrix3, Vector3};
use onorbit_core::earth::{Earth, EarthError, Epoch};
use onorbit_core::environment::surfaces::{Optics, Surface, SurfaceError};
use onorbit_core::environment::{EnvironmentError, RadiationPressure, Wrench, sunlit};
use onorbit_core::model::{Geometry, Inertial, Link, Model, ModelBuilder, Visual};
use std::f64::consts::PI;

const LIGHT: f64 = 299_792_458.0;
const AU: f64 = 149_597_870_700.0;

fn earth() -> Earth {
    Earth::about_z(0.0, 7.29e-5).with_epoch(Epoch::parse("2024-01-03T00:00:00 UTC").expect("an instant"))
}

/// Returns a position on the day side, and the direction and distance of the Sun from there.
fn day_side() -> (Vector3<f64>, Vector3<f64>, f64) {
    let sun = earth().sun(0.0).expect("an epoch");
    let r = sun.normalize() * 7.0e6;
    let to_sun = sun - r;
    (r, to_sun.normalize(), to_sun.norm())
}

/// Light with a pressure of 1 Pa on a body with this attitude.
fn light(surface: Surface, rot: Matrix3<f64>) -> Wrench {
    let (r, _, distance) = day_side();
    let flux = LIGHT * (distance / AU).powi(2);
    let effect = RadiationPressure::new(alone(surface)).with_flux(flux).expect("positive");
    let state = body(rot, Vector3::zeros(), Vector3::zeros());
    wrenches(&effect, Some(&earth()), (r, Vector3::zeros()), &[state]).expect("outside")[0]
}

/// Returns the force on a plate by the textbook formula.
fn plate_force(area: f64, n: &Vector3<f64>, s: &Vector3<f64>, specular: f64, diffuse: f64) -> Vector3<f64> {
    let cosine = n.dot(s);
    if cosine <= 0.0 {
        return Vector3::zeros();
    }
    (s * (1.0 - specular) + n * (2.0 * (specular * cosine + diffuse / 3.0))) * (-area * cosine)
}

fn of_shape(geometry: Geometry, specular: f64, diffuse: f64) -> Surface {
    let visual = Visual { pose: Isometry3::translation(0.6, -0.9, 1.3), geometry, rgba: None };
    let inertial = Inertial { mass: 2.0, com: Vector3::new(0.1, -0.2, 0.3), inertia: Matrix3::identity() };
    let link = Link { visuals: vec![visual], ..Link::new("hull", Some(inertial)) };
    let model = ModelBuilder::new("robot", link).and_then(ModelBuilder::build).expect("a body");
    Surface::from_shapes(&model, 0, 1.0, Optics::new(specular, diffuse).expect("shares")).expect("a shape")
}

fn plate(area: f64, normal: [f64; 3], centroid: [f64; 3], specular: f64, diffuse: f64) -> Surface {
    let model = Model::rigid_body(1.0, Matrix3::identity()).expect("a body");
    let optics = Optics::new(specular, diffuse).expect("shares");
    Surface::plates(&model, model.body_frame(0), &[area], &[normal], &[centroid], 1.0, optics)
        .expect("a plate")
}

fn assert_close(got: &Wrench, (force, torque): (Vector3<f64>, Vector3<f64>), share: f64) {
    let scale = force.norm();
    let errors = [(got.force - force).norm() / scale, (got.torque - torque).norm() / scale];
    println!("force {:.1e}, torque {:.1e}", errors[0], errors[1]);
    assert!(errors.iter().all(|error| *error < share), "{got:?} is not {force:?} {torque:?}");
}

#[test]
fn radiation_pressure_depends_on_the_distance_from_the_sun() {
    let (r, s, distance) = day_side();
    let effect = RadiationPressure::new(alone(Surface::cannonball(16.0, 2.2, 1.8).expect("positive")));
    let state = body(attitudes()[2], Vector3::zeros(), Vector3::zeros());
    let got = wrenches(&effect, Some(&earth()), (r, Vector3::zeros()), &[state]).expect("outside")[0];
    let expected = -s * (1361.0 / LIGHT * (AU / distance).powi(2) * 1.8 * 16.0);
    assert_close(&got, (expected, Vector3::zeros()), 1e-14);
    // near perihelion 3.4 % more than at 1 au
    assert!((got.force.norm() / (1361.0 / LIGHT * 1.8 * 16.0) - 1.034).abs() < 1e-3);
}

#[test]
fn specular_diffuse_and_absorbing_plates_facing_the_sun() {
    let (_, s, _) = day_side();
    let n = [s.x, s.y, s.z];
    for (specular, diffuse, share) in
        [(0.0, 0.0, 1.0), (1.0, 0.0, 2.0), (0.0, 1.0, 5.0 / 3.0), (0.3, 0.2, 1.3 + 0.4 / 3.0)]
    {
        let got = light(plate(3.0, n, [0.0; 3], specular, diffuse), Matrix3::identity());
        assert_close(&got, (-s * (3.0 * share), Vector3::zeros()), 1e-14);
    }
}

#[test]
fn specular_force_is_along_the_normal_and_absorption_along_the_light() {
    let (_, s, _) = day_side();
    let side = s.cross(&Vector3::z()).normalize();
    let (sin, cos) = (40.0_f64).to_radians().sin_cos();
    let n = s * cos + side * sin;
    let mirror = light(plate(2.0, [n.x, n.y, n.z], [0.0; 3], 1.0, 0.0), Matrix3::identity());
    assert_close(&mirror, (n * (-2.0 * 2.0 * cos * cos), Vector3::zeros()), 1e-14);
    // a panel to the side: light pushes it away from the Sun, T = c × F
    let black = light(
        plate(2.0, [n.x, n.y, n.z], [side.x * 3.0, side.y * 3.0, side.z * 3.0], 0.0, 0.0),
        Matrix3::identity(),
    );
    assert_close(&black, (s * (-2.0 * cos), side.cross(&s) * (-3.0 * 2.0 * cos)), 1e-14);
    let back = light(plate(2.0, [-n.x, -n.y, -n.z], [1.0; 3], 0.5, 0.5), Matrix3::identity());
    assert_eq!(back, Wrench::default());
}

#[test]
fn radiation_pressure_on_curved_surfaces_is_the_sum_over_plates() {
    let (_, s, _) = day_side();
    let (radius, length, centre) = (0.4, 2.5, Vector3::new(0.5, -0.7, 1.0));
    let mut cylinder = strips(radius, length, centre, 20_000);
    for side in [-1.0, 1.0] {
        let n = Vector3::z() * side;
        cylinder.push((PI * radius * radius, n, centre + n * (0.5 * length)));
    }
    let shapes: [(Geometry, Vec<Plate>, f64); 2] = [
        (Geometry::Cylinder { radius, length }, cylinder, 1e-7),
        (Geometry::Sphere { radius }, ball(radius, centre, 600), 1e-5),
    ];
    for (geometry, plates, share) in shapes {
        for (specular, diffuse) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.35, 0.4)] {
            for rot in attitudes() {
                let s_k = rot.transpose() * s;
                let (force, torque) =
                    summed(&plates, |area, n, _| plate_force(area, n, &s_k, specular, diffuse));
                let got = light(of_shape(geometry.clone(), specular, diffuse), rot);
                assert_close(&got, (rot * force, rot * torque), share);
            }
        }
    }
}

#[test]
fn the_force_on_an_absorbing_box_is_that_on_its_projected_area() {
    // the momentum of the light intercepted by a box, for any attitude
    let (_, s, _) = day_side();
    let [x, y, z] = [1.0, 2.0, 3.0];
    for rot in attitudes() {
        let s_k = rot.transpose() * s;
        let shadow = y * z * s_k.x.abs() + z * x * s_k.y.abs() + x * y * s_k.z.abs();
        let got = light(of_shape(Geometry::Box([x, y, z]), 0.0, 0.0), rot);
        assert!((got.force + s * shadow).norm() < 1e-14 * shadow);
    }
}

#[test]
fn the_shadow_reduces_the_force_and_is_optional() {
    let (r, ..) = day_side();
    let sun = earth().sun(0.0).expect("an epoch");
    let state = body(Matrix3::identity(), Vector3::zeros(), Vector3::zeros());
    let effect = || RadiationPressure::new(alone(Surface::cannonball(1.0, 2.2, 1.0).expect("positive")));
    let push = |effect: &RadiationPressure, r: Vector3<f64>| {
        wrenches(effect, Some(&earth()), (r, Vector3::zeros()), &[state]).expect("outside")[0].force.norm()
    };
    assert_eq!(push(&effect(), -r), 0.0);
    let bare = effect().with_shadow(None).expect("no radius");
    assert!((push(&bare, -r) / push(&effect(), r) - 1.0).abs() < 2e-4); // 14 000 km farther from the Sun
    let aside = r.cross(&Vector3::z()).normalize();
    let rim = -r * (3.0 / 7.0) + aside * 6.37e6;
    let share = sunlit(&rim, &sun, 6_378_137.0);
    assert!(share > 0.1 && share < 0.9, "{share}");
    assert!((push(&effect(), rim) / push(&bare, rim) - share).abs() < 1e-14);
    let larger = effect().with_shadow(Some(6.5e6)).expect("positive");
    assert_eq!(push(&larger, rim), 0.0);
}

#[test]
fn light_needs_an_earth_with_an_epoch_and_sane_numbers() {
    let effect = || RadiationPressure::new(alone(Surface::cannonball(1.0, 2.2, 1.0).expect("positive")));
    let state = body(Matrix3::identity(), Vector3::zeros(), Vector3::zeros());
    let at = (Vector3::new(7.0e6, 0.0, 0.0), Vector3::zeros());
    assert_eq!(
        wrenches(&effect(), None, at, &[state]),
        Err(EnvironmentError::NoEarth { effect: "radiation pressure" })
    );
    let timeless = wrenches(&effect(), Some(&Earth::about_z(0.0, 7.3e-5)), at, &[state]);
    assert!(matches!(timeless, Err(EnvironmentError::Earth(EarthError::NeedsEpoch { .. }))), "{timeless:?}");
    assert!(matches!(effect().with_flux(-1.0), Err(SurfaceError::Value { name: "flux", .. })));
    assert!(matches!(
        effect().with_shadow(Some(f64::NAN)),
        Err(SurfaceError::Value { name: "earth_radius", .. })
    ));
}
