//! What a surface does with light.

use super::error::{SurfaceError, not_negative};
use crate::environment::eight::Eight;
use crate::spatial::Real;

/// Shares of the light that a surface sends back; the rest is absorbed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Optics<T = f64> {
    pub(super) specular: T,
    pub(super) diffuse: T,
}

impl Optics {
    /// `specular` as a mirror does, `diffuse` as a matt wall does (Lambert); 0 to 1.
    ///
    /// # Errors
    /// [`SurfaceError::Value`] and [`SurfaceError::Reflection`].
    pub fn new(specular: f64, diffuse: f64) -> Result<Self, SurfaceError> {
        not_negative("specular", specular)?;
        not_negative("diffuse", diffuse)?;
        if specular + diffuse > 1.0 {
            return Err(SurfaceError::Reflection { specular, diffuse });
        }
        Ok(Self { specular, diffuse })
    }

    /// Of eight bodies.
    pub(super) fn eight(optics: impl Fn(usize) -> Self) -> Optics<Eight> {
        Optics { specular: Eight::of(|i| optics(i).specular), diffuse: Eight::of(|i| optics(i).diffuse) }
    }

    /// `C_R` of a ball: of a mirror's push that of a black one, of a matt one's 4/9 more.
    pub(super) fn of_ball(&self) -> f64 {
        1.0 + 4.0 / 9.0 * self.diffuse
    }
}

impl Optics<Eight> {
    #[inline(always)]
    pub(super) fn load<S: Real>(&self, offset: usize) -> Optics<S> {
        Optics { specular: self.specular.load(offset), diffuse: self.diffuse.load(offset) }
    }
}

impl<S: Real> Optics<S> {
    /// `1 - ρs`: what pushes along the light.
    #[inline(always)]
    pub(super) fn absorbed(&self) -> S {
        S::of(1.0) - self.specular
    }

    /// `2 (ρs cos θ + ρd/3)`: what pushes against the normal.
    #[inline(always)]
    pub(super) fn along_normal(&self, cosine: S) -> S {
        cosine.mul_add(S::of(2.0) * self.specular, S::of(2.0 / 3.0) * self.diffuse)
    }
}
