//! C² curves through given points.

use super::quintic_spline::curvatures;
use crate::number_text::{count, exact, short, unlike};
use thiserror::Error;

/// Errors of points and times that do not define a curve.
#[derive(Clone, Debug, PartialEq, Error)]
#[allow(missing_docs)] // the messages explain the fields
pub enum SplineError {
    #[error(
        "'{name}' contains {value} at point {point}; it must be finite and within ±1e60 (SI units)",
        value = exact(*value)
    )]
    NotFinite { name: &'static str, point: usize, value: f64 },
    #[error("the array '{name}' has {got}; expected {expected} (one row per time)", got = count(*got, "number"))]
    WrongLength { name: &'static str, expected: usize, got: usize },
    #[error("the curve has {got}; give at least {least}", got = count(*got, "point"))]
    TooFew { got: usize, least: usize },
    #[error(
        "times[{index}] is {after} s, but the time before it is {before} s; times must increase",
        before = short(*before), after = unlike(*after, &[*before])
    )]
    NotIncreasing { index: usize, before: f64, after: f64 },
    #[error(
        "the attitudes at points {point} and {next} are half a turn apart, so the direction of rotation is ambiguous; \
         add a point between them",
        next = point + 1
    )]
    HalfTurn { point: usize },
}

/// End conditions of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// Zero slope and zero curvature.
    Rest,
    /// Slope of the cubic polynomial through the four points nearest to the end, or of the polynomial through
    /// all points if there are fewer than four.
    Free,
}

/// C² spline of quintic polynomials with given values, slopes and curvatures (first and second derivatives)
/// at K knots. A value has n components; arrays are row-major.
///
/// The C² cubic spline is a special case. Outside the knots, the value of the nearest end is held.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    times: Vec<f64>,
    width: usize,
    /// Value, slope and curvature at each knot, (K, 3, n).
    knots: Vec<f64>,
}

impl Spline {
    /// Creates the spline with knots at `times` (K,), s, and with `values`, `slopes` and `curvatures` (K, n)
    /// at the knots, where n is `width`.
    ///
    /// # Errors
    /// [`SplineError`] for fewer than two points, wrong lengths, numbers that are not finite or exceed 1e60
    /// in magnitude, or times that do not increase.
    pub fn new(
        times: &[f64],
        width: usize,
        values: &[f64],
        slopes: &[f64],
        curvatures: &[f64],
    ) -> Result<Self, SplineError> {
        check_times(times)?;
        let mut knots = vec![0.0; 3 * width * times.len()];
        for (place, (name, rows)) in
            [("values", values), ("slopes", slopes), ("curvatures", curvatures)].into_iter().enumerate()
        {
            check_rows(name, rows, times.len(), width)?;
            for (knot, row) in knots.chunks_exact_mut(3 * width).zip(rows.chunks_exact(width)) {
                knot[place * width..][..width].copy_from_slice(row);
            }
        }
        Ok(Self { times: times.to_vec(), width, knots })
    }

    /// Creates the spline through `values` (K, n) at `times` (K,), s, that is at rest at every point.
    ///
    /// # Errors
    /// The errors of [`Spline::new`].
    pub fn resting(times: &[f64], width: usize, values: &[f64]) -> Result<Self, SplineError> {
        let zeros = vec![0.0; values.len()];
        Self::new(times, width, values, &zeros, &zeros)
    }

    /// Creates the spline through `values` (K, n) at `times` (K,), s, whose slopes and curvatures at the
    /// knots are those of the C² cubic spline. With [`Ends::Rest`], the slopes and curvatures of the first
    /// and the last point are zero.
    ///
    /// # Errors
    /// The errors of [`Spline::new`].
    pub fn interpolating(
        times: &[f64],
        width: usize,
        values: &[f64],
        ends: Ends,
    ) -> Result<Self, SplineError> {
        check_times(times)?;
        check_rows("values", values, times.len(), width)?;
        let slopes = cubic_slopes(times, width, values, ends);
        let curvatures = cubic_curvatures(times, width, values, &slopes, ends);
        Self::new(times, width, values, &slopes, &curvatures)
    }

    /// Creates the spline through `values` (K, n) at `times` (K,), s, with the given `slopes` (K, n). The
    /// spline has a continuous third derivative and an error of order 6 in the spacing of the points.
    ///
    /// # Errors
    /// The errors of [`Spline::new`].
    pub fn with_slopes(
        times: &[f64],
        width: usize,
        values: &[f64],
        slopes: &[f64],
    ) -> Result<Self, SplineError> {
        check_times(times)?;
        check_rows("values", values, times.len(), width)?;
        check_rows("slopes", slopes, times.len(), width)?;
        Self::new(times, width, values, slopes, &curvatures(times, width, values, slopes))
    }

    /// Returns the times of the knots, s: (K,).
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Returns the number of components of a value.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the value, slope and curvature at knot `k`, (3, n).
    pub fn knot(&self, k: usize) -> &[f64] {
        &self.knots[3 * self.width * k..][..3 * self.width]
    }

    /// Computes the value, slope and curvature at `t`, s; each is (n,). Outside the knots, the value of the
    /// nearest end is returned, and slope and curvature are zero.
    pub fn sample(&self, t: f64, value: &mut [f64], slope: &mut [f64], curvature: &mut [f64]) {
        let (n, at) = (self.width, KnotInterval::of(&self.times, t));
        let (start, end) = (self.knot(at.segment), self.knot(at.segment + 1));
        for i in 0..n {
            let pick = |knot: &[f64]| [knot[i], knot[n + i], knot[2 * n + i]];
            [value[i], slope[i], curvature[i]] = at.interpolate(pick(start), pick(end));
        }
    }
}

/// Position of a time relative to the knots.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KnotInterval {
    pub(crate) segment: usize,
    length: f64,
    /// Normalized time in the interval between two knots, 0 to 1.
    u: f64,
    is_outside: bool,
}

impl KnotInterval {
    pub(crate) fn of(times: &[f64], t: f64) -> Self {
        let last = times.len() - 2;
        let segment = times.partition_point(|knot| *knot <= t).saturating_sub(1).min(last);
        let length = times[segment + 1] - times[segment];
        let is_outside = t < times[0] || t > times[last + 1];
        Self { segment, length, u: ((t - times[segment]) / length).clamp(0.0, 1.0), is_outside }
    }

    /// Returns the value, slope and curvature of the quintic polynomial between two knots; `start` and `end`
    /// hold those at the two knots. Outside the knots the curve is at rest.
    pub(crate) fn interpolate(&self, start: [f64; 3], end: [f64; 3]) -> [f64; 3] {
        let (h, u) = (self.length, self.u);
        if self.is_outside {
            return [if u > 0.5 { end[0] } else { start[0] }, 0.0, 0.0];
        }
        if u <= 0.5 {
            return quintic(h, u, start, end);
        }
        // the second half is evaluated backwards in time, so that the value at the end is also exact
        let back = |[p, v, a]: [f64; 3]| [p, -v, a];
        back(quintic(h, 1.0 - u, back(end), back(start)))
    }
}

/// Returns the value, slope and curvature of `p + v s + a s²/2 + c₃s³ + c₄s⁴ + c₅s⁵` at `s = u h`, which has
/// the value, slope and curvature `[p, v, a]` at `s = 0` and `[p1, v1, a1]` at `s = h`. The conditions at `s
/// = 0` are satisfied to the last bit.
fn quintic(h: f64, u: f64, [p, v, a]: [f64; 3], [p1, v1, a1]: [f64; 3]) -> [f64; 3] {
    // differences of position, velocity and acceleration at the far end, over h³, h² and h
    let difference_p = ((p1 - p) / h - v - a * (0.5 * h)) / (h * h);
    let difference_v = (v1 - v - a * h) / (h * h);
    let difference_a = (a1 - a) / h;
    let c3 = 10.0 * difference_p - 4.0 * difference_v + 0.5 * difference_a;
    let c4 = (-15.0 * difference_p + 7.0 * difference_v - difference_a) / h;
    let c5 = (6.0 * difference_p - 3.0 * difference_v + 0.5 * difference_a) / (h * h);
    let s = u * h;
    let value = p + s * (v + s * (0.5 * a + s * (c3 + s * (c4 + s * c5))));
    let slope = v + s * (a + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)));
    let curvature = a + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5));
    [value, slope, curvature]
}

/// Checks that there are at least two times, that they increase, and that they are finite and at most 1e60 in
/// magnitude.
pub(super) fn check_times(times: &[f64]) -> Result<(), SplineError> {
    if times.len() < 2 {
        return Err(SplineError::TooFew { got: times.len(), least: 2 });
    }
    check_rows("times", times, times.len(), 1)?;
    match times.windows(2).position(|pair| pair[0] >= pair[1]) {
        Some(k) => Err(SplineError::NotIncreasing { index: k + 1, before: times[k], after: times[k + 1] }),
        None => Ok(()),
    }
}

/// Checks that `width` is not zero and that there are `points` rows of `width` numbers, which are finite and
/// at most 1e60 in magnitude.
pub(super) fn check_rows(
    name: &'static str,
    rows: &[f64],
    points: usize,
    width: usize,
) -> Result<(), SplineError> {
    if width == 0 {
        return Err(SplineError::WrongLength { name, expected: points, got: 0 });
    }
    if rows.len() != points * width {
        return Err(SplineError::WrongLength { name, expected: points * width, got: rows.len() });
    }
    match rows.iter().position(|x| !x.is_finite() || x.abs() > 1e60) {
        Some(i) => Err(SplineError::NotFinite { name, point: i / width, value: rows[i] }),
        None => Ok(()),
    }
}

/// Returns the slope at each point of the C² cubic spline through all points; zero at both ends with
/// [`Ends::Rest`].
///
/// `m₋/h₋ + 2 (1/h₋ + 1/h) m + m₊/h = 3 (Δ₋/h₋ + Δ/h)` at each inner point, where `m` is the slope, `h` the
/// length of the interval after the point, and `Δ` the slope of the chord over that interval; `₋` and `₊`
/// mark the neighbours.
///
/// Source: de Boor, A Practical Guide to Splines, 1978, ch. IV.
fn cubic_slopes(times: &[f64], width: usize, values: &[f64], ends: Ends) -> Vec<f64> {
    let (last, mut m) = (times.len() - 1, vec![0.0; values.len()]);
    let inverse = |k: usize| 1.0 / (times[k + 1] - times[k]);
    let mut upper = vec![0.0; times.len()]; // upper diagonal divided by the pivot
    for i in 0..width {
        let at = |k: usize| k * width + i;
        if ends == Ends::Free {
            m[at(0)] = end_slope(times, |k| values[at(k)], |k| k);
            m[at(last)] = end_slope(times, |k| values[at(k)], |k| last - k);
        }
        // forward elimination and back substitution (Thomas)
        upper[0] = 0.0;
        for k in 1..last {
            let (before, after) = (inverse(k - 1), inverse(k));
            let chord = |k: usize, h: f64| (values[at(k + 1)] - values[at(k)]) * h * h;
            let pivot = 2.0 * (before + after) - before * upper[k - 1];
            upper[k] = after / pivot;
            m[at(k)] = (3.0 * (chord(k - 1, before) + chord(k, after)) - before * m[at(k - 1)]) / pivot;
        }
        for k in (1..last).rev() {
            m[at(k)] -= upper[k] * m[at(k + 1)];
        }
    }
    m
}

/// Returns the slope at one end of the polynomial through the (at most four) points nearest to that end.
/// Point number `k` from that end has the index `index(k)`, and point `i` the value `value(i)`.
fn end_slope(times: &[f64], value: impl Fn(usize) -> f64, index: impl Fn(usize) -> usize) -> f64 {
    let count = times.len().min(4);
    let t = |k: usize| times[index(k)];
    let mut slope = 0.0;
    for j in 1..count {
        // derivative at t₀ of the Lagrange polynomial that is 1 at t_j
        let others = (1..count).filter(|&k| k != j);
        let weight: f64 = others.map(|k| (t(0) - t(k)) / (t(j) - t(k))).product();
        slope += (value(index(j)) - value(index(0))) * weight / (t(j) - t(0));
    }
    slope
}

/// Returns the curvatures of the cubic polynomials with these values and slopes; zero at both ends with
/// [`Ends::Rest`].
fn cubic_curvatures(times: &[f64], width: usize, values: &[f64], slopes: &[f64], ends: Ends) -> Vec<f64> {
    let last = times.len() - 1;
    let mut out = vec![0.0; values.len()];
    for (j, out) in out.iter_mut().enumerate() {
        let k = j / width;
        let is_end = k == 0 || k == last;
        if !(is_end && ends == Ends::Rest) {
            // p̈ = (6Δ − 4m − 2m₊)/h from the next point, or (−6Δ + 4m + 2m₋)/h from the preceding point
            let other = if k < last { j + width } else { j - width };
            let h = times[other / width] - times[k];
            *out = (6.0 * (values[other] - values[j]) / h - 4.0 * slopes[j] - 2.0 * slopes[other]) / h;
        }
    }
    out
}
