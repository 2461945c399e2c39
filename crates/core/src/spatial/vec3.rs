//! Vectors of three components.

use super::scalar::{Real, Scalar};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// Vector with three components.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Vec3<S> {
    /// First component.
    pub x: S,
    /// Second component.
    pub y: S,
    /// Third component.
    pub z: S,
}

impl<S> Vec3<S> {
    /// Returns the vector with `f` applied to each component.
    #[inline(always)]
    pub fn map<T>(&self, f: impl Fn(&S) -> T) -> Vec3<T> {
        Vec3 { x: f(&self.x), y: f(&self.y), z: f(&self.z) }
    }
}

impl<S: Real> Vec3<S> {
    /// Creates the vector `(x, y, z)`.
    #[inline(always)]
    pub fn new(x: S, y: S, z: S) -> Self {
        Self { x, y, z }
    }

    /// Returns the zero vector.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::new(S::of(0.0), S::of(0.0), S::of(0.0))
    }

    /// Creates the vector with `v` in every lane.
    #[inline(always)]
    pub fn of(v: &Vec3<f64>) -> Self {
        Self::new(S::of(v.x), S::of(v.y), S::of(v.z))
    }

    /// Creates the vector with the components of `f(i)` in lane `i`.
    #[inline(always)]
    pub fn from_lanes(f: impl Fn(usize) -> Vec3<f64>) -> Self {
        Self::new(S::from_lanes(|i| f(i).x), S::from_lanes(|i| f(i).y), S::from_lanes(|i| f(i).z))
    }

    /// Returns the vector in lane `i`.
    #[inline(always)]
    pub fn lane(self, i: usize) -> Vec3<f64> {
        Vec3::new(self.x.lane(i), self.y.lane(i), self.z.lane(i))
    }

    /// Creates the vector from the first three numbers of a slice.
    #[inline(always)]
    pub fn from_slice(s: &[S]) -> Self {
        Self::new(s[0], s[1], s[2])
    }

    /// Writes the components to the first three elements of a slice.
    #[inline(always)]
    pub fn write(self, out: &mut [S]) {
        out[0] = self.x;
        out[1] = self.y;
        out[2] = self.z;
    }

    /// Returns the scalar product `self · o`.
    #[inline(always)]
    pub fn dot(self, o: Self) -> S {
        self.x.mul_add(o.x, self.y.mul_add(o.y, self.z * o.z))
    }

    /// Returns `self · o + s`.
    #[inline(always)]
    pub fn dot_add(self, o: Self, s: S) -> S {
        self.x.mul_add(o.x, self.y.mul_add(o.y, self.z.mul_add(o.z, s)))
    }

    /// Returns the cross product `self × o`.
    #[inline(always)]
    pub fn cross(self, o: Self) -> Self {
        Self::new(
            self.y.mul_add(o.z, -(self.z * o.y)),
            self.z.mul_add(o.x, -(self.x * o.z)),
            self.x.mul_add(o.y, -(self.y * o.x)),
        )
    }

    /// Returns `self × o + s`.
    #[inline(always)]
    pub fn cross_add(self, o: Self, s: Self) -> Self {
        Self::new(
            self.y.mul_add(o.z, (-self.z).mul_add(o.y, s.x)),
            self.z.mul_add(o.x, (-self.x).mul_add(o.z, s.y)),
            self.x.mul_add(o.y, (-self.y).mul_add(o.x, s.z)),
        )
    }

    /// Returns `self · s + o`.
    #[inline(always)]
    pub fn scale_add(self, s: S, o: Self) -> Self {
        Self::new(self.x.mul_add(s, o.x), self.y.mul_add(s, o.y), self.z.mul_add(s, o.z))
    }

    /// Returns the Euclidean norm.
    #[inline(always)]
    pub fn norm(self) -> S {
        self.dot(self).sqrt()
    }
}

impl<S: Scalar> Vec3<S> {
    /// Returns the vector as a nalgebra vector.
    #[inline(always)]
    pub fn to_nalgebra(self) -> Vector3<f64> {
        Vector3::new(self.x.value(), self.y.value(), self.z.value())
    }
}

impl From<Vector3<f64>> for Vec3<f64> {
    fn from(v: Vector3<f64>) -> Self {
        Self { x: v.x, y: v.y, z: v.z }
    }
}

impl<S: Real> Add for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::new(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}
impl<S: Real> Sub for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self::new(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}
impl<S: Real> Mul<S> for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: S) -> Self {
        Self::new(self.x * s, self.y * s, self.z * s)
    }
}
impl<S: Real> Neg for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}
impl<S: Real> AddAssign for Vec3<S> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}
impl<S: Real> SubAssign for Vec3<S> {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}
