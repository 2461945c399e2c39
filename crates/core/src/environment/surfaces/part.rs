//! Parts of a surface, and what a stream of air or light does to each.

use super::error::{SurfaceError, not_negative};
use super::push::{Pressed, Swept};
use crate::spatial::{Real, Vec3};
use std::f64::consts::PI;

/// A flat face, seen from the side of its normal; axes of the body, positions from its centre of mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plate {
    area: f64,
    /// Unit vector, outward.
    normal: Vec3<f64>,
    centroid: Vec3<f64>,
    /// `c × n`
    moment: Vec3<f64>,
}

/// The curved side of a cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tube {
    /// Radius, m.
    pub(super) radius: f64,
    /// Length, m.
    pub(super) length: f64,
    /// Unit vector along it.
    pub(super) axis: Vec3<f64>,
    /// Its middle, m.
    pub(super) centre: Vec3<f64>,
}

/// A whole ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ball {
    /// Area of its disc, m².
    pub(super) area: f64,
    /// Its middle, m.
    pub(super) centre: Vec3<f64>,
    /// `C_R`: 1 where all light is absorbed or sent back as a mirror does, 13/9 for a matt one.
    pub(super) reflectivity: f64,
}

/// Shares of the light that a surface sends back; the rest is absorbed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Optics {
    specular: f64,
    diffuse: f64,
}

impl Optics {
    /// `specular` as a mirror does, `diffuse` as a matt wall does (Lambert); 0 to 1.
    ///
    /// # Errors
    /// [`SurfaceError::Value`] and [`SurfaceError::Reflection`].
    pub fn new(specular: f64, diffuse: f64) -> Result<Self, SurfaceError> {
        not_negative("specular", specular)?;
        not_negative("diffuse", diffuse)?;
        if specular + diffuse > 1.0 {
            return Err(SurfaceError::Reflection { specular, diffuse });
        }
        Ok(Self { specular, diffuse })
    }

    /// `C_R` of a ball: of a mirror's push that of a black one, of a matt one's 4/9 more.
    pub(super) fn of_ball(&self) -> f64 {
        1.0 + 4.0 / 9.0 * self.diffuse
    }
}

impl Plate {
    /// Of this area, m², outward unit normal, and place, m.
    pub(super) fn new(area: f64, normal: Vec3<f64>, centroid: Vec3<f64>) -> Self {
        Self { area, normal, centroid, moment: centroid.cross(normal) }
    }

    /// `A (n·u)₊`: what of it the wind meets, by the wind's speed.
    #[inline(always)]
    pub(super) fn blow<S: Real>(&self, v: Vec3<S>, w: Vec3<S>, swept: &mut Swept<S>) {
        // n·u = n·(v + w × c) = n·v + (c × n)·w
        let speed = Vec3::of(&self.normal).dot(v) + Vec3::of(&self.moment).dot(w);
        swept.add(positive(speed) * S::of(self.area), &self.centroid);
    }

    /// `-A cos θ [(1 - ρs) ŝ + 2 (ρs cos θ + ρd/3) n]`
    #[inline(always)]
    pub(super) fn shine<S: Real>(&self, to_sun: Vec3<S>, optics: &Optics, pressed: &mut Pressed<S>) {
        let normal = Vec3::of(&self.normal);
        let cosine = positive(normal.dot(to_sun));
        let lit = cosine * S::of(self.area);
        pressed.add(lit * S::of(1.0 - optics.specular), &self.centroid);
        let along_normal =
            cosine.mul_add(S::of(2.0 * optics.specular), S::of(2.0 / 3.0 * optics.diffuse)) * lit;
        pressed.force -= normal * along_normal;
        pressed.torque -= Vec3::of(&self.moment) * along_normal;
    }
}

impl Tube {
    /// Over the half in the wind: `Σ A (n·u)₊ = 2 r L |u⊥|`, its centroid is `π/4 r û⊥` off the axis.
    #[inline(always)]
    pub(super) fn blow<S: Real>(&self, v: Vec3<S>, w: Vec3<S>, swept: &mut Swept<S>) {
        let (axis, area) = (Vec3::of(&self.axis), 2.0 * self.radius * self.length);
        let u = v + w.cross(Vec3::of(&self.centre));
        let along = axis.dot(u);
        let across = u - axis * along;
        swept.add(across.norm() * S::of(area), &self.centre);
        // (π/4 r u⊥) × (-2 r L u),  u⊥ × u = -(a·u) a × u
        swept.torque += axis.cross(u) * (along * S::of(PI / 4.0 * self.radius * area));
    }

    /// The integral of a plate's over its lit half: `n = cos φ ŝ⊥ + sin φ …`, `n·s = σ cos φ`, `dA = r L dφ`, `|φ| < π/2`.
    #[inline(always)]
    pub(super) fn shine<S: Real>(&self, to_sun: Vec3<S>, optics: &Optics, pressed: &mut Pressed<S>) {
        let (s, Optics { specular, diffuse }) = (S::of, *optics);
        let (axis, area) = (Vec3::of(&self.axis), self.radius * self.length);
        let along = axis.dot(to_sun);
        let across = to_sun - axis * along;
        let sigma = across.norm();
        let absorbed = 2.0 * area * (1.0 - specular);
        pressed.add(sigma * s(absorbed), &self.centre);
        let reflected =
            across * sigma.mul_add(s(-8.0 / 3.0 * specular * area), s(-PI / 3.0 * diffuse * area));
        pressed.force += reflected;
        pressed.torque += Vec3::of(&self.centre).cross(reflected);
        pressed.torque += axis.cross(to_sun) * (along * s(PI / 4.0 * self.radius * absorbed));
    }
}

impl Ball {
    /// `A |u|`
    #[inline(always)]
    pub(super) fn blow<S: Real>(&self, v: Vec3<S>, w: Vec3<S>, swept: &mut Swept<S>) {
        let u = v + w.cross(Vec3::of(&self.centre));
        swept.add(u.norm() * S::of(self.area), &self.centre);
    }

    /// `-A C_R s`
    #[inline(always)]
    pub(super) fn shine<S: Real>(&self, pressed: &mut Pressed<S>) {
        pressed.add(S::of(self.area * self.reflectivity), &self.centre);
    }
}

/// `x₊`
#[inline(always)]
fn positive<S: Real>(x: S) -> S {
    S::select(S::of(0.0).less(x), x, S::of(0.0))
}
