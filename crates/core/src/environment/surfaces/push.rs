//! Sums over the parts of a surface, and the push they make.

use crate::spatial::{Mat3, Real, Sym3, Vec3};
use std::ops::Mul;

/// A force through the centre of mass and a torque about it, axes of the body.
#[derive(Clone, Copy, Debug)]
pub(in crate::environment) struct Push<S> {
    pub(in crate::environment) force: Vec3<S>,
    pub(in crate::environment) torque: Vec3<S>,
}

impl<S: Real> Push<S> {
    /// In the axes that `rot` leads to.
    #[inline(always)]
    pub(in crate::environment) fn turned(self, rot: &Mat3<S>) -> Self {
        Self { force: *rot * self.force, torque: *rot * self.torque }
    }
}

impl<S: Real> Mul<S> for Push<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: S) -> Self {
        Self { force: self.force * s, torque: self.torque * s }
    }
}

/// What the wind meets: every part at `c` feels `-a u`, `u = v + w × c`, where it sweeps `a` (an area by a speed).
#[derive(Clone, Copy, Debug)]
pub(super) struct Swept<S> {
    /// `Σ a`
    sum: S,
    /// `Σ a c`
    first: Vec3<S>,
    /// `Σ a (c² 1 - c cᵀ)`
    second: Sym3<S>,
    /// Torque of parts whose push is not at `c`.
    pub(super) torque: Vec3<S>,
}

impl<S: Real> Swept<S> {
    #[inline(always)]
    pub(super) fn nothing() -> Self {
        let o = S::of(0.0);
        Self { sum: o, first: Vec3::zero(), second: Sym3::diagonal(o), torque: Vec3::zero() }
    }

    #[inline(always)]
    pub(super) fn add(&mut self, a: S, c: &Vec3<f64>) {
        let c = Vec3::of(c);
        let moment = c * a;
        self.sum += a;
        self.first += moment;
        self.second = self.second.shift(moment, c);
    }

    /// `F = -Σ a (v + w × c)`, `T = -Σ a c × (v + w × c)`.
    #[inline(always)]
    pub(super) fn push(&self, v: Vec3<S>, w: Vec3<S>) -> Push<S> {
        Push {
            force: -(v * self.sum + w.cross(self.first)),
            torque: self.torque - self.first.cross(v) - self.second * w,
        }
    }
}

/// What light meets: every part at `c` feels `-a ŝ` for what it absorbs of it, and what it sends back pushes along its normal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pressed<S> {
    /// `Σ a`
    sum: S,
    /// `Σ a c`
    first: Vec3<S>,
    /// Force of what is sent back.
    pub(super) force: Vec3<S>,
    /// Its torque, and that of parts whose push is not at `c`.
    pub(super) torque: Vec3<S>,
}

impl<S: Real> Pressed<S> {
    #[inline(always)]
    pub(super) fn nothing() -> Self {
        let none = Vec3::zero();
        Self { sum: S::of(0.0), first: none, force: none, torque: none }
    }

    #[inline(always)]
    pub(super) fn add(&mut self, a: S, c: &Vec3<f64>) {
        self.sum += a;
        self.first += Vec3::of(c) * a;
    }

    /// `F = -Σ a ŝ + …`, `T = -Σ a c × ŝ + …`.
    #[inline(always)]
    pub(super) fn push(&self, to_sun: Vec3<S>) -> Push<S> {
        Push { force: self.force - to_sun * self.sum, torque: self.torque - self.first.cross(to_sun) }
    }
}
