//! A field linear about a point.

use super::{GravityError, GravityField};
use crate::spatial::{Mat3, Real, Sym3, Vec3};
use std::sync::{Mutex, PoisonError};

/// Distance over which a field is taken for linear, m.
///
/// What that leaves out is `½ ∂²g d²`: at most 3.5e-12 m/s² within 28 m from 150 km up, 7e-13 in the mean (EGM2008 36 × 36,
/// measured in `tests/gravity_nearby.rs`), a ten-billionth of the field without its point mass.
const REACH: f64 = 40.0;

/// `g(x) = g₀ + G₀ (x - x₀)`
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

    /// `g(x)`
    #[inline(always)]
    pub(super) fn value_at<S: Real>(&self, x: Vec3<S>) -> Vec3<S> {
        Vec3::of(&self.value) + self.rise(x - Vec3::of(&self.at))
    }

    /// `g(x + d) - g(x)`
    #[inline(always)]
    pub(super) fn rise<S: Real>(&self, d: Vec3<S>) -> Vec3<S> {
        Sym3::of(&self.gradient) * d
    }

    /// Whether it is good at all these places.
    #[inline(always)]
    pub(super) fn reaches<S: Real>(&self, places: Vec3<S>) -> bool {
        is_near(Vec3::of(&self.at), places)
    }

    /// In the axes that `rot` takes to those of this one.
    pub(super) fn turned_back(&self, rot: &Mat3<f64>) -> Self {
        Self {
            at: rot.transpose_mul(self.at),
            value: rot.transpose_mul(self.value),
            gradient: self.gradient.rotate(&rot.transpose()),
        }
    }
}

/// Whether places are within reach of each other, in all lanes.
#[inline(always)]
pub(super) fn is_near<S: Real>(a: Vec3<S>, b: Vec3<S>) -> bool {
    let d = a - b;
    !S::any(S::of(REACH * REACH).less(d.dot(d)))
}

/// What was expanded last: functions of the place alone, so that it does not matter who asked for them.
#[derive(Debug, Default)]
pub(super) struct Memo(Mutex<[Option<Expansion>; 4]>);

impl Clone for Memo {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Memo {
    /// The field about this place.
    pub(super) fn about(&self, field: &GravityField, at: Vec3<f64>) -> Result<Expansion, GravityError> {
        // not held while the field is evaluated: other runs may share it
        let known = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(expansion) = known().iter().flatten().find(|expansion| expansion.at == at) {
            return Ok(*expansion);
        }
        let expansion = Expansion::of(field, at)?;
        let mut known = known();
        known.rotate_right(1);
        known[0] = Some(expansion);
        Ok(expansion)
    }
}
