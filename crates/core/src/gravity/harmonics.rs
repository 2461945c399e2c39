//! Spherical harmonics of any degree and order, with their gradient, evaluated without singularities.

use super::series::{Axis, Series};
use crate::spatial::{Fused, InstructionSet, Real};
use nalgebra::{Matrix3, Vector3};

/// Acceleration and gradient as eight series that are summed together: `gx gy gz Gzz Gxx Gxy Gxz Gyz`.
///
/// Derivatives of solid harmonics are again solid harmonics, so acceleration and gradient are sums of the
/// same functions, with coefficients that are computed once. For a fixed order `m` the functions are `Vnm =
/// Vmm hnm` and `Wnm = Wmm hnm`. A single recursion for `hnm` serves both; it needs only its two preceding
/// values and has no divisor that vanishes at a pole. `Gyy = -Gxx - Gzz`, because the trace of the gradient
/// is zero.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Harmonics {
    mu: f64,
    radius: f64,
    /// For each order `m`, the factor `fm` of `Vmm` and the number of degrees.
    orders: Vec<(f64, usize)>,
    /// Terms sorted by order, then by degree.
    terms: Vec<Term>,
}

/// Coefficients of the term of one degree and order.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Term {
    /// Recursion coefficients `a` and `b` of the next degree.
    next: [f64; 2],
    /// Coefficients of `V` in the eight series.
    c: [f64; 8],
    /// Coefficients of `W` in the eight series.
    s: [f64; 8],
}

/// Scale factor 2⁻⁹³⁰, which prevents overflow of `hnm` near the poles up to degree 2700 (Holmes and
/// Featherstone, section 4).
const SCALE: f64 = f64::from_bits((1023 - 930) << 52);

impl Harmonics {
    pub(super) fn new(mu: f64, radius: f64, potential: &Series) -> Self {
        let along = |axis| potential.derivative(axis);
        let [x, y, z] = [along(Axis::X), along(Axis::Y), along(Axis::Z)];
        let second = [(&z, Axis::Z), (&x, Axis::X), (&x, Axis::Y), (&x, Axis::Z), (&y, Axis::Z)];
        let [zz, xx, xy, xz, yz] = second.map(|(series, axis)| series.derivative(axis));
        let all = [&x, &y, &z, &zz, &xx, &xy, &xz, &yz];
        let degree = potential.degree() + 2;
        let order = potential.order() + 2;
        let mut terms = Vec::new();
        for m in 0..=order {
            for n in m..=degree {
                let both = all.map(|series| series.get(n, m));
                let next = recursion(n + 1, m);
                terms.push(Term { next, c: both.map(|[c, _]| c), s: both.map(|[_, s]| s) });
            }
        }
        // fm = √3 for m = 1, then √((2m + 1)/2m)
        let sectoral = |m: usize| if m < 2 { 3.0 } else { (2 * m + 1) as f64 / (2 * m) as f64 };
        let orders = (0..=order).map(|m| (sectoral(m).sqrt(), degree + 1 - m)).collect();
        Self { mu, radius, orders, terms }
    }

    /// Returns the acceleration, m/s², at position `r` from the planet's centre, m, axes of `F`.
    pub(super) fn acceleration(&self, r: &Vector3<f64>) -> Vector3<f64> {
        let [x, y, z, _] = self.evaluate::<4>(r);
        Vector3::new(x, y, z) * (self.mu / (self.radius * self.radius))
    }

    /// Returns the acceleration, m/s², and its gradient, 1/s², at position `r` from the planet's centre, m,
    /// axes of `F`.
    pub(super) fn gradient(&self, r: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        let [x, y, z, zz, xx, xy, xz, yz] = self.evaluate::<8>(r);
        let scale = self.mu / (self.radius * self.radius);
        let tensor = Matrix3::new(xx, xy, xz, xy, -xx - zz, yz, xz, yz, zz);
        (Vector3::new(x, y, z) * scale, tensor * (scale / self.radius))
    }

    fn evaluate<const L: usize>(&self, r: &Vector3<f64>) -> [f64; L] {
        match InstructionSet::current() {
            InstructionSet::Baseline => self.sum::<f64, L>(r),
            InstructionSet::Fused | InstructionSet::Wide => Fused::enter(
                #[inline(always)]
                || self.sum::<Fused, L>(r).map(|x| x.0),
            ),
        }
    }

    /// Returns the first `L` of the eight series at position `r`, m, in units with `μ = R = 1`.
    ///
    /// Source: Holmes and Featherstone, J. Geodesy 76, 279-299, 2002, equations 11 and 12 (forward column).
    #[inline(always)]
    fn sum<S: Real, const L: usize>(&self, r: &Vector3<f64>) -> [S; L] {
        let inverse = self.radius / r.norm_squared();
        let [x, y, z] = [r.x, r.y, r.z].map(|x| S::of(x * inverse));
        let square = S::of(self.radius * inverse);
        let (mut v, mut w) = (S::of((self.radius * inverse).sqrt() / SCALE), S::of(0.0));
        let (mut total, mut terms) = ([S::of(0.0); L], self.terms.iter());
        for (m, (f, count)) in self.orders.iter().enumerate() {
            if m > 0 {
                // Vmm = fm (x Vm-1 - y Wm-1),  Wmm = fm (y Vm-1 + x Wm-1)
                let f = S::of(*f);
                (v, w) = (f * (x * v - y * w), f * (y * v + x * w));
            }
            let (mut h, mut before) = (S::of(SCALE), S::of(0.0));
            let (mut c, mut s) = ([S::of(0.0); L], [S::of(0.0); L]);
            for term in terms.by_ref().take(*count) {
                for i in 0..L {
                    c[i] = h.mul_add(S::of(term.c[i]), c[i]);
                    s[i] = h.mul_add(S::of(term.s[i]), s[i]);
                }
                // hnm = anm (z R/r²) hn-1,m - bnm (R/r)² hn-2,m
                let [a, b] = term.next.map(S::of);
                (h, before) = ((a * z).mul_add(h, -(b * square * before)), h);
            }
            for i in 0..L {
                total[i] = v.mul_add(c[i], w.mul_add(s[i], total[i]));
            }
        }
        total
    }
}

/// Returns `anm = √((2n-1)(2n+1)/((n-m)(n+m)))`, `bnm = √((2n+1)(n+m-1)(n-m-1)/((n-m)(n+m)(2n-3)))`, for `n >
/// m`.
fn recursion(n: usize, m: usize) -> [f64; 2] {
    let (n, m) = (n as f64, m as f64);
    let below = (n - m) * (n + m);
    let a = ((2.0 * n - 1.0) * (2.0 * n + 1.0) / below).sqrt();
    let b = (2.0 * n + 1.0) * (n + m - 1.0) * (n - m - 1.0) / (below * (2.0 * n - 3.0));
    [a, if b > 0.0 { b.sqrt() } else { 0.0 }] // b = 0 for n = m + 1; for n = 1 the divisor is negative
}
