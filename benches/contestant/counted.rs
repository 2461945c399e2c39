//! A number that counts what is done with it.

use onorbit_core::spatial::Real;
use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

thread_local! {
    static DONE: Cell<Operations> = const { Cell::new(Operations { add: 0, mul: 0, mul_add: 0, div: 0, sqrt: 0, sin_cos: 0 }) };
}

/// How often each operation was done. Signs, comparisons and choices are not counted.
#[derive(Clone, Copy)]
struct Operations {
    add: u32,
    mul: u32,
    mul_add: u32,
    div: u32,
    sqrt: u32,
    sin_cos: u32,
}

fn count(change: impl FnOnce(&mut Operations)) {
    DONE.with(|done| {
        let mut now = done.get();
        change(&mut now);
        done.set(now);
    });
}

/// What `work` does, as JSON.
pub(crate) fn during(work: impl FnOnce()) -> String {
    DONE.with(|done| done.set(Operations { add: 0, mul: 0, mul_add: 0, div: 0, sqrt: 0, sin_cos: 0 }));
    work();
    let Operations { add, mul, mul_add, div, sqrt, sin_cos } = DONE.with(Cell::get);
    format!(
        r#"{{"add": {add}, "mul": {mul}, "mul_add": {mul_add}, "div": {div}, "sqrt": {sqrt}, "sin_cos": {sin_cos}}}"#
    )
}

/// An `f64` whose arithmetic is counted.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Counted(f64);

macro_rules! operator {
    ($trait:ident, $method:ident, $assign:ident, $in_place:ident, $op:tt, $kind:ident) => {
        impl $trait for Counted {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                count(|done| done.$kind += 1);
                Self(self.0 $op other.0)
            }
        }
        impl $assign for Counted {
            fn $in_place(&mut self, other: Self) {
                *self = *self $op other;
            }
        }
    };
}
operator!(Add, add, AddAssign, add_assign, +, add);
operator!(Sub, sub, SubAssign, sub_assign, -, add);
operator!(Mul, mul, MulAssign, mul_assign, *, mul);

impl Div for Counted {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        count(|done| done.div += 1);
        Self(self.0 / other.0)
    }
}

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Real for Counted {
    type Mask = bool;
    const LANES: usize = 1;

    fn of(x: f64) -> Self {
        Self(x)
    }
    fn from_lanes(f: impl Fn(usize) -> f64) -> Self {
        Self(f(0))
    }
    fn lane(self, _: usize) -> f64 {
        self.0
    }
    fn mul_add(self, a: Self, b: Self) -> Self {
        count(|done| done.mul_add += 1);
        Self(self.0 * a.0 + b.0)
    }
    fn sqrt(self) -> Self {
        count(|done| done.sqrt += 1);
        Self(self.0.sqrt())
    }
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    fn sin_cos(self) -> (Self, Self) {
        count(|done| done.sin_cos += 1);
        let (sine, cosine) = self.0.sin_cos();
        (Self(sine), Self(cosine))
    }
    fn atan2(self, x: Self) -> Self {
        Self(self.0.atan2(x.0))
    }
    fn less(self, other: Self) -> bool {
        self.0 < other.0
    }
    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }
    fn any(mask: bool) -> bool {
        mask
    }
    fn enter<R>(kernel: impl FnOnce() -> R) -> R {
        kernel()
    }
}
