//! Checks that batches of orbits agree with single orbits for any number of threads, and that errors name the
//! orbit.

use onorbit_core::batch::{InputError, Times, kepler_states, propagate};
use onorbit_core::orbit::sgp4::Sgp4Error;
use onorbit_core::orbit::{Elements, FixedFrame, Kepler, MeanElements, Orbit, OrbitError, Phase, Sgp4, Size};
use std::sync::Arc;

fn tle(line1: &str, line2: &str) -> Sgp4 {
    Sgp4::new(MeanElements::from_tle(line1, line2, true).expect("a TLE"), Default::default())
}

/// Low and eccentric orbits with all drag terms, and deep space: from the published verification set.
fn orbits() -> Vec<Arc<dyn Orbit>> {
    let ellipse = |e| Elements {
        phase: Phase::MeanAnomaly(1.0),
        epoch: 33.0,
        ..Elements::new(Size::SemiMajorAxis(9e6), e)
    };
    vec![
        Arc::new(tle(
            "1 00005U 58002B   00179.78495062  .00000023  00000-0  28098-4 0  4753",
            "2 00005  34.2682 348.7242 1859667 331.7664  19.3264 10.82419157413667",
        )),
        Arc::new(tle(
            "1 06251U 62025E   06176.82412014  .00008885  00000-0  12808-3 0  3985",
            "2 06251  58.0579  54.0425 0030035 139.1568 221.1854 15.56387291  6774",
        )),
        Arc::new(tle(
            "1 11801U          80230.29629788  .01431103  00000-0  14311-1      13",
            "2 11801  46.7916 230.4354 7318036  47.4722  10.4117  2.28537848    13",
        )),
        Arc::new(Kepler::new(&ellipse(0.0)).expect("a circle")),
        Arc::new(Kepler::new(&ellipse(0.3)).expect("an ellipse")),
        Arc::new(
            Kepler::new(&Elements {
                phase: Phase::PeriapsisTime(5.0),
                ..Elements::new(Size::SemiMajorAxis(-9e6), 1.3)
            })
            .expect("a hyperbola"),
        ),
        Arc::new(
            Kepler::new(&ellipse(0.1)).and_then(|k| k.with_secular_j2(1e-3, 6.4e6)).expect("an ellipse"),
        ),
    ]
}

#[test]
fn every_kind_agrees_with_one_state_at_a_time() {
    let (orbits, times): (_, Vec<f64>) = (orbits(), (0..101).map(|k| 600.0 * f64::from(k) - 2e4).collect());
    let count = 3 * orbits.len() * times.len();
    let run = |times: Times<'_>, threads| {
        let (mut r, mut v) = (vec![0.0; count], vec![0.0; count]);
        propagate(&orbits, times, &mut r, &mut v, threads).expect("states");
        (r, v)
    };
    let all = run(Times::Common(&times), None);
    let each: Vec<f64> = orbits.iter().flat_map(|_| times.clone()).collect();
    assert_eq!(all, run(Times::Common(&times), Some(1)));
    assert_eq!(all, run(Times::Each(&each), Some(2)));
    for (index, orbit) in orbits.iter().enumerate() {
        for (k, &t) in times.iter().enumerate() {
            let (r, v) = orbit.position_velocity(t).expect("a state");
            let at = 3 * (index * times.len() + k);
            for c in 0..3 {
                // 4 roundings of the position, and the effect of rounding a phase of 1e5 rad
                assert!(
                    (all.0[at + c] - r[c]).abs() < 2e-7,
                    "orbit {index} at {t} s: {} m",
                    all.0[at + c] - r[c]
                );
                assert!(
                    (all.1[at + c] - v[c]).abs() < 3e-10,
                    "orbit {index} at {t} s: {} m/s",
                    all.1[at + c] - v[c]
                );
            }
        }
    }
}

#[test]
fn the_first_orbit_refused_is_named_and_so_is_the_time() {
    let mut orbits = orbits();
    orbits.insert(
        2,
        Arc::new(tle(
            // these elements are valid for a short time only
            "1 28350U 04020A   06167.21788666  .16154492  76267-5  18678-3 0  8894",
            "2 28350  64.9977 345.6130 0024870 260.7578  99.9590 16.47856722116490",
        )),
    );
    let times: Vec<f64> = (0..200).map(|k| 600.0 * f64::from(k)).collect();
    let (mut r, mut v) = (vec![0.0; 3 * 200 * orbits.len()], vec![0.0; 3 * 200 * orbits.len()]);
    let error = propagate(&orbits, Times::Common(&times), &mut r, &mut v, None).expect_err("decays");
    let first = times.iter().find_map(|&t| orbits[2].position_velocity(t).err()).expect("decays");
    assert!(matches!(first, OrbitError::Sgp4(Sgp4Error::MeanEccentricity { .. })), "{first}");
    assert_eq!(error, InputError::Orbit { orbit: 2, source: first });
    assert!(error.to_string().starts_with("orbit 2: SGP4 error 1 at t = "), "{error}");

    let times = [f64::NAN];
    let (mut r, mut v) = (vec![0.0; 3 * orbits.len()], vec![0.0; 3 * orbits.len()]);
    let error = propagate(&orbits, Times::Common(&times), &mut r, &mut v, Some(1)).expect_err("no time");
    assert!(
        matches!(error, InputError::Orbit { orbit: 0, source: OrbitError::NotFinite { .. } }),
        "{error:?}"
    );
    assert_eq!(
        propagate(&orbits, Times::Common(&times), &mut r, &mut v, Some(0)),
        Err(InputError::NoThreads)
    );
    let short = propagate(&orbits, Times::Common(&times), &mut r[3..], &mut v, None);
    assert!(matches!(short, Err(InputError::WrongTotal { name: "positions", .. })));
}

#[test]
fn empty_batches_of_orbits_and_times_are_accepted() {
    let still: Vec<Arc<dyn Orbit>> = vec![Arc::new(
        FixedFrame::new(nalgebra::Vector3::x(), nalgebra::UnitQuaternion::identity(), None).expect("finite"),
    )];
    propagate(&still, Times::Common(&[]), &mut [], &mut [], None).expect("nothing");
    propagate(&[], Times::Common(&[1.0]), &mut [], &mut [], None).expect("nothing");
}

#[test]
fn ellipses_from_elements_agree_with_kepler() {
    let (count, mu) = (1003, 3.986e14);
    let column = |scale: f64, offset: f64| -> Vec<f64> {
        (0..count).map(|k| offset + scale * (0.618_033_988 * f64::from(k)).fract()).collect()
    };
    let columns = [
        column(3e7, 7e6),
        column(0.99, 0.0),
        column(3.1, 0.0),
        column(6.2, 0.1),
        column(6.0, -2.0),
        column(20.0, -10.0),
        column(1e5, -5e4),
    ];
    let (mut r, mut v) = (vec![0.0; 3 * count as usize], vec![0.0; 3 * count as usize]);
    let slices: [&[f64]; 7] = std::array::from_fn(|k| &columns[k][..]);
    kepler_states(slices, mu, &mut r, &mut v, None).expect("states");
    for k in 0..count as usize {
        let [a, eccentricity, inclination, raan, argument_of_periapsis, anomaly, t] =
            std::array::from_fn(|c| columns[c][k]);
        let orbit = Kepler::new(&Elements {
            size: Size::SemiMajorAxis(a),
            eccentricity,
            inclination,
            raan,
            argument_of_periapsis,
            phase: Phase::MeanAnomaly(anomaly),
            mu,
            epoch: 0.0,
        });
        let (p, w) = orbit.expect("an orbit").position_velocity(t).expect("a state");
        for c in 0..3 {
            // the rounding of a phase of 1e2 rad, times ten at the periapsis
            assert!((r[3 * k + c] - p[c]).abs() < 1e-6, "{k}: {}", r[3 * k + c] - p[c]);
            assert!((v[3 * k + c] - w[c]).abs() < 1e-8, "{k}: {}", v[3 * k + c] - w[c]);
        }
    }
    let wrong = |a: f64, e: f64, mu: f64| {
        let given: [&[f64]; 7] = [&[a], &[e], &[0.0], &[0.0], &[0.0], &[0.0], &[0.0]];
        kepler_states(given, mu, &mut [0.0; 3], &mut [0.0; 3], None).expect_err("refused").to_string()
    };
    assert!(wrong(-7e6, 0.1, mu).starts_with("semi_major_axis is -7000000; it must be positive"));
    assert!(wrong(7e6, 1.0, mu).starts_with("eccentricity is 1; it must be"));
    let each: [&[f64]; 7] = [&[7e6, -7e6], &[0.1], &[0.0], &[0.0], &[0.0], &[0.0], &[0.0]];
    let second =
        kepler_states(each, mu, &mut [0.0; 6], &mut [0.0; 6], None).expect_err("refused").to_string();
    assert!(second.starts_with("semi_major_axis is -7000000 in state 1;"), "{second}");
    assert!(wrong(7e6, 0.1, 0.0).starts_with("mu is 0"));
    assert!(wrong(7e6, f64::NAN, mu).contains("eccentricity' holds NaN; expected"));
    let each: [&[f64]; 7] = [&[7e6, f64::INFINITY], &[0.1], &[0.0], &[0.0], &[0.0], &[0.0], &[0.0]];
    let second =
        kepler_states(each, mu, &mut [0.0; 6], &mut [0.0; 6], None).expect_err("refused").to_string();
    assert!(second.contains("semi_major_axis' holds inf in state 1;"), "{second}");
}
