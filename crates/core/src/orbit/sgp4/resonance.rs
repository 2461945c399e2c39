//! Resonances with the rotation of the Earth, in which the effects of longitude harmonics accumulate over
//! months.
//!
//! Source: Spacetrack Report #3, section 7; AIAA 2006-6753, appendix B.

use super::constants::{Earth, Mean};
use super::harmonics::{Harmonic, day, half_day};
use nalgebra::Complex;
use std::f64::consts::TAU;

/// Rotation rate of the Earth, rad/min.
pub(super) const EARTH_RATE: f64 = 4.375_269_088_011_3e-3;
/// Step of the integration, min.
const STEP: f64 = 720.0;

/// Resonance with the Earth's rotation: `ṅ = Σ d sin(p ω + q λ - φ)` in the resonant longitude `λ`, `λ̇ = n +
/// λ̇₀`, with the mean motion `n`, the argument of perigee `ω` and the terms of [`Harmonic`].
#[derive(Clone, Debug)]
pub(super) struct Resonance {
    kind: Kind,
    harmonics: Vec<Harmonic>,
    /// Resonant longitude `λ` at the epoch, rad.
    longitude: f64,
    /// Offset `λ̇₀` of the rate of `λ`, rad/min.
    drift: f64,
    n: f64,
    perigee: f64,
    perigee_rate: f64,
}

/// Period of the resonance, and definition of the resonant longitude with the sidereal time `θ`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// A period of one day, with `λ = M + Ω + ω - θ`.
    Day,
    /// A period of half a day, with `λ = M + 2 Ω - 2 θ`.
    HalfDay,
}

/// Secular rates of the angles, rad/min: each pair holds the rate caused by the Earth's oblateness, which
/// includes the mean motion for the mean anomaly, and that caused by Sun and Moon.
pub(super) struct Rates {
    pub(super) anomaly: [f64; 2],
    pub(super) perigee: [f64; 2],
    pub(super) node: [f64; 2],
}

impl Resonance {
    /// Returns the resonance of an orbit with a period between 1200 and 1800 min (about one day), or between
    /// 680 and 760 min (about half a day) at an eccentricity of 0.5 or more; `None` for other orbits.
    /// `sidereal` is the sidereal time at the epoch, rad.
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

    /// Sets the mean motion and mean anomaly in `mean` to their values `t` minutes after the epoch, when the
    /// sidereal time is `theta`, rad.
    ///
    /// Each call integrates from the epoch in Euler-Maclaurin steps of 720 min, so that the result depends
    /// only on `t`.
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

    /// Returns `λ̇`, rad/min, `ṅ`, rad/min², and `n̈`, rad/min³, at `time` minutes after the epoch.
    fn slopes(&self, time: f64, longitude: f64, n: f64) -> [f64; 3] {
        let (perigee, rate) = (self.perigee + self.perigee_rate * time, n + self.drift);
        // d sin(p ω + q λ - φ) and its derivative with respect to λ are Im and q Re of d e⁻ⁱᵠ (eⁱʷ)ᵖ (eⁱˡ)ᵠ
        let (w, l) = (Complex::cis(perigee), Complex::cis(longitude));
        let (w, l) = ([w.conj(), Complex::ONE, w, w * w], [l, l * l, l * l * l]);
        let (mut n1, mut n2) = (0.0, 0.0);
        for Harmonic { d, p, q } in &self.harmonics {
            let wave = d * w[(p + 1) as usize] * l[usize::from(q - 1)];
            n1 += wave.im;
            n2 += f64::from(*q) * wave.re;
        }
        [rate, n1, n2 * rate]
    }
}
