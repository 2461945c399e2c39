//! Precession and nutation of the Earth's pole.
//!
//! Angles are in rad and `T` is in Julian centuries of TT from J2000.0 (2000-01-01T12:00:00 TT).

use nalgebra::Vector3;

use super::nutation_table::NUTATION;
use super::rotation::{r1, r3};

/// One arc second, rad.
pub(super) const ARC_SECOND: f64 = std::f64::consts::PI / 648_000.0;

/// Returns the value of the polynomial `c₀ + c₁ T + c₂ T² + …` at `T` = `t`.
pub(super) fn polynomial(coefficients: &[f64], t: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

/// Returns the fundamental arguments `l, l', F, D, Ω` of the motion of Moon and Sun, rad.
///
/// Source: Simon and others, Astronomy and Astrophysics 282, 1994; IERS Conventions (2010), eq. 5.43.
pub(super) fn arguments(t: f64) -> [f64; 5] {
    const ARC_SECONDS: [[f64; 5]; 5] = [
        [485_868.249_036, 1_717_915_923.217_8, 31.879_2, 0.051_635, -0.000_244_70],
        [1_287_104.793_05, 129_596_581.048_1, -0.553_2, 0.000_136, -0.000_011_49],
        [335_779.526_232, 1_739_527_262.847_8, -12.751_2, -0.001_037, 0.000_004_17],
        [1_072_260.703_69, 1_602_961_601.209, -6.370_6, 0.006_593, -0.000_031_69],
        [450_160.398_036, -6_962_890.543_1, 7.472_2, 0.007_702, -0.000_059_39],
    ];
    ARC_SECONDS.map(|c| (polynomial(&c, t) % 1_296_000.0) * ARC_SECOND)
}

/// Returns the Fukushima-Williams angles `γ̄, φ̄, ψ̄, ε_A` of the mean ecliptic and equator of date, with
/// frame bias, rad.
///
/// Source: Capitaine and others, Astronomy and Astrophysics 450, 2006, eq. 37-40 (IAU 2006).
pub(super) fn precession(t: f64) -> [f64; 4] {
    const ARC_SECONDS: [[f64; 6]; 4] = [
        [-0.052_928, 10.556_378, 0.493_204_4, -0.000_312_38, -0.000_002_788, 0.000_000_026],
        [84_381.412_819, -46.811_016, 0.051_126_8, 0.000_532_89, -0.000_000_44, -0.000_000_017_6],
        [-0.041_775, 5_038.481_484, 1.558_417_5, -0.000_185_22, -0.000_026_452, -0.000_000_014_8],
        [84_381.406, -46.836_769, -0.000_183_1, 0.002_003_4, -0.000_000_576, -0.000_000_043_4],
    ];
    ARC_SECONDS.map(|c| polynomial(&c, t) * ARC_SECOND)
}

/// Returns the nutation in longitude and obliquity, `Δψ, Δε`, rad, from the lunisolar terms of at least 0.1
/// mas.
fn nutation(t: f64, arguments: &[f64; 5]) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for (multiples, c) in &NUTATION {
        let angle: f64 = multiples.iter().zip(arguments).map(|(k, a)| f64::from(*k) * a).sum();
        let (sine, cosine) = angle.sin_cos();
        // Δψ = Σ (A + A' T) sin θ + A'' cos θ,  Δε = Σ (B + B' T) cos θ + B'' sin θ
        sum[0] += (c[0] + c[1] * t) * sine + c[2] * cosine;
        sum[1] += (c[3] + c[4] * t) * cosine + c[5] * sine;
    }
    sum.map(|x| x * 1e-6 * ARC_SECOND)
}

/// Returns the coordinates `X, Y` of the celestial intermediate pole in GCRF and the CIO locator `s`, rad, at
/// `t`, Julian centuries of TT from J2000.0.
///
/// `X` and `Y` are the first two elements of the last row of `R₁(-ε_A - Δε) R₃(-ψ̄ - Δψ) R₁(φ̄) R₃(γ̄)`.
///
/// Source: IERS Conventions (2010), section 5.6.4 and table 5.2d. Of the series for `s`, only the polynomial
/// and the periodic terms with constant amplitudes above 10 µas are computed. The largest term that is
/// omitted, `743.52 t² sin Ω` µas with the longitude `Ω` of the Moon's node, reaches about 55 µas in 2027.
pub(super) fn pole(t: f64) -> Vector3<f64> {
    const S: [f64; 6] = [94.0, 3_808.65, -122.68, -72_574.11, 27.98, 15.62];
    let arguments = arguments(t);
    let [gamma, phi, psi, epsilon] = precession(t);
    let [d_psi, d_epsilon] = nutation(t, &arguments);
    // R₁(-ε_A - Δε) R₃(-ψ̄ - Δψ) R₁(φ̄) R₃(γ̄)
    let equator = r1(-epsilon - d_epsilon) * r3(-psi - d_psi) * r1(phi) * r3(gamma);
    let (x, y) = (equator[(2, 0)], equator[(2, 1)]);
    // s = -XY/2 + polynomial + Σ C sin θ
    let [_, _, f, d, omega] = arguments;
    let sines = -2_640.73 * omega.sin()
        - 63.53 * (2.0 * omega).sin()
        - 11.75 * (2.0 * f - 2.0 * d + 3.0 * omega).sin()
        - 11.21 * (2.0 * f - 2.0 * d + omega).sin();
    let s = (polynomial(&S, t) + sines) * 1e-6 * ARC_SECOND - 0.5 * x * y;
    Vector3::new(x, y, s)
}
