//! A flat face in a stream of air or light.

use super::optics::Optics;
use super::sums::{Pressed, Swept};
use crate::environment::eight::Eight;
use crate::spatial::{Real, Vec3};

/// A flat face, seen from the side of its normal; axes of the body, positions from its centre of mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Plate<T> {
    pub(super) area: T,
    /// Unit vector, outward.
    normal: Vec3<T>,
    centroid: Vec3<T>,
    /// `c × n`
    moment: Vec3<T>,
}

impl Plate<f64> {
    /// Of this area, m², outward unit normal, and place, m.
    pub(super) fn new(area: f64, normal: Vec3<f64>, centroid: Vec3<f64>) -> Self {
        Self { area, normal, centroid, moment: centroid.cross(normal) }
    }

    /// One of each of eight bodies.
    pub(super) fn eight(plates: impl Fn(usize) -> Self) -> Plate<Eight> {
        Plate {
            area: Eight::of(|i| plates(i).area),
            normal: Eight::vectors(|i| plates(i).normal),
            centroid: Eight::vectors(|i| plates(i).centroid),
            moment: Eight::vectors(|i| plates(i).moment),
        }
    }
}

impl Plate<Eight> {
    #[inline(always)]
    pub(super) fn load<S: Real>(&self, offset: usize) -> Plate<S> {
        let vectors = |rows: &Vec3<Eight>| rows.map(|row| row.load(offset));
        let [normal, centroid, moment] = [&self.normal, &self.centroid, &self.moment].map(vectors);
        Plate { area: self.area.load(offset), normal, centroid, moment }
    }
}

impl<S: Real> Plate<S> {
    /// `A (n·u)₊`: what of it the wind meets, by the wind's speed.
    #[inline(always)]
    pub(super) fn blow(&self, v: Vec3<S>, w: Vec3<S>, swept: &mut Swept<S>) {
        // n·u = n·(v + w × c) = n·v + (c × n)·w
        let speed = self.normal.dot_add(v, self.moment.dot(w));
        swept.add(positive(speed) * self.area, self.centroid);
    }

    /// `-A cos θ [(1 - ρs) ŝ + 2 (ρs cos θ + ρd/3) n]`
    #[inline(always)]
    pub(super) fn shine(&self, to_sun: Vec3<S>, optics: &Optics<S>, pressed: &mut Pressed<S>) {
        let cosine = positive(self.normal.dot(to_sun));
        let lit = cosine * self.area;
        pressed.absorb(lit * optics.absorbed(), self.centroid);
        pressed.send_back(optics.along_normal(cosine) * lit, self.normal, self.moment);
    }
}

/// `x₊`
#[inline(always)]
fn positive<S: Real>(x: S) -> S {
    S::select(S::of(0.0).less(x), x, S::of(0.0))
}
