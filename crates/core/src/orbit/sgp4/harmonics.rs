//! Coefficients of the Earth's longitude harmonics for resonant orbits.
//!
//! Source: Spacetrack Report #3, section 7: eccentricity functions `Gₗₚᵩ`, inclination functions `Fₗₘₚ`,
//! amplitudes and phases of the harmonics.

use nalgebra::Complex;

/// Term of the rate of the mean motion, `d sin(p ω + q λ - φ)`, rad/min², with the amplitude `d`, the phase
/// `φ`, the argument of perigee `ω` and the resonant longitude `λ`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Harmonic {
    /// Complex amplitude `d e⁻ⁱᵠ`, where the exponent contains the phase `φ`.
    pub(super) d: Complex<f64>,
    /// Multiple of the argument of perigee, -1 to 2.
    pub(super) p: i8,
    /// Multiple of the resonant longitude, 1 to 3.
    pub(super) q: u8,
}

impl Harmonic {
    fn new(d: f64, p: i8, q: u8, phase: f64) -> Self {
        Self { d: Complex::from_polar(d, -phase), p, q }
    }
}

/// Returns the resonant terms for orbits with one revolution per day, which are due to the harmonics (2,2),
/// (3,1) and (3,3). `n` is the mean motion, rad/min, `a` the reciprocal of the semi-major axis, 1/Earth
/// radii, `e` the eccentricity and `i` the inclination, rad.
pub(super) fn day(n: f64, a: f64, e: f64, i: f64) -> Vec<Harmonic> {
    let ((sin, cos), e2) = (i.sin_cos(), e * e);
    let (g200, g310) = (1.0 + e2 * (-2.5 + 0.8125 * e2), 1.0 + 2.0 * e2);
    let g300 = 1.0 + e2 * (-6.0 + 6.60937 * e2);
    let up = 1.0 + cos;
    let f220 = 0.75 * up * up;
    let f311 = 0.9375 * sin * sin * (1.0 + 3.0 * cos) - 0.75 * up;
    let f330 = 1.875 * up * up * up;
    let k = 3.0 * n * n * a * a;
    let harmonic = |d, q: u8, phase| Harmonic::new(d, 0, q, f64::from(q) * phase);
    vec![
        harmonic(k * f311 * g310 * 2.146_074_8e-6 * a, 1, 0.131_309_08),
        harmonic(2.0 * k * f220 * g200 * 1.789_167_9e-6, 2, 2.884_319_8),
        harmonic(3.0 * k * f330 * g300 * 2.212_301_5e-7 * a, 3, 0.374_480_87),
    ]
}

/// Returns the resonant terms for orbits with two revolutions per day, which are due to harmonics of orders 2
/// and 4 and degrees 2 to 5. The arguments are those of [`day`].
pub(super) fn half_day(n: f64, a: f64, e: f64, i: f64) -> Vec<Harmonic> {
    let (sin, cos) = i.sin_cos();
    let (e2, s2, c2) = (e * e, sin * sin, cos * cos);
    // eccentricity functions, fitted piecewise; the order of summation matters because terms nearly cancel
    let fit = |[c0, c1, c2, c3]: [f64; 4]| c0 + c1 * e + c2 * e2 + c3 * (e * e2);
    let pick = |is_low, low, high| fit(if is_low { low } else { high });
    let g201 = -0.306 - (e - 0.64) * 0.440;
    let low = e <= 0.65;
    let g211 = pick(low, [3.616, -13.247, 16.29, 0.0], [-72.099, 331.819, -508.738, 266.724]);
    let g310 = pick(low, [-19.302, 117.39, -228.419, 156.591], [-346.844, 1582.851, -2415.925, 1246.113]);
    let g322 =
        pick(low, [-18.9068, 109.7927, -214.6334, 146.5816], [-342.585, 1554.908, -2366.899, 1215.972]);
    let g410 = pick(low, [-41.122, 242.694, -471.094, 313.953], [-1052.797, 4758.686, -7193.992, 3651.957]);
    let g422 = pick(low, [-146.407, 841.88, -1629.014, 1083.435], [-3581.69, 16178.11, -24462.77, 12422.52]);
    let g520_high =
        if e > 0.715 { [-5149.66, 29936.92, -54087.36, 31324.56] } else { [1464.74, -4664.75, 3763.64, 0.0] };
    let g520 = pick(low, [-532.114, 3017.977, -5740.032, 3708.276], g520_high);
    let low = e < 0.7;
    let g533 =
        pick(low, [-919.2277, 4988.61, -9064.77, 5542.21], [-37995.78, 161616.52, -229838.2, 109377.94]);
    let g521 = pick(
        low,
        [-822.71072, 4568.6173, -8491.4146, 5337.524],
        [-51752.104, 218913.95, -309468.16, 146349.42],
    );
    let g532 =
        pick(low, [-853.666, 4690.25, -8624.77, 5341.4], [-40023.88, 170470.89, -242699.48, 115605.82]);
    // inclination functions
    let f220 = 0.75 * (1.0 + 2.0 * cos + c2);
    let f221 = 1.5 * s2;
    let f321 = 1.875 * sin * (1.0 - 2.0 * cos - 3.0 * c2);
    let f322 = -1.875 * sin * (1.0 + 2.0 * cos - 3.0 * c2);
    let f441 = 35.0 * s2 * f220;
    let f442 = 39.375 * s2 * s2;
    let f522 =
        9.84375 * sin * (s2 * (1.0 - 2.0 * cos - 5.0 * c2) + 0.333_333_33 * (-2.0 + 4.0 * cos + 6.0 * c2));
    let f523 = sin
        * (4.921_875_12 * s2 * (-2.0 - 4.0 * cos + 10.0 * c2) + 6.562_500_12 * (1.0 + 2.0 * cos - 3.0 * c2));
    let f542 = 29.53125 * sin * (2.0 - 8.0 * cos + c2 * (-12.0 + 8.0 * cos + 10.0 * c2));
    let f543 = 29.53125 * sin * (-2.0 - 8.0 * cos + c2 * (12.0 + 8.0 * cos - 10.0 * c2));
    // d = 3 n² a⁻ˡ √(C² + S²) F G, doubled for order 4
    let k2 = 3.0 * (n * n) * (a * a);
    let (k3, k4, k5) = (k2 * a, k2 * a * a, k2 * a * a * a);
    let (r22, r32, r52) = (k2 * 1.789_167_9e-6, k3 * 3.739_379_2e-7, k5 * 1.142_863_9e-7);
    let (r44, r54) = (2.0 * k4 * 7.363_695_3e-9, 2.0 * k5 * 2.176_580_3e-9);
    let (g22, g32, g44, g52, g54) = (5.768_639_6, 0.952_408_98, 1.801_499_8, 1.050_833_0, 4.410_889_8);
    [
        (r22 * f220 * g201, 2, 1, g22),
        (r22 * f221 * g211, 0, 1, g22),
        (r32 * f321 * g310, 1, 1, g32),
        (r32 * f322 * g322, -1, 1, g32),
        (r44 * f441 * g410, 2, 2, g44),
        (r44 * f442 * g422, 0, 2, g44),
        (r52 * f522 * g520, 1, 1, g52),
        (r52 * f523 * g532, -1, 1, g52),
        (r54 * f542 * g521, 1, 2, g54),
        (r54 * f543 * g533, -1, 2, g54),
    ]
    .map(|(d, p, q, phase)| Harmonic::new(d, p, q, phase))
    .to_vec()
}
