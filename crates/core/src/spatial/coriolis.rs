//! Coriolis operator of rigid bodies, from which the derivatives of the equations of motion are computed.

use super::inertia::SpatialInertia;
use super::mat3::Mat3;
use super::motion::{Force, Motion};
use super::scalar::Real;
use super::vec3::Vec3;
use std::ops::AddAssign;

/// Coriolis operator `2B = v×* I − I v× + (I v) ×̄*` of one or several bodies with inertia `I` and twist `v`,
/// where `f ×̄* m = m ×* f`.
///
/// For a motion `m` with the angular half `ω`, `2B m` is the force `2 ω × ṙ dm` summed over all points `r` of
/// the body: with `p = ∫ ṙ dm` and `N = ∫ ṙ rᵀ dm`, `2B m = (2 ω × p, 2 (tr N ω − N ω))`. It does not depend
/// on the linear half of `m`.
///
/// Source: Singh, Russell and Wensing, IEEE Robotics and Automation Letters 7(2), 2022.
#[derive(Clone, Copy, Debug, Default)]
pub struct Coriolis<S> {
    /// `2 p`, kg m/s.
    momentum: Vec3<S>,
    /// `2 (tr N 1 − N)`, kg m²/s.
    moment: Mat3<S>,
}

impl<S: Real> Coriolis<S> {
    /// Creates the operator of a body with inertia `i`, twist `v = (u, ω)` and `momentum` `I v`.
    #[inline(always)]
    pub fn of(i: &SpatialInertia<S>, v: Motion<S>, momentum: Force<S>) -> Self {
        let (j, w, two) = (&i.about_origin, v.angular, S::of(2.0));
        // ∫ r rᵀ dm = ½ tr(J) 1 − J, multiplied by two, by columns
        let trace = j.xx + j.yy + j.zz;
        let x = Vec3::new(trace - two * j.xx, -(two * j.xy), -(two * j.xz));
        let y = Vec3::new(-(two * j.xy), trace - two * j.yy, -(two * j.yz));
        let z = Vec3::new(-(two * j.xz), -(two * j.yz), trace - two * j.zz);
        // 2 N = 2 u hᵀ + ω × 2 ∫ r rᵀ dm
        let (h, u) = (i.moment, v.linear * two);
        let n = [u.scale_add(h.x, w.cross(x)), u.scale_add(h.y, w.cross(y)), u.scale_add(h.z, w.cross(z))];
        let (xx, yy, zz) = (n[0].x, n[1].y, n[2].z);
        Self {
            momentum: momentum.linear * two,
            moment: Mat3::from_columns(
                Vec3::new(yy + zz, -n[0].y, -n[0].z),
                Vec3::new(-n[1].x, xx + zz, -n[1].z),
                Vec3::new(-n[2].x, -n[2].y, xx + yy),
            ),
        }
    }

    /// Returns the operator shifted from the point `r` to the origin: `N' = N + p rᵀ`.
    #[inline(always)]
    #[must_use]
    pub fn from_point(&self, r: Vec3<S>) -> Self {
        let p = self.momentum;
        let (x, y, z) = (p.x * r.x, p.y * r.y, p.z * r.z);
        let mut moment = self.moment.add_outer(-p, r);
        let trace = x + y + z;
        moment.x.x += trace;
        moment.y.y += trace;
        moment.z.z += trace;
        Self { momentum: p, moment }
    }

    /// Returns `2B m` for the angular half `ω` of `m`.
    #[inline(always)]
    pub fn apply(&self, omega: Vec3<S>) -> Force<S> {
        Force::new(omega.cross(self.momentum), self.moment * omega)
    }

    /// Returns the angular half of `2Bᵀ m`; the linear half is zero.
    #[inline(always)]
    pub fn transpose_apply(&self, m: Motion<S>) -> Vec3<S> {
        self.momentum.cross(m.linear) + self.moment.transpose_mul(m.angular)
    }
}

impl<S: Real> AddAssign for Coriolis<S> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        self.momentum += o.momentum;
        self.moment += o.moment;
    }
}
