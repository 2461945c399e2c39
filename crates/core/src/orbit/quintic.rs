//! Piecewise polynomials of degree five or less through given points, twice continuously differentiable.

use nalgebra::{Matrix3, SVector};

/// A C² curve through points in `D` dimensions.
///
/// Every piece is the quintic that meets position, velocity and acceleration at both of its ends. What was
/// not given at the knots is chosen so that as many derivatives as possible go on across them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Quintic<const D: usize> {
    times: Vec<f64>,
    /// `c₀ … c₅` of `x = Σ cₖ sᵏ`, `s = t - tᵢ`; the last piece goes on where the path ends.
    pieces: Vec<[SVector<f64, D>; 6]>,
}

/// Position, velocity and acceleration.
pub(super) type Jet<const D: usize> = [SVector<f64, D>; 3];

impl<const D: usize> Quintic<D> {
    /// Cubic not-a-knot spline through positions alone: two points make a line, three a parabola.
    ///
    /// Source: de Boor, A Practical Guide to Splines, Springer 2001, chapter IV.
    pub(super) fn through(times: Vec<f64>, x: &[SVector<f64, D>]) -> Self {
        let (n, h, slope) = (x.len(), gaps(&times), slopes(&times, x));
        let mut a = vec![SVector::zeros(); n];
        if n == 3 {
            a = vec![(slope[1] - slope[0]) * 2.0 / (h[0] + h[1]); 3];
        } else if n > 3 {
            // hᵢ₋₁ aᵢ₋₁ + 2 (hᵢ₋₁ + hᵢ) aᵢ + hᵢ aᵢ₊₁ = 6 (Δᵢ/hᵢ - Δᵢ₋₁/hᵢ₋₁)
            let mut rows: Vec<Row<D>> = (1..n - 1)
                .map(|i| Row(h[i - 1], 2.0 * (h[i - 1] + h[i]), h[i], (slope[i] - slope[i - 1]) * 6.0))
                .collect();
            // not a knot: a₀ = a₁ - (h₀/h₁) (a₂ - a₁), and so at the end
            let (first, last, ratio) = (0, n - 3, (h[0] / h[1], h[n - 2] / h[n - 3]));
            rows[first].1 += h[0] * (1.0 + ratio.0);
            rows[first].2 -= h[0] * ratio.0;
            rows[last].1 += h[n - 2] * (1.0 + ratio.1);
            rows[last].0 -= h[n - 2] * ratio.1;
            a[1..n - 1].copy_from_slice(&solve(rows));
            a[0] = a[1] - (a[2] - a[1]) * ratio.0;
            a[n - 1] = a[n - 2] + (a[n - 2] - a[n - 3]) * ratio.1;
        }
        // vᵢ = Δᵢ/hᵢ - hᵢ (2 aᵢ + aᵢ₊₁)/6
        let mut v: Vec<_> = (0..n - 1).map(|i| slope[i] - (a[i] * 2.0 + a[i + 1]) * (h[i] / 6.0)).collect();
        v.push(slope[n - 2] + (a[n - 2] + a[n - 1] * 2.0) * (h[n - 2] / 6.0));
        Self::hermite(times, x, &v, &a)
    }

    /// Quintic spline through positions and velocities, its third derivative continuous too.
    ///
    /// Accelerations come from the continuity of the third derivative at inner knots and of the fourth at the
    /// first and last of them (not-a-knot). Two points make a cubic, three one quintic.
    pub(super) fn with_velocities(times: Vec<f64>, x: &[SVector<f64, D>], v: &[SVector<f64, D>]) -> Self {
        let (n, h, slope) = (x.len(), gaps(&times), slopes(&times, x));
        // third and fourth derivatives at a knot, less what the unknown accelerations add to them
        let jerk = |i: usize| {
            let (k, l) = (1.0 / h[i - 1], 1.0 / h[i]);
            (slope[i] * 60.0 - v[i + 1] * 24.0 - v[i] * 36.0) * (l * l)
                - (slope[i - 1] * 60.0 - v[i] * 36.0 - v[i - 1] * 24.0) * (k * k)
        };
        let snap = |i: usize| {
            let (k, l) = (1.0 / h[i - 1], 1.0 / h[i]);
            (v[i + 1] * 168.0 + v[i] * 192.0 - slope[i] * 360.0) * l.powi(3)
                + (v[i] * 192.0 + v[i - 1] * 168.0 - slope[i - 1] * 360.0) * k.powi(3)
        };
        let a = if n == 2 {
            let cubic = (slope[0] * 6.0 - v[0] * 4.0 - v[1] * 2.0, v[0] * 2.0 + v[1] * 4.0 - slope[0] * 6.0);
            vec![cubic.0 / h[0], cubic.1 / h[0]]
        } else if n == 3 {
            let (k, l) = (1.0 / h[0], 1.0 / h[1]);
            let crackle = (slope[1] * 12.0 - (v[2] + v[1]) * 6.0) * l.powi(4)
                - (slope[0] * 12.0 - (v[1] + v[0]) * 6.0) * k.powi(4);
            // scaled by the first gap, so that the determinant does not depend on the unit of time
            let r = l / k;
            #[rustfmt::skip]
            let left = Matrix3::new(
                -3.0, 9.0 * (1.0 + r), -3.0 * r,
                -24.0, 36.0 * (1.0 - r * r), 24.0 * r * r,
                -1.0, 1.0 + r.powi(3), -r.powi(3),
            );
            let right = [jerk(1) / k, snap(1) / (k * k), crackle / k.powi(3)];
            let inverse = left.try_inverse().unwrap_or_else(Matrix3::zeros); // determinant -108 r² (1 + r)⁴ or so
            (0..3).map(|i| (0..3).map(|j| right[j] * inverse[(i, j)]).sum()).collect()
        } else {
            // -3k aᵢ₋₁ + 9 (k + l) aᵢ - 3l aᵢ₊₁ = jerk,  k = 1/hᵢ₋₁, l = 1/hᵢ
            let mut rows: Vec<Row<D>> = (1..n - 1)
                .map(|i| {
                    let (k, l) = (1.0 / h[i - 1], 1.0 / h[i]);
                    Row(-3.0 * k, 9.0 * (k + l), -3.0 * l, jerk(i))
                })
                .collect();
            // -24k² a₀ + 36 (k² - l²) a₁ + 24l² a₂ = snap, from which a₀ = α a₁ + β a₂ - snap/24k²
            let end = |own: f64, next: f64| {
                let r2 = (own / next) * (own / next); // l²/k²
                (1.5 * (1.0 - r2), r2, own * own / 24.0)
            };
            let (e, f) = (end(h[0], h[1]), end(h[n - 2], h[n - 3]));
            let (s, z) = (snap(1) * e.2, -snap(n - 2) * f.2);
            let (first, last, k, l) = (0, n - 3, 3.0 / h[0], 3.0 / h[n - 2]);
            rows[first].1 -= k * e.0;
            rows[first].2 -= k * e.1;
            rows[first].3 -= s * k;
            rows[last].1 -= l * f.0;
            rows[last].0 -= l * f.1;
            rows[last].3 -= z * l;
            let mut a = vec![SVector::zeros(); n];
            a[1..n - 1].copy_from_slice(&solve(rows));
            a[0] = a[1] * e.0 + a[2] * e.1 - s;
            a[n - 1] = a[n - 2] * f.0 + a[n - 3] * f.1 - z;
            a
        };
        Self::hermite(times, x, v, &a)
    }

    /// The quintic between neighbours that meets position, velocity and acceleration of both.
    pub(super) fn hermite(
        times: Vec<f64>,
        x: &[SVector<f64, D>],
        v: &[SVector<f64, D>],
        a: &[SVector<f64, D>],
    ) -> Self {
        let mut pieces = Vec::with_capacity(x.len());
        for (i, h) in gaps(&times).into_iter().enumerate() {
            let slope = (x[i + 1] - x[i]) / h;
            // what velocity and acceleration lack at the far end, per h² and h
            let (p, q, r) = (
                (slope - v[i] - a[i] * (0.5 * h)) / (h * h),
                (v[i + 1] - v[i] - a[i] * h) / (h * h),
                (a[i + 1] - a[i]) / h,
            );
            let c3 = p * 10.0 - q * 4.0 + r * 0.5;
            let c4 = (q * 7.0 - p * 15.0 - r) / h;
            let c5 = (p * 6.0 - q * 3.0 + r * 0.5) / (h * h);
            pieces.push([x[i], v[i], a[i] * 0.5, c3, c4, c5]);
        }
        let (last, zero) = (x.len() - 1, SVector::zeros());
        pieces.push([x[last], v[last], a[last] * 0.5, zero, zero, zero]);
        Self { times, pieces }
    }

    pub(super) fn start(&self) -> f64 {
        self.times[0]
    }

    pub(super) fn end(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// Where the curve is at `t`, exactly what was given at a knot; `t` lies within.
    pub(super) fn at(&self, t: f64) -> Jet<D> {
        let i = self.times.partition_point(|&knot| knot <= t).max(1) - 1;
        let (c, s) = (&self.pieces[i], t - self.times[i]);
        let x = c[0] + (c[1] + (c[2] + (c[3] + (c[4] + c[5] * s) * s) * s) * s) * s;
        let v = c[1] + (c[2] * 2.0 + (c[3] * 3.0 + (c[4] * 4.0 + c[5] * (5.0 * s)) * s) * s) * s;
        let a = c[2] * 2.0 + (c[3] * 6.0 + (c[4] * 12.0 + c[5] * (20.0 * s)) * s) * s;
        [x, v, a]
    }
}

fn gaps(times: &[f64]) -> Vec<f64> {
    times.windows(2).map(|t| t[1] - t[0]).collect()
}

fn slopes<const D: usize>(times: &[f64], x: &[SVector<f64, D>]) -> Vec<SVector<f64, D>> {
    times.windows(2).zip(x.windows(2)).map(|(t, x)| (x[1] - x[0]) / (t[1] - t[0])).collect()
}

/// `below xᵢ₋₁ + middle xᵢ + above xᵢ₊₁ = right`.
struct Row<const D: usize>(f64, f64, f64, SVector<f64, D>);

/// Solves rows whose middle outweighs the others.
fn solve<const D: usize>(mut rows: Vec<Row<D>>) -> Vec<SVector<f64, D>> {
    for i in 1..rows.len() {
        let factor = rows[i].0 / rows[i - 1].1;
        rows[i].1 -= factor * rows[i - 1].2;
        let above = rows[i - 1].3;
        rows[i].3 -= above * factor;
    }
    let mut x = vec![SVector::zeros(); rows.len()];
    let mut next = SVector::zeros();
    for (x, row) in x.iter_mut().zip(&rows).rev() {
        next = (row.3 - next * row.2) / row.1;
        *x = next;
    }
    x
}
