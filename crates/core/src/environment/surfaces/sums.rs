//! Sums over the parts of a surface, and the push they make.

use crate::environment::wrenches::Push;
use crate::spatial::{Real, Sym3, Vec3};

/// What the wind meets: every part at `c` feels `-a u`, `u = v + w × c`, where it sweeps `a` (an area by a speed).
#[derive(Clone, Copy, Debug)]
pub(super) struct Swept<S> {
    /// `Σ a`
    sum: S,
    /// `Σ a c`
    first: Vec3<S>,
    /// `Σ a c cᵀ`
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

    /// A part that sweeps `a` at `c`.
    #[inline(always)]
    pub(super) fn add(&mut self, a: S, c: Vec3<S>) {
        let moment = c * a;
        self.sum += a;
        self.first += moment;
        self.second = self.second.add_parallel(c, moment);
    }

    /// `F = -Σ a (v + w × c)`, `T = -Σ a c × (v + w × c)`.
    #[inline(always)]
    pub(super) fn push(&self, v: Vec3<S>, w: Vec3<S>) -> Push<S> {
        // c × (w × c) = (c·c) w - (c·w) c
        let Sym3 { xx, yy, zz, .. } = self.second;
        let turning = w * (xx + yy + zz) - self.second * w;
        Push {
            force: -(v * self.sum + w.cross(self.first)),
            torque: self.torque - self.first.cross(v) - turning,
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

    /// A part that absorbs `a` of it at `c`.
    #[inline(always)]
    pub(super) fn absorb(&mut self, a: S, c: Vec3<S>) {
        self.sum += a;
        self.first = c.scale_add(a, self.first);
    }

    /// A face that sends back `b` of it along its normal; `moment` is `c × n`.
    #[inline(always)]
    pub(super) fn send_back(&mut self, b: S, normal: Vec3<S>, moment: Vec3<S>) {
        self.force = normal.scale_add(-b, self.force);
        self.torque = moment.scale_add(-b, self.torque);
    }

    /// `F = -Σ a ŝ + …`, `T = -Σ a c × ŝ + …`.
    #[inline(always)]
    pub(super) fn push(&self, to_sun: Vec3<S>) -> Push<S> {
        Push { force: self.force - to_sun * self.sum, torque: self.torque - self.first.cross(to_sun) }
    }
}
