//! 3 × 3 matrices, stored by columns.

use super::scalar::{Real, Scalar};
use super::vec3::Vec3;
use nalgebra::Matrix3;
use std::ops::{Add, AddAssign, Mul};

/// 3 × 3 matrix `A`. A rotation matrix `rot_ab` converts B components to A components.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mat3<S> {
    /// First column.
    pub x: Vec3<S>,
    /// Second column.
    pub y: Vec3<S>,
    /// Third column.
    pub z: Vec3<S>,
}

impl<S> Mat3<S> {
    /// Returns the matrix with `f` applied to each entry.
    #[inline(always)]
    pub fn map<T>(&self, f: impl Fn(&S) -> T) -> Mat3<T> {
        Mat3 { x: self.x.map(&f), y: self.y.map(&f), z: self.z.map(&f) }
    }
}

impl<S: Real> Mat3<S> {
    /// Creates a matrix from its columns.
    #[inline(always)]
    pub fn from_columns(x: Vec3<S>, y: Vec3<S>, z: Vec3<S>) -> Self {
        Self { x, y, z }
    }

    /// Returns the identity matrix.
    #[inline(always)]
    pub fn identity() -> Self {
        let (o, l) = (S::of(0.0), S::of(1.0));
        Self::from_columns(Vec3::new(l, o, o), Vec3::new(o, l, o), Vec3::new(o, o, l))
    }

    /// Returns the zero matrix.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::from_columns(Vec3::zero(), Vec3::zero(), Vec3::zero())
    }

    /// Creates the matrix with `m` in every lane.
    #[inline(always)]
    pub fn of(m: &Mat3<f64>) -> Self {
        Self::from_columns(Vec3::of(&m.x), Vec3::of(&m.y), Vec3::of(&m.z))
    }

    /// Returns `Aᵀ`.
    #[inline(always)]
    #[must_use]
    pub fn transpose(&self) -> Self {
        Self::from_columns(
            Vec3::new(self.x.x, self.y.x, self.z.x),
            Vec3::new(self.x.y, self.y.y, self.z.y),
            Vec3::new(self.x.z, self.y.z, self.z.z),
        )
    }

    /// Returns `Aᵀ v`.
    #[inline(always)]
    pub fn transpose_mul(&self, v: Vec3<S>) -> Vec3<S> {
        Vec3::new(self.x.dot(v), self.y.dot(v), self.z.dot(v))
    }

    /// Returns `A + u vᵀ`.
    #[inline(always)]
    #[must_use]
    pub fn add_outer(&self, u: Vec3<S>, v: Vec3<S>) -> Self {
        Self::from_columns(u.scale_add(v.x, self.x), u.scale_add(v.y, self.y), u.scale_add(v.z, self.z))
    }
}

impl<S: Scalar> Mat3<S> {
    /// Returns the matrix as a nalgebra matrix.
    #[inline(always)]
    pub fn to_nalgebra(self) -> Matrix3<f64> {
        Matrix3::from_columns(&[self.x.to_nalgebra(), self.y.to_nalgebra(), self.z.to_nalgebra()])
    }
}

impl From<Matrix3<f64>> for Mat3<f64> {
    fn from(m: Matrix3<f64>) -> Self {
        let column = |j| Vec3::new(m[(0, j)], m[(1, j)], m[(2, j)]);
        Self { x: column(0), y: column(1), z: column(2) }
    }
}

impl<S: Real> Mul<Vec3<S>> for Mat3<S> {
    type Output = Vec3<S>;
    #[inline(always)]
    fn mul(self, v: Vec3<S>) -> Vec3<S> {
        self.x.scale_add(v.x, self.y.scale_add(v.y, self.z * v.z))
    }
}
impl<S: Real> Mul for Mat3<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self::from_columns(self * o.x, self * o.y, self * o.z)
    }
}
impl<S: Real> Add for Mat3<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::from_columns(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}
impl<S: Real> AddAssign for Mat3<S> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

/// Returns the pose with rotation `r` and position `p` as a homogeneous `(4, 4)` matrix, row major.
#[inline(always)]
pub fn pose_rows<S: Real>(r: &Mat3<S>, p: Vec3<S>) -> [S; 16] {
    let (o, l) = (S::of(0.0), S::of(1.0));
    [r.x.x, r.y.x, r.z.x, p.x, r.x.y, r.y.y, r.z.y, p.y, r.x.z, r.y.z, r.z.z, p.z, o, o, o, l]
}
