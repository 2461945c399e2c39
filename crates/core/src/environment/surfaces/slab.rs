//! Two faces back to back in a stream of air or light.

use super::optics::Optics;
use super::sums::{Pressed, Swept};
use crate::environment::eight::Eight;
use crate::spatial::{Real, Vec3};

/// Opposite faces of a box, the ends of a cylinder; axes of the body, positions from its centre of mass.
///
/// Of two such faces a stream meets one: `n·u` is the same all along `n`, since `n·(w × n) = 0`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Slab<T> {
    /// Of each face, m².
    area: T,
    /// From the middle to a face, m.
    half: T,
    /// Unit vector across.
    normal: Vec3<T>,
    /// Its middle, m.
    centre: Vec3<T>,
    /// `c × n`, the same for both faces.
    moment: Vec3<T>,
}

impl Slab<f64> {
    /// Two faces of this area, m², `thickness` apart, m, across a unit normal, about a place, m.
    pub(super) fn new(area: f64, thickness: f64, normal: Vec3<f64>, centre: Vec3<f64>) -> Self {
        Self { area, half: 0.5 * thickness, normal, centre, moment: centre.cross(normal) }
    }

    /// One of each of eight bodies.
    pub(super) fn eight(slabs: impl Fn(usize) -> Self) -> Slab<Eight> {
        Slab {
            area: Eight::of(|i| slabs(i).area),
            half: Eight::of(|i| slabs(i).half),
            normal: Eight::vectors(|i| slabs(i).normal),
            centre: Eight::vectors(|i| slabs(i).centre),
            moment: Eight::vectors(|i| slabs(i).moment),
        }
    }
}

impl Slab<Eight> {
    #[inline(always)]
    pub(super) fn load<S: Real>(&self, offset: usize) -> Slab<S> {
        let vectors = |rows: &Vec3<Eight>| rows.map(|row| row.load(offset));
        let [normal, centre, moment] = [&self.normal, &self.centre, &self.moment].map(vectors);
        Slab { area: self.area.load(offset), half: self.half.load(offset), normal, centre, moment }
    }
}

impl<S: Real> Slab<S> {
    /// `x` on the side of the normal that looks into a stream of `speed` along it, `-x` on the other.
    #[inline(always)]
    fn facing(speed: S, x: S) -> S {
        S::select(speed.less(S::of(0.0)), -x, x)
    }

    /// `A |n·u|`, at the face that looks into the wind.
    #[inline(always)]
    pub(super) fn blow(&self, v: Vec3<S>, w: Vec3<S>, swept: &mut Swept<S>) {
        // n·u = n·v + (c × n)·w
        let speed = self.normal.dot_add(v, self.moment.dot(w));
        let face = self.normal.scale_add(Self::facing(speed, self.half), self.centre);
        swept.add(speed.abs() * self.area, face);
    }

    /// `-A cos θ [(1 - ρs) ŝ + 2 (ρs cos θ + ρd/3) n]`, of the face that looks to the Sun.
    #[inline(always)]
    pub(super) fn shine(&self, to_sun: Vec3<S>, optics: &Optics<S>, pressed: &mut Pressed<S>) {
        let along = self.normal.dot(to_sun);
        let cosine = along.abs();
        let lit = cosine * self.area;
        let face = self.normal.scale_add(Self::facing(along, self.half), self.centre);
        pressed.absorb(lit * optics.absorbed(), face);
        pressed.send_back(Self::facing(along, optics.along_normal(cosine) * lit), self.normal, self.moment);
    }
}
