//! C² curves through given attitudes.

use super::rotation::{Quat, exp_so3, log_so3};
use super::spline::{Ends, KnotInterval, Spline, SplineError, check_rows, check_times};
use super::vec3::Vec3;
use nalgebra::{Matrix3, Vector3};

/// Distance from half a turn, rad, within which the direction of rotation between two attitudes is treated as
/// ambiguous.
const HALF_TURN_MARGIN: f64 = 1e-6;

/// Spline `R(t) = Rk exp(φ(t))` from each attitude `Rk` to the next, where `φ`, rad, is the quintic
/// polynomial with the given angular velocities and accelerations at the knots.
///
/// With zero rates and accelerations at the knots each piece is a geodesic. Outside the knots the first or
/// last attitude is held.
#[derive(Clone, Debug, PartialEq)]
pub struct RotationSpline {
    times: Vec<f64>,
    pieces: Vec<Piece>,
}

/// Curve between two successive attitudes.
#[derive(Clone, Debug, PartialEq)]
struct Piece {
    start: Quat<f64>,
    /// `φ`, rad, and its first two time derivatives at the start of the piece.
    from: [Vec3<f64>; 3],
    /// `φ`, rad, and its first two time derivatives at the end of the piece.
    to: [Vec3<f64>; 3],
}

impl RotationSpline {
    /// Creates the spline through the attitudes (K,) at `times` (K,), s, that is at rest at every attitude.
    ///
    /// # Errors
    /// [`SplineError`] for fewer than two points, wrong lengths, numbers that are not finite or exceed 1e60
    /// in magnitude, times that do not increase, or successive attitudes half a turn apart.
    pub fn resting(times: &[f64], attitudes: &[Quat<f64>]) -> Result<Self, SplineError> {
        let zeros = vec![Vec3::zero(); attitudes.len()];
        Self::new(times, attitudes, &zeros, &zeros)
    }

    /// Creates the spline through the attitudes (K,) at `times` (K,), s, whose angular velocities and
    /// accelerations at the knots are those of the C² cubic spline through the quaternions with the end
    /// conditions `ends`.
    ///
    /// # Errors
    /// The errors of [`RotationSpline::resting`].
    pub fn interpolating(times: &[f64], attitudes: &[Quat<f64>], ends: Ends) -> Result<Self, SplineError> {
        let attitudes = continuous(attitudes);
        let mut rows = vec![0.0; 4 * attitudes.len()];
        attitudes.iter().zip(rows.chunks_exact_mut(4)).for_each(|(q, row)| q.write_xyzw(row));
        let spline = Spline::interpolating(times, 4, &rows, ends)?;
        let knot = |k: usize| -> (Vec3<f64>, Vec3<f64>) {
            // ω = 2 vec(q* q̇) and α = 2 vec(q* q̈) for q = s/|s|, where |s| = 1 and d|s|/dt = s·ṡ
            let [s, s1, s2] = [0, 4, 8].map(|i| Quat::from_xyzw(&spline.knot(k)[i..i + 4]));
            let (turn, phi_acceleration) = (s.conjugate().product(s1).v, s.conjugate().product(s2).v);
            let norm_squared_rate = s.v.dot(s1.v) + s.w * s1.w;
            (turn * 2.0, (phi_acceleration - turn * (2.0 * norm_squared_rate)) * 2.0)
        };
        let (rates, accelerations): (Vec<_>, Vec<_>) = (0..times.len()).map(knot).unzip();
        Self::new(times, &attitudes, &rates, &accelerations)
    }

    /// Creates the spline through the attitudes (K,) at `times` (K,), s, with the angular velocities `rates`
    /// (K,), rad/s in body axes. The angular accelerations are those of the cubic spline through the angular
    /// velocities.
    ///
    /// # Errors
    /// The errors of [`RotationSpline::resting`].
    pub fn with_rates(
        times: &[f64],
        attitudes: &[Quat<f64>],
        rates: &[Vec3<f64>],
    ) -> Result<Self, SplineError> {
        let rows: Vec<f64> = rates.iter().flat_map(|w| [w.x, w.y, w.z]).collect();
        let spline = Spline::interpolating(times, 3, &rows, Ends::Free)?;
        let accelerations: Vec<_> =
            (0..times.len()).map(|k| Vec3::from_slice(&spline.knot(k)[3..])).collect();
        Self::new(times, attitudes, rates, &accelerations)
    }

    /// Creates the spline through the attitudes at `times`, s, with the given angular velocities, rad/s, and
    /// angular accelerations, rad/s², in body axes.
    fn new(
        times: &[f64],
        attitudes: &[Quat<f64>],
        rates: &[Vec3<f64>],
        accelerations: &[Vec3<f64>],
    ) -> Result<Self, SplineError> {
        check_times(times)?;
        let numbers: Vec<f64> = attitudes.iter().flat_map(|q| [q.v.x, q.v.y, q.v.z, q.w]).collect();
        check_rows("attitudes", &numbers, times.len(), 4)?;
        let piece = |k: usize| {
            let start = attitudes[k];
            let turn = log_so3(start.conjugate().product(attitudes[k + 1]));
            if turn.norm() > std::f64::consts::PI - HALF_TURN_MARGIN {
                return Err(SplineError::HalfTurn { point: k });
            }
            // φ̇ = J⁻¹ ω, φ̈ = J⁻¹ (α − J̇ φ̇), where J is the differential of exp, equal to 1 at φ = 0
            let rate = inverse_differential(turn, rates[k + 1]);
            let (_, bias) = differential(turn, rate, Vec3::zero());
            let phi_acceleration = inverse_differential(turn, accelerations[k + 1] - bias);
            Ok(Piece {
                start,
                from: [Vec3::zero(), rates[k], accelerations[k]],
                to: [turn, rate, phi_acceleration],
            })
        };
        let pieces = (0..times.len() - 1).map(piece).collect::<Result<_, _>>()?;
        Ok(Self { times: times.to_vec(), pieces })
    }

    /// Returns the attitude at `t`, s, and the angular velocity (rad/s) and acceleration (rad/s²) in the axes
    /// relative to which the attitudes are given; both are zero outside the knots.
    pub fn sample(&self, t: f64) -> (Quat<f64>, Vec3<f64>, Vec3<f64>) {
        let at = KnotInterval::of(&self.times, t);
        let Piece { start, from, to } = &self.pieces[at.segment];
        let component =
            |pick: fn(&Vec3<f64>) -> f64| at.interpolate(from.map(|x| pick(&x)), to.map(|x| pick(&x)));
        let (x, y, z) = (component(|v| v.x), component(|v| v.y), component(|v| v.z));
        let [phi, rate, phi_acceleration] = [0, 1, 2].map(|i| Vec3::new(x[i], y[i], z[i]));
        let (omega, alpha) = differential(phi, rate, phi_acceleration);
        let attitude = start.product(exp_so3(phi));
        let rot = attitude.matrix();
        (attitude, rot * omega, rot * alpha) // d/dt (R ω) = R (ω × ω + ω̇)
    }
}

/// Returns the attitudes with signs chosen such that successive quaternions are close to each other.
fn continuous(attitudes: &[Quat<f64>]) -> Vec<Quat<f64>> {
    let mut out: Vec<Quat<f64>> = Vec::with_capacity(attitudes.len());
    for q in attitudes {
        let is_far = out.last().is_some_and(|last| last.v.dot(q.v) + last.w * q.w < 0.0);
        out.push(if is_far { Quat { v: -q.v, w: -q.w } } else { *q });
    }
    out
}

/// Returns the angular velocity, rad/s, and angular acceleration, rad/s², of `exp(φ)` in body axes from the
/// rotation vector `φ` (`phi`), rad, and its first two time derivatives.
///
/// `ω = φ̇ − B φ×φ̇ + C φ×(φ×φ̇)` and its derivative, with `B = (1 − cos|φ|)/|φ|²` and `C = (|φ| −
/// sin|φ|)/|φ|³`.
///
/// Source: Iserles et al., Acta Numerica 9, 2000, eq. B.11.
fn differential(phi: Vec3<f64>, rate: Vec3<f64>, phi_acceleration: Vec3<f64>) -> (Vec3<f64>, Vec3<f64>) {
    let ([b, c], [b1, c1]) = coefficients(phi.dot(phi));
    let norm_squared_rate = 2.0 * phi.dot(rate); // d|φ|²/dt
    let (once, phi_cross_acceleration) = (phi.cross(rate), phi.cross(phi_acceleration));
    let twice = phi.cross(once);
    let omega = rate - once * b + twice * c;
    let alpha = phi_acceleration - phi_cross_acceleration * b - once * (b1 * norm_squared_rate)
        + (rate.cross(once) + phi.cross(phi_cross_acceleration)) * c
        + twice * (c1 * norm_squared_rate);
    (omega, alpha)
}

/// Returns the rate `φ̇`, rad/s, of the rotation vector `φ` for the angular velocity `ω` in body axes, rad/s.
fn inverse_differential(phi: Vec3<f64>, omega: Vec3<f64>) -> Vec3<f64> {
    let column = |axis: Vector3<f64>| differential(phi, axis.into(), Vec3::zero()).0.to_nalgebra();
    let jacobian = Matrix3::from_columns(&[Vector3::x(), Vector3::y(), Vector3::z()].map(column));
    let inverse = jacobian.try_inverse().expect("det J = 2(1 − cos|φ|)/|φ|² > 0 below a full turn");
    (inverse * omega.to_nalgebra()).into()
}

/// Returns `[B, C]` of [`differential`] as functions of `x = |φ|²`, and their derivatives with respect to
/// `x`. The series `Σ (−x)ᵏ/(2k+2)!` and `Σ (−x)ᵏ/(2k+3)!` have no cancellation at zero and an error of 1e-16
/// up to a full turn.
fn coefficients(x: f64) -> ([f64; 2], [f64; 2]) {
    let (mut value, mut slope) = ([0.0; 2], [0.0; 2]);
    let mut term = 0.5; // 1/(2k+2)! times (−1)ᵏ
    let mut power = 1.0; // xᵏ
    let mut before = 0.0; // xᵏ⁻¹
    for k in 0..24 {
        let count = f64::from(k);
        for (i, coefficient) in [term, term / (2.0 * count + 3.0)].into_iter().enumerate() {
            value[i] += coefficient * power;
            slope[i] += coefficient * count * before;
        }
        term /= -(2.0 * count + 3.0) * (2.0 * count + 4.0);
        before = power;
        power *= x;
    }
    (value, slope)
}
