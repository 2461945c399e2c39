//! Parts of a surface, and what a stream of air or light does to each.

use super::error::{SurfaceError, not_negative};
use crate::spatial::{Scalar, Vec3};
use std::f64::consts::PI;

/// A part of a body's outside; axes of the body, positions from its centre of mass, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    /// Flat, seen from the side of its normal.
    Plate {
        /// Area, m².
        area: f64,
        /// Unit normal, outward.
        normal: Vec3<f64>,
        /// Where its area is centred.
        centroid: Vec3<f64>,
    },
    /// Two opposite faces, of which a stream meets one.
    Slab {
        /// Area of each, m².
        area: f64,
        /// Unit normal of one; the other's is opposite.
        normal: Vec3<f64>,
        /// The middle between them.
        centre: Vec3<f64>,
        /// Half the distance between them, m.
        half: f64,
    },
    /// The curved side of a cylinder.
    Tube {
        /// Radius, m.
        radius: f64,
        /// Length, m.
        length: f64,
        /// Unit vector along it.
        axis: Vec3<f64>,
        /// Its middle.
        centre: Vec3<f64>,
    },
    /// A whole ball.
    Ball {
        /// Area of its disc, m².
        area: f64,
        /// Its middle.
        centre: Vec3<f64>,
    },
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
}

/// A force through the centre of mass and a torque about it, axes of the body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Push<S> {
    pub(super) force: Vec3<S>,
    pub(super) torque: Vec3<S>,
}

impl<S: Scalar> Push<S> {
    #[inline(always)]
    pub(super) fn none() -> Self {
        Self { force: Vec3::zero(), torque: Vec3::zero() }
    }

    #[inline(always)]
    fn add(&mut self, force: Vec3<S>, torque: Vec3<S>) {
        self.force += force;
        self.torque += torque;
    }
}

impl Part {
    /// `-Σ A (n·u)₊ u` and its torque: drag but for `½ ρ C_D`.
    ///
    /// `u = v + w × c` is the velocity of the part's middle in the air, `v` that of the centre of mass and `w` the
    /// turn relative to the air, body axes. Since `|u|² (n·û) û = (n·u) u`, no root is needed for a plate.
    #[inline(always)]
    pub(super) fn blow<S: Scalar>(&self, v: Vec3<S>, w: Vec3<S>, push: &mut Push<S>) {
        let (s, of) = (S::of, Vec3::<S>::of);
        match *self {
            Self::Plate { area, normal, centroid } => {
                let (normal, centroid) = (of(&normal), of(&centroid));
                let u = v + w.cross(centroid);
                // F = -A (n·u)₊ u,  T = c × F
                let force = u * (positive(normal.dot(u)) * s(-area));
                push.add(force, centroid.cross(force));
            }
            Self::Slab { area, normal, centre, half } => {
                let (normal, centre) = (of(&normal), of(&centre));
                // the turn moves neither face along its normal: n·u is that of the middle
                let side = normal * signed(s(half), normal.dot(v + w.cross(centre)));
                let centroid = centre + side;
                let u = v + w.cross(centroid);
                let force = u * (normal.dot(u).abs() * s(-area));
                push.add(force, centroid.cross(force));
            }
            Self::Tube { radius, length, axis, centre } => {
                let (axis, centre) = (of(&axis), of(&centre));
                // over the half in the wind: Σ A (n·u)₊ = 2 r L |u⊥|, its centroid is π/4 r û⊥ off the axis
                let u = v + w.cross(centre);
                let across = u - axis * axis.dot(u);
                let speed = across.norm();
                let side = u * s(-2.0 * radius * length);
                push.add(side * speed, (centre * speed + across * s(PI / 4.0 * radius)).cross(side));
            }
            Self::Ball { area, centre } => {
                let centre = of(&centre);
                let u = v + w.cross(centre);
                let force = u * (u.norm() * s(-area));
                push.add(force, centre.cross(force));
            }
        }
    }

    /// `-Σ A (n·s)₊ [(1 - ρs) s + 2 (ρs n·s + ρd/3) n]` and its torque: light's push but for its pressure.
    ///
    /// `s`, here `to_sun`, points to the Sun, body axes. Of a ball a mirror's push is that of a black one, of a matt one 4/9
    /// more; a tube is the integral of the same over its lit half.
    ///
    /// Source: Montenbruck and Gill, Satellite Orbits, Springer 2000, section 3.4; Wertz, Spacecraft Attitude
    /// Determination and Control, 1978, section 17.2.
    #[inline(always)]
    pub(super) fn shine<S: Scalar>(&self, to_sun: Vec3<S>, optics: &Optics, push: &mut Push<S>) {
        let (s, of) = (S::of, Vec3::<S>::of);
        let Optics { specular, diffuse } = *optics;
        match *self {
            Self::Plate { area, normal, centroid } => {
                let (normal, centroid) = (of(&normal), of(&centroid));
                let force = lit(to_sun, normal, positive(normal.dot(to_sun)), optics) * s(area);
                push.add(force, centroid.cross(force));
            }
            Self::Slab { area, normal, centre, half } => {
                let (normal, centre) = (of(&normal), of(&centre));
                let cosine = normal.dot(to_sun);
                let facing = normal * signed(s(1.0), cosine);
                let force = lit(to_sun, facing, cosine.abs(), optics) * s(area);
                push.add(force, (centre + facing * s(half)).cross(force));
            }
            Self::Tube { radius, length, axis, centre } => {
                let (axis, centre) = (of(&axis), of(&centre));
                // n = cos φ ŝ⊥ + sin φ …,  n·s = σ cos φ,  dA = r L dφ over |φ| < π/2
                let across = to_sun - axis * axis.dot(to_sun);
                let sigma = across.norm();
                let area = radius * length;
                let absorbed = to_sun * s(-2.0 * area * (1.0 - specular));
                let reflected =
                    across * ((sigma * s(8.0 / 3.0 * specular) + s(PI / 3.0 * diffuse)) * s(-area));
                let force = absorbed * sigma + reflected;
                let torque = (across * s(PI / 4.0 * radius)).cross(absorbed);
                push.add(force, centre.cross(force) + torque);
            }
            Self::Ball { area, centre } => {
                let centre = of(&centre);
                let force = to_sun * s(-area * (1.0 + 4.0 / 9.0 * diffuse));
                push.add(force, centre.cross(force));
            }
        }
    }
}

/// `-cos θ [(1 - ρs) ŝ + 2 (ρs cos θ + ρd/3) n]`.
#[inline(always)]
fn lit<S: Scalar>(to_sun: Vec3<S>, normal: Vec3<S>, cosine: S, optics: &Optics) -> Vec3<S> {
    let along_normal = (cosine * S::of(optics.specular) + S::of(optics.diffuse / 3.0)) * S::of(2.0);
    (to_sun * S::of(1.0 - optics.specular) + normal * along_normal) * -cosine
}

/// `x₊`
#[inline(always)]
fn positive<S: Scalar>(x: S) -> S {
    S::select(S::of(0.0).less(x), x, S::of(0.0))
}

/// `x` with the sign of `y`.
#[inline(always)]
fn signed<S: Scalar>(x: S, y: S) -> S {
    S::select(y.less(S::of(0.0)), -x, x)
}
