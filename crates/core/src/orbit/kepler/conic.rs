//! Motion in the orbital plane as a function of the time since an instant with a known phase.
//!
//! Perifocal axes: x towards the periapsis, y along the velocity at the periapsis.

use std::f64::consts::{PI, TAU};

use super::anomaly;
use super::double::{self, Double};
use crate::orbit::OrbitError;
use crate::orbit::error::positive;
use crate::spatial::Real;

/// Size and shape of a conic. Each field has full relative accuracy. `1 - e` is stored as well,
/// because its computation from a rounded `e` would lose digits near a parabola.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shape {
    /// Eccentricity `e`.
    pub(super) e: f64,
    /// `1 - e`, negative on a hyperbola.
    pub(super) one_minus_e: f64,
    /// Periapsis distance `q`, m.
    pub(super) periapsis: f64,
    /// `1/a`, 1/m; zero on a parabola, negative on a hyperbola.
    pub(super) inverse_axis: Double,
}

/// Value of `|1 - e|` below which the orbit is treated as a parabola.
pub(super) const PARABOLIC: f64 = 1e-30;

/// Position and velocity in perifocal axes, m and m/s.
#[derive(Clone, Copy, Debug)]
pub(super) struct PerifocalState<S = f64> {
    pub(super) x: S,
    pub(super) y: S,
    pub(super) vx: S,
    pub(super) vy: S,
}

/// Ellipse with its semi-axes `a` and `b`, m, and the velocity scales `√(μ a)` and `√(μ p)`, m²/s, with the
/// semi-latus rectum `p`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ellipse<S> {
    pub(super) e: S,
    pub(super) one_minus_e: S,
    pub(super) periapsis: S,
    pub(super) a: S,
    pub(super) b: S,
    pub(super) velocity_scale: [S; 2],
}

impl<S: Real> Ellipse<S> {
    /// Returns the state in perifocal axes at the mean anomaly `mean` in [-π, π], rad.
    #[inline(always)]
    pub(super) fn at(&self, mean: S) -> PerifocalState<S> {
        let Self { e, one_minus_e, periapsis: q, a, b, velocity_scale } = *self;
        let half = anomaly::solve_ellipse(e, one_minus_e, mean);
        let (s, c) = (half.sin, half.cos);
        // r = a (1 - e cos E) = q + 2 a e sin²(E/2)
        let versed = S::of(2.0) * s * s;
        let sin = S::of(2.0) * s * c;
        let over_r = S::of(1.0) / (q + a * e * versed);
        // x = a (cos E - e), y = b sin E, ẋ = -√(μ a) sin E / r, ẏ = √(μ p) cos E / r
        PerifocalState {
            x: q - a * versed,
            y: b * sin,
            vx: -velocity_scale[0] * sin * over_r,
            vy: velocity_scale[1] * (S::of(1.0) - versed) * over_r,
        }
    }
}

/// Period of revolution, s, also stored as the sum of three `pieces`. The first two have 26 bits, so that
/// their multiples up to 2²⁶ are exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Period {
    pub(super) seconds: f64,
    per_second: f64,
    pieces: [f64; 3],
}

/// Largest number of whole periods that are subtracted exactly.
const MOST_PERIODS: f64 = 67_108_864.0;

/// Longest time that can be evaluated on an open orbit, s: more than twice the age of the universe.
const LONGEST_TIME: f64 = 1e18;

impl Period {
    fn new(period: Double) -> Self {
        let head = |x: f64| f64::from_bits(x.to_bits() & !((1 << 27) - 1));
        let first = head(period.hi);
        let rest = period - Double::from(first);
        let second = head(rest.hi);
        let third = (rest - Double::from(second)).hi;
        Self { seconds: period.hi, per_second: 1.0 / period.hi, pieces: [first, second, third] }
    }

    /// Returns the time `dt`, s, less the nearest whole number of periods.
    #[inline(always)]
    fn reduce<S: Real>(&self, dt: S) -> S {
        // adding 1.5 × 2⁵² rounds to an integer without a library call
        const ROUND: f64 = 6_755_399_441_055_744.0;
        let k = (dt * S::of(self.per_second) + S::of(ROUND)) - S::of(ROUND);
        let [first, second, third] = self.pieces.map(|piece| k * S::of(piece));
        ((dt - first) - second) - third
    }
}

/// Kind of conic, with the constants of the motion along the conic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Conic {
    /// Ellipse, `e < 1`, with the semi-axes `a` and `b`, m; the phase is the mean anomaly, rad.
    Ellipse {
        a: f64,
        b: f64,
        /// Mean motion `n = √(μ/a³)`, rad/s.
        n: f64,
        period: Period,
        /// `√(μ a)` and `√(μ p)`, m²/s.
        velocity_scale: [f64; 2],
    },
    /// Parabola, `e = 1`; the phase is the time since periapsis, s.
    Parabola {
        /// Rate of `B` in Barker's equation, `√(μ/(2 q³))`, 1/s.
        n: f64,
        /// Half the speed at periapsis, `√(μ/(2 q))`, m/s.
        speed: f64,
    },
    /// Hyperbola, `e > 1`; the phase is the time since periapsis, s. The semi-axes `a` and `b`, m, are
    /// positive (`n = √(μ/|a|³)`); the other fields are defined as for the ellipse.
    Hyperbola { a: f64, b: f64, n: f64, velocity_scale: [f64; 2] },
}

impl Conic {
    pub(super) fn new(shape: &Shape, mu: f64) -> Result<Self, OrbitError> {
        let (e, q) = (shape.e, positive("periapsis distance", shape.periapsis)?);
        if shape.one_minus_e.abs() < PARABOLIC {
            let speed = (0.5 * mu / q).sqrt();
            let n = positive("mean motion", speed / q)?;
            return Ok(Self::Parabola { n, speed });
        }
        // |a|, b = |a| √|1 - e²|, n = √(μ/|a|³)
        let closed = shape.inverse_axis.hi > 0.0;
        let inverse = if closed { shape.inverse_axis } else { -shape.inverse_axis };
        let n = (Double::from(mu) * inverse * inverse * inverse).sqrt();
        positive("mean motion", n.hi)?;
        let a = (Double::from(1.0) / inverse).hi;
        let b = a * (shape.one_minus_e.abs() * (1.0 + e)).sqrt();
        let velocity_scale = (mu * a).sqrt();
        let velocity_scale = [velocity_scale, velocity_scale * (b / a)];
        if closed {
            Ok(Self::Ellipse { a, b, n: n.hi, period: Period::new(double::TAU / n), velocity_scale })
        } else {
            Ok(Self::Hyperbola { a, b, n: n.hi, velocity_scale })
        }
    }

    /// Returns the largest time from the epoch at which the state can be evaluated, s.
    pub(super) fn longest_time(&self) -> f64 {
        match self {
            Self::Ellipse { period, .. } => MOST_PERIODS * period.seconds,
            _ => LONGEST_TIME,
        }
    }

    /// Returns the phase `dt` s after the instant with the phase `phase`: the mean anomaly, rad, on an
    /// ellipse, otherwise the time since periapsis, s.
    pub(super) fn advance(&self, phase: f64, dt: f64) -> f64 {
        match self {
            Self::Ellipse { n, period, .. } => wrap(phase + n * period.reduce(dt)),
            _ => phase + dt,
        }
    }

    /// Returns the state on an ellipse in perifocal axes, `dt` s after the instant with the mean anomaly
    /// `phase`; `None` for an open orbit.
    #[inline(always)]
    pub(super) fn ellipse_state_at<S: Real>(
        &self,
        shape: &Shape,
        phase: f64,
        dt: S,
    ) -> Option<PerifocalState<S>> {
        let Self::Ellipse { a, b, n, period, velocity_scale } = self else { return None };
        let ellipse = Ellipse {
            e: S::of(shape.e),
            one_minus_e: S::of(shape.one_minus_e),
            periapsis: S::of(shape.periapsis),
            a: S::of(*a),
            b: S::of(*b),
            velocity_scale: velocity_scale.map(S::of),
        };
        Some(ellipse.at(wrap(S::of(phase) + S::of(*n) * period.reduce(dt))))
    }

    /// Returns the position and velocity in perifocal axes at a phase, which is defined as in
    /// [`Conic::advance`].
    pub(super) fn perifocal_state(&self, shape: &Shape, phase: f64) -> PerifocalState {
        let (e, q) = (shape.e, shape.periapsis);
        match *self {
            Self::Ellipse { a, b, velocity_scale, .. } => {
                Ellipse { e, one_minus_e: shape.one_minus_e, periapsis: q, a, b, velocity_scale }.at(phase)
            }
            Self::Hyperbola { a, b, n, velocity_scale } => {
                let half = anomaly::solve_hyperbola(e, -shape.one_minus_e, n * phase);
                let (s, c) = (half.sin, half.cos);
                // r = a (e cosh H - 1) = q + 2 a e sinh²(H/2)
                let versed = 2.0 * s * s;
                let sinh = 2.0 * s * c;
                let over_r = 1.0 / (q + a * e * versed);
                PerifocalState {
                    x: q - a * versed,
                    y: b * sinh,
                    vx: -velocity_scale[0] * sinh * over_r,
                    vy: velocity_scale[1] * (1.0 + versed) * over_r,
                }
            }
            Self::Parabola { n, speed } => {
                // D + D³/3 = √(μ/(2 q³)) (t - t_p)
                let d = anomaly::solve_parabola(n * phase);
                // x = q (1 - D²), y = 2 q D, ẋ = -√(μ/(2q)) 2 D/(1 + D²), ẏ = √(μ/(2q)) 2/(1 + D²)
                let along = 2.0 * speed / (1.0 + d * d);
                PerifocalState { x: q * (1.0 - d) * (1.0 + d), y: 2.0 * q * d, vx: -along * d, vy: along }
            }
        }
    }
}

/// Wraps an angle, rad, to [-π, π], for `|angle| ≤ 3π`.
#[inline(always)]
pub(super) fn wrap<S: Real>(angle: S) -> S {
    let (pi, turn) = (S::of(PI), S::of(TAU));
    let angle = S::select(S::less(pi, angle), angle - turn, angle);
    S::select(S::less(angle, -pi), angle + turn, angle)
}

/// Subtracts the nearest whole number of turns from an angle with a magnitude up to 1e15 rad.
pub(super) fn subtract_turns(angle: f64) -> f64 {
    let k = (angle / TAU).round();
    (-k).mul_add(double::TAU.lo, (-k).mul_add(TAU, angle))
}
