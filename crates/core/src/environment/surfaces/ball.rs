//! A ball in a stream of air or light.

use super::sums::{Pressed, Swept};
use crate::environment::eight::Eight;
use crate::spatial::{Real, Vec3};

/// A whole ball.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Ball<T> {
    /// Area of its disc, m².
    pub(super) area: T,
    /// Its middle, m.
    pub(super) centre: Vec3<T>,
    /// `C_R`: 1 where all light is absorbed or sent back as a mirror does, 13/9 for a matt one.
    pub(super) reflectivity: T,
}

impl Ball<f64> {
    /// One of each of eight bodies.
    pub(super) fn eight(balls: impl Fn(usize) -> Self) -> Ball<Eight> {
        Ball {
            area: Eight::of(|i| balls(i).area),
            centre: Eight::vectors(|i| balls(i).centre),
            reflectivity: Eight::of(|i| balls(i).reflectivity),
        }
    }
}

impl Ball<Eight> {
    #[inline(always)]
    pub(super) fn load<S: Real>(&self, offset: usize) -> Ball<S> {
        let centre = self.centre.map(|row| row.load(offset));
        Ball { area: self.area.load(offset), centre, reflectivity: self.reflectivity.load(offset) }
    }
}

impl<S: Real> Ball<S> {
    /// `A |u|`
    #[inline(always)]
    pub(super) fn blow(&self, v: Vec3<S>, w: Vec3<S>, swept: &mut Swept<S>) {
        let u = v + w.cross(self.centre);
        swept.add(u.norm() * self.area, self.centre);
    }

    /// `-A C_R s`
    #[inline(always)]
    pub(super) fn shine(&self, pressed: &mut Pressed<S>) {
        pressed.absorb(self.area * self.reflectivity, self.centre);
    }
}
