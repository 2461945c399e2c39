//! Drag and radiation pressure on a flat face.

use super::optics::Optics;
use super::sums::{DragSums, PressureSums};
use crate::environment::soa::Column8;
use crate::spatial::{Real, Vec3};

/// Flat face whose outer side is exposed, in body axes with positions from the centre of mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Face<T> {
    /// Area, m².
    area: T,
    /// Outward unit normal.
    normal: Vec3<T>,
    /// Centroid, m.
    centroid: Vec3<T>,
    /// Moment of the normal, `c × n` with the centroid `c`, m.
    moment: Vec3<T>,
}

impl Face<f64> {
    /// Creates a face from its area, m², outward unit normal, and centroid, m.
    pub(super) fn new(area: f64, normal: Vec3<f64>, centroid: Vec3<f64>) -> Self {
        Self { area, normal, centroid, moment: centroid.cross(normal) }
    }

    /// Stores the faces of eight bodies in columns; `faces(i)` returns the face of body `i`.
    pub(super) fn block(faces: impl Fn(usize) -> Self) -> Face<Column8> {
        Face {
            area: Column8::of(|i| faces(i).area),
            normal: Column8::vectors(|i| faces(i).normal),
            centroid: Column8::vectors(|i| faces(i).centroid),
            moment: Column8::vectors(|i| faces(i).moment),
        }
    }
}

impl Face<Column8> {
    #[inline(always)]
    pub(super) fn load<S: Real>(&self, offset: usize) -> Face<S> {
        let vectors = |columns: &Vec3<Column8>| columns.map(|column| column.load(offset));
        let [normal, centroid, moment] = [&self.normal, &self.centroid, &self.moment].map(vectors);
        Face { area: self.area.load(offset), normal, centroid, moment }
    }
}

impl<S: Real> Face<S> {
    /// Adds the term `a = A (n·u)₊` of the face to the sums for drag.
    ///
    /// The drag of a face at its centroid `c`, where `u = v + w × c`, is `F = -½ ρ C_D A (n·u)₊ u = -½ ρ C_D
    /// a u`. [`DragSums::wrench`], which defines `v` and `w`, computes `-Σ a u`, `SurfaceBlock::drag`
    /// multiplies by `½ C_D`, and `Drag` by `ρ`.
    #[inline(always)]
    pub(super) fn add_drag(&self, v: Vec3<S>, w: Vec3<S>, sums: &mut DragSums<S>) {
        // n·u = n·(v + w × c) = n·v + (c × n)·w
        let normal_speed = self.normal.dot_add(v, self.moment.dot(w));
        // a = A (n·u)₊
        sums.add(positive(normal_speed) * self.area, self.centroid);
    }

    /// Adds the force terms of the face along `-ŝ` (`ŝ` is `to_sun`) and `-n` to the sums for radiation
    /// pressure.
    ///
    /// The force on a face at its centroid is `F = -P A cos θ [(1 - ρs) ŝ + 2 (ρs cos θ + ρd/3) n]`, where
    /// `cos θ = (n·ŝ)₊`. [`PressureSums::wrench`] computes the force for `P = 1`; `RadiationPressure`
    /// multiplies it by `P`.
    #[inline(always)]
    pub(super) fn add_pressure(&self, to_sun: Vec3<S>, optics: &Optics<S>, sums: &mut PressureSums<S>) {
        let cosine = positive(self.normal.dot(to_sun));
        let lit = cosine * self.area;
        // along -ŝ:  A cos θ (1 - ρs)
        sums.push_along_light(lit * optics.along_light(), self.centroid);
        // along -n:  A cos θ 2 (ρs cos θ + ρd/3)
        sums.push_against_normal(optics.along_normal(cosine) * lit, self.normal, self.moment);
    }
}

/// Returns the positive part `x₊ = max(x, 0)`.
#[inline(always)]
fn positive<S: Real>(x: S) -> S {
    S::select(S::of(0.0).less(x), x, S::of(0.0))
}
