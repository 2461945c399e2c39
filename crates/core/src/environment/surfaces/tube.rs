//! The side of a cylinder in a stream of air or light.

use super::optics::Optics;
use super::sums::{Pressed, Swept};
use crate::environment::eight::Eight;
use crate::spatial::{Real, Vec3};
use std::f64::consts::PI;

/// The curved side of a cylinder.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Tube<T> {
    /// Radius, m.
    pub(super) radius: T,
    /// Length, m.
    pub(super) length: T,
    /// Unit vector along it.
    pub(super) axis: Vec3<T>,
    /// Its middle, m.
    pub(super) centre: Vec3<T>,
}

impl Tube<f64> {
    /// One of each of eight bodies.
    pub(super) fn eight(tubes: impl Fn(usize) -> Self) -> Tube<Eight> {
        Tube {
            radius: Eight::of(|i| tubes(i).radius),
            length: Eight::of(|i| tubes(i).length),
            axis: Eight::vectors(|i| tubes(i).axis),
            centre: Eight::vectors(|i| tubes(i).centre),
        }
    }
}

impl Tube<Eight> {
    #[inline(always)]
    pub(super) fn load<S: Real>(&self, offset: usize) -> Tube<S> {
        let [axis, centre] = [&self.axis, &self.centre].map(|rows| rows.map(|row| row.load(offset)));
        Tube { radius: self.radius.load(offset), length: self.length.load(offset), axis, centre }
    }
}

impl<S: Real> Tube<S> {
    /// Over the half in the wind: `Σ A (n·u)₊ = 2 r L |u⊥|`, its centroid is `π/4 r û⊥` off the axis.
    #[inline(always)]
    pub(super) fn blow(&self, v: Vec3<S>, w: Vec3<S>, swept: &mut Swept<S>) {
        let (axis, area) = (self.axis, S::of(2.0) * self.radius * self.length);
        let u = v + w.cross(self.centre);
        let along = axis.dot(u);
        let across = u - axis * along;
        swept.add(across.norm() * area, self.centre);
        // (π/4 r u⊥) × (-2 r L u),  u⊥ × u = -(a·u) a × u
        swept.torque += axis.cross(u) * (along * S::of(PI / 4.0) * self.radius * area);
    }

    /// The integral of a plate's over its lit half: `n = cos φ ŝ⊥ + sin φ …`, `n·s = σ cos φ`, `dA = r L dφ`, `|φ| < π/2`.
    #[inline(always)]
    pub(super) fn shine(&self, to_sun: Vec3<S>, optics: &Optics<S>, pressed: &mut Pressed<S>) {
        let (s, Optics { specular, diffuse }) = (S::of, *optics);
        let (axis, area) = (self.axis, self.radius * self.length);
        let along = axis.dot(to_sun);
        let across = to_sun - axis * along;
        let sigma = across.norm();
        let absorbed = s(2.0) * area * optics.absorbed();
        pressed.absorb(sigma * absorbed, self.centre);
        let reflected = across * (sigma.mul_add(s(-8.0 / 3.0) * specular, s(-PI / 3.0) * diffuse) * area);
        pressed.force += reflected;
        pressed.torque += self.centre.cross(reflected);
        pressed.torque += axis.cross(to_sun) * (along * s(PI / 4.0) * self.radius * absorbed);
    }
}
