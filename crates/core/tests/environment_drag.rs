//! Checks drag on surfaces against closed forms and sums over small plates.
#![allow(clippy::print_stdout)] // shows what was measured when a test fails

mod common;

use common::stream::{alone, attitudes, ball, body, strips, summed, wrenches};
use nalgebra::{Isometry3, Matrix3, Vector3};
use onorbit_core::earth::{Earth, Epoch, Geodetic, WGS84};
use onorbit_core::environment::atmosphere::{
    Atmosphere, AtmosphereError, AtmospherePoint, ConstantAtmosphere, ExponentialAtmosphere, HarrisPriester,
    Layer, LocalAtmosphere,
};
use onorbit_core::environment::surfaces::{Covering, Optics, Surface, SurfaceError, Surfaces};
use onorbit_core::environment::{BodyIndex, BodyState, Drag, EnvironmentError, Wrench};
use onorbit_core::model::{Geometry, Inertial, Link, Model, ModelBuilder, Visual};
use std::f64::consts::PI;
use std::sync::Arc;

const RADIUS: Vector3<f64> = Vector3::new(6.9e6, 0.0, 0.0);
const STILL: Vector3<f64> = Vector3::new(0.0, 0.0, 0.0);

/// Air of 2 kg/m³ and `C_D` of 1: `½ ρ C_D` is one.
fn drag(surface: Surface, state: BodyState, v: Vector3<f64>) -> Wrench {
    let air = Arc::new(ConstantAtmosphere::new(2.0).expect("positive"));
    let effect = Drag::new(air, alone(surface));
    wrenches(&effect, Some(&Earth::about_z(0.0, 0.0)), (RADIUS, v), &[state]).expect("outside")[0]
}

fn robot(shapes: &[(Geometry, Isometry3<f64>)]) -> Model {
    let visual = |(geometry, pose): &(Geometry, Isometry3<f64>)| Visual {
        pose: *pose,
        geometry: geometry.clone(),
        rgba: None,
    };
    let inertial = Inertial { mass: 2.0, com: Vector3::new(0.1, -0.2, 0.3), inertia: Matrix3::identity() };
    let link = Link { visuals: shapes.iter().map(visual).collect(), ..Link::new("hull", Some(inertial)) };
    ModelBuilder::new("robot", link).and_then(ModelBuilder::build).expect("a body")
}

fn of_shape(geometry: Geometry, pose: Isometry3<f64>) -> Surface {
    Surface::from_shapes(&robot(&[(geometry, pose)]), 0, 1.0, Optics::default()).expect("a shape")
}

fn plates(areas: &[f64], normals: &[[f64; 3]], centroids: &[[f64; 3]]) -> Result<Surface, SurfaceError> {
    let model = Model::rigid_body(1.0, Matrix3::identity()).expect("a body");
    Surface::plates(&model, model.body_frame(0), areas, normals, centroids, 1.0, Optics::default())
}

fn assert_close(got: &Wrench, (force, torque): (Vector3<f64>, Vector3<f64>), share: f64) {
    let scale = force.norm();
    let errors = [(got.force - force).norm() / scale, (got.torque - torque).norm() / scale];
    println!("force {:.1e}, torque {:.1e}", errors[0], errors[1]);
    assert!(errors.iter().all(|error| *error < share), "{got:?} is not {force:?} {torque:?}");
}

#[test]
fn drag_on_a_cannonball_is_half_rho_cd_a_v_squared() {
    let air = Arc::new(ConstantAtmosphere::new(1.4e-12).expect("positive"));
    let effect = Drag::new(air, alone(Surface::cannonball(1.5, 2.2, 1.0).expect("positive")));
    let state = body(Matrix3::identity(), Vector3::new(0.0, 0.0, 3.0), Vector3::new(9.0, 8.0, 7.0));
    let earth = Earth::about_z(0.4, 7.3e-5);
    let got = wrenches(&effect, Some(&earth), (RADIUS, Vector3::new(0.0, 7500.0, 0.0)), &[state]);
    // air moves along y at 7.3e-5 · 6.9e6 = 503.7 m/s
    let v = Vector3::new(0.0, 7500.0 - 503.7, 3.0);
    let force = v * (-0.5 * 1.4e-12 * 2.2 * 1.5 * v.norm());
    assert_close(&got.expect("outside")[0], (force, Vector3::zeros()), 1e-13);
}

#[test]
fn drag_on_an_inclined_plate_agrees_with_the_closed_form() {
    // 2 m² at 60° to the flow, at 3 m along x: F = -A cos 60° |v|² v̂, T = c × F
    let (s, c) = (PI / 3.0).sin_cos();
    let panel =
        |sign: f64| plates(&[2.0], &[[s * sign, c * sign, 0.0]], &[[3.0, 0.0, 0.0]]).expect("a plate");
    let v = Vector3::new(0.0, 7000.0, 0.0);
    let force = Vector3::new(0.0, -2.0 * 0.5 * 7000.0 * 7000.0, 0.0);
    // flow from +y: a panel at +x is pushed towards -y, which gives a torque about -z
    let torque = Vector3::new(0.0, 0.0, 3.0 * force.y);
    assert_close(&drag(panel(1.0), body(Matrix3::identity(), STILL, STILL), v), (force, torque), 1e-14);
    let back = drag(panel(-1.0), body(Matrix3::identity(), STILL, STILL), v);
    assert_eq!(back, Wrench::default());
}

#[test]
fn drag_on_a_box_is_that_of_its_projected_area() {
    let [x, y, z] = [1.0, 2.0, 3.0];
    let middle = Isometry3::translation(0.1, -0.2, 0.3); // position of the centre of mass
    let v = Vector3::new(1000.0, -5000.0, 4000.0);
    for rot in attitudes() {
        let got = drag(of_shape(Geometry::Box([x, y, z]), middle), body(rot, STILL, STILL), v);
        let u = rot.transpose() * v;
        let shadow = y * z * u.x.abs() + z * x * u.y.abs() + x * y * u.z.abs();
        // the faces exposed to the flow are centred off the middle, and their torques do not cancel
        let sums =
            [(y * z, x, u.x, Vector3::x()), (z * x, y, u.y, Vector3::y()), (x * y, z, u.z, Vector3::z())];
        let torque: Vector3<f64> =
            sums.iter().map(|(area, edge, w, n)| (n * (0.5 * edge * w)).cross(&(u * -*area))).sum();
        assert_close(&got, (-v * shadow, rot * torque), 1e-14);
    }
    // for a cube the torque is zero, as for a sphere
    let cube = drag(of_shape(Geometry::Box([1.0; 3]), middle), body(attitudes()[3], STILL, STILL), v);
    assert!(cube.torque.norm() < 1e-15 * cube.force.norm());
}

#[test]
fn drag_on_a_cylinder_is_the_sum_over_strips() {
    let (radius, length) = (0.4, 2.5);
    let pose = Isometry3::translation(0.6, -0.9, 1.3);
    let centre = Vector3::new(0.5, -0.7, 1.0);
    let v = Vector3::new(1000.0, -5000.0, 4000.0);
    let mut many = strips(radius, length, centre, 20_000);
    for side in [-1.0, 1.0] {
        let n = Vector3::z() * side;
        many.push((PI * radius * radius, n, centre + n * (0.5 * length)));
    }
    for rot in attitudes() {
        let got = drag(of_shape(Geometry::Cylinder { radius, length }, pose), body(rot, STILL, STILL), v);
        let u = rot.transpose() * v;
        let (force, torque) = summed(&many, |area, n, _| u * (-area * n.dot(&u).max(0.0)));
        assert_close(&got, (rot * force, rot * torque), 1e-7);
    }
}

#[test]
fn drag_on_a_capsule_is_that_of_a_cylinder_and_a_sphere() {
    let (radius, length) = (0.4, 1.0);
    let pose = Isometry3::translation(0.6, -0.9, 1.3);
    let centre = Vector3::new(0.5, -0.7, 1.0);
    let v = Vector3::new(1000.0, -5000.0, 4000.0);
    let sphere = ball(radius, centre, 400);
    let mut capsule = strips(radius, length, centre, 4000);
    for (area, n, c) in &sphere {
        capsule.push((*area, *n, c + Vector3::z() * (0.5 * length * n.z.signum())));
    }
    for rot in attitudes() {
        let u = rot.transpose() * v;
        let wind = |area: f64, n: &Vector3<f64>, _: &Vector3<f64>| u * (-area * n.dot(&u).max(0.0));
        let (force, torque) = summed(&sphere, wind);
        let got = drag(of_shape(Geometry::Sphere { radius }, pose), body(rot, STILL, STILL), v);
        assert_close(&got, (rot * force, rot * torque), 1e-4);
        let (force, torque) = summed(&capsule, wind);
        let got = drag(of_shape(Geometry::Capsule { radius, length }, pose), body(rot, STILL, STILL), v);
        assert_close(&got, (rot * force, rot * torque), 2e-2);
    }
}

#[test]
fn rotating_paddles_are_damped_by_the_velocity_of_their_centroids() {
    // a wheel of four two-sided paddles in air at rest: only the rotation causes a flow
    let (areas, mut normals, mut centroids) = ([0.5; 8], Vec::new(), Vec::new());
    for k in 0..4 {
        let (s, c) = (f64::from(k) * PI / 2.0).sin_cos();
        for side in [-1.0, 1.0] {
            normals.push([-s * side, c * side, 0.0]);
            centroids.push([2.0 * c, 2.0 * s, 0.0]);
        }
    }
    let wheel = plates(&areas, &normals, &centroids).expect("plates");
    let got = drag(wheel, body(Matrix3::identity(), STILL, Vector3::new(0.0, 0.0, 3.0)), STILL);
    // T = -Σ A (ω r)² r
    let expected = -4.0 * 0.5 * (3.0_f64 * 2.0).powi(2) * 2.0;
    assert!((got.torque - Vector3::z() * expected).norm() < 1e-12, "{got:?}");
    assert!(got.force.norm() < 1e-12);
}

#[test]
fn drag_is_independent_of_the_axes_of_the_body() {
    // the box as a body at rest in rotated axes, and rotated itself: the results rotate with it
    let surface = of_shape(Geometry::Box([1.0, 2.0, 3.0]), Isometry3::translation(1.0, 0.0, 0.0));
    let (v, spin) = (Vector3::new(10.0, 7000.0, -300.0), Vector3::new(0.2, -0.1, 0.4));
    let plain = drag(surface.clone(), body(Matrix3::identity(), STILL, spin), v);
    for rot in attitudes() {
        let turned = drag(surface.clone(), body(rot, STILL, rot * spin), rot * v);
        assert_close(&turned, (rot * plain.force, rot * plain.torque), 1e-14);
    }
}

#[test]
fn invalid_surfaces_are_refused() {
    assert!(matches!(Surface::cannonball(-1.0, 2.2, 1.0), Err(SurfaceError::Value { name: "area", .. })));
    assert!(matches!(
        Surface::cannonball(1.0, f64::NAN, 1.0),
        Err(SurfaceError::Value { name: "drag_coefficient", .. })
    ));
    assert!(matches!(Optics::new(0.7, 0.4), Err(SurfaceError::Reflection { .. })));
    assert!(matches!(Optics::new(-0.1, 0.4), Err(SurfaceError::Value { name: "specular", .. })));
    assert!(matches!(plates(&[1.0], &[[0.0; 3]], &[[0.0; 3]]), Err(SurfaceError::Normal { plate: 0, .. })));
    assert!(matches!(plates(&[1.0], &[], &[[0.0; 3]]), Err(SurfaceError::WrongLength { normals: 0, .. })));
    assert!(matches!(
        plates(&[-1.0], &[[1.0; 3]], &[[0.0; 3]]),
        Err(SurfaceError::Value { name: "area", .. })
    ));
    let mesh = Geometry::Mesh { filename: "arm.stl".to_owned(), scale: [1.0; 3] };
    let error = Surfaces::from_shapes(&robot(&[(mesh, Isometry3::identity())]), 2.2, Optics::default());
    assert!(matches!(error, Err(SurfaceError::Mesh { link, .. }) if link == "hull"));
    assert!(matches!(
        Surfaces::from_shapes(&robot(&[]), 2.2, Optics::default()),
        Err(SurfaceError::NoShape { .. })
    ));
    let covering =
        || Covering { body: 1.into(), surface: Surface::cannonball(1.0, 2.2, 1.0).expect("positive") };
    let unknown = Surfaces::new(vec![covering()], &[1]);
    assert!(matches!(unknown, Err(SurfaceError::UnknownBody { body: BodyIndex { system: 0, body: 1 }, .. })));
    assert!(matches!(
        Surfaces::new(vec![covering(), covering()], &[2]),
        Err(SurfaceError::Twice { body: BodyIndex { system: 0, body: 1 } })
    ));
}

#[test]
fn drag_needs_an_earth_and_air() {
    let air = Arc::new(ExponentialAtmosphere::table());
    let effect = Drag::new(air, alone(Surface::cannonball(1.0, 2.2, 1.0).expect("positive")));
    let state = body(Matrix3::identity(), STILL, STILL);
    let refused = wrenches(&effect, None, (RADIUS, STILL), &[state]);
    assert_eq!(refused, Err(EnvironmentError::NoEarth { effect: "drag" }));
    let low = Vector3::new(6_370_000.0, 0.0, 0.0);
    let refused = wrenches(&effect, Some(&Earth::about_z(0.0, 0.0)), (low, STILL), &[state]);
    let Err(EnvironmentError::Atmosphere(AtmosphereError::BelowSurface { altitude })) = refused else {
        panic!("{refused:?}");
    };
    assert!((altitude + 8_137.0).abs() < 1e-3);
    let message = HarrisPriester::default().at(1_000_001.0, 0.0).expect_err("above").to_string();
    assert!(message.contains("1000000 m; use an exponential atmosphere"), "{message}");
    assert!(HarrisPriester::default().at(99_999.0, 0.0).is_err());
    assert!(HarrisPriester::new(1.0, 0.0).is_err() && HarrisPriester::new(2.0, f64::NAN).is_err());
}

#[test]
fn exponential_layers_agree_with_the_published_table() {
    let layer = |base, density, scale_height| Layer { base, density, scale_height };
    let air = ExponentialAtmosphere::new(vec![layer(200e3, 3e-10, 40e3)]).expect("one layer");
    assert!((air.at(240e3) / (3e-10 * (-1.0_f64).exp()) - 1.0).abs() < 1e-15);
    assert!((air.at(0.0) / (3e-10 * 5.0_f64.exp()) - 1.0).abs() < 1e-14); // goes on below
    let table = ExponentialAtmosphere::table();
    assert_eq!(table.at(0.0), 1.225);
    // Vallado's example 8-4: 747.2119 km, 2.1219854e-14 kg/m³
    assert!((table.at(747.2119e3) / 2.121_985_4e-14 - 1.0).abs() < 1e-6, "{}", table.at(747.2119e3));
    for above in (25..1000).map(|km| f64::from(km) * 1e3) {
        assert!(table.at(above + 1.0) < table.at(above - 1.0) * 1.02, "{above}");
    }
    assert!(matches!(
        ExponentialAtmosphere::new(vec![layer(1.0, 1.0, 1.0), layer(1.0, 1.0, 1.0)]),
        Err(AtmosphereError::LayerOrder { index: 1, .. })
    ));
    let message = |layers| ExponentialAtmosphere::new(layers).expect_err("refused").to_string();
    let text = message(vec![layer(1.0, 1.0, 1.0), layer(0.5, 1.0, 1.0)]);
    assert_eq!(text, "layer 1 begins at 0.5 m; expected a finite altitude above 1 m, where layer 0 begins");
    let text = message(vec![layer(f64::INFINITY, 1.0, 1.0)]);
    assert_eq!(text, "layer 0 begins at inf m; expected a finite altitude");
    assert!(matches!(ExponentialAtmosphere::new(vec![]), Err(AtmosphereError::NoLayers)));
    assert!(matches!(
        ExponentialAtmosphere::new(vec![layer(1.0, -1.0, 1.0)]),
        Err(AtmosphereError::Value { name: "density", .. })
    ));
    assert!(ConstantAtmosphere::new(-1e-12).is_err() && ConstantAtmosphere::new(0.0).is_ok());
}

#[test]
fn around_the_start_of_a_step_the_air_is_what_the_model_says_to_its_stated_error() {
    let earth = Earth::about_z(0.3, 7.3e-5);
    let air = ExponentialAtmosphere::table();
    let exact =
        |r: &Vector3<f64>| air.density(&AtmospherePoint::new(&earth, 5.0, r).expect("outside")).expect("air");
    let mut worst = 0.0_f64;
    for latitude in [-1.5, -0.7, 0.0, 0.9] {
        for altitude in [160e3, 410e3, 720e3] {
            let place = Geodetic { latitude, longitude: 2.0, altitude };
            let centre = earth.rot_fi(5.0).tr_mul(&place.position(&WGS84));
            let local = LocalAtmosphere::new(&air, &earth, 5.0, &centre).expect("outside");
            for turn in attitudes() {
                let r = centre + turn * Vector3::new(0.0, 0.0, 159.0);
                let got = local.density(&r).expect("near");
                worst = worst.max((got / exact(&r) - 1.0).abs());
            }
            assert_eq!(local.density(&(centre + Vector3::new(161.0, 0.0, 0.0))), None);
        }
    }
    println!("density within 159 m: {worst:.1e}");
    assert!(worst < 1e-4);
    // without the altitude dependence the error would be a hundred times larger
    let place = AtmospherePoint::new(&earth, 5.0, &RADIUS).expect("outside");
    let above = exact(&(RADIUS + Vector3::new(99.0, 0.0, 0.0)));
    assert!((air.density(&place).expect("air") / above - 1.0).abs() > 1e-3);
}

#[test]
fn the_interpolated_air_has_the_stated_error_at_all_positions() {
    let air = ExponentialAtmosphere::table();
    let effect =
        Drag::new(Arc::new(air.clone()), alone(Surface::cannonball(2.0, 1.0, 1.0).expect("positive")));
    let earth = Earth::about_z(0.3, 7.3e-5);
    let v = Vector3::new(0.0, 7500.0, 0.0);
    let mut worst = 0.0_f64;
    for k in 0..500 {
        let r = Vector3::new(6.7e6 + 37.7 * f64::from(k), 11.3 * f64::from(k), 400e3);
        let got = wrenches(&effect, Some(&earth), (r, v), &[body(Matrix3::identity(), STILL, STILL)]);
        let density = air.density(&AtmospherePoint::new(&earth, 0.0, &r).expect("outside")).expect("air");
        let u = v - Vector3::new(0.0, 0.0, 7.3e-5).cross(&r);
        let share = got.expect("outside")[0].force.norm() / (density * u.norm_squared()) - 1.0;
        worst = worst.max(share.abs());
    }
    println!("drag off the grid: {worst:.1e}");
    assert!(worst > 1e-9 && worst < 1e-4); // the grid is fine
}

#[test]
fn the_air_of_a_step_is_independent_of_earlier_queries() {
    let make = || {
        let surface = Surface::cannonball(1.0, 2.2, 1.0).expect("positive");
        Drag::new(Arc::new(ExponentialAtmosphere::table()), alone(surface))
    };
    let earth = Earth::about_z(0.3, 7.3e-5);
    let state = body(Matrix3::identity(), STILL, STILL);
    let ask = |effect: &Drag, r: f64| {
        let at = (Vector3::new(r, 0.0, 0.0), Vector3::new(0.0, 7500.0, 0.0));
        wrenches(effect, Some(&earth), at, &[state]).expect("outside")[0]
    };
    let (fresh, used) = (make(), make());
    ask(&used, 6.8e6);
    assert_eq!(ask(&fresh, 6.9e6), ask(&used, 6.9e6));
    assert_ne!(ask(&used, 6.8e6), ask(&used, 6.9e6));
}

/// A body without surfaces above the end of a model is accepted, one with surfaces is not.
#[test]
fn the_air_is_evaluated_only_at_bodies_with_surfaces() {
    let far = BodyState { com: Vector3::x() * 9e5, ..body(Matrix3::identity(), STILL, STILL) };
    let states = [body(Matrix3::identity(), STILL, STILL), far];
    let on = |bodies: &[usize]| {
        let surface = || Surface::cannonball(1.0, 2.2, 1.0).expect("positive");
        let coverings =
            bodies.iter().map(|&body| Covering { body: body.into(), surface: surface() }).collect();
        let surfaces = Surfaces::new(coverings, &[2]).expect("two bodies");
        let air = HarrisPriester::new(3.0, 0.5).expect("an exponent");
        let earth = Earth::about_z(0.0, 7.3e-5)
            .with_epoch(Epoch::parse("2024-01-03T00:00:00 UTC").expect("an instant"));
        wrenches(&Drag::new(Arc::new(air), surfaces), Some(&earth), (RADIUS, Vector3::y() * 7.6e3), &states)
    };
    let on_bodies = on(&[0]).expect("only the base meets air");
    assert!(on_bodies[0].force.norm() > 0.0 && on_bodies[1] == Wrench::default());
    assert!(on(&[0, 1]).is_err(), "above the table");
}
