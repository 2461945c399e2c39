//! Coefficients of a planet's field, checked.

use super::GravityError;
use super::series::Series;

/// Highest degree that is stable; no published model goes beyond.
const HIGHEST: usize = 2700;

/// Fully normalised coefficients of a planet's field, of degree 1 and above.
///
/// `U = (μ/r) [1 + Σ (R/r)ⁿ P̄nm(sin φ) (C̄nm cos mλ + S̄nm sin mλ)]`, in axes fixed in the planet.
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficients {
    pub(super) model: String,
    pub(super) mu: f64,
    pub(super) radius: f64,
    pub(super) series: Series,
}

impl Coefficients {
    /// From square arrays `c` and `s`, row after row: `c[n (degree + 1) + m]`; `mu` in m³/s², `radius` `R` in m.
    ///
    /// `c[0]` is taken for 1 whatever it holds, and entries with `m > n` are not looked at.
    ///
    /// # Errors
    /// [`GravityError`]: wrong lengths, numbers that are not finite, `mu` or `radius` not positive, and
    /// coefficients that are not normalised.
    pub fn new(
        model: &str,
        mu: f64,
        radius: f64,
        degree: usize,
        c: &[f64],
        s: &[f64],
    ) -> Result<Self, GravityError> {
        let expected = (degree + 1) * (degree + 1);
        for (name, given) in [("c", c), ("s", s)] {
            if given.len() != expected {
                return Err(GravityError::WrongLength { name, expected, got: given.len() });
            }
        }
        let mut series = Series::zeros(check_degree(degree)?);
        for n in 1..=degree {
            for m in 0..=n {
                *series.at(n, m) = [c[n * (degree + 1) + m], s[n * (degree + 1) + m]];
            }
        }
        Self::checked(model.to_owned(), mu, radius, series)
    }

    pub(super) fn checked(
        model: String,
        mu: f64,
        radius: f64,
        mut series: Series,
    ) -> Result<Self, GravityError> {
        for (name, value) in [("mu", mu), ("radius", radius)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(GravityError::NotPositive { name, value });
            }
        }
        *series.at(0, 0) = [0.0; 2]; // the point mass
        for n in 1..=series.degree() {
            for m in 0..=n {
                for (name, value) in ["c", "s"].into_iter().zip(series.get(n, m)) {
                    if !value.is_finite() {
                        return Err(GravityError::NotFinite { name, value });
                    }
                }
            }
        }
        if let Some(found) = fall_of_unnormalised(&series) {
            return Err(GravityError::NotNormalised { model, found });
        }
        Ok(Self { model, mu, radius, series })
    }

    /// Highest degree.
    pub fn degree(&self) -> usize {
        self.series.degree()
    }

    /// The part up to a degree and an order.
    pub(super) fn cut(&self, degree: usize, order: usize) -> Result<Series, GravityError> {
        if order > degree {
            return Err(GravityError::OrderAboveDegree { degree, order });
        }
        if check_degree(degree)? > self.degree() {
            let (model, highest) = (self.model.clone(), self.degree());
            return Err(GravityError::BeyondModel { model, degree, order, highest });
        }
        let mut series = Series::zeros(degree);
        for n in 0..=degree {
            for m in 0..=order.min(n) {
                *series.at(n, m) = self.series.get(n, m);
            }
        }
        Ok(series)
    }
}

pub(super) fn check_degree(degree: usize) -> Result<usize, GravityError> {
    if (2..=HIGHEST).contains(&degree) { Ok(degree) } else { Err(GravityError::Degree { degree }) }
}

/// How coefficients that are not normalised show: those of order `n` fall off with the factorials of their degree.
///
/// `Nnn = √(2 (2n + 1)/(2n)!)` is a ten-millionth at n = 10 of what it is at n = 4, and as much less than `Nn0`; normalised
/// coefficients of planets fall as `n⁻²` or so (Kaula's rule), and those of a degree are alike. Told apart half way
/// (in the logarithm), from degree 8 on, and only where both falls show.
fn fall_of_unnormalised(series: &Series) -> Option<String> {
    let high = series.degree().min(series.order()).min(16);
    let size = |n: usize, m: usize| -> f64 {
        [m, m + 1].into_iter().flat_map(|m| series.get(n, m)).map(f64::abs).sum()
    };
    let [low, fallen, zonal] = [size(4, 3), size(high, high - high.min(1)), size(high, 0)];
    if high < 8 || low == 0.0 || fallen == 0.0 || zonal == 0.0 {
        return None;
    }
    let factorial = |from: usize| (from..=2 * high).map(|k| (k as f64).ln()).sum::<f64>();
    let over_degrees = 0.5 * (((2 * high + 1) as f64 / 9.0).ln() - factorial(9));
    let over_orders = 0.5 * (2.0_f64.ln() - factorial(1));
    let shows = (fallen / low).ln() < 0.5 * over_degrees && (fallen / zonal).ln() < 0.5 * over_orders;
    shows
        .then(|| format!("those of order n fall from {low:.1e} at degree 4 to {fallen:.1e} at degree {high}"))
}
