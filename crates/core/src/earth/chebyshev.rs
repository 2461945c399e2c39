//! Piecewise Chebyshev interpolation of functions of time that are slow to evaluate.

use nalgebra::Vector3;
use std::f64::consts::PI;
use std::sync::OnceLock;

/// Number of intervals for which memory is allocated at once.
const BLOCK: usize = 32;

type Coefficients<const N: usize> = [Vector3<f64>; N];
type Block<const N: usize> = Box<[OnceLock<Coefficients<N>>; BLOCK]>;

/// Interpolation of a vector function of time by Chebyshev series with `N` coefficients, one series per
/// interval.
///
/// The series of an interval is computed on first use. It depends only on the function, so results do not
/// depend on earlier calls.
#[derive(Clone, Debug)]
pub(super) struct PiecewiseChebyshev<const N: usize> {
    start: f64,
    length: f64,
    blocks: Box<[OnceLock<Block<N>>]>,
}

impl<const N: usize> PiecewiseChebyshev<N> {
    /// Creates the interpolation on intervals of `length`, s, from `start` to at least `end`, s.
    pub(super) fn new(start: f64, end: f64, length: f64) -> Self {
        let blocks = ((end - start) / (length * BLOCK as f64)).ceil().max(1.0) as usize;
        Self { start, length, blocks: vec![OnceLock::new(); blocks].into() }
    }

    /// Returns the series of the interval that contains `t`, s, or of the nearest interval, and the position
    /// of `t` in the interval, clamped to [-1, 1].
    fn series_at(&self, t: f64, function: impl Fn(f64) -> Vector3<f64>) -> (&Coefficients<N>, f64) {
        let position = (t - self.start) / self.length;
        let last = self.blocks.len() * BLOCK - 1;
        let index = (position as usize).min(last); // the conversion maps negative values and NaN to 0
        let block = self.blocks[index / BLOCK].get_or_init(|| Box::new([const { OnceLock::new() }; BLOCK]));
        let series = block[index % BLOCK].get_or_init(|| {
            let middle = self.start + (index as f64 + 0.5) * self.length;
            coefficients(|x| function(middle + 0.5 * self.length * x))
        });
        (series, (2.0 * (position - index as f64) - 1.0).clamp(-1.0, 1.0))
    }

    /// Returns the value of the interpolated function at `t`, s; for a time outside the intervals, its
    /// value at their nearest end. `function` must be the same in all calls.
    pub(super) fn value(&self, t: f64, function: impl Fn(f64) -> Vector3<f64>) -> Vector3<f64> {
        let (series, x) = self.series_at(t, function);
        // Clenshaw's recursion: b_k = c_k + 2x b_{k+1} - b_{k+2},  f = c_0 + x b_1 - b_2
        let (mut b1, mut b2) = (Vector3::zeros(), Vector3::zeros());
        for c in series[1..].iter().rev() {
            (b1, b2) = ((c - b2) + b1 * (2.0 * x), b1);
        }
        series[0] + b1 * x - b2
    }

    /// Returns the value of the interpolated function at `t`, s, as [`Self::value`] does, and its derivative
    /// with respect to time, per second.
    pub(super) fn with_rate(
        &self,
        t: f64,
        function: impl Fn(f64) -> Vector3<f64>,
    ) -> (Vector3<f64>, Vector3<f64>) {
        let (series, x) = self.series_at(t, function);
        // T_{k+1} = 2x T_k - T_{k-1},  T'_{k+1} = 2 T_k + 2x T'_k - T'_{k-1}
        let (mut polynomial, mut slope) = ((1.0, x), (0.0, 1.0));
        let (mut value, mut rate) = (series[0], Vector3::zeros());
        for c in &series[1..] {
            value += c * polynomial.1;
            rate += c * slope.1;
            slope = (slope.1, 2.0 * polynomial.1 + 2.0 * x * slope.1 - slope.0);
            polynomial = (polynomial.1, 2.0 * x * polynomial.1 - polynomial.0);
        }
        (value, rate * (2.0 / self.length))
    }
}

/// Returns the Chebyshev coefficients of a function on [-1, 1] from its values at the zeros of `T_N`.
fn coefficients<const N: usize>(function: impl Fn(f64) -> Vector3<f64>) -> Coefficients<N> {
    let angle = |j: usize| PI * (j as f64 + 0.5) / N as f64;
    let values: [Vector3<f64>; N] = std::array::from_fn(|j| function(angle(j).cos()));
    std::array::from_fn(|k| {
        // c_k = (2 - δ_k0)/N Σ f(cos θ_j) cos k θ_j
        let weight = if k == 0 { 1.0 } else { 2.0 } / N as f64;
        values.iter().enumerate().map(|(j, f)| f * (weight * (k as f64 * angle(j)).cos())).sum()
    })
}
