//! Dual numbers `x + ε x'`, `ε² = 0`: a kernel evaluated on them returns its exact derivative.

use onorbit_core::spatial::Real;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

#[derive(Clone, Copy, Debug, Default)]
pub struct Dual<S> {
    pub value: S,
    pub rate: S,
}

impl<S: Real> Dual<S> {
    pub fn new(value: S, rate: S) -> Self {
        Self { value, rate }
    }
}

/// Returns these numbers, with a derivative of one at place `j` (or nowhere).
pub fn seeded(x: &[f64], j: Option<usize>) -> Vec<Dual<f64>> {
    x.iter().enumerate().map(|(i, x)| Dual::new(*x, f64::from(u8::from(Some(i) == j)))).collect()
}

impl<S: Real> Add for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::new(self.value + o.value, self.rate + o.rate)
    }
}
impl<S: Real> Sub for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self::new(self.value - o.value, self.rate - o.rate)
    }
}
impl<S: Real> Mul for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self::new(self.value * o.value, self.value.mul_add(o.rate, self.rate * o.value))
    }
}
impl<S: Real> Div for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let quotient = self.value / o.value;
        Self::new(quotient, (self.rate - quotient * o.rate) / o.value)
    }
}
impl<S: Real> Neg for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.value, -self.rate)
    }
}
impl<S: Real> AddAssign for Dual<S> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}
impl<S: Real> SubAssign for Dual<S> {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}
impl<S: Real> MulAssign for Dual<S> {
    #[inline(always)]
    fn mul_assign(&mut self, o: Self) {
        *self = *self * o;
    }
}

impl<S: Real> Real for Dual<S> {
    type Mask = S::Mask;
    const LANES: usize = S::LANES;

    #[inline(always)]
    fn of(x: f64) -> Self {
        Self::new(S::of(x), S::of(0.0))
    }
    #[inline(always)]
    fn from_lanes(f: impl Fn(usize) -> f64) -> Self {
        Self::new(S::from_lanes(f), S::of(0.0))
    }
    #[inline(always)]
    fn lane(self, i: usize) -> f64 {
        self.value.lane(i)
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        let rate = self.value.mul_add(a.rate, self.rate.mul_add(a.value, b.rate));
        Self::new(self.value.mul_add(a.value, b.value), rate)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        Self::new(root, self.rate / (root + root))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self::select(S::less(self.value, S::of(0.0)), -self, self)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.value.sin_cos();
        (Self::new(s, c * self.rate), Self::new(c, -(s * self.rate)))
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let squared = x.value.mul_add(x.value, self.value * self.value);
        let rate = (x.value * self.rate - self.value * x.rate) / squared;
        Self::new(self.value.atan2(x.value), rate)
    }
    #[inline(always)]
    fn less(self, other: Self) -> Self::Mask {
        self.value.less(other.value)
    }
    #[inline(always)]
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self {
        Self::new(S::select(mask, a.value, b.value), S::select(mask, a.rate, b.rate))
    }
    #[inline(always)]
    fn any(mask: Self::Mask) -> bool {
        S::any(mask)
    }
    #[inline(always)]
    fn enter<R>(kernel: impl FnOnce() -> R) -> R {
        S::enter(kernel)
    }
}
