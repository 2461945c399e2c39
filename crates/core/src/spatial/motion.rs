//! Spatial motions and forces, linear part first.

use super::scalar::Real;
use super::vec3::Vec3;
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// Motion vector `v`: the twist of a body, or its spatial acceleration, which is the time derivative of the
/// twist.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion<S> {
    /// Velocity of the body-fixed point at the origin, m/s; for a spatial acceleration, the rate of change of
    /// the velocity at the origin, m/s².
    pub linear: Vec3<S>,
    /// Angular velocity, rad/s, or angular acceleration, rad/s².
    pub angular: Vec3<S>,
}

/// Force vector: a wrench, or a spatial momentum, about the origin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Force<S> {
    /// Force, N, or linear momentum, kg m/s.
    pub linear: Vec3<S>,
    /// Moment about the origin, N m, or angular momentum, kg m²/s.
    pub angular: Vec3<S>,
}

macro_rules! pair {
    ($name:ident) => {
        impl<S> $name<S> {
            /// Returns the vector with `f` applied to each component.
            #[inline(always)]
            pub fn map<T>(&self, f: impl Fn(&S) -> T) -> $name<T> {
                $name { linear: self.linear.map(&f), angular: self.angular.map(&f) }
            }
        }

        impl<S: Real> $name<S> {
            /// Creates the vector from its linear and angular parts.
            #[inline(always)]
            pub fn new(linear: Vec3<S>, angular: Vec3<S>) -> Self {
                Self { linear, angular }
            }

            /// Returns the zero vector.
            #[inline(always)]
            pub fn zero() -> Self {
                Self::new(Vec3::zero(), Vec3::zero())
            }

            /// Creates the vector from the first six numbers of a slice, linear before angular.
            #[inline(always)]
            pub fn from_slice(s: &[S]) -> Self {
                Self::new(Vec3::from_slice(s), Vec3::from_slice(&s[3..]))
            }

            /// Writes the six components to a slice, linear before angular.
            #[inline(always)]
            pub fn write(self, out: &mut [S]) {
                self.linear.write(out);
                self.angular.write(&mut out[3..]);
            }

            /// Returns `self · s + o`.
            #[inline(always)]
            pub fn scale_add(self, s: S, o: Self) -> Self {
                Self::new(self.linear.scale_add(s, o.linear), self.angular.scale_add(s, o.angular))
            }
        }
        impl<S: Real> Add for $name<S> {
            type Output = Self;
            #[inline(always)]
            fn add(self, o: Self) -> Self {
                Self::new(self.linear + o.linear, self.angular + o.angular)
            }
        }
        impl<S: Real> Sub for $name<S> {
            type Output = Self;
            #[inline(always)]
            fn sub(self, o: Self) -> Self {
                Self::new(self.linear - o.linear, self.angular - o.angular)
            }
        }
        impl<S: Real> Mul<S> for $name<S> {
            type Output = Self;
            #[inline(always)]
            fn mul(self, s: S) -> Self {
                Self::new(self.linear * s, self.angular * s)
            }
        }
        impl<S: Real> Neg for $name<S> {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self::new(-self.linear, -self.angular)
            }
        }
        impl<S: Real> AddAssign for $name<S> {
            #[inline(always)]
            fn add_assign(&mut self, o: Self) {
                *self = *self + o;
            }
        }
        impl<S: Real> SubAssign for $name<S> {
            #[inline(always)]
            fn sub_assign(&mut self, o: Self) {
                *self = *self - o;
            }
        }
    };
}
pair!(Motion);
pair!(Force);

impl<S: Real> Motion<S> {
    /// Returns the scalar product `vᵀ f`; for a twist and a wrench, the power, W.
    #[inline(always)]
    pub fn dot(self, f: Force<S>) -> S {
        self.linear.dot(f.linear) + self.angular.dot(f.angular)
    }

    /// Returns `vᵀ f + s`.
    #[inline(always)]
    pub fn dot_add(self, f: Force<S>, s: S) -> S {
        self.linear.dot_add(f.linear, s) + self.angular.dot(f.angular)
    }

    /// Returns `v × m = (ω × m_lin + v × m_ang, ω × m_ang)`, the rate of change of a motion `m` that is fixed
    /// in a frame with the twist `v`.
    #[inline(always)]
    pub fn cross(self, m: Self) -> Self {
        Self::new(self.angular.cross(m.linear) + self.linear.cross(m.angular), self.angular.cross(m.angular))
    }

    /// Returns `v ×* f = (ω × f_lin, ω × f_ang + v × f_lin)`, the rate of change of a force `f` that is fixed
    /// in a frame with the twist `v`.
    #[inline(always)]
    pub fn cross_force(self, f: Force<S>) -> Force<S> {
        Force::new(self.angular.cross(f.linear), self.angular.cross(f.angular) + self.linear.cross(f.linear))
    }

    /// Returns the velocity of the body-fixed point at `p`: `v + ω × p`.
    #[inline(always)]
    pub fn at(self, p: Vec3<S>) -> Vec3<S> {
        self.linear + self.angular.cross(p)
    }

    /// Returns this motion with its linear part referred to the point `p` instead of the origin.
    #[inline(always)]
    #[must_use]
    pub fn referred_to(self, p: Vec3<S>) -> Self {
        Self::new(self.angular.cross_add(p, self.linear), self.angular)
    }
}

impl<S: Real> Force<S> {
    /// Returns the wrench, about the origin, of a `force` acting at `p` plus a free `moment`.
    #[inline(always)]
    pub fn at(force: Vec3<S>, moment: Vec3<S>, p: Vec3<S>) -> Self {
        Self::new(force, moment + p.cross(force))
    }

    /// Returns this wrench, whose moment is about the point `p`, with its moment about the origin.
    #[inline(always)]
    #[must_use]
    pub fn from_point(self, p: Vec3<S>) -> Self {
        Self::new(self.linear, p.cross_add(self.linear, self.angular))
    }

    /// Computes [`from_point`](Self::from_point) with the cross product evaluated first. This takes three
    /// more operations, but shortens the dependency chain if the moment is the last result of a recursion.
    #[inline(always)]
    #[must_use]
    pub fn from_point_late(self, p: Vec3<S>) -> Self {
        Self::at(self.linear, self.angular, p)
    }
}
