//! Scalar type that counts arithmetic operations.

use onorbit_core::spatial::Real;
use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// Kind of a counted operation. Changes of sign, absolute values, comparisons and selections are not counted.
#[derive(Clone, Copy)]
enum Operation {
    Sum,
    Product,
    MulAdd,
    Quotient,
    Root,
    SinCos,
}
use Operation::{MulAdd, Product, Quotient, Root, SinCos, Sum};

const NAMES: [&str; 6] = ["add", "mul", "mul_add", "div", "sqrt", "sin_cos"];

thread_local! {
    static DONE: Cell<[u32; 6]> = const { Cell::new([0; 6]) };
}

fn count(operation: Operation) {
    let mut done = DONE.get();
    done[operation as usize] += 1;
    DONE.set(done);
}

/// Runs `work` and returns the number of its operations of each kind, as JSON.
pub(crate) fn during(work: impl FnOnce()) -> String {
    DONE.set([0; 6]);
    work();
    let pairs: Vec<String> =
        NAMES.iter().zip(DONE.get()).map(|(name, times)| format!("\"{name}\": {times}")).collect();
    format!("{{{}}}", pairs.join(", "))
}

/// Number of type `f64` whose arithmetic operations are counted.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CountedF64(f64);

macro_rules! operator {
    ($trait:ident, $method:ident, $assign:ident, $in_place:ident, $op:tt, $kind:expr) => {
        impl $trait for CountedF64 {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                count($kind);
                Self(self.0 $op other.0)
            }
        }
        impl $assign for CountedF64 {
            fn $in_place(&mut self, other: Self) {
                *self = *self $op other;
            }
        }
    };
}
operator!(Add, add, AddAssign, add_assign, +, Sum);
operator!(Sub, sub, SubAssign, sub_assign, -, Sum);
operator!(Mul, mul, MulAssign, mul_assign, *, Product);

impl Div for CountedF64 {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        count(Quotient);
        Self(self.0 / other.0)
    }
}

impl Neg for CountedF64 {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Real for CountedF64 {
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
        count(MulAdd);
        Self(self.0 * a.0 + b.0)
    }
    fn sqrt(self) -> Self {
        count(Root);
        Self(self.0.sqrt())
    }
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    fn sin_cos(self) -> (Self, Self) {
        count(SinCos);
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
