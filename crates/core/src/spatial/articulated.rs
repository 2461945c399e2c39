//! Articulated-body inertia: the apparent inertia of a body whose subtree can move at the joints.

use super::inertia::SpatialInertia;
use super::mat3::Mat3;
use super::motion::{Force, Motion};
use super::scalar::Real;
use super::sym3::Sym3;
use super::vec3::Vec3;
use std::ops::Add;

/// Articulated-body inertia: a symmetric 6 × 6 operator `[[A, H], [Hᵀ, I]]`, linear first, with 21
/// independent entries.
#[derive(Clone, Copy, Debug, Default)]
pub struct ArticulatedInertia<S> {
    /// Linear block, kg.
    pub linear: Sym3<S>,
    /// Coupling block, kg m, which maps angular acceleration to force.
    pub coupling: Mat3<S>,
    /// Angular block, kg m².
    pub angular: Sym3<S>,
}

impl<S: Real> ArticulatedInertia<S> {
    /// Returns the zero operator.
    #[inline(always)]
    pub fn zero() -> Self {
        let o = Sym3::diagonal(S::of(0.0));
        Self { linear: o, coupling: Mat3::zero(), angular: o }
    }

    /// Adds the inertia of a rigid body with mass `m` and first moment `h`: `A = m 1`, `H = −h×`, and `I`
    /// about the origin.
    #[inline(always)]
    pub fn add_rigid(&mut self, i: &SpatialInertia<S>) {
        let (a, c, h) = (&mut self.linear, &mut self.coupling, i.moment);
        (a.xx, a.yy, a.zz) = (a.xx + i.mass, a.yy + i.mass, a.zz + i.mass);
        (c.x.y, c.x.z) = (c.x.y - h.z, c.x.z + h.y);
        (c.y.x, c.y.z) = (c.y.x + h.z, c.y.z - h.x);
        (c.z.x, c.z.y) = (c.z.x - h.y, c.z.y + h.x);
        self.angular += i.about_origin;
    }

    /// Returns the force `IA a` for the acceleration `a`.
    #[inline(always)]
    pub fn apply(&self, a: Motion<S>) -> Force<S> {
        Force::new(
            self.linear * a.linear + self.coupling * a.angular,
            self.coupling.transpose_mul(a.linear) + self.angular * a.angular,
        )
    }

    /// Returns the operator shifted from the point `r` to the origin.
    ///
    /// `H' = H − A r×` and, with `Z = H + H'`, `I' = I + ½ (r× Z + (r× Z)ᵀ)`.
    #[inline(always)]
    #[must_use]
    pub fn from_point(&self, r: Vec3<S>) -> Self {
        let (a, h, i, half) = (&self.linear, &self.coupling, &self.angular, r * S::of(0.5));
        let [ax, ay, az] = a.columns();
        // column j of A r× is A (r × e_j)
        let coupling = Mat3::from_columns(
            ay.scale_add(-r.z, az.scale_add(r.y, h.x)),
            az.scale_add(-r.x, ax.scale_add(r.z, h.y)),
            ax.scale_add(-r.y, ay.scale_add(r.x, h.z)),
        );
        let z: Mat3<S> = *h + coupling;
        let (x, y, w) = (half.x, half.y, half.z);
        let pair = |a: S, p: S, b: S, q: S, s: S| a.mul_add(p, (-b).mul_add(q, s));
        let angular = Sym3::new(
            pair(r.y, z.x.z, r.z, z.x.y, i.xx),
            pair(r.z, z.y.x, r.x, z.y.z, i.yy),
            pair(r.x, z.z.y, r.y, z.z.x, i.zz),
            pair(y, z.y.z, w, z.y.y, pair(w, z.x.x, x, z.x.z, i.xy)),
            pair(y, z.z.z, w, z.z.y, pair(x, z.x.y, y, z.x.x, i.xz)),
            pair(w, z.z.x, x, z.z.z, pair(x, z.y.y, y, z.y.x, i.yz)),
        );
        Self { linear: *a, coupling, angular }
    }

    /// Returns `IA + U Wᵀ`. `W` must be a multiple of `U`, so that the sum is symmetric.
    #[inline(always)]
    #[must_use]
    pub fn add_parallel(&self, u: Force<S>, w: Force<S>) -> Self {
        Self {
            linear: self.linear.add_parallel(u.linear, w.linear),
            coupling: self.coupling.add_outer(u.linear, w.angular),
            angular: self.angular.add_parallel(u.angular, w.angular),
        }
    }

    /// Computes the factors of `IA⁻¹` by block elimination: `A⁻¹`, `A⁻¹ H` and `(I − Hᵀ A⁻¹ H)⁻¹`.
    #[inline(always)]
    pub fn inverse(&self) -> InverseArticulated<S> {
        let a = self.linear.inverse();
        let h = &self.coupling;
        let (x, y, z) = (a * h.x, a * h.y, a * h.z);
        let schur = Sym3::new(
            self.angular.xx - h.x.dot(x),
            self.angular.yy - h.y.dot(y),
            self.angular.zz - h.z.dot(z),
            self.angular.xy - h.x.dot(y),
            self.angular.xz - h.x.dot(z),
            self.angular.yz - h.y.dot(z),
        );
        InverseArticulated { linear: a, a_inv_h: Mat3::from_columns(x, y, z), angular: schur.inverse() }
    }

    /// Returns `IA⁻¹ f`, the acceleration that the force `f` causes.
    #[inline(always)]
    pub fn solve(&self, f: Force<S>) -> Motion<S> {
        self.inverse().apply(f)
    }
}

/// Factors of `IA⁻¹`, with which `IA⁻¹ f` can be computed for several forces `f`.
#[derive(Clone, Copy, Debug, Default)]
pub struct InverseArticulated<S> {
    /// `A⁻¹`.
    linear: Sym3<S>,
    /// `A⁻¹ H`.
    a_inv_h: Mat3<S>,
    /// `(I − Hᵀ A⁻¹ H)⁻¹`.
    angular: Sym3<S>,
}

impl<S> InverseArticulated<S> {
    /// Returns the factors with `f` applied to each entry.
    #[inline(always)]
    pub fn map<T>(&self, f: impl Fn(&S) -> T) -> InverseArticulated<T> {
        InverseArticulated {
            linear: self.linear.map(&f),
            a_inv_h: self.a_inv_h.map(&f),
            angular: self.angular.map(&f),
        }
    }
}

impl<S: Real> InverseArticulated<S> {
    /// Returns the motion `(v, ω) = IA⁻¹ (f, n)`: `ω = (I − Hᵀ A⁻¹ H)⁻¹ (n − (A⁻¹ H)ᵀ f)`,
    /// `v = A⁻¹ f − A⁻¹ H ω`.
    #[inline(always)]
    pub fn apply(&self, f: Force<S>) -> Motion<S> {
        let angular = self.angular * (f.angular - self.a_inv_h.transpose_mul(f.linear));
        Motion::new(self.linear * f.linear - self.a_inv_h * angular, angular)
    }
}

impl<S: Real> Add for ArticulatedInertia<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self {
            linear: self.linear + o.linear,
            coupling: self.coupling + o.coupling,
            angular: self.angular + o.angular,
        }
    }
}
