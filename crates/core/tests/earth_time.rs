//! Checks epochs, Earth-orientation parameters and geodetic coordinates, and their errors.

use nalgebra::{Matrix3, Vector3};
use onorbit_core::earth::{
    Axes, Earth, EarthError, EarthParameterRow, EarthParameters, Ellipsoid, Epoch, Geodetic, WGS84,
};
use onorbit_core::orbit::{EarthModel, MeanElements, Orbit, Sgp4};
use serde_json::Value;

const DAY: f64 = 86_400.0;
const ARC_SECOND: f64 = std::f64::consts::PI / 648_000.0;

fn epoch(text: &str) -> Epoch {
    Epoch::parse(text).expect("an epoch")
}

#[test]
fn time_scales_give_the_same_instant() {
    let one = epoch("2024-03-01T12:00:00 UTC");
    for text in [
        "2024-03-01T12:00:00Z",
        "2024-03-01 12:00 UTC",
        " 2024-03-01T12:00:00.000000000 UTC ",
        "2024-03-01T12:00:37 TAI",
        "2024-03-01T12:01:09.184 TT",
    ] {
        assert_eq!(epoch(text), one, "{text}");
    }
    assert_eq!(one.to_string(), "2024-03-01T12:00:00.000000 UTC");
    // TDB is within 2 ms of TT
    let tdb = epoch("2024-03-01T12:01:09.184 TDB");
    assert!(tdb != one && tdb.to_string().starts_with("2024-03-01T1"), "{tdb}");
    assert!(format!("{:?}", Earth::new(tdb, &EarthParameters::default())).len() > 10);
}

#[test]
fn leap_seconds_are_distinct_instants() {
    let around = [
        ("2016-12-31T23:59:24.5 UTC", "2017-01-01T00:00:00.5 TAI"),
        ("2016-12-31T23:59:59 UTC", "2017-01-01T00:00:35 TAI"),
        ("2016-12-31T23:59:60 UTC", "2017-01-01T00:00:36 TAI"),
        ("2016-12-31T23:59:60.75 UTC", "2017-01-01T00:00:36.75 TAI"),
        ("2017-01-01T00:00:00 UTC", "2017-01-01T00:00:37 TAI"),
        ("1972-07-01T00:00:00 UTC", "1972-07-01T00:00:11 TAI"),
    ];
    for (utc, tai) in around {
        assert_eq!(epoch(utc), epoch(tai), "{utc}");
        let written = epoch(tai).to_string();
        assert_eq!(epoch(&written), epoch(utc), "{written}");
        assert!(written.starts_with(utc.trim_end_matches(" UTC")), "{written}");
    }
    assert_eq!(epoch("2016-12-31T23:59:30 UTC").utc_minus_tai(), -36.0);
    assert_eq!(epoch("1971-12-31T23:59:59 TAI").to_string(), "1971-12-31T23:59:59.000000 TAI");
}

#[test]
fn invalid_instants_are_refused() {
    for text in [
        "",
        "Z",
        "UTC",
        "2024-03-01",
        "2024-03-01T12:00:00",
        "2024-03-01T12:00:00 UT1",
        "2024-03-01T12:00:00+01:00",
        "2024-02-30T12:00:00 UTC",
        "2024-13-01T12:00:00 UTC",
        "2024-00-01T12:00:00 UTC",
        "2024-03-01T24:00:00 UTC",
        "2024-03-01T12:60:00 UTC",
        "2024-03-01T12:00:61 UTC",
        "2024-03-01T12:00:60 UTC",
        "2015-12-31T23:59:60 UTC",
        "2016-12-31T23:59:60 TAI",
        "2024-03-01T12:00:-1 UTC",
        "2024-03-01T12:00:00.1234567890 UTC",
        "1899-12-31T12:00:00 TAI",
        "2100-01-01T12:00:00 TAI",
        "99999-01-01T12:00:00 TAI",
        "２024-03-01T12:00:00 UTC",
        "2024-3-1T1:2:3:4 UTC",
    ] {
        let error = Epoch::parse(text).expect_err(text);
        assert!(matches!(&error, EarthError::Epoch { text: said, .. } if said == text), "{error}");
    }
    assert!(matches!(Epoch::parse("1965-03-01T12:00:00 UTC"), Err(EarthError::BeforeUtc { .. })));
}

#[test]
fn the_error_of_an_epoch_names_the_wrong_part() {
    for (text, part) in [
        ("2024-03-01T12:00:00", "it does not end with a time scale, which is UTC (or Z), TAI, TT or TDB"),
        ("2024-03-01T12:00:00+01:00", "an offset from UTC is not accepted (convert the time to UTC)"),
        ("2024-03-01 UTC", "is not a date and a time of the form YYYY-MM-DDThh:mm:ss.s"),
        ("1899-03-01T12:00:00 TAI", "the year is 1899 and must be from 1900 to 2099"),
        ("2024-13-01T12:00:00 UTC", "the month is 13 and must be from 1 to 12"),
        ("2024-02-30T12:00:00 UTC", "the day is 30 and must be from 1 to 29 in 2024-02"),
        ("2023-02-29T12:00:00 UTC", "the day is 29 and must be from 1 to 28 in 2023-02"),
        ("2000-02-30T12:00:00 UTC", "from 1 to 29 in 2000-02"),
        ("2024-04-31T12:00:00 UTC", "from 1 to 30 in 2024-04"),
        ("2024-03-01T24:00:00 UTC", "the hour is 24 and must be from 0 to 23"),
        ("2024-03-01T12:60:00 UTC", "the minute is 60 and must be from 0 to 59"),
        ("2024-03-01T12:00.5 UTC", "the minutes have decimals; write whole minutes, and seconds"),
        ("2024-03-01T12:00:61 UTC", "the second is 61 and must be from 0 to 60"),
        ("2024-03-01T12:00:60 UTC", "the second is 60 in a minute without a leap second of UTC"),
    ] {
        let error = Epoch::parse(text).expect_err(text).to_string();
        assert!(error.contains(part), "{error}");
    }
    assert!(Epoch::parse("2024-02-29T23:59:59 UTC").is_ok(), "a leap day is accepted");
}

fn table(rows: &[[f64; 4]]) -> EarthParameters {
    EarthParameters::from_rows(rows)
}

#[test]
fn ut1_is_continuous_across_a_leap_second() {
    // UT1 - UTC jumps by a second at the end of 2016, UT1 does not
    let rows = [
        [57_752.0, 0.0, 0.0, -0.405],
        [57_753.0, 0.0, 0.0, -0.406],
        [57_754.0, 0.0, 0.0, 0.593],
        [57_755.0, 0.0, 0.0, 0.592],
    ];
    let start = epoch("2016-12-30T00:00:00 UTC");
    let earth = Earth::new(start, &table(&rows)).expect("an Earth");
    for k in -300..=300 {
        let t = 2.0 * DAY + 1.0 + f64::from(k) * 0.1;
        let turn = earth.rot_fi(t + 0.1) * earth.rot_fi(t).transpose();
        assert!((turn[(0, 1)] - 7.292_115e-6).abs() < 1e-11, "{k}: {turn}");
    }
    // at the rows the table equals constant parameters
    let december = EarthParameters::Constant { ut1_minus_utc: -0.406, polar_motion: [0.0; 2] };
    let december = Earth::new(epoch("2016-12-31T00:00:00 UTC"), &december).expect("an Earth");
    assert!((earth.rot_fi(DAY) - december.rot_fi(0.0)).norm() < 1e-12);
    let january = EarthParameters::Constant { ut1_minus_utc: 0.593, polar_motion: [0.0; 2] };
    let january = Earth::new(epoch("2017-01-01T00:00:00 UTC"), &january).expect("an Earth");
    assert!((earth.rot_fi(2.0 * DAY + 1.0) - january.rot_fi(0.0)).norm() < 1e-12);
    // a second corresponds to 7e-5 rad
    assert!((earth.rot_fi(2.0 * DAY) - january.rot_fi(0.0)).norm() > 7e-5);
}

#[test]
fn times_outside_a_table_are_refused() {
    let rows = [[60_370.0, 1e-7, 1e-6, -0.01], [60_372.0, 2e-7, 1e-6, -0.012]];
    let earth = Earth::new(epoch("2024-03-01T12:00:00 UTC"), &table(&rows)).expect("an Earth");
    assert!(earth.covers(1.5 * DAY).is_ok());
    let said = earth.covers(1.6 * DAY).expect_err("it ends").to_string();
    assert!(said.contains("2024-03-01T00:00:00.000000 UTC to 2024-03-03T00:00:00.000000 UTC"), "{said}");
    assert!(matches!(earth.covers(f64::NAN), Err(EarthError::NotFinite { .. })));
    let before = Earth::new(epoch("2024-02-29T12:00:00 UTC"), &table(&rows));
    assert!(matches!(before, Err(EarthError::OutsideSpan { .. })));
    let years = Earth::new(epoch("2024-02-29T12:00:00 UTC"), &EarthParameters::default()).expect("an Earth");
    assert!(matches!(years.covers(3e9), Err(EarthError::OutsideSpan { .. })));
    for wrong in [
        vec![rows[0]],
        vec![rows[1], rows[0]],
        vec![rows[0], [60_372.0, 0.2, 0.3, 0.0]],
        vec![rows[0], [60_372.0, 0.0, 0.0, -200.0]],
        vec![rows[0], [60_372.0, 0.0, 0.0, f64::NAN]],
        vec![rows[0], [f64::NAN, 0.0, 0.0, 0.0]],
    ] {
        let refused = Earth::new(epoch("2024-03-01T12:00:00 UTC"), &table(&wrong));
        assert!(matches!(refused, Err(EarthError::Parameter { .. } | EarthError::ShortTable { got: 1 })));
    }
}

#[test]
fn files_of_the_iers_are_read() {
    let finals = |mjd: f64, x: f64, y: f64, ut1: f64| {
        format!("24 3 1 {mjd:8.2} I {x:9.6} 0.000091 {y:9.6} 0.000091  I{ut1:10.7} 0.0000101  0.5")
    };
    let empty = "24 3 3 60372.00                                                  ";
    let finals =
        [finals(60_370.0, -0.013, 0.31, -0.0077), finals(60_371.0, -0.012, 0.312, -0.0081), empty.to_owned()]
            .join("\n");
    let c04 = "# EOP 20 C04\n2024   3   1   0  60370.00  -0.013000   0.310000  -0.0077000   0.1 0.2\n\
               2024   3   1  60371  -0.012000   0.312000  -0.0081000   0.1 0.2\n";
    let csv = "mjd,x_arcsec,y_arcsec,ut1_minus_utc_s\n60370, -0.013, 0.31, -0.0077\n60371, -0.012, 0.312, -0.0081\n";
    let expected = EarthParameterRow {
        mjd: 60_371.0,
        polar_motion: [-0.012 * ARC_SECOND, 0.312 * ARC_SECOND],
        ut1_minus_utc: -0.0081,
    };
    for text in [finals.as_str(), c04, csv] {
        let Ok(EarthParameters::Table(rows)) = EarthParameters::read(text) else { panic!("{text}") };
        assert_eq!((rows.len(), rows[1]), (2, expected), "{text}");
    }
    for (text, line) in [
        ("", 1),
        ("# nothing\n\n", 1),
        ("mjd,x,y,dut1\n60370,0,0,0", 1),
        ("mjd,x_arcsec,y_arcsec,ut1_minus_utc_s\n60370,0,0,0\n60371,0,0", 3),
        ("2024 3 1 60370 0.1", 1),
        (&c04.replace("60371", "6037x"), 3),
    ] {
        let said = EarthParameters::read(text).expect_err(text);
        assert!(matches!(said, EarthError::Table { line: l, .. } if l == line), "{said}");
    }
}

#[test]
fn element_sets_define_the_epoch() {
    let lines = (
        "1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927",
        "2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537",
    );
    let set = MeanElements::from_tle(lines.0, lines.1, true).expect("a set");
    let orbit = Sgp4::new(set, EarthModel::Wgs72);
    let at = orbit.epoch().expect("an epoch");
    assert_eq!(at.to_string(), "2008-09-20T12:25:40.104192 UTC");
    let earth = Earth::new(at, &EarthParameters::default()).expect("an Earth");
    assert!(matches!(earth.check_orbit(orbit.axes(), Some(at)), Err(EarthError::OtherAxes { .. })));
    let earth = earth.in_axes(Axes::Teme);
    assert!(earth.check_orbit(orbit.axes(), Some(at)).is_ok());
    let other = Some(epoch("2008-09-20T12:25:40 UTC"));
    assert!(matches!(earth.check_orbit(orbit.axes(), other), Err(EarthError::OtherEpoch { .. })));
}

#[test]
fn geodetic_coordinates_agree_with_the_closed_form() {
    let table: Value = serde_json::from_str(include_str!("../../../tests/fixtures/earth.json"))
        .expect("the fixture is JSON");
    let number = |value: &Value| value.as_f64().expect("a number");
    for case in table["places"].as_array().expect("cases") {
        let given = Geodetic {
            latitude: number(&case["latitude"]),
            longitude: number(&case["longitude"]),
            altitude: number(&case["altitude"]),
        };
        let position = Vector3::from_fn(|i, _| number(&case["position"][i]));
        // a nanometre, and the rounding of the input
        let tolerance = 1e-9 + 4.0 * f64::EPSILON * position.norm();
        assert!((given.position(&WGS84) - position).norm() < tolerance, "{case}");
        let found = Geodetic::of(&position, &WGS84).expect("a place");
        let off = [
            (found.latitude - given.latitude) * position.norm(),
            (found.longitude - given.longitude) * position.norm() * given.latitude.cos(),
            found.altitude - given.altitude,
        ];
        assert!(off.iter().all(|x| x.abs() < tolerance), "{case}: {off:?}");
    }
}

#[test]
fn geodetic_coordinates_need_a_distance_from_the_centre() {
    for (position, is_near) in [
        (Vector3::zeros(), true),
        (Vector3::new(0.0, 0.0, 4.9e4), true),
        (Vector3::new(5.1e4, 0.0, 0.0), false),
    ] {
        let place = Geodetic::of(&position, &WGS84);
        assert_eq!(matches!(place, Err(EarthError::NearCentre { .. })), is_near);
    }
    assert!(matches!(Geodetic::of(&Vector3::repeat(f64::NAN), &WGS84), Err(EarthError::NotFinite { .. })));
    let south = Geodetic::of(&Vector3::new(0.0, 0.0, -7e6), &WGS84).expect("a place");
    assert_eq!((south.latitude, south.longitude), (-std::f64::consts::FRAC_PI_2, 0.0));
    // a sphere needs no iteration
    let sphere = Ellipsoid { radius: 6e6, flattening: 0.0 };
    let place = Geodetic::of(&Vector3::new(3e6, -4e6, 5e6), &sphere).expect("a place");
    assert!((place.latitude - std::f64::consts::FRAC_PI_4).abs() < 1e-15);
    assert!((place.altitude - (50e12_f64.sqrt() - 6e6)).abs() < 2e-9);
}

#[test]
fn a_uniform_rotation_is_uniform() {
    let earth = Earth::about_z(0.3, 7e-5);
    let (s, c) = (0.3_f64 + 7e-5 * 100.0).sin_cos();
    assert!((earth.rot_fi(100.0) - Matrix3::new(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0)).norm() < 1e-16);
    assert_eq!(earth.angular_velocity(5.0), Vector3::z() * 7e-5);
    assert!(earth.covers(1e12).is_ok() && earth.axes().is_none());
}
