//! Checks differential gravity and the gravity-gradient torque against independently computed numbers.
#![allow(clippy::print_stdout)] // shows what was measured when a test fails
#![allow(clippy::excessive_precision)] // tables stand as their sources print them

use nalgebra::{Matrix3, Rotation3, Vector3};
use onorbit_core::environment::{
    Bodies, BodyIndex, BodyState, DifferentialGravity, Effect, EnvironmentError, GravityGradient,
    GravityMode, Reference, Scene, ScenePoint, Wrench, Wrenches,
};
use onorbit_core::gravity::Gravity;
use onorbit_core::orbit::{Kepler, MU_EARTH, Orbit, OrbitState};

/// The reference's position, m: NASA's typical orbit.
const ORIGIN: [f64; 3] = [-4292653.41, 955168.47, 5139356.57];

/// Offset ρ from the reference (m) and the tide g(R + ρ) - g(R) there (m/s²): radial, skew and
/// across, 1 mm to 10 000 km, then the far side of the Earth and 300 km below.
/// mpmath 1.3.0 (the last row Python's decimal), 60 digits, the definition as it stands, every input taken as
/// the double it is, mu 3.986004418e14; 2026-11-21.
#[rustfmt::skip]
const TIDES: [([f64; 3], [f64; 3]); 17] = [
    ([-0.0006346288412326936, 0.00014121276548578954, 0.0007598060204680561], [-1.6348184001098716e-9, 3.6376731145429088e-10, 1.9572776748732569e-9]),
    ([0.00035999999999999997, -0.00048, 0.0008], [-1.227789176308155e-9, 7.8826831134905893e-10, -1.1558840193628835e-10]),
    ([0.00011297021238863165, 0.0009635866852669886, -8.472765929147371e-05], [-1.4550692478590747e-10, -1.2411106627429007e-9, 1.0913019366632237e-10]),
    ([-0.6346288412326936, 0.14121276548578954, 0.7598060204680561], [-1.6348180379334621e-6, 3.6376723086556082e-7, 1.9572772412594679e-6]),
    ([0.36, -0.48, 0.8], [-1.227789205468036e-6, 7.8826824672607115e-7, -1.1558814812077306e-7]),
    ([0.11297021238863164, 0.9635866852669885, -0.08472765929147372], [-1.4550709653729627e-7, -1.241110624526053e-6, 1.0913039929476542e-7]),
    ([-634.6288412326936, 141.21276548578953, 759.8060204680561], [-1.6344559329031812e-3, 3.6368665801825224e-4, 1.9568437129289327e-3]),
    ([360.0, -480.0, 800.0], [-1.2278183252771982e-3, 7.882036061446861e-4, -1.1533435387006677e-4]),
    ([112.97021238863164, 963.5866852669885, -84.72765929147371], [-1.4567884340166045e-4, -1.2410723691258368e-3, 1.0933602434247226e-4]),
    ([-63462.88412326936, 14121.276548578953, 75980.60204680561], [-1.5992661624276518e-1, 3.5585649890350493e-2, 1.9147129465202363e-1]),
    ([36000.0, -48000.0, 80000.0], [-1.2303105082887482e-1, 7.8162719088408163e-2, -9.0399204929904248e-3]),
    ([11297.021238863164, 96358.66852669885, -8472.765929147372], [-1.6264956888808275e-2, -1.2369003252050446e-1, 1.2967436401723352e-2]),
    ([-6346288.412326936, 1412127.6548578953, 7598060.204680561], [-4.628866833349846, 1.0299801145707958, 5.5418863112062025]),
    ([3600000.0, -4800000.0, 8000000.0], [-5.4217987920362126, 1.8252541556468583, 4.5862394503020483]),
    ([1129702.1238863163, 9635866.852669885, -847276.5929147372], [-4.7727291114874025, -1.302034864119109, 5.5933192566401883]),
    ([8585306.82, -1910335.94, -10278713.14], [-1.1057973645903682e+1, 2.4605345996641143, 1.3239100407121372e+1]),
    ([190388.64, -42363.83, -227941.81], [5.25116542505289564e-1, -1.16844920120231902e-1, -6.28692973018048241e-1]),
];

fn body(com: Vector3<f64>) -> BodyState {
    BodyState {
        mass: 1.0,
        inertia: Matrix3::identity(),
        com,
        rot_wk: Matrix3::identity(),
        origin: com,
        velocity: Vector3::zeros(),
        angular_velocity: Vector3::zeros(),
    }
}

/// Returns gravity with a static lifetime.
fn point_mass(mu: f64) -> &'static Gravity {
    Box::leak(Box::new(Gravity::point_mass(mu)))
}

/// Returns a reference with a static lifetime at `position`, without acceleration.
fn reference(position: [f64; 3], mu: f64) -> Reference<'static> {
    let zero = Vector3::zeros();
    let state = OrbitState { position: position.into(), velocity: zero, acceleration: zero };
    Reference { state: Box::leak(Box::new(state)), gravity: Some(point_mass(mu)), in_free_fall: false }
}

fn wrench(
    effect: &dyn Effect,
    reference: Option<Reference<'_>>,
    body: BodyState,
) -> Result<Wrench, EnvironmentError> {
    let mut wrenches = Wrenches::new(&[1]);
    let bodies = Bodies::from_iter([body]);
    let act = |scene: &Scene<'_>| effect.add_wrenches(scene, &mut wrenches);
    Scene::with((0.0, 1.0), 0.0, &bodies, reference, None, act)?;
    Ok(wrenches.get(0).expect("one body"))
}

const CARRIED: DifferentialGravity = DifferentialGravity { gravity_mode: GravityMode::Carried };
const TRUE: DifferentialGravity = DifferentialGravity { gravity_mode: GravityMode::True };

#[test]
fn the_tide_is_free_of_cancellation_from_1_mm_to_10000_km() {
    for (offset, expected) in TIDES {
        let got = wrench(&CARRIED, Some(reference(ORIGIN, MU_EARTH)), body(offset.into())).expect("outside");
        let expected = Vector3::from(expected);
        let error = (got.force - expected).norm() / expected.norm();
        println!("{:9.1e} m: {:.1} roundings", Vector3::from(offset).norm(), error / f64::EPSILON);
        // a few roundings, none of them amplified
        assert!(error < 4.0 * f64::EPSILON, "{offset:?}: {error}");
    }
}

#[test]
fn plain_subtraction_of_accelerations_loses_the_tide() {
    let pull = |r: Vector3<f64>| r * (-MU_EARTH / r.norm().powi(3));
    let (offset, expected) = TIDES[0];
    let (origin, expected) = (Vector3::from(ORIGIN), Vector3::from(expected));
    let plain = pull(origin + Vector3::from(offset)) - pull(origin);
    assert!((plain - expected).norm() > 1e-8 * expected.norm());
}

#[test]
fn a_reference_in_free_fall_leaves_exactly_the_tide() {
    let v = Vector3::new(109.649663, -7527.726490, 1484.521489);
    let orbit = Kepler::from_state(ORIGIN.into(), v, MU_EARTH).expect("an ellipse");
    for t in [0.0, 1234.5, 86_400.0] {
        let (state, gravity) = (orbit.state(t).expect("a valid time"), orbit.mu().map(point_mass));
        let reference = Reference { state: &state, gravity, in_free_fall: false };
        assert_eq!(DifferentialGravity::residual(t, &reference), Ok(Some(Vector3::zeros())));
        let b = body(Vector3::new(0.3, -0.2, 0.1));
        assert_eq!(wrench(&TRUE, Some(reference), b), wrench(&CARRIED, Some(reference), b));
    }
}

#[test]
fn gravity_acts_fully_relative_to_a_reference_at_rest() {
    // for a reference at rest, the full gravity; in `carried` mode, only the tide
    let (r, b) = (reference([7e6, 0.0, 0.0], MU_EARTH), body(Vector3::zeros()));
    let g = MU_EARTH / 49e12;
    let force = wrench(&TRUE, Some(r), b).expect("outside").force;
    // one division and one product
    assert!((force + Vector3::x() * g).norm() < 4.0 * f64::EPSILON * g, "{force}");
    assert_eq!(wrench(&CARRIED, Some(r), b).expect("outside").force, Vector3::zeros());
}

#[test]
fn force_scales_with_mass_and_adds_to_what_is_there() {
    let heavy = BodyState { mass: 3.0, ..body(Vector3::x()) };
    let bodies = Bodies::from_iter([body(Vector3::x()), heavy]);
    let there = Wrench { force: Vector3::new(1.0, 2.0, 3.0), torque: Vector3::y() };
    let mut wrenches = Wrenches::new(&[2]);
    wrenches.add(1, there).expect("two bodies");
    let reference = Some(reference(ORIGIN, MU_EARTH));
    let act = |scene: &Scene<'_>| CARRIED.add_wrenches(scene, &mut wrenches);
    Scene::with((0.0, 1.0), 0.0, &bodies, reference, None, act).expect("outside");
    let [light, heavy] = [0, 1].map(|k| wrenches.get(k).expect("two bodies"));
    assert_eq!(heavy.force, there.force + light.force * 3.0);
    assert_eq!(heavy.torque, there.torque);
}

/// NASA/TM-2015-218675 cases 10A and 10C (JEOD's logs): position (m), inertial to body (row
/// major), body rate (rad/s), angular acceleration (rad/s², body axes). Cylinder with
/// I = diag(500, 12250, 12250) kg m², mu 3.986004415e14. 10A at the end, 10C at both; the attitude
/// printed for 10A at the start is no rotation beyond 1.5e-10.
type Case = ([f64; 3], [f64; 9], [f64; 3], [f64; 3]);
#[rustfmt::skip]
const CYLINDER: [Case; 3] = [
    ([-1024262.411095882, -6151093.565368023, 2599975.06217899],
     [-0.1303977224153033, -0.9235551691194414, 0.3606137595567613, -0.9835635249313684, 0.0746803593168579, -0.1643947576928366, 0.1248968631050554, -0.3761232424685627, -0.9181133263717784],
     [-1.97989570839746e-05, -0.001080027400090759, -0.0007098670173048437], [0.0, 1.243056784774573e-07, 4.58638231464994e-08]),
    ([-4315967.74, 960356.2, 5167269.53],
     [-0.6443912269484258, 0.0528421023505859, 0.762868048125672, -0.7615617871967408, -0.1345758406652156, -0.6339660774765135, 0.0691635085403311, -0.9894933326346473, 0.1269620169892195],
     [-1.958561461497211e-05, -0.001122059109806593, 0.0], [0.0, 3.165626971469091e-07, -8.422776295536121e-08]),
    ([-1051395.223245429, -6116653.272961161, 2626343.274205685],
     [-0.1416223422259105, -0.9171375917053928, 0.372561068904521, -0.9814677649343182, 0.08101112610984618, -0.1736612329832083, 0.1290896532541655, -0.3902509901681823, -0.9116139676943704],
     [-1.958561461497211e-05, -0.001102150420357001, -0.0007137081527530395], [0.0, 9.285032588060049e-08, 2.393403219339611e-08]),
];

/// Error of the angular acceleration, rad/s², with the inertia rotated by `turned` and the torque times
/// `sign`.
fn cylinder_error(case: &Case, sign: f64, turned: bool) -> f64 {
    let (position, rot_bw, rate_b, expected) = case;
    let (rot_bw, w) = (Matrix3::from_row_slice(rot_bw), Vector3::from(*rate_b));
    let inertia_b = Matrix3::from_diagonal(&Vector3::new(500.0, 12250.0, 12250.0));
    let inertia = if turned { inertia_b } else { rot_bw * inertia_b * rot_bw.transpose() };
    let b = BodyState { inertia, rot_wk: rot_bw.transpose(), ..body(Vector3::zeros()) };
    let reference = reference(*position, 3.986004415e14);
    let torque_b = rot_bw * wrench(&GravityGradient, Some(reference), b).expect("outside").torque * sign;
    // I ω̇ = T - ω × I ω
    let rhs = torque_b - w.cross(&(inertia_b * w));
    (rhs.component_div(&inertia_b.diagonal()) - Vector3::from(*expected)).norm()
}

#[test]
fn gravity_gradient_torque_agrees_with_nasa() {
    for case in &CYLINDER {
        let error = cylinder_error(case, 1.0, true);
        println!("{error:.1e} rad/s²");
        // Accelerations of 1e-7, printed to 16 digits: 1e-23; differences of terms 1e-6 in size, rounded.
        assert!(error < 3e-20, "{error}");
        // negative controls: the torque with the wrong sign, and the inertia used in W axes
        assert!(cylinder_error(case, -1.0, true) > 1e-8);
        assert!(cylinder_error(case, 1.0, false) > 1e-8);
    }
}

#[test]
fn the_gravity_gradient_aligns_a_long_body_with_the_vertical() {
    // Pitched by θ about z from the radial x axis: T = -(3μ/2r³) (C - A) sin 2θ along z, with A the small
    // moment.
    let (small, large, r, pitch) = (2.0, 30.0, 7e6_f64, 0.3_f64);
    let rot = Rotation3::from_axis_angle(&Vector3::z_axis(), pitch).into_inner();
    let inertia = Matrix3::from_diagonal(&Vector3::new(small, large, large));
    let b = BodyState { inertia, rot_wk: rot, ..body(Vector3::zeros()) };
    let got = wrench(&GravityGradient, Some(reference([r, 0.0, 0.0], MU_EARTH)), b).expect("outside").torque;
    let expected = -1.5 * MU_EARTH / r.powi(3) * (large - small) * (2.0 * pitch).sin();
    // the difference of moments loses one of 16 digits
    assert!((got - Vector3::z() * expected).norm() < 1e-14 * expected.abs(), "{got} {expected}");
}

#[test]
fn torque_is_taken_at_the_body_and_not_at_the_reference() {
    let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0));
    let at = |com| BodyState { inertia, ..body(com) };
    let here = Some(reference([7e6, 0.0, 0.0], MU_EARTH));
    let there = Some(reference([7e6, 7e6, 0.0], MU_EARTH));
    let moved = wrench(&GravityGradient, here, at(Vector3::y() * 7e6)).expect("outside").torque;
    assert_eq!(moved, wrench(&GravityGradient, there, at(Vector3::zeros())).expect("outside").torque);
    // on a principal axis the torque is zero
    assert_eq!(
        wrench(&GravityGradient, here, at(Vector3::zeros())).expect("outside").torque,
        Vector3::zeros()
    );
}

#[test]
fn gravity_without_a_planet_or_inside_one_is_refused() {
    let origin = reference(ORIGIN, MU_EARTH);
    let no_planet = Reference { gravity: None, ..origin };
    for effect in [&TRUE as &dyn Effect, &CARRIED, &GravityGradient] {
        assert!(effect.requires_orbit());
        for missing in [None, Some(no_planet)] {
            let error = wrench(effect, missing, body(Vector3::zeros())).expect_err("no planet");
            assert!(matches!(error, EnvironmentError::NoPlanet { .. }), "{error}");
        }
        for position in [[0.0; 3], [1e3, 0.0, 0.0], [f64::NAN, 0.0, 0.0]] {
            let error = wrench(effect, Some(reference(position, MU_EARTH)), body(Vector3::zeros()))
                .expect_err("inside");
            assert!(
                matches!(error, EnvironmentError::InsidePlanet { what: ScenePoint::Reference, .. }),
                "{error}"
            );
        }
        // the body hits the Earth while the reference continues
        let error = wrench(effect, Some(origin), body(-Vector3::from(ORIGIN))).expect_err("inside");
        assert!(
            matches!(
                error,
                EnvironmentError::InsidePlanet {
                    what: ScenePoint::Body(BodyIndex { system: 0, body: 0 }),
                    ..
                }
            ),
            "{error}"
        );
    }
}

#[test]
fn one_wrench_per_body_is_needed() {
    let (bodies, mut two) = (Bodies::from_iter([body(Vector3::zeros())]), Wrenches::new(&[2]));
    for effect in [&TRUE as &dyn Effect, &GravityGradient] {
        let act = |scene: &Scene<'_>| effect.add_wrenches(scene, &mut two);
        let reference = Some(reference(ORIGIN, MU_EARTH));
        let error = Scene::with((0.0, 1.0), 0.0, &bodies, reference, None, act).expect_err("one too many");
        let [expected, got] = ["1 body of system 0", "2 bodies of system 0"].map(str::to_owned);
        assert_eq!(error, EnvironmentError::OtherBodies { expected, got });
    }
}
