//! Drag and radiation pressure on a sphere.

use super::sums::{DragSums, PressureSums};
use crate::environment::soa::Column8;
use crate::spatial::{Real, Vec3};

/// Complete sphere, in body axes with positions from the centre of mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sphere<T> {
    /// Area of the cross-section, m².
    pub(super) area: T,
    /// Centre relative to the centre of mass, m.
    pub(super) centre: Vec3<T>,
    /// Reflectivity `C_R`: 1 for complete absorption or specular reflection, 13/9 for diffuse reflection.
    pub(super) reflectivity: T,
}

impl Sphere<f64> {
    /// Stores the spheres of eight bodies in columns; `spheres(i)` returns the sphere of body `i`.
    pub(super) fn block(spheres: impl Fn(usize) -> Self) -> Sphere<Column8> {
        Sphere {
            area: Column8::of(|i| spheres(i).area),
            centre: Column8::vectors(|i| spheres(i).centre),
            reflectivity: Column8::of(|i| spheres(i).reflectivity),
        }
    }
}

impl Sphere<Column8> {
    #[inline(always)]
    pub(super) fn load<S: Real>(&self, offset: usize) -> Sphere<S> {
        let centre = self.centre.map(|column| column.load(offset));
        Sphere { area: self.area.load(offset), centre, reflectivity: self.reflectivity.load(offset) }
    }
}

impl<S: Real> Sphere<S> {
    /// Adds the term `a = A |u|` of the sphere to the sums for drag, with `v` and `w` as in
    /// [`DragSums::wrench`]. The drag at the centre of the sphere is `F = -½ ρ C_D a u`.
    #[inline(always)]
    pub(super) fn add_drag(&self, v: Vec3<S>, w: Vec3<S>, sums: &mut DragSums<S>) {
        let u = v + w.cross(self.centre);
        // F = -½ ρ C_D a u,  a = A |u|
        sums.add(u.norm() * self.area, self.centre);
    }

    /// Adds the force of radiation pressure on the sphere, `F = -P A C_R ŝ` at its centre with `P = 1`. The
    /// unit vector `ŝ` points to the Sun.
    #[inline(always)]
    pub(super) fn add_pressure(&self, sums: &mut PressureSums<S>) {
        sums.push_along_light(self.area * self.reflectivity, self.centre);
    }
}
