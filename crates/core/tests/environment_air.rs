//! Checks models of the atmosphere against other implementations.
#![allow(clippy::print_stdout)] // shows what was measured when a test fails

use onorbit_core::earth::{Earth, EarthError, Epoch, Geodetic, WGS84};
use onorbit_core::environment::atmosphere::{
    Atmosphere, AtmosphereError, AtmospherePoint, HarrisPriester, LocalAtmosphere, MagneticActivity,
    Nrlmsise00, SpaceIndices, SpaceWeather, SpaceWeatherTable,
};

/// Altitude (m), cosine of the angle from the bulge, density (kg/m³) for n = 6: brahe 1.8.0,
/// `density_harris_priester`, with a lag of 30°; 2026-11-21. The largest difference over 3000 positions is
/// 4.1e-7.
const HARRIS_PRIESTER: [(f64, f64, f64); 6] = [
    (160_209.566_304_123_03, -0.062_534_533_991_536_15, 1.259_338_773_803_707_6e-9),
    (261_671.446_830_658_24, 0.915_698_326_262_844_2, 6.932_283_261_508_475e-11),
    (423_542.384_268_544_6, -0.056_441_575_681_446_15, 1.878_475_747_471_462_6e-12),
    (564_650.640_312_212_5, 0.375_346_396_299_784_45, 4.033_503_227_638_339e-13),
    (778_219.223_346_737_2, -0.301_604_134_788_165_3, 1.251_539_761_119_929_8e-14),
    (986_686.730_883_425_1, 0.553_367_100_100_619_3, 9.939_748_256_069_699e-15),
];

type NrlmsiseRow = (&'static str, [f64; 3], [f64; 2], &'static [f64], f64);

/// UTC; altitude km, latitude and longitude in degrees; F10.7a, F10.7; Ap; density in kg/m³: PyPI's `nrlmsise00` 0.1.2,
/// Brodowski's C in double precision, `gtd7d`; 2026-11-21.
#[rustfmt::skip]
const NRLMSISE: [NrlmsiseRow; 8] = [
    ("2010-06-21T12:00:00 UTC", [400.0, 0.0, 0.0], [150.0, 150.0], &[4.0], 4.402_257_472_096_389e-12),
    ("2003-10-29T18:30:15 UTC", [250.5, -62.3, 131.7], [140.0, 279.0], &[204.0], 1.360_653_952_224_782_6e-10),
    ("2019-02-03T03:15:30 UTC", [160.25, 78.1, -75.2], [70.4, 69.1], &[2.0], 8.382_959_857_608_663e-10),
    ("2000-12-31T23:59:59 UTC", [700.0, -10.0, 179.0], [190.3, 211.7], &[12.0], 2.301_990_726_423_985e-13),
    ("2014-03-01T06:00:00 UTC", [110.0, 45.0, -120.0], [154.0, 167.0], &[7.0], 1.051_992_964_735_962_5e-7),
    ("2020-02-29T00:00:01 UTC", [40.0, 20.0, 30.0], [71.0, 70.0], &[5.0], 4.035_043_371_099_46e-3),
    ("2001-07-04T09:45:00 UTC", [950.0, -89.0, 10.0], [160.0, 150.0], &[30.0], 6.678_973_052_978_576e-15),
    ("2015-03-17T21:00:00 UTC", [420.0, 35.0, -100.0], [130.0, 113.0], &[108.0, 179.0, 94.0, 132.0, 132.0, 40.5, 6.25],
     4.997_254_128_168_247e-12),
];

fn earth(epoch: &str) -> Earth {
    Earth::about_z(0.4, 7.29e-5).with_epoch(Epoch::parse(epoch).expect("an instant"))
}

fn density(
    air: &dyn Atmosphere,
    earth: &Earth,
    t: f64,
    [km, latitude, longitude]: [f64; 3],
) -> Result<f64, AtmosphereError> {
    let (latitude, longitude) = (latitude.to_radians(), longitude.to_radians());
    air.density(&AtmospherePoint::at(earth, t, Geodetic { latitude, longitude, altitude: km * 1e3 })?)
}

fn constant(f107: f64, f107a: f64, ap: &[f64]) -> Nrlmsise00 {
    let activity = <[f64; 7]>::try_from(ap).map_or(MagneticActivity::Daily(ap[0]), MagneticActivity::History);
    Nrlmsise00::new(SpaceWeather::Constant(SpaceIndices::new(f107, f107a, activity).expect("indices")))
}

#[test]
fn harris_priester_interpolates_the_published_table() {
    let air = HarrisPriester::new(6.0, 0.0).expect("polar");
    for (altitude, cosine, expected) in HARRIS_PRIESTER {
        let got = air.at(altitude, cosine).expect("within");
        assert!((got / expected - 1.0).abs() < 1e-6, "{altitude}: {got:e} is not {expected:e}");
    }
    assert!((air.at(400e3, 1.0).expect("within") / 7.492e-12 - 1.0).abs() < 1e-14);
    assert!((air.at(400e3, -1.0).expect("within") / 2.249e-12 - 1.0).abs() < 1e-14);
    assert!(air.at(1_000e3, 0.3).is_ok() && air.at(100e3, 0.3).is_ok());
}

#[test]
fn the_bulge_lags_the_sun_by_two_hours() {
    let earth = earth("2024-03-20T03:06:00 UTC"); // equinox: the Sun is on the equator
    let air = HarrisPriester::default();
    let sun = earth.rot_fi(0.0) * earth.sun(0.0).expect("an epoch").normalize();
    let noon = sun.y.atan2(sun.x).to_degrees();
    let at = |east: f64| density(&air, &earth, 0.0, [400.0, 0.0, noon + east]).expect("within");
    let densest = (0..360).max_by(|a, b| at(f64::from(*a)).total_cmp(&at(f64::from(*b))));
    assert_eq!(densest, Some(30));
    assert!(at(30.0) > 0.999 * 7.492e-12 && at(210.0) < 1.001 * 2.249e-12);
    let no_epoch = Earth::about_z(0.0, 7.3e-5);
    let refused = density(&air, &no_epoch, 0.0, [400.0, 0.0, 0.0]);
    assert!(matches!(refused, Err(AtmosphereError::Earth(EarthError::NeedsEpoch { .. }))), "{refused:?}");
}

#[test]
fn nrlmsise_agrees_with_the_reference_in_c() {
    for (epoch, place, [f107a, f107], ap, expected) in NRLMSISE {
        let got = density(&constant(f107, f107a, ap), &earth(epoch), 0.0, place).expect("air");
        // rounding of altitudes and angles by unit conversion
        assert!((got / expected - 1.0).abs() < 1e-12, "{epoch}: {got:e} is not {expected:e}");
        // negative control: the Sun an hour later
        let later = density(&constant(f107, f107a, ap), &earth(epoch), 3600.0, place).expect("air");
        assert!(place[0] < 50.0 || (later / expected - 1.0).abs() > 1e-4);
    }
}

#[test]
fn invalid_space_weather_is_refused() {
    let daily = |f107, f107a, ap| SpaceIndices::new(f107, f107a, MagneticActivity::Daily(ap));
    assert!(matches!(daily(0.0, 150.0, 4.0), Err(AtmosphereError::Value { name: "f107", .. })));
    assert!(matches!(daily(150.0, f64::NAN, 4.0), Err(AtmosphereError::Value { name: "f107a", .. })));
    assert!(matches!(daily(150.0, 150.0, -1.0), Err(AtmosphereError::Value { name: "ap", .. })));
    let history = MagneticActivity::History([4.0, 4.0, 4.0, 401.0, 4.0, 4.0, 4.0]);
    assert!(matches!(
        SpaceIndices::new(150.0, 150.0, history),
        Err(AtmosphereError::Value { value: 401.0, .. })
    ));
}

/// Days around the end of a month, with artificial numbers that identify their position.
const TABLE: &str = "DATE,BSRN,AP1,AP2,AP3,AP4,AP5,AP6,AP7,AP8,AP_AVG,F10.7_OBS,F10.7_OBS_CENTER81
2024-02-27,1,11,12,13,14,15,16,17,18,14,101,151
2024-02-28,1,21,22,23,24,25,26,27,28,24,102,152
2024-02-29,1,31,32,33,34,35,36,37,38,34,103,153
2024-03-01,1,41,42,43,44,45,46,47,48,44,,154
2024-03-02,1,51,52,53,54,55,56,57,58,54,105,155
";

#[test]
fn a_table_gives_the_flux_of_the_day_before_and_three_days_of_activity() {
    let table = SpaceWeatherTable::from_csv(TABLE).expect("a table");
    let leap_day = 60_369; // 2024-02-29
    let got = table.at(leap_day + 1, 7.0 * 3600.0).expect("held"); // 07:00: the third interval
    assert_eq!((got.f107, got.f107a), (103.0, 154.0));
    // 12 to 33 h before: intervals 4 to 11 back; 36 to 57 h: 12 to 19 back
    let first = [37.0, 36.0, 35.0, 34.0, 33.0, 32.0, 31.0, 28.0].iter().sum::<f64>() / 8.0;
    let second = [27.0, 26.0, 25.0, 24.0, 23.0, 22.0, 21.0, 18.0].iter().sum::<f64>() / 8.0;
    assert_eq!(got.activity, MagneticActivity::History([44.0, 43.0, 42.0, 41.0, 38.0, first, second]));
    let daily = table.clone().daily().at(leap_day, 0.0).expect("held");
    assert_eq!(daily.activity, MagneticActivity::Daily(34.0));

    // the next day needs the missing flux, the day after the last is not in the table
    let missing = table.at(leap_day + 2, 0.0).expect_err("a gap").to_string();
    assert!(missing.contains("F10.7_OBS of 2024-03-01 is missing"), "{missing}");
    let outside = table.at(leap_day + 3, 0.0).expect_err("after the end").to_string();
    assert!(
        outside.contains("2024-03-03 is outside the table, which covers 2024-02-27 to 2024-03-02"),
        "{outside}"
    );
    assert!(matches!(table.at(leap_day - 2, 0.0), Err(AtmosphereError::OutsideTable { .. })));
    // likewise a run on such a day
    let air = Nrlmsise00::new(SpaceWeather::Table(table));
    let at = |epoch: &str| density(&air, &earth(epoch), 0.0, [400.0, 10.0, 20.0]);
    assert!(at("2024-03-01T07:00:00 UTC").is_ok());
    assert!(matches!(at("2024-03-02T07:00:00 UTC"), Err(AtmosphereError::MissingSpaceWeather { .. })));
    assert!(matches!(at("2023-03-02T07:00:00 UTC"), Err(AtmosphereError::OutsideTable { .. })));
}

#[test]
fn errors_of_tables_name_the_line() {
    let refused = |text: &str| SpaceWeatherTable::from_csv(text).expect_err("broken").to_string();
    assert!(refused("").contains("line 1: the table is empty"));
    assert!(refused("DATE,AP_AVG,F10.7_OBS\n").contains("no column F10.7_OBS_CENTER81"));
    let one = |row: &str| refused(&format!("DATE,AP_AVG,F10.7_OBS,F10.7_OBS_CENTER81\n{row}"));
    assert!(one("").contains("line 2: the table has no rows"));
    assert!(refused("\n\nDATE\n").contains("line 3: the header has no column"));
    assert!(
        refused("\n\nDATE,AP_AVG,F10.7_OBS,F10.7_OBS_CENTER81").contains("line 4: the table has no rows")
    );
    assert!(one("2023-02-29,4,150,150").contains("line 2: DATE is '2023-02-29'; expected a date"));
    // the sum of days overflowed
    assert!(one("2024-03-9223372036854775807,4,150,150").contains("expected a date such as 2024-03-01"));
    assert!(one("9223372036854775807-03-01,4,150,150").contains("expected a date such as 2024-03-01"));
    // a truncated download, and CelesTrak's mark of a gap
    assert!(
        one("2023-02-28,4,150,150\n2023-03-01,4,1")
            .contains("line 3: the row has 3 fields, but the header has 4")
    );
    assert!(one("2023-02-28,4,999.9,150").contains("F10.7_OBS is '999.9'"));
    assert!(one("2023-02-28,401,150,150").contains("Ap, not Kp"));
    assert!(one("2023-02-28,four,150,150").contains("AP_AVG is 'four'"));
    assert!(one("2023-02-28,4,-150,150").contains("F10.7_OBS is '-150'"));
    assert!(
        one("2023-02-28,4,150,150\n2023-03-02,4,150,150")
            .contains("2023-03-02 is not the day after 2023-02-28")
    );
}

#[test]
fn around_the_start_of_a_step_every_model_keeps_its_stated_error() {
    let earth = earth("2014-03-01T06:00:00 UTC");
    let models: [&dyn Atmosphere; 2] = [&HarrisPriester::default(), &constant(150.0, 150.0, &[15.0])];
    for air in models {
        let mut worst = 0.0_f64;
        for k in 0..200 {
            let angle = f64::from(k) * 0.7;
            let altitude = 155e3 + 4e3 * f64::from(k);
            let place = Geodetic { latitude: 1.5 * angle.sin(), longitude: angle, altitude };
            let centre = earth.rot_fi(5.0).tr_mul(&place.position(&WGS84));
            let local = LocalAtmosphere::new(air, &earth, 5.0, &centre).expect("outside");
            for side in [-159.0, 159.0] {
                let (s, c) = (2.0 * angle).sin_cos();
                let r = centre + nalgebra::Vector3::new(c * s, s * s, c) * side;
                let exact =
                    air.density(&AtmospherePoint::new(&earth, 5.0, &r).expect("outside")).expect("air");
                worst = worst.max((local.density(&r).expect("near") / exact - 1.0).abs());
            }
        }
        println!("{}: {worst:.1e}", air.name());
        assert!(worst < 1e-4);
    }
}

#[test]
fn models_are_valid_up_to_their_highest_altitude() {
    let earth = earth("2014-03-01T06:00:00 UTC");
    let at = |altitude: f64| {
        let place = Geodetic { latitude: 0.3, longitude: 0.2, altitude };
        let centre = earth.rot_fi(0.0).tr_mul(&place.position(&WGS84));
        LocalAtmosphere::new(&HarrisPriester::default(), &earth, 0.0, &centre).map(|air| (air, centre))
    };
    for altitude in [100_001.0, 999_999.0] {
        let (air, centre) = at(altitude).expect("within");
        let below = centre * (1.0 - 50.0 / centre.norm());
        assert!(air.density(&below).expect("near") > air.density(&centre).expect("near"));
    }
    assert!(matches!(at(1_000_001.0), Err(AtmosphereError::OutsideLayers { .. })));
}
