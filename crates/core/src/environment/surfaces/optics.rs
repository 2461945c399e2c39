//! Optical coefficients of a surface.

use super::error::{SurfaceError, not_negative};
use crate::environment::soa::Column8;
use crate::spatial::Real;

/// Optical coefficients of a surface: the fractions of the light that are reflected. The remainder is
/// absorbed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Optics<T = f64> {
    /// Fraction `ρs` that is reflected specularly.
    pub(super) specular: T,
    /// Fraction `ρd` that is reflected diffusely.
    pub(super) diffuse: T,
}

impl Optics {
    /// Creates the coefficients from the fractions `specular` (mirror) and `diffuse` (Lambert's law), each
    /// from 0 to 1.
    ///
    /// # Errors
    /// [`SurfaceError::Value`] for a fraction that is negative or not finite, and
    /// [`SurfaceError::Reflection`] for a sum above 1.
    pub fn new(specular: f64, diffuse: f64) -> Result<Self, SurfaceError> {
        not_negative("specular", specular)?;
        not_negative("diffuse", diffuse)?;
        if specular + diffuse > 1.0 {
            return Err(SurfaceError::Reflection { specular, diffuse });
        }
        Ok(Self { specular, diffuse })
    }

    /// Stores the coefficients of eight bodies in columns; `optics(i)` returns those of body `i`.
    pub(super) fn block(optics: impl Fn(usize) -> Self) -> Optics<Column8> {
        Optics { specular: Column8::of(|i| optics(i).specular), diffuse: Column8::of(|i| optics(i).diffuse) }
    }

    /// Returns the radiation pressure coefficient of a sphere, `C_R = 1 + 4/9 ρd`. Specular reflection does
    /// not change the force on a sphere.
    pub(super) fn of_sphere(&self) -> f64 {
        1.0 + 4.0 / 9.0 * self.diffuse
    }
}

impl Optics<Column8> {
    #[inline(always)]
    pub(super) fn load<S: Real>(&self, offset: usize) -> Optics<S> {
        Optics { specular: self.specular.load(offset), diffuse: self.diffuse.load(offset) }
    }
}

impl<S: Real> Optics<S> {
    /// Returns the factor `1 - ρs` of the force along the light, to which specular reflection does not
    /// contribute.
    #[inline(always)]
    pub(super) fn along_light(&self) -> S {
        S::of(1.0) - self.specular
    }

    /// Returns the factor `2 (ρs cos θ + ρd/3)` of the force against the normal, where `cosine` is `cos θ`.
    #[inline(always)]
    pub(super) fn along_normal(&self, cosine: S) -> S {
        cosine.mul_add(S::of(2.0) * self.specular, S::of(2.0 / 3.0) * self.diffuse)
    }
}
