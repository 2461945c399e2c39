//! SGP4: a short table of AIAA 2006-6753, what it refuses, and its acceleration.
#![allow(clippy::print_stdout)] // shows what was measured when a test fails

use nalgebra::Vector3;
use onorbit_core::orbit::sgp4::{ElementSetError, Sgp4Error};
use onorbit_core::orbit::{Axes, EarthModel, MeanElements, Orbit, OrbitError, Sgp4};

const LINES: [&str; 2] = [
    "1 00005U 58002B   00179.78495062  .00000023  00000-0  28098-4 0  4753",
    "2 00005  34.2682 348.7242 1859667 331.7664  19.3264 10.82419157413667",
];

fn sgp4(line1: &str, line2: &str) -> Sgp4 {
    let elements = MeanElements::from_tle(line1, line2, true).expect("a TLE");
    Sgp4::new(elements, EarthModel::Wgs72).expect("an orbit")
}

/// Rows of tcppver.out (minutes, km, km/s) of satellite 5.
/// The whole table is compared in `tests/oracles/test_sgp4.py`.
#[test]
fn published_states_come_back() {
    #[rustfmt::skip]
    let table: [([&str; 2], &[[f64; 7]]); 1] = [
        (LINES, &[
            [0.0, 7022.46529266, -1400.08296755, 0.03995155, 1.893841015, 6.405893759, 4.534807250],
            [360.0, -7154.03120202, -3783.17682504, -3536.19412294, 4.741887409, -4.151817765, -2.093935425],
            [4320.0, -9060.47373569, 4658.70952502, 813.68673153, -2.232832783, -4.110453490, -3.157345433],
        ]),
    ];
    for (lines, rows) in table {
        let orbit = sgp4(lines[0], lines[1]);
        for [minutes, x, y, z, vx, vy, vz] in rows {
            let state = orbit.state(60.0 * minutes).expect("a published time");
            assert!((state.position / 1e3 - Vector3::new(*x, *y, *z)).amax() < 2e-7);
            assert!((state.velocity / 1e3 - Vector3::new(*vx, *vy, *vz)).amax() < 2e-7);
        }
        assert_eq!(orbit.axes(), Axes::Teme);
        assert_eq!(orbit.elements().epoch.to_string(), "2000-06-27T18:50:19.733568Z");
    }
}

#[test]
fn the_acceleration_is_that_of_the_position() {
    let orbit = sgp4(LINES[0], LINES[1]);
    for t in [0.0, 1234.5, 40_000.0] {
        let at = |t| orbit.state(t).expect("no decay");
        let (state, h) = (at(t), 10.0);
        // fourth order, another step: -r(±2h) + 16 r(±h) - 30 r
        let far = at(t + 2.0 * h).position + at(t - 2.0 * h).position;
        let near = at(t + h).position + at(t - h).position;
        let other = (near * 16.0 - far - state.position * 30.0) / (12.0 * h * h);
        let apart = (other - state.acceleration).norm();
        println!("acceleration at {t} s: {apart:.1e} m/s²");
        assert!(apart < 2e-7);
        // and not that of the published velocity
        let slope = (at(t + h).position - at(t - h).position) * 8.0
            - (at(t + 2.0 * h).position - at(t - 2.0 * h).position);
        let off = (slope / (12.0 * h) - state.velocity).norm();
        println!("velocity at {t} s: {off:.1e} m/s from the derivative of the position");
        assert!(off > 1e-3 && off < 3.0); // short-period terms of J2 times the eccentricity: J2 e v
    }
}

#[test]
fn corrupted_lines_are_refused_with_their_column() {
    let replaced = |line: usize, column: usize, text: &str| {
        let mut lines = LINES.map(str::to_owned);
        lines[line - 1].replace_range(column - 1..column - 1 + text.len(), text);
        MeanElements::from_tle(&lines[0], &lines[1], false).expect_err(text)
    };
    for (line, column, text) in [
        (1, 1, "2"),
        (2, 1, "1"),
        (1, 2, "x"),
        (1, 3, "I0005"),
        (1, 19, "x0"),
        (1, 21, "000.5"),
        (1, 34, " .0x000023"),
        (1, 54, "*28098-4"),
        (1, 54, " 2809.-4"),
        (2, 8, "1"),
        (2, 9, " 34.26x2"),
        (2, 18, "348,7242"),
        (2, 27, "18596.7"),
        (2, 35, "331 7664"),
        (2, 44, " 1-.3264"),
        (2, 53, "1e.82419157"),
    ] {
        match replaced(line, column, text) {
            ElementSetError::Column { line: l, column: c, .. } => {
                assert_eq!((usize::from(l), c), (line, column), "{text}");
            }
            ElementSetError::TwoSatellites { .. } => assert_eq!(column, 3),
            other => panic!("{text}: {other}"),
        }
    }
    assert!(matches!(replaced(2, 9, "199.2682"), ElementSetError::Range { .. }));
    let short = MeanElements::from_tle(&LINES[0][..68], LINES[1], false);
    assert_eq!(short, Err(ElementSetError::Length { line: 1, got: 68 }));
    let wide = MeanElements::from_tle(&LINES[0].replace('U', "Ü"), LINES[1], false);
    assert!(matches!(wide, Err(ElementSetError::Column { line: 1, column: 8, .. })));
    let one_digit = LINES[1].replace("34.2682", "34.2683");
    let refused = MeanElements::from_tle(LINES[0], &one_digit, true);
    assert_eq!(refused, Err(ElementSetError::Checksum { line: 2, got: 7, expected: 8 }));
    assert!(MeanElements::from_tle(LINES[0], &one_digit, false).is_ok());
}

#[test]
fn decay_and_far_times_are_refused() {
    let orbit = sgp4(
        "1 28872U 05037B   05333.02012661  .25992681  00000-0  24476-3 0  1534",
        "2 28872  96.4736 157.9986 0303955 244.0492 110.6523 16.46015938 10708",
    );
    assert!(orbit.state(0.0).is_ok());
    match orbit.state(3600.0) {
        Err(OrbitError::Sgp4(error @ Sgp4Error::Decayed { time: 3600.0, .. })) => {
            assert_eq!(error.code(), 6);
            assert!(error.value().is_some_and(|r| r < 6.378135e6));
        }
        other => panic!("{other:?}"),
    }
    assert!(matches!(orbit.state(1e18), Err(OrbitError::TimeOutOfRange { .. })));
    assert!(matches!(orbit.state(f64::INFINITY), Err(OrbitError::NotFinite { .. })));
}
