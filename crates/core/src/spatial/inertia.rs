//! Inertia of a rigid body about its centre of mass and about other points.

use super::motion::{Force, Motion};
use super::scalar::Real;
use super::sym3::Sym3;
use super::vec3::Vec3;
use std::ops::{Add, AddAssign};

/// Inertia of a rigid body: mass, centre of mass `c`, and inertia `I_c` about the centre of mass.
///
/// Twists, momenta and forces refer to the origin, but their products with the inertia are formed at the
/// centre of mass, which avoids cancellation for small bodies far from the origin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidInertia<S> {
    /// Mass, kg.
    pub mass: S,
    /// Centre of mass, m.
    pub com: Vec3<S>,
    /// Rotational inertia about the centre of mass, kg m².
    pub about_com: Sym3<S>,
}

impl<S: Real> RigidInertia<S> {
    /// Returns the inertia about the origin.
    #[inline(always)]
    pub fn about_origin(&self) -> SpatialInertia<S> {
        SpatialInertia::at_com(self.mass, self.com, self.about_com)
    }

    /// Returns the momentum `(p, L)` for the twist `(v, ω)`: `p = m (v + ω × c)`, `L = I_c ω + c × p`.
    #[inline(always)]
    pub fn momentum(&self, v: Motion<S>) -> Force<S> {
        Force::at(v.at(self.com) * self.mass, self.about_com * v.angular, self.com)
    }

    /// Returns the rate of change `(f, n)` of the momentum, `I a + v ×* I v`, for the twist `(v, ω)` and the
    /// spatial acceleration `(a, α)`:
    ///
    /// `f = m (a + α × c + ω × (v + ω × c))`, `n = I_c α + ω × I_c ω + c × f`.
    #[inline(always)]
    pub fn inertial_force(&self, v: Motion<S>, a: Motion<S>) -> Force<S> {
        let force = v.angular.cross_add(v.at(self.com), a.at(self.com)) * self.mass;
        let moment = v.angular.cross_add(self.about_com * v.angular, self.about_com * a.angular);
        Force::at(force, moment, self.com)
    }
}

/// Inertia about the origin: mass `m`, first moment `h = m c` and rotational inertia `I_o`.
///
/// The 6 × 6 matrix, linear first, is `[[m 1, −h×], [h×, I_o]]`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpatialInertia<S> {
    /// Mass, kg.
    pub mass: S,
    /// Mass times centre of mass, kg m.
    pub moment: Vec3<S>,
    /// Rotational inertia about the origin, kg m².
    pub about_origin: Sym3<S>,
}

impl<S: Real> SpatialInertia<S> {
    /// Returns the inertia of a body without mass.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { mass: S::of(0.0), moment: Vec3::zero(), about_origin: Sym3::diagonal(S::of(0.0)) }
    }

    /// Creates the inertia from the centre of mass `c` and the inertia `about_com` about the centre of mass.
    #[inline(always)]
    pub fn at_com(mass: S, c: Vec3<S>, about_com: Sym3<S>) -> Self {
        let moment = c * mass;
        Self { mass, moment, about_origin: about_com.shift(moment, c) }
    }

    /// Returns the momentum `(p, L)` for the twist `(v, ω)`: `p = m v + ω × h`, `L = I_o ω + h × v`.
    #[inline(always)]
    pub fn momentum(&self, v: Motion<S>) -> Force<S> {
        Force::new(
            v.angular.cross_add(self.moment, v.linear * self.mass),
            self.moment.cross_add(v.linear, self.about_origin * v.angular),
        )
    }

    /// Returns the inertia shifted from the point `r` to the origin: with `h' = h + m r`,
    ///
    /// `I_o' = I_o + 2 (h · r) 1 − (h rᵀ + r hᵀ) + m (r² 1 − r rᵀ)`.
    #[inline(always)]
    #[must_use]
    pub fn from_point(&self, r: Vec3<S>) -> Self {
        let (h, i, twice, mr) = (self.moment, &self.about_origin, r + r, r * self.mass);
        let (x, y, z) = (
            h.x.mul_add(twice.x, mr.x * r.x),
            h.y.mul_add(twice.y, mr.y * r.y),
            h.z.mul_add(twice.z, mr.z * r.z),
        );
        let product = |a: S, p: S, b: S, q: S, own: S| a.mul_add(p, b.mul_add(q, own));
        let about_origin = Sym3::new(
            i.xx + (y + z),
            i.yy + (x + z),
            i.zz + (x + y),
            i.xy - product(h.x, r.y, h.y, r.x, mr.x * r.y),
            i.xz - product(h.x, r.z, h.z, r.x, mr.x * r.z),
            i.yz - product(h.y, r.z, h.z, r.y, mr.y * r.z),
        );
        Self { mass: self.mass, moment: h + mr, about_origin }
    }

    /// Returns the centre of mass, m. The mass must not be zero.
    #[inline(always)]
    pub fn com(&self) -> Vec3<S> {
        self.moment * (S::of(1.0) / self.mass)
    }

    /// Returns the inertia about the centre of mass, kg m².
    #[inline(always)]
    pub fn about_com(&self) -> Sym3<S> {
        self.about_origin.shift(-self.moment, self.com())
    }
}

/// Factors of `I⁻¹`, with which `I⁻¹ f` can be computed for several forces `f`.
#[derive(Clone, Copy, Debug, Default)]
pub struct InverseInertia<S> {
    inverse_mass: S,
    /// Centre of mass, m.
    pub com: Vec3<S>,
    inverse_about_com: Sym3<S>,
}

impl<S: Real> SpatialInertia<S> {
    /// Computes the factors of `I⁻¹`. The mass must not be zero.
    #[inline(always)]
    pub fn inverse(&self) -> InverseInertia<S> {
        let inverse_mass = S::of(1.0) / self.mass;
        let com = self.moment * inverse_mass;
        let about_com = self.about_origin.shift(-self.moment, com);
        InverseInertia { inverse_mass, com, inverse_about_com: about_com.inverse() }
    }
}

impl<S: Real> InverseInertia<S> {
    /// Returns the motion `(v, ω) = I⁻¹ (f, n)`, where both the motion and the force `(f, n)` are about the
    /// centre of mass. There the linear and angular parts decouple: `ω = I_c⁻¹ n`, `v = f/m`.
    #[inline(always)]
    pub fn at_com(&self, f: Force<S>) -> Motion<S> {
        Motion::new(f.linear * self.inverse_mass, self.inverse_about_com * f.angular)
    }

    /// Returns the motion `(v, ω) = I⁻¹ (f, n)`, both about the origin: `ω = I_c⁻¹ (n − c × f)`,
    /// `v = f/m − ω × c`.
    #[inline(always)]
    pub fn apply(&self, f: Force<S>) -> Motion<S> {
        let angular = self.inverse_about_com * (f.angular - self.com.cross(f.linear));
        Motion::new(f.linear.scale_add(self.inverse_mass, self.com.cross(angular)), angular)
    }
}

impl<S: Real> Add for SpatialInertia<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self {
            mass: self.mass + o.mass,
            moment: self.moment + o.moment,
            about_origin: self.about_origin + o.about_origin,
        }
    }
}
impl<S: Real> AddAssign for SpatialInertia<S> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}
