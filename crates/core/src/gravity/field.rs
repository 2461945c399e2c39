//! Gravity field of a planet, excluding its point mass.

use super::coefficients::{Coefficients, check_planet};
use super::error::GravityError;
use super::gfc;
use super::harmonics::Harmonics;
use super::point_mass::SURFACE;
use super::zonal::{self, Zonal};
use crate::text_file::{TextFileError, read_text};
use nalgebra::{Matrix3, Vector3};
use std::path::Path;

/// Names and contents of the bundled models, which extend to degree and order 70.
const BUNDLED: [(&str, &str); 2] =
    [("egm2008", include_str!("models/egm2008.gfc")), ("jgm3", include_str!("models/jgm3.gfc"))];

/// Largest accepted size of a model file, bytes. The size of a file with coefficients up to degree 2190 is
/// 0.3 GB.
const LARGEST_FILE: usize = 1 << 30;

/// Gravity field of a planet, excluding its point mass, in axes `F` fixed in the planet with z along the
/// rotation axis.
#[derive(Clone, Debug, PartialEq)]
pub struct GravityField {
    name: String,
    mu: f64,
    radius: f64,
    degree: usize,
    order: usize,
    kind: Kind,
}

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    Zonal(Zonal),
    Harmonics(Harmonics),
}

impl GravityField {
    /// Creates the zonal field of the Earth (EGM2008) up to `degree`, which is from 2 to 6.
    ///
    /// # Errors
    /// [`GravityError::ZonalDegree`] for any other degree.
    pub fn zonal(degree: usize) -> Result<Self, GravityError> {
        let count = degree.checked_sub(1).filter(|count| (1..=zonal::EARTH.len()).contains(count));
        let j = &zonal::EARTH[..count.ok_or(GravityError::ZonalDegree { degree })?];
        Self::zonals(3.986_004_415e14, 6_378_136.3, j)
    }

    /// Creates the zonal field of a planet with gravitational parameter `mu`, m³/s², reference radius
    /// `radius`, m, and one to five unnormalised coefficients `j`: `J2`, `J3` and so on, up to `J6`.
    ///
    /// # Errors
    /// [`GravityError`] for an empty `j` or more than five coefficients, non-finite numbers, and `mu` and
    /// `radius` that are not positive or have the wrong units.
    pub fn zonals(mu: f64, radius: f64, j: &[f64]) -> Result<Self, GravityError> {
        let degree = j.len() + 1;
        if j.is_empty() || degree > zonal::HIGHEST {
            return Err(GravityError::ZonalDegree { degree });
        }
        check_planet(mu, radius)?;
        if let Some(&value) = j.iter().find(|j| !j.is_finite()) {
            return Err(GravityError::NotFinite { name: "j", value });
        }
        let mut all = [0.0; 5];
        all[..j.len()].copy_from_slice(j);
        let kind = Kind::Zonal(Zonal { mu, radius, j: all });
        Ok(Self { name: "zonal".to_owned(), mu, radius, degree, order: 0, kind })
    }

    /// Creates a field from a bundled model: `egm2008` (tide-free) or `jgm3` (`C̄20` with the permanent
    /// tide). Both extend to degree and order 70.
    ///
    /// # Errors
    /// [`GravityError::UnknownModel`] for another name; [`GravityError::Degree`],
    /// [`GravityError::BeyondModel`] and [`GravityError::OrderAboveDegree`] for an invalid degree or order.
    pub fn bundled(name: &str, degree: usize, order: usize) -> Result<Self, GravityError> {
        let Some((name, text)) = BUNDLED.iter().find(|(known, _)| *known == name) else {
            let known = BUNDLED.iter().map(|(known, _)| *known).chain(["zonal"]).collect();
            return Err(GravityError::UnknownModel { name: name.to_owned(), known });
        };
        let mut coefficients = gfc::read(name, text, Some(degree))?;
        coefficients.model = (*name).to_owned();
        Self::new(&coefficients, degree, order)
    }

    /// Reads a model from a `.gfc` file. By default, `degree` is the degree of the file and `order` equals
    /// `degree`.
    ///
    /// # Errors
    /// [`GravityError`] for a file that is missing, unreadable, invalid, truncated, not normalised or
    /// time-dependent, and the errors of [`GravityField::new`].
    pub fn from_gfc(path: &Path, degree: Option<usize>, order: Option<usize>) -> Result<Self, GravityError> {
        let file = path.display().to_string();
        let text = read_text(path, LARGEST_FILE).map_err(|error| {
            let file = file.clone();
            match error {
                TextFileError::NotFound => GravityError::NotFound { file },
                error => GravityError::Unreadable { file, reason: error.to_string() },
            }
        })?;
        let coefficients = gfc::read(&file, &text, degree)?;
        let degree = degree.unwrap_or(coefficients.degree());
        Self::new(&coefficients, degree, order.unwrap_or(degree))
    }

    /// Creates the field of a model up to `degree` and `order`. Zonal fields up to degree 6 without a term of
    /// degree 1 are evaluated in closed form.
    ///
    /// # Errors
    /// [`GravityError::BeyondModel`], [`GravityError::OrderAboveDegree`] and [`GravityError::Degree`] for an
    /// invalid degree or order.
    pub fn new(coefficients: &Coefficients, degree: usize, order: usize) -> Result<Self, GravityError> {
        let series = coefficients.truncated(degree, order)?;
        let Coefficients { model, mu, radius, .. } = coefficients;
        let (name, mu, radius) = (model.clone(), *mu, *radius);
        let is_closed = order == 0 && degree <= zonal::HIGHEST && series.get(1, 0) == [0.0; 2];
        let kind = if is_closed {
            // Jn = -√(2n + 1) C̄n0
            let j = [2, 3, 4, 5, 6].map(|n: usize| -((2 * n + 1) as f64).sqrt() * series.get(n, 0)[0]);
            Kind::Zonal(Zonal { mu, radius, j })
        } else {
            Kind::Harmonics(Harmonics::new(mu, radius, &series))
        };
        Ok(Self { name, mu, radius, degree, order, kind })
    }

    /// Returns the name of the model.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the gravitational parameter of the planet, m³/s², with which the coefficients were determined.
    pub fn mu(&self) -> f64 {
        self.mu
    }

    /// Returns the reference radius `R`, m.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns the highest degree of the terms of the field.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Returns the highest order of the terms; a field of order 0 is symmetric about the z axis of `F`.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Returns true if the field is evaluated in closed form and therefore needs no grid of expansions.
    pub(super) fn is_closed(&self) -> bool {
        matches!(self.kind, Kind::Zonal(_))
    }

    /// Returns the acceleration, m/s², at position `r` from the planet's centre, m; both in axes of `F`.
    ///
    /// # Errors
    /// [`GravityError::BelowSurface`] below 0.996 `R`, where series are not reliable;
    /// [`GravityError::NotFinite`] for an `r` that is not finite.
    #[inline]
    pub fn acceleration(&self, r: &Vector3<f64>) -> Result<Vector3<f64>, GravityError> {
        self.check(r)?;
        Ok(match &self.kind {
            Kind::Zonal(zonal) => zonal.acceleration(r),
            Kind::Harmonics(harmonics) => harmonics.acceleration(r),
        })
    }

    /// Returns the acceleration, m/s², and its gradient `∂g/∂r`, 1/s², at position `r` from the planet's
    /// centre, m; all in axes of `F`.
    ///
    /// The gradient is symmetric and has zero trace.
    ///
    /// # Errors
    /// The errors of [`GravityField::acceleration`].
    pub fn gradient(&self, r: &Vector3<f64>) -> Result<(Vector3<f64>, Matrix3<f64>), GravityError> {
        self.check(r)?;
        Ok(match &self.kind {
            Kind::Zonal(zonal) => zonal.gradient(r),
            Kind::Harmonics(harmonics) => harmonics.gradient(r),
        })
    }

    /// Computes the accelerations `(n, 3)`, m/s², at positions `(n, 3)` from the planet's centre, m, axes of
    /// `F`.
    ///
    /// # Errors
    /// [`GravityError::WrongLength`] for arrays of the wrong length; otherwise the first error of
    /// [`GravityField::acceleration`]. The rows before that error have then been written.
    pub fn accelerations(&self, positions: &[f64], out: &mut [f64]) -> Result<(), GravityError> {
        self.at_each(positions, out, 3, |r, row| {
            row.copy_from_slice(self.acceleration(r)?.as_slice());
            Ok(())
        })
    }

    /// Computes the gradients `(n, 3, 3)`, 1/s², at positions `(n, 3)` from the planet's centre, m, axes of
    /// `F`.
    ///
    /// # Errors
    /// The errors of [`GravityField::accelerations`].
    pub fn gradients(&self, positions: &[f64], out: &mut [f64]) -> Result<(), GravityError> {
        self.at_each(positions, out, 9, |r, row| {
            row.copy_from_slice(self.gradient(r)?.1.as_slice());
            Ok(())
        })
    }

    fn at_each(
        &self,
        positions: &[f64],
        out: &mut [f64],
        width: usize,
        mut write: impl FnMut(&Vector3<f64>, &mut [f64]) -> Result<(), GravityError>,
    ) -> Result<(), GravityError> {
        let expected = positions.len() / 3 * width;
        if !positions.len().is_multiple_of(3) {
            let (expected, got) = (positions.len().next_multiple_of(3), positions.len());
            return Err(GravityError::WrongLength { name: "positions", expected, got });
        }
        if out.len() != expected {
            return Err(GravityError::WrongLength { name: "out", expected, got: out.len() });
        }
        for (r, row) in positions.chunks_exact(3).zip(out.chunks_exact_mut(width)) {
            write(&Vector3::from_column_slice(r), row)?;
        }
        Ok(())
    }

    #[inline]
    fn check(&self, r: &Vector3<f64>) -> Result<(), GravityError> {
        let (minimum, square) = (SURFACE * self.radius, r.norm_squared());
        if square >= minimum * minimum && square < f64::INFINITY {
            Ok(())
        } else if square.is_finite() {
            Err(GravityError::BelowSurface { distance: square.sqrt(), minimum })
        } else {
            Err(GravityError::NotFinite { name: "position", value: square.sqrt() })
        }
    }
}
