//! Symmetric 3 × 3 matrices.

use super::mat3::Mat3;
use super::scalar::{Real, Scalar};
use super::vec3::Vec3;
use nalgebra::Matrix3;
use std::ops::{Add, AddAssign, Mul, Sub};

/// Symmetric 3 × 3 matrix `A`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sym3<S> {
    /// First diagonal entry.
    pub xx: S,
    /// Second diagonal entry.
    pub yy: S,
    /// Third diagonal entry.
    pub zz: S,
    /// Entry (0, 1).
    pub xy: S,
    /// Entry (0, 2).
    pub xz: S,
    /// Entry (1, 2).
    pub yz: S,
}

impl<S> Sym3<S> {
    /// Returns the matrix with `f` applied to each entry.
    #[inline(always)]
    pub fn map<T>(&self, f: impl Fn(&S) -> T) -> Sym3<T> {
        let Self { xx, yy, zz, xy, xz, yz } = self;
        Sym3 { xx: f(xx), yy: f(yy), zz: f(zz), xy: f(xy), xz: f(xz), yz: f(yz) }
    }
}

impl<S: Real> Sym3<S> {
    /// Creates the matrix from its six independent entries.
    #[inline(always)]
    pub fn new(xx: S, yy: S, zz: S, xy: S, xz: S, yz: S) -> Self {
        Self { xx, yy, zz, xy, xz, yz }
    }

    /// Returns the multiple `s 1` of the identity matrix.
    #[inline(always)]
    pub fn diagonal(s: S) -> Self {
        let o = S::of(0.0);
        Self::new(s, s, s, o, o, o)
    }

    /// Creates the matrix with `m` in every lane.
    #[inline(always)]
    pub fn of(m: &Sym3<f64>) -> Self {
        Self::new(S::of(m.xx), S::of(m.yy), S::of(m.zz), S::of(m.xy), S::of(m.xz), S::of(m.yz))
    }

    /// Returns the three columns.
    #[inline(always)]
    pub fn columns(&self) -> [Vec3<S>; 3] {
        let Self { xx, yy, zz, xy, xz, yz } = *self;
        [Vec3::new(xx, xy, xz), Vec3::new(xy, yy, yz), Vec3::new(xz, yz, zz)]
    }

    /// Returns `A + u uᵀ s`.
    #[inline(always)]
    #[must_use]
    pub fn add_outer(&self, u: Vec3<S>, s: S) -> Self {
        self.add_parallel(u, u * s)
    }

    /// Returns `A + u wᵀ`. `w` must be a multiple of `u`, so that the sum is symmetric.
    #[inline(always)]
    #[must_use]
    pub fn add_parallel(&self, u: Vec3<S>, w: Vec3<S>) -> Self {
        Self::new(
            u.x.mul_add(w.x, self.xx),
            u.y.mul_add(w.y, self.yy),
            u.z.mul_add(w.z, self.zz),
            u.x.mul_add(w.y, self.xy),
            u.x.mul_add(w.z, self.xz),
            u.y.mul_add(w.z, self.yz),
        )
    }

    /// Returns `R A Rᵀ`, which is the tensor `A` in other axes.
    #[inline(always)]
    #[must_use]
    pub fn rotate(&self, r: &Mat3<S>) -> Self {
        // columns of R A, then the six required products with rows of R
        let (p, q, s) = (
            r.x.scale_add(self.xx, r.y.scale_add(self.xy, r.z * self.xz)),
            r.x.scale_add(self.xy, r.y.scale_add(self.yy, r.z * self.yz)),
            r.x.scale_add(self.xz, r.y.scale_add(self.yz, r.z * self.zz)),
        );
        let entry = |pi: S, qi: S, si: S, a: S, b: S, c: S| pi.mul_add(a, qi.mul_add(b, si * c));
        Self::new(
            entry(p.x, q.x, s.x, r.x.x, r.y.x, r.z.x),
            entry(p.y, q.y, s.y, r.x.y, r.y.y, r.z.y),
            entry(p.z, q.z, s.z, r.x.z, r.y.z, r.z.z),
            entry(p.x, q.x, s.x, r.x.y, r.y.y, r.z.y),
            entry(p.x, q.x, s.x, r.x.z, r.y.z, r.z.z),
            entry(p.y, q.y, s.y, r.x.z, r.y.z, r.z.z),
        )
    }

    /// Returns `A + m (c² 1 − c cᵀ)`, the shift of an inertia by `c` (parallel-axis theorem), where
    /// `h = m c`.
    #[inline(always)]
    #[must_use]
    pub fn shift(&self, h: Vec3<S>, c: Vec3<S>) -> Self {
        let (sx, sy, sz) = (h.x * c.x, h.y * c.y, h.z * c.z);
        Self::new(
            self.xx + (sy + sz),
            self.yy + (sx + sz),
            self.zz + (sx + sy),
            self.xy - h.x * c.y,
            self.xz - h.x * c.z,
            self.yz - h.y * c.z,
        )
    }

    /// Returns `A⁻¹` by cofactors. The matrix must be positive definite.
    #[inline(always)]
    #[must_use]
    pub fn inverse(&self) -> Self {
        let xx = self.yy.mul_add(self.zz, -(self.yz * self.yz));
        let xy = self.xz.mul_add(self.yz, -(self.xy * self.zz));
        let xz = self.xy.mul_add(self.yz, -(self.xz * self.yy));
        let yy = self.xx.mul_add(self.zz, -(self.xz * self.xz));
        let yz = self.xy.mul_add(self.xz, -(self.xx * self.yz));
        let zz = self.xx.mul_add(self.yy, -(self.xy * self.xy));
        let det = self.xx.mul_add(xx, self.xy.mul_add(xy, self.xz * xz));
        let d = S::of(1.0) / det;
        Self::new(xx * d, yy * d, zz * d, xy * d, xz * d, yz * d)
    }
}

impl<S: Scalar> Sym3<S> {
    /// Returns the matrix as a nalgebra matrix.
    #[inline(always)]
    pub fn to_nalgebra(self) -> Matrix3<f64> {
        let [xx, yy, zz, xy, xz, yz] =
            [self.xx, self.yy, self.zz, self.xy, self.xz, self.yz].map(Scalar::value);
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }
}

impl From<Matrix3<f64>> for Sym3<f64> {
    /// Returns the symmetric part of a matrix.
    fn from(m: Matrix3<f64>) -> Self {
        let mean = |i, j| 0.5 * (m[(i, j)] + m[(j, i)]);
        Self::new(m[(0, 0)], m[(1, 1)], m[(2, 2)], mean(0, 1), mean(0, 2), mean(1, 2))
    }
}

impl<S: Real> Mul<Vec3<S>> for Sym3<S> {
    type Output = Vec3<S>;
    #[inline(always)]
    fn mul(self, v: Vec3<S>) -> Vec3<S> {
        Vec3::new(
            self.xx.mul_add(v.x, self.xy.mul_add(v.y, self.xz * v.z)),
            self.xy.mul_add(v.x, self.yy.mul_add(v.y, self.yz * v.z)),
            self.xz.mul_add(v.x, self.yz.mul_add(v.y, self.zz * v.z)),
        )
    }
}
impl<S: Real> Add for Sym3<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::new(
            self.xx + o.xx,
            self.yy + o.yy,
            self.zz + o.zz,
            self.xy + o.xy,
            self.xz + o.xz,
            self.yz + o.yz,
        )
    }
}
impl<S: Real> Sub for Sym3<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self::new(
            self.xx - o.xx,
            self.yy - o.yy,
            self.zz - o.zz,
            self.xy - o.xy,
            self.xz - o.xz,
            self.yz - o.yz,
        )
    }
}
impl<S: Real> AddAssign for Sym3<S> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}
