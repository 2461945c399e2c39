//! Coefficients of a planet's gravity field, and their checks.

use super::error::GravityError;
use super::point_mass::is_earth;
use super::series::Series;
use crate::number_text::short;

/// Highest supported degree, up to which the recursion for the harmonics is stable. Most published models end
/// at degree 2190 or below.
const HIGHEST: usize = 2700;

/// Largest plausible magnitude of coefficients of degree 2 and above. For comparison, that of Saturn's `C̄20`
/// is 0.0073.
const LARGEST: f64 = 1e-2;
/// Largest plausible magnitude of coefficients of degree 1, which give the offset `√3 C̄ R` of the centre of
/// mass.
const LARGEST_FIRST: f64 = 1e-4;

/// Fully normalised coefficients of a planet's field, of degree 1 and above.
///
/// `U = (μ/r) [1 + Σ (R/r)ⁿ P̄nm(sin φ) (C̄nm cos mλ + S̄nm sin mλ)]` with latitude `φ` and longitude `λ` in
/// axes fixed in the planet, the gravitational parameter `μ`, m³/s², and the reference radius `R`, m.
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficients {
    pub(super) model: String,
    pub(super) mu: f64,
    pub(super) radius: f64,
    pub(super) series: Series,
}

impl Coefficients {
    /// Creates the coefficients from square arrays `c` and `s`, in which the element of degree `n` and order
    /// `m` is `c[n (degree + 1) + m]`.
    ///
    /// `mu` is the gravitational parameter, m³/s², and `radius` is the reference radius `R`, m.
    ///
    /// `c[0]` is treated as 1 regardless of its value; entries with `m > n` and `s` of order 0 must be zero.
    ///
    /// # Errors
    /// [`GravityError`] for a degree outside its range, wrong lengths, non-finite numbers, nonzero entries of
    /// terms that do not exist, `mu` and `radius` that are not positive or have the wrong units, and
    /// implausible coefficients, such as coefficients without normalisation.
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

    /// Creates the coefficients from a series, or returns an error if they are implausible.
    pub(super) fn checked(
        model: String,
        mu: f64,
        radius: f64,
        mut series: Series,
    ) -> Result<Self, GravityError> {
        check_planet(mu, radius)?;
        *series.at(0, 0) = [0.0; 2]; // the point mass is computed separately
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
        let found = unnormalised_earth(mu, &series).or_else(|| unnormalised_decay(&series));
        if let Some(found) = found {
            return Err(GravityError::NotNormalised { model, found });
        }
        Ok(Self { model, mu, radius, series })
    }

    /// Returns the highest degree of the coefficients.
    pub fn degree(&self) -> usize {
        self.series.degree()
    }

    /// Returns the series up to the given degree and order, or an error if the order exceeds the degree, or
    /// if the degree is below 2 or above that of the model.
    pub(super) fn truncated(&self, degree: usize, order: usize) -> Result<Series, GravityError> {
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

/// Returns an error if the gravitational parameter `mu`, m³/s², and the reference radius `radius`, m, cannot
/// be those of a planet.
pub(super) fn check_planet(mu: f64, radius: f64) -> Result<(), GravityError> {
    for (name, value, unit) in [("mu", mu, "m³/s²"), ("radius", radius, "m")] {
        if !(value.is_finite() && value > 0.0) {
            return Err(GravityError::NotPositive { name, value, unit });
        }
    }
    if radius < 1e5 {
        let expected = "at least 1e5 m, as for planets".to_owned();
        return Err(GravityError::Units { name: "radius", value: radius, expected });
    }
    // μ/R³ = 4π/3 G ρ
    if !(1e-8..=1e-5).contains(&(mu / radius.powi(3))) {
        let [least, most] = [1e-8, 1e-5].map(|ratio| short(ratio * radius.powi(3)));
        let radius = short(radius);
        let expected = format!(
            "{least} to {most} m³/s² for a radius of {radius} m, which is a density of about 40 to 40 000 kg/m³"
        );
        return Err(GravityError::Units { name: "mu", value: mu, expected });
    }
    Ok(())
}

/// Returns a message that states `C20` if it is an unnormalised coefficient of the Earth, about -1.08e-3,
/// which is √5 times the normalised value; `None` for other values and other planets.
fn unnormalised_earth(mu: f64, series: &Series) -> Option<String> {
    let [c20, _] = series.get(2, 0);
    (is_earth(mu) && (0.9e-3..1.3e-3).contains(&c20.abs())).then(|| {
        format!(
            "the coefficient of degree 2, order 0 is {}, but should be -4.84e-4 for the Earth",
            short(c20)
        )
    })
}

/// Returns a message that states how fast the coefficients decay if the decay shows that they are not
/// normalised; otherwise `None`. Unnormalised sectoral coefficients (order equal to degree) decay with
/// the factorial of the degree.
///
/// At n = 10, the normalisation factor `Nnn = √(2 (2n + 1)/(2n)!)` is 2e-7 times as large as at n = 4, and
/// 9e-10 times as large as `Nn0`. Normalised coefficients of planets decay approximately as `n⁻²` (Kaula's
/// rule) and are similar within a degree. The threshold is the geometric mean of the two decays. The
/// test requires a degree and order of 8 or more; the decay must exceed the threshold both over degrees and
/// over orders.
fn unnormalised_decay(series: &Series) -> Option<String> {
    let high = series.degree().min(series.order()).min(16);
    let size = |n: usize, m: usize| -> f64 {
        [m, m + 1].into_iter().flat_map(|m| series.get(n, m)).map(f64::abs).sum()
    };
    let [low, sectoral, zonal] = [size(4, 3), size(high, high - high.min(1)), size(high, 0)];
    if high < 8 || low == 0.0 || sectoral == 0.0 || zonal == 0.0 {
        return None;
    }
    let factorial = |from: usize| (from..=2 * high).map(|k| (k as f64).ln()).sum::<f64>();
    let over_degrees = 0.5 * (((2 * high + 1) as f64 / 9.0).ln() - factorial(9));
    let over_orders = 0.5 * (2.0_f64.ln() - factorial(1));
    let is_unnormalised =
        (sectoral / low).ln() < 0.5 * over_degrees && (sectoral / zonal).ln() < 0.5 * over_orders;
    let [low, sectoral] = [short(low), short(sectoral)];
    is_unnormalised.then(|| {
        format!("the sectoral coefficients fall from {low} at degree 4 to {sectoral} at degree {high}")
    })
}
