//! Coefficients of a planet's field, checked.

use super::GravityError;
use super::point_mass::is_earth;
use super::series::Series;
use crate::number_text::short;

/// Highest degree that is stable; no published model goes beyond.
const HIGHEST: usize = 2700;

/// Largest coefficients believed: Saturn's `C̄20` is 0.0073; those of degree 1 are the offset of the centre of mass, `√3 C̄ R`.
const LARGEST: f64 = 1e-2;
const LARGEST_FIRST: f64 = 1e-4;

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
    /// `c[0]` is taken for 1 whatever it holds; entries with `m > n` and `s` of order 0 must be zero.
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
        for index in 1..expected {
            let (n, m) = (index / (degree + 1), index % (degree + 1));
            for (name, value, exists) in [("c", c[index], m <= n), ("s", s[index], (1..=n).contains(&m))] {
                if !exists && value != 0.0 {
                    return Err(GravityError::NoSuchTerm { name, degree: n, order: m, value });
                }
            }
        }
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
        check_planet(mu, radius)?;
        *series.at(0, 0) = [0.0; 2]; // the point mass
        for n in 1..=series.degree() {
            for m in 0..=n {
                for (name, value) in ["c", "s"].into_iter().zip(series.get(n, m)) {
                    if !value.is_finite() {
                        return Err(GravityError::NotFinite { name, value });
                    }
                    let limit = if n == 1 { LARGEST_FIRST } else { LARGEST };
                    if value.abs() > limit {
                        return Err(GravityError::Implausible { model, degree: n, order: m, value, limit });
                    }
                }
            }
        }
        let found = earth_not_normalised(mu, &series).or_else(|| fall_of_unnormalised(&series));
        if let Some(found) = found {
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

/// Refuses what is no planet in SI units.
pub(super) fn check_planet(mu: f64, radius: f64) -> Result<(), GravityError> {
    for (name, value) in [("mu", mu), ("radius", radius)] {
        if !(value.is_finite() && value > 0.0) {
            return Err(GravityError::NotPositive { name, value });
        }
    }
    if radius < 1e5 {
        let expected = "planets have radii of at least 1e5 m";
        return Err(GravityError::Units { name: "radius", value: radius, expected });
    }
    // μ/R³ = 4π/3 G ρ
    if !(1e-8..=1e-5).contains(&(mu / radius.powi(3))) {
        let expected = "with this radius no density of a planet, of 40 to 40 000 kg/m³";
        return Err(GravityError::Units { name: "mu", value: mu, expected });
    }
    Ok(())
}

/// The Earth's `C20` where it is not normalised, -1.08e-3: √5 times what it ought to be.
fn earth_not_normalised(mu: f64, series: &Series) -> Option<String> {
    let [c20, _] = series.get(2, 0);
    (is_earth(mu) && (0.9e-3..1.3e-3).contains(&c20.abs()))
        .then(|| format!("of degree 2, order 0 it is {}, the Earth's is -4.84e-4", short(c20)))
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
    let [low, fallen] = [short(low), short(fallen)];
    shows.then(|| format!("those of order n fall from {low} at degree 4 to {fallen} at degree {high}"))
}
