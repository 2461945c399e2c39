//! Numbers with their derivatives, for exact gradients (forward-mode differentiation).

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Number of derivatives: with respect to translations along three axes, then to rotations about them.
pub(super) const DIRECTIONS: usize = 6;

/// Number in a geometric computation, with or without derivatives.
pub(super) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// Returns a number with this value and, except for `f64`, with these derivatives.
    fn new(value: f64, slopes: [f64; DIRECTIONS]) -> Self;
    /// Returns a constant, whose derivatives are zero.
    fn of(x: f64) -> Self {
        Self::new(x, [0.0; DIRECTIONS])
    }
    /// Returns the number without its derivatives.
    fn value(self) -> f64;
    /// Returns `f(x)` of this number `x`, from the value of `f` and its derivative `slope` at `x`.
    fn function(self, value: f64, slope: f64) -> Self;

    fn sqrt(self) -> Self {
        let root = self.value().sqrt();
        self.function(root, if root > 0.0 { 0.5 / root } else { 0.0 })
    }

    fn is_below(self, other: Self) -> bool {
        self.value() < other.value()
    }
}

impl Number for f64 {
    fn new(value: f64, _: [f64; DIRECTIONS]) -> Self {
        value
    }
    fn value(self) -> f64 {
        self
    }
    fn function(self, value: f64, _: f64) -> Self {
        value
    }
}

/// Number with its derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dual {
    pub(super) value: f64,
    pub(super) slopes: [f64; DIRECTIONS],
}

impl Dual {
    /// Returns `f(x, y)`, from the value of `f` and its derivatives with respect to `x` and `y`.
    fn of_two(value: f64, (x, by_x): (Self, f64), (y, by_y): (Self, f64)) -> Self {
        Self { value, slopes: std::array::from_fn(|k| by_x * x.slopes[k] + by_y * y.slopes[k]) }
    }
}

impl Number for Dual {
    fn new(value: f64, slopes: [f64; DIRECTIONS]) -> Self {
        Self { value, slopes }
    }
    fn value(self) -> f64 {
        self.value
    }
    fn function(self, value: f64, slope: f64) -> Self {
        Self { value, slopes: self.slopes.map(|own| own * slope) }
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::of_two(self.value + o.value, (self, 1.0), (o, 1.0))
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self::of_two(self.value - o.value, (self, 1.0), (o, -1.0))
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self::of_two(self.value * o.value, (self, o.value), (o, self.value))
    }
}

impl Div for Dual {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let value = self.value / o.value;
        Self::of_two(value, (self, 1.0 / o.value), (o, -value / o.value))
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        self.function(-self.value, -1.0)
    }
}
