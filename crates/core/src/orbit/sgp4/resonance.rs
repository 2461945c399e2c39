//! Orbits that keep step with the turning Earth: its longitude harmonics add up over months.
//!
//! Source: Spacetrack Report #3, section 7; AIAA 2006-6753, appendix B.

use super::constants::{Earth, Mean};
use std::f64::consts::TAU;

/// Turn of the Earth, rad/min.
pub(super) const EARTH_RATE: f64 = 4.375_269_088_011_299_66e-3;
/// Step of the integration, min.
const STEP: f64 = 720.0;

/// `ṅ = Σ d sin(p ω + q λ - φ)` in the resonant longitude `λ`, `λ̇ = n + λ̇₀`.
#[derive(Clone, Debug)]
pub(super) struct Resonance {
    kind: Kind,
    harmonics: Vec<Harmonic>,
    /// `λ` at the epoch, and what its rate has beside `n`.
    longitude: f64,
    drift: f64,
    n: f64,
    perigee: f64,
    perigee_rate: f64,
}

/// Which period is shared with the Earth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// `λ = M + Ω + ω - θ`.
    Day,
    /// `λ = M + 2 Ω - 2 θ`.
    HalfDay,
}

#[derive(Clone, Copy, Debug)]
struct Harmonic {
    d: f64,
    p: f64,
    q: f64,
    phase: f64,
}

/// Secular rates of the angles, rad/min: by the Earth, and by Sun and Moon.
pub(super) struct Rates {
    pub(super) anomaly: [f64; 2],
    pub(super) perigee: [f64; 2],
    pub(super) node: [f64; 2],
}

impl Resonance {
    /// `None` for periods that are neither a day nor, with eccentricity 0.5 and more, half of one.
    pub(super) fn new(mean: &Mean, rates: &Rates, sidereal: f64, earth: &Earth) -> Option<Self> {
        let Mean { n, e, i, node, perigee, anomaly } = *mean;
        let a = (n / earth.ke).powf(2.0 / 3.0); // 1/a
        let (Rates { anomaly: m, perigee: w, node: h }, theta) = (rates, sidereal);
        let (kind, harmonics, longitude, drift) = if 0.003_490_658_5 < n && n < 0.005_235_987_7 {
            let longitude = anomaly + node + perigee - theta;
            let drift = m[0] + (w[0] + h[0]) - EARTH_RATE + m[1] + w[1] + h[1] - n;
            (Kind::Day, day(n, a, e, i), longitude, drift)
        } else if (8.26e-3..=9.24e-3).contains(&n) && e >= 0.5 {
            let longitude = anomaly + node + node - theta - theta;
            let drift = m[0] + m[1] + 2.0 * (h[0] + h[1] - EARTH_RATE) - n;
            (Kind::HalfDay, half_day(n, a, e, i), longitude, drift)
        } else {
            return None;
        };
        let perigee_rate = w[0];
        Some(Self { kind, harmonics, longitude: longitude % TAU, drift, n, perigee, perigee_rate })
    }

    /// Puts mean motion and mean anomaly at `t` minutes into `mean`; `theta` is the sidereal time then.
    ///
    /// Euler-Maclaurin steps of 720 min from the epoch at every call, so that a time has one state whatever
    /// was asked before.
    pub(super) fn apply(&self, t: f64, theta: f64, mean: &mut Mean) {
        let step = STEP.copysign(t);
        let (mut time, mut longitude, mut n) = (0.0, self.longitude, self.n);
        while (t - time).abs() >= STEP {
            let [rate, n1, n2] = self.slopes(time, longitude, n);
            // λ += λ̇ h + ṅ h²/2,  n += ṅ h + n̈ h²/2
            longitude = longitude + rate * step + n1 * (0.5 * STEP * STEP);
            n = n + n1 * step + n2 * (0.5 * STEP * STEP);
            time += step;
        }
        let ([rate, n1, n2], rest) = (self.slopes(time, longitude, n), t - time);
        let l = longitude + rate * rest + n1 * rest * rest * 0.5;
        mean.n = n + n1 * rest + n2 * rest * rest * 0.5;
        mean.anomaly = match self.kind {
            Kind::Day => l - mean.node - mean.perigee + theta,
            Kind::HalfDay => l - 2.0 * mean.node + 2.0 * theta,
        };
    }

    /// `λ̇`, `ṅ`, `n̈`.
    fn slopes(&self, time: f64, longitude: f64, n: f64) -> [f64; 3] {
        let (perigee, rate) = (self.perigee + self.perigee_rate * time, n + self.drift);
        let (mut n1, mut n2) = (0.0, 0.0);
        for Harmonic { d, p, q, phase } in &self.harmonics {
            let (sin, cos) = (p * perigee + q * longitude - phase).sin_cos();
            n1 += d * sin;
            n2 += q * d * cos;
        }
        [rate, n1, n2 * rate]
    }
}

/// One revolution a day: harmonics (2,2), (3,1) and (3,3).
fn day(n: f64, a: f64, e: f64, i: f64) -> Vec<Harmonic> {
    let ((sin, cos), e2) = (i.sin_cos(), e * e);
    let (g200, g310) = (1.0 + e2 * (-2.5 + 0.8125 * e2), 1.0 + 2.0 * e2);
    let g300 = 1.0 + e2 * (-6.0 + 6.60937 * e2);
    let up = 1.0 + cos;
    let f220 = 0.75 * up * up;
    let f311 = 0.9375 * sin * sin * (1.0 + 3.0 * cos) - 0.75 * up;
    let f330 = 1.875 * up * up * up;
    let k = 3.0 * n * n * a * a;
    let harmonic = |d, q, phase: f64| Harmonic { d, p: 0.0, q, phase: q * phase };
    vec![
        harmonic(k * f311 * g310 * 2.146_074_8e-6 * a, 1.0, 0.131_309_08),
        harmonic(2.0 * k * f220 * g200 * 1.789_167_9e-6, 2.0, 2.884_319_8),
        harmonic(3.0 * k * f330 * g300 * 2.212_301_5e-7 * a, 3.0, 0.374_480_87),
    ]
}

/// Two revolutions a day: harmonics of order 2 and 4, degrees 2 to 5.
fn half_day(n: f64, a: f64, e: f64, i: f64) -> Vec<Harmonic> {
    let (sin, cos) = i.sin_cos();
    let (e2, s2, c2) = (e * e, sin * sin, cos * cos);
    // eccentricity functions, fitted piece by piece; summed in this order since their terms nearly cancel
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
    // d = 3 n² a⁻ˡ √(C² + S²) F G, once more for order 4
    let k2 = 3.0 * (n * n) * (a * a);
    let (k3, k4, k5) = (k2 * a, k2 * a * a, k2 * a * a * a);
    let (r22, r32, r52) = (k2 * 1.789_167_9e-6, k3 * 3.739_379_2e-7, k5 * 1.142_863_9e-7);
    let (r44, r54) = (2.0 * k4 * 7.363_695_3e-9, 2.0 * k5 * 2.176_580_3e-9);
    let (g22, g32, g44, g52, g54) = (5.768_639_6, 0.952_408_98, 1.801_499_8, 1.050_833_0, 4.410_889_8);
    [
        (r22 * f220 * g201, 2.0, 1.0, g22),
        (r22 * f221 * g211, 0.0, 1.0, g22),
        (r32 * f321 * g310, 1.0, 1.0, g32),
        (r32 * f322 * g322, -1.0, 1.0, g32),
        (r44 * f441 * g410, 2.0, 2.0, g44),
        (r44 * f442 * g422, 0.0, 2.0, g44),
        (r52 * f522 * g520, 1.0, 1.0, g52),
        (r52 * f523 * g532, -1.0, 1.0, g52),
        (r54 * f542 * g521, 1.0, 2.0, g54),
        (r54 * f543 * g533, -1.0, 2.0, g54),
    ]
    .map(|(d, p, q, phase)| Harmonic { d, p, q, phase })
    .to_vec()
}
