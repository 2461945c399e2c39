//! Linear expansion of a gravity field about a point.

use super::error::GravityError;
use super::field::GravityField;
use crate::spatial::{Mat3, Real, Sym3, Vec3};
use std::sync::{Mutex, PoisonError};

/// Distance from the point of expansion within which a field is approximated as linear, m.
///
/// The error `½ ∂²g d²` is at most 3.5e-12 m/s², and 7e-13 m/s² on average, within `d` = 28 m at altitudes
/// from 150 km (EGM2008 36 × 36, measured in `tests/gravity_local_field.rs`). This is 1e-10 of the field
/// without its point mass.
const LINEAR_RADIUS: f64 = 40.0;

/// Linear expansion `g(x) = g₀ + G₀ (x - x₀)` of a gravity field about the position `x₀` (`at`), m, with the
/// acceleration `g₀` (`value`), m/s², and the gradient `G₀`, 1/s².
#[derive(Clone, Copy, Debug)]
pub(super) struct Expansion {
    pub(super) at: Vec3<f64>,
    pub(super) value: Vec3<f64>,
    pub(super) gradient: Sym3<f64>,
}

impl Expansion {
    pub(super) fn of(field: &GravityField, at: Vec3<f64>) -> Result<Self, GravityError> {
        let (value, gradient) = field.gradient(&at.to_nalgebra())?;
        Ok(Self { at, value: value.into(), gradient: gradient.into() })
    }

    /// Returns the field `g(x)`, m/s².
    #[inline(always)]
    pub(super) fn value_at<S: Real>(&self, x: Vec3<S>) -> Vec3<S> {
        Vec3::of(&self.value) + self.difference(x - Vec3::of(&self.at))
    }

    /// Returns the difference `g(x + d) - g(x)` of the linear field, m/s².
    #[inline(always)]
    pub(super) fn difference<S: Real>(&self, d: Vec3<S>) -> Vec3<S> {
        Sym3::of(&self.gradient) * d
    }

    /// Returns true if the positions in all lanes are within [`LINEAR_RADIUS`] of the point of expansion.
    #[inline(always)]
    pub(super) fn covers<S: Real>(&self, positions: Vec3<S>) -> bool {
        is_near(Vec3::of(&self.at), positions)
    }

    /// Returns the expansion in axes `A`, where `rot` converts components in `A` to components in the present
    /// axes.
    pub(super) fn rotated_back(&self, rot: &Mat3<f64>) -> Self {
        Self {
            at: rot.transpose_mul(self.at),
            value: rot.transpose_mul(self.value),
            gradient: self.gradient.rotate(&rot.transpose()),
        }
    }
}

/// Returns true if the two positions of every lane are within [`LINEAR_RADIUS`] of each other.
#[inline(always)]
pub(super) fn is_near<S: Real>(a: Vec3<S>, b: Vec3<S>) -> bool {
    let d = a - b;
    !S::any(S::of(LINEAR_RADIUS * LINEAR_RADIUS).less(d.dot(d)))
}

/// Cache of the last four expansions of a field. Each depends only on the position about which the field is
/// expanded.
#[derive(Debug, Default)]
pub(super) struct ExpansionCache(Mutex<[Option<Expansion>; 4]>);

impl Clone for ExpansionCache {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl ExpansionCache {
    /// Returns the expansion of `field` about the position `at`, m, from the cache if possible.
    pub(super) fn about(&self, field: &GravityField, at: Vec3<f64>) -> Result<Expansion, GravityError> {
        // The lock is released while the field is evaluated, because runs may share the cache.
        let cached = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(expansion) = cached().iter().flatten().find(|expansion| expansion.at == at) {
            return Ok(*expansion);
        }
        let expansion = Expansion::of(field, at)?;
        let mut cached = cached();
        cached.rotate_right(1);
        cached[0] = Some(expansion);
        Ok(expansion)
    }
}
