//! Series of solid harmonics and their derivatives.

/// Fully normalised series `Σ (c V + s W)` over degrees `n` and orders `m ≤ n`.
///
/// `V + i W = (R/r)ⁿ⁺¹ P̄nm(sin φ) exp(i m λ)`, with latitude `φ`, longitude `λ`, distance `r` and lengths in
/// units of the reference radius `R`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Series {
    degree: usize,
    /// Coefficients `(c, s)`, sorted by degree, then by order.
    terms: Vec<[f64; 2]>,
}

/// Axis of differentiation.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Axis {
    X,
    Y,
    Z,
}

impl Series {
    /// Creates a series of zeros up to the given degree.
    pub(super) fn zeros(degree: usize) -> Self {
        Self { degree, terms: vec![[0.0; 2]; (degree + 1) * (degree + 2) / 2] }
    }

    pub(super) fn degree(&self) -> usize {
        self.degree
    }

    /// Returns the coefficients `(c, s)` of the term of degree `n` and order `m`, which are zero beyond the
    /// series.
    pub(super) fn get(&self, n: usize, m: usize) -> [f64; 2] {
        if n > self.degree || m > n { [0.0; 2] } else { self.terms[n * (n + 1) / 2 + m] }
    }

    /// Returns a mutable reference to the coefficients `(c, s)` of the term of degree `n` and order `m`.
    pub(super) fn at(&mut self, n: usize, m: usize) -> &mut [f64; 2] {
        &mut self.terms[n * (n + 1) / 2 + m]
    }

    /// Returns the series divided by a number.
    pub(super) fn divided_by(mut self, divisor: f64) -> Self {
        self.terms.iter_mut().flatten().for_each(|x| *x /= divisor);
        self
    }

    /// Returns the highest order with a non-zero term.
    pub(super) fn order(&self) -> usize {
        let all = (0..=self.degree).flat_map(|n| (0..=n).map(move |m| (n, m)));
        all.filter(|&(n, m)| self.get(n, m) != [0.0; 2]).map(|(_, m)| m).max().unwrap_or(0)
    }

    /// Returns the derivative with respect to the coordinate along an axis: a series whose degree
    /// is higher by one.
    ///
    /// With `Z = V + i W`: `∂z Znm = -(n-m+1) Zn+1,m`, `(∂x + i ∂y) Znm = -Zn+1,m+1`,
    /// `(∂x - i ∂y) Znm = (n-m+2)(n-m+1) Zn+1,m-1`; in normalised form, the factors are square roots of
    /// rational numbers.
    ///
    /// Source: Cunningham, Celestial Mechanics 2, 207-216, 1970; Montenbruck and Gill, Satellite Orbits,
    /// Springer 2000, equation 3.33.
    pub(super) fn derivative(&self, axis: Axis) -> Self {
        let mut out = Self::zeros(self.degree + 1);
        for n in 0..=self.degree {
            for m in 0..=n {
                let [c, s] = self.get(n, m);
                let s = if m == 0 { 0.0 } else { s }; // Wn0 = 0
                let (i, j) = (n as f64, m as f64);
                let k = (2.0 * i + 1.0) / (2.0 * i + 3.0);
                if axis == Axis::Z {
                    let f = -(k * (i + j + 1.0) * (i - j + 1.0)).sqrt();
                    add(out.at(n + 1, m), f * c, f * s);
                    continue;
                }
                let zonal = if m == 0 { 2.0_f64.sqrt() } else { 1.0 };
                let up = -0.5 * zonal * (k * (i + j + 1.0) * (i + j + 2.0)).sqrt();
                match axis {
                    Axis::X => add(out.at(n + 1, m + 1), up * c, up * s),
                    _ => add(out.at(n + 1, m + 1), -up * s, up * c),
                }
                if m > 0 {
                    let zonal = if m == 1 { 2.0 } else { 1.0 };
                    let down = 0.5 * (k * zonal * (i - j + 2.0) * (i - j + 1.0)).sqrt();
                    match axis {
                        Axis::X => add(out.at(n + 1, m - 1), down * c, down * s),
                        _ => add(out.at(n + 1, m - 1), down * s, -down * c),
                    }
                }
            }
        }
        out
    }
}

fn add(to: &mut [f64; 2], c: f64, s: f64) {
    to[0] += c;
    to[1] += s;
}
