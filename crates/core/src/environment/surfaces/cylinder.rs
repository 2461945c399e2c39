//! Drag and radiation pressure on the curved side of a cylinder.

use super::optics::Optics;
use super::sums::{DragSums, PressureSums};
use crate::environment::soa::Column8;
use crate::spatial::{Real, Vec3};
use std::f64::consts::PI;

/// Curved side of a cylinder, in body axes with positions from the centre of mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Cylinder<T> {
    /// Radius, m.
    pub(super) radius: T,
    /// Length, m.
    pub(super) length: T,
    /// Unit vector along the axis.
    pub(super) axis: Vec3<T>,
    /// Midpoint of the axis, m.
    pub(super) centre: Vec3<T>,
}

impl Cylinder<f64> {
    /// Stores the cylinders of eight bodies in columns; `cylinders(i)` returns the cylinder of body `i`.
    pub(super) fn block(cylinders: impl Fn(usize) -> Self) -> Cylinder<Column8> {
        Cylinder {
            radius: Column8::of(|i| cylinders(i).radius),
            length: Column8::of(|i| cylinders(i).length),
            axis: Column8::vectors(|i| cylinders(i).axis),
            centre: Column8::vectors(|i| cylinders(i).centre),
        }
    }
}

impl Cylinder<Column8> {
    #[inline(always)]
    pub(super) fn load<S: Real>(&self, offset: usize) -> Cylinder<S> {
        let [axis, centre] =
            [&self.axis, &self.centre].map(|columns| columns.map(|column| column.load(offset)));
        Cylinder { radius: self.radius.load(offset), length: self.length.load(offset), axis, centre }
    }
}

impl<S: Real> Cylinder<S> {
    /// Adds the term `a = 2 r L |u⊥|` of the part of the curved side that faces the stream to the sums for
    /// drag, and the torque about the axis centre. `r` is the radius, `L` the length, and `u⊥` the part of
    /// the velocity normal to the axis; `v` and `w` are those of [`DragSums::wrench`].
    #[inline(always)]
    pub(super) fn add_drag(&self, v: Vec3<S>, w: Vec3<S>, sums: &mut DragSums<S>) {
        let (axis, area) = (self.axis, S::of(2.0) * self.radius * self.length);
        let u = v + w.cross(self.centre);
        let along = axis.dot(u);
        let across = u - axis * along;
        // F = -½ ρ C_D a u,  a = ∫ (n·u)₊ dA = 2 r L |u⊥|
        sums.add(across.norm() * area, self.centre);
        // the centroid of the exposed area is offset from the axis by π/4 r û⊥; (π/4 r u⊥) × (-2 r L u) is
        // evaluated with u⊥ × u = -(a·u) a × u
        sums.torque += axis.cross(u) * (along * S::of(PI / 4.0) * self.radius * area);
    }

    /// Adds the force and torque of a radiation pressure of 1 on the illuminated half of the curved side,
    /// with the unit vector `ŝ` (`to_sun`) to the Sun.
    ///
    /// `n = cos φ ŝ⊥ + sin φ a × ŝ⊥`, `n·ŝ = σ cos φ`, `dA = r L dφ`, `|φ| < π/2`, where `a` is the axis,
    /// `s⊥` the part of `ŝ` normal to the axis, `σ = |s⊥|`, `ŝ⊥ = s⊥/σ`, `n` the normal of the area `dA` at
    /// the angle `φ` from `ŝ⊥`, `r` the radius and `L` the length.
    #[inline(always)]
    pub(super) fn add_pressure(&self, to_sun: Vec3<S>, optics: &Optics<S>, sums: &mut PressureSums<S>) {
        let (s, Optics { specular, diffuse }) = (S::of, *optics);
        let (axis, area) = (self.axis, self.radius * self.length);
        let along = axis.dot(to_sun);
        let across = to_sun - axis * along;
        let sigma = across.norm();
        // along -ŝ:  2 r L σ (1 - ρs)
        let along_light = s(2.0) * area * optics.along_light();
        sums.push_along_light(sigma * along_light, self.centre);
        // along -s⊥:  r L (8/3 ρs σ + π/3 ρd)
        let against_normal =
            across * (sigma.mul_add(s(-8.0 / 3.0) * specular, s(-PI / 3.0) * diffuse) * area);
        sums.force += against_normal;
        sums.torque += self.centre.cross(against_normal);
        // the force along the light acts at the offset π/4 r ŝ⊥ from the axis
        sums.torque += axis.cross(to_sun) * (along * s(PI / 4.0) * self.radius * along_light);
    }
}
