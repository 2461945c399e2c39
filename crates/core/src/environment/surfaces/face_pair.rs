//! Drag and radiation pressure on a pair of opposite flat faces.

use super::optics::Optics;
use super::sums::{DragSums, PressureSums};
use crate::environment::soa::Column8;
use crate::spatial::{Real, Vec3};

/// Two opposite faces of a box, or the two ends of a cylinder, in body axes with positions from the centre of
/// mass.
///
/// A stream strikes at most one of the two faces, because `n·u`, with the normal `n` and the velocity `u`
/// relative to the atmosphere, is equal at both centroids: they differ by a multiple of `n`, and
/// `n·(w × n) = 0` for every angular velocity `w`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct FacePair<T> {
    /// Area of each face, m².
    area: T,
    /// Distance from the centre to a face, m.
    half: T,
    /// Unit normal of both faces, up to sign.
    normal: Vec3<T>,
    /// Midpoint of the two faces, m.
    centre: Vec3<T>,
    /// Moment of the normal, `c × n` with the centroid `c` of either face, m.
    moment: Vec3<T>,
}

impl FacePair<f64> {
    /// Creates two faces of the given area, m², normal to a unit vector, at a `distance` from each other, m,
    /// and symmetric about `centre`, m.
    pub(super) fn new(area: f64, distance: f64, normal: Vec3<f64>, centre: Vec3<f64>) -> Self {
        Self { area, half: 0.5 * distance, normal, centre, moment: centre.cross(normal) }
    }

    /// Stores the face pairs of eight bodies in columns; `pairs(i)` returns the face pair of body `i`.
    pub(super) fn block(pairs: impl Fn(usize) -> Self) -> FacePair<Column8> {
        FacePair {
            area: Column8::of(|i| pairs(i).area),
            half: Column8::of(|i| pairs(i).half),
            normal: Column8::vectors(|i| pairs(i).normal),
            centre: Column8::vectors(|i| pairs(i).centre),
            moment: Column8::vectors(|i| pairs(i).moment),
        }
    }
}

impl FacePair<Column8> {
    #[inline(always)]
    pub(super) fn load<S: Real>(&self, offset: usize) -> FacePair<S> {
        let vectors = |columns: &Vec3<Column8>| columns.map(|column| column.load(offset));
        let [normal, centre, moment] = [&self.normal, &self.centre, &self.moment].map(vectors);
        FacePair { area: self.area.load(offset), half: self.half.load(offset), normal, centre, moment }
    }
}

impl<S: Real> FacePair<S> {
    /// Returns `x` if `speed` is not negative, which exposes the face on the side of the normal, and `-x`
    /// otherwise.
    #[inline(always)]
    fn facing(speed: S, x: S) -> S {
        S::select(speed.less(S::of(0.0)), -x, x)
    }

    /// Adds the term `a = A |n·u|` of the exposed face to the sums for drag, with `v` and `w` as in
    /// [`DragSums::wrench`]. The drag at the centroid of the face is `F = -½ ρ C_D a u`.
    #[inline(always)]
    pub(super) fn add_drag(&self, v: Vec3<S>, w: Vec3<S>, sums: &mut DragSums<S>) {
        // n·u = n·v + (c × n)·w
        let normal_speed = self.normal.dot_add(v, self.moment.dot(w));
        let centroid = self.normal.scale_add(Self::facing(normal_speed, self.half), self.centre);
        // a = A |n·u|
        sums.add(normal_speed.abs() * self.area, centroid);
    }

    /// Adds the force of radiation pressure, `F = -P A cos θ [(1 - ρs) ŝ + 2 (ρs cos θ + ρd/3) n]` with
    /// `P = 1`, on the face that is turned towards the Sun. The symbols are defined at `RadiationPressure`.
    #[inline(always)]
    pub(super) fn add_pressure(&self, to_sun: Vec3<S>, optics: &Optics<S>, sums: &mut PressureSums<S>) {
        let along = self.normal.dot(to_sun);
        let cosine = along.abs();
        let lit = cosine * self.area;
        let centroid = self.normal.scale_add(Self::facing(along, self.half), self.centre);
        // along -ŝ:  A cos θ (1 - ρs)
        sums.push_along_light(lit * optics.along_light(), centroid);
        // along -n:  A cos θ 2 (ρs cos θ + ρd/3)
        sums.push_against_normal(
            Self::facing(along, optics.along_normal(cosine) * lit),
            self.normal,
            self.moment,
        );
    }
}
