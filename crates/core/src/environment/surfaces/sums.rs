//! Sums over the parts of a surface, from which the wrenches are computed.

use crate::environment::wrenches::WrenchLanes;
use crate::spatial::{Real, Sym3, Vec3};

/// Sums for drag. The force on a part at `c` is `-½ ρ C_D a u` with `u = v + w × c`, where `a`, m³/s, is the
/// volume of air that the part sweeps per second, and `v`, `w` and `c` are defined at [`Self::wrench`].
#[derive(Clone, Copy, Debug)]
pub(super) struct DragSums<S> {
    /// Sum `Σ a`, m³/s.
    sum: S,
    /// First moment `Σ a c`, m⁴/s.
    first: Vec3<S>,
    /// Second moment `Σ a c cᵀ`, m⁵/s.
    second: Sym3<S>,
    /// Torque of forces that do not act at `c`, for `½ ρ C_D = 1`, m⁵/s².
    pub(super) torque: Vec3<S>,
}

impl<S: Real> DragSums<S> {
    #[inline(always)]
    pub(super) fn zero() -> Self {
        let o = S::of(0.0);
        Self { sum: o, first: Vec3::zero(), second: Sym3::diagonal(o), torque: Vec3::zero() }
    }

    /// Adds the term `a`, m³/s, of a part at the position `c`, m.
    #[inline(always)]
    pub(super) fn add(&mut self, a: S, c: Vec3<S>) {
        let moment = c * a;
        self.sum += a;
        self.first += moment;
        self.second = self.second.add_parallel(c, moment);
    }

    /// Returns the wrench for `½ ρ C_D = 1`: `F = -Σ a (v + w × c)`, `T = T₀ - Σ a c × (v + w × c)`, where
    /// `T₀` is the field `torque`, `v` and `w` are the velocity of the centre of mass and the angular
    /// velocity, both relative to the atmosphere, and `c` is the position of a part from the centre of mass.
    #[inline(always)]
    pub(super) fn wrench(&self, v: Vec3<S>, w: Vec3<S>) -> WrenchLanes<S> {
        // Σ a c × (w × c) = Σ a [(c·c) w - (c·w) c]
        let Sym3 { xx, yy, zz, .. } = self.second;
        let turning = w * (xx + yy + zz) - self.second * w;
        WrenchLanes {
            force: -(v * self.sum + w.cross(self.first)),
            torque: self.torque - self.first.cross(v) - turning,
        }
    }
}

/// Sums for radiation pressure. At a pressure of 1, the force on a part at `c` is the sum of `-a ŝ`, along
/// the light, and `-b n`, against the normal `n`; the unit vector `ŝ` points to the Sun.
#[derive(Clone, Copy, Debug)]
pub(super) struct PressureSums<S> {
    /// Sum `Σ a`, m².
    sum: S,
    /// First moment `Σ a c`, m³.
    first: Vec3<S>,
    /// Force against the normals for a pressure of 1, m².
    pub(super) force: Vec3<S>,
    /// Torque of the forces against the normals and of forces that do not act at `c`, for a pressure of 1,
    /// m³.
    pub(super) torque: Vec3<S>,
}

impl<S: Real> PressureSums<S> {
    #[inline(always)]
    pub(super) fn zero() -> Self {
        let none = Vec3::zero();
        Self { sum: S::of(0.0), first: none, force: none, torque: none }
    }

    /// Adds the force `-a ŝ` at the position `c`.
    #[inline(always)]
    pub(super) fn push_along_light(&mut self, a: S, c: Vec3<S>) {
        self.sum += a;
        self.first = c.scale_add(a, self.first);
    }

    /// Adds the force `-b n` at the position `c`; `moment` is `c × n`.
    #[inline(always)]
    pub(super) fn push_against_normal(&mut self, b: S, normal: Vec3<S>, moment: Vec3<S>) {
        self.force = normal.scale_add(-b, self.force);
        self.torque = moment.scale_add(-b, self.torque);
    }

    /// Returns the wrench for a pressure of 1: `F = -Σ a ŝ - Σ b n`, `T = -Σ a c × ŝ - Σ b c × n`.
    #[inline(always)]
    pub(super) fn wrench(&self, to_sun: Vec3<S>) -> WrenchLanes<S> {
        WrenchLanes { force: self.force - to_sun * self.sum, torque: self.torque - self.first.cross(to_sun) }
    }
}
