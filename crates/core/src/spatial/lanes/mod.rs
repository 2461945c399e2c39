//! Scalars for batch computations, with one state in each lane of a vector register.
//!
//! The lane types are private to the crate, because their arithmetic uses instructions that not every
//! processor supports.

#[cfg_attr(target_arch = "x86_64", path = "x86.rs")]
#[cfg_attr(not(target_arch = "x86_64"), path = "array.rs")]
mod register;

use super::cpu_features::{has_avx512, has_fma};
use super::scalar::{Real, gather_each, scatter_each};
use super::sine::{FAST_SINE_LIMIT, sin_cos};
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

macro_rules! lanes {
    (
        $(#[$doc:meta])* $name:ident, $register:ident, $mask:ident, $width:literal, $features:literal,
        $enter:ident, $available:expr
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        #[repr(transparent)]
        pub(crate) struct $name(register::$register);

        impl $name {
            /// Returns true if this processor supports the instructions that [`Real::enter`] uses.
            #[inline(always)]
            pub(crate) fn is_available() -> bool {
                $available
            }

            #[inline(always)]
            fn each(self, f: impl Fn(f64) -> f64) -> Self {
                let numbers = self.0.to_array();
                Self::from_lanes(|i| f(numbers[i]))
            }
        }

        impl Default for $name {
            #[inline(always)]
            fn default() -> Self {
                Self::of(0.0)
            }
        }

        lanes!(@operator $name, Add, add, AddAssign, add_assign);
        lanes!(@operator $name, Sub, sub, SubAssign, sub_assign);
        lanes!(@operator $name, Mul, mul, MulAssign, mul_assign);
        impl Div for $name {
            type Output = Self;
            #[inline(always)]
            fn div(self, other: Self) -> Self {
                Self(self.0.div(other.0))
            }
        }

        impl Neg for $name {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self::of(-0.0) - self // exactly −x, also for zeros
            }
        }

        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = $features)]
        fn $enter<R>(kernel: impl FnOnce() -> R) -> R {
            // a vector in memory makes LLVM align the stack; otherwise spilled registers straddle cache lines
            std::hint::black_box(&$name::default());
            kernel()
        }

        impl Real for $name {
            type Mask = register::$mask;
            const LANES: usize = $width;

            #[inline(always)]
            fn of(x: f64) -> Self {
                Self(register::$register::from_array([x; $width]))
            }
            #[inline(always)]
            fn from_lanes(f: impl Fn(usize) -> f64) -> Self {
                let mut numbers = [0.0; $width];
                for (i, number) in numbers.iter_mut().enumerate() {
                    *number = f(i); // array::from_fn is not inlined if f is long
                }
                Self(register::$register::from_array(numbers))
            }
            #[inline(always)]
            fn lane(self, i: usize) -> f64 {
                self.0.to_array()[i]
            }
            #[inline(always)]
            fn set_lane(&mut self, i: usize, x: f64) {
                let mut numbers = self.0.to_array();
                numbers[i] = x;
                self.0 = register::$register::from_array(numbers);
            }
            #[inline(always)]
            fn gather(from: &[f64], offset: impl Fn(usize) -> usize, to: &mut [Self]) {
                let width = to.len();
                if width < $width {
                    return gather_each(from, offset, to);
                }
                let mut block = [Self::default().0; $width];
                for start in (0..width).step_by($width) {
                    let start = start.min(width - $width); // the last block overlaps the preceding one
                    for lane in 0..$width {
                        let row = from[offset(lane) + start..][..$width].try_into();
                        block[lane] = register::$register::from_array(row.unwrap_or_default());
                    }
                    let columns = register::$register::transpose(block);
                    for (to, column) in to[start..start + $width].iter_mut().zip(columns) {
                        *to = Self(column);
                    }
                }
            }
            #[inline(always)]
            fn scatter(from: &[Self], to: &mut [f64], count: usize, offset: impl Fn(usize) -> usize) {
                let width = from.len();
                if width < $width {
                    return scatter_each(from, to, count, offset);
                }
                let mut block = [Self::default().0; $width];
                for start in (0..width).step_by($width) {
                    let start = start.min(width - $width);
                    for (block, from) in block.iter_mut().zip(&from[start..start + $width]) {
                        *block = from.0;
                    }
                    let rows = register::$register::transpose(block);
                    for (lane, row) in rows.into_iter().enumerate().take(count) {
                        to[offset(lane) + start..][..$width].copy_from_slice(&row.to_array());
                    }
                }
            }
            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                Self(self.0.mul_add(a.0, b.0))
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                Self(self.0.sqrt())
            }
            #[inline(always)]
            fn abs(self) -> Self {
                Self(self.0.abs())
            }
            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                let (near, (s, c)) =
                    (self.abs().less(Self::of(FAST_SINE_LIMIT)), sin_cos(self));
                if register::$register::all(near) {
                    return (s, c);
                }
                // lanes are replaced individually, so that the angle in one lane does not affect the bits of
                // other lanes
                (Self::select(near, s, self.each(f64::sin)), Self::select(near, c, self.each(f64::cos)))
            }
            #[inline(always)]
            fn atan2(self, x: Self) -> Self {
                let (y, x) = (self.0.to_array(), x.0.to_array());
                Self::from_lanes(|i| f64::atan2(y[i], x[i]))
            }
            #[inline(always)]
            fn less(self, other: Self) -> Self::Mask {
                self.0.less(other.0)
            }
            #[inline(always)]
            fn select(mask: Self::Mask, a: Self, b: Self) -> Self {
                Self(register::$register::select(mask, a.0, b.0))
            }
            #[inline(always)]
            fn any(mask: Self::Mask) -> bool {
                register::$register::any(mask)
            }
            #[inline(always)]
            fn enter<R>(kernel: impl FnOnce() -> R) -> R {
                #[cfg(target_arch = "x86_64")]
                {
                    assert!(Self::is_available(), "this processor lacks the SIMD instructions of the kernel");
                    // SAFETY: the assertion above guarantees that the processor has these features.
                    unsafe { $enter(kernel) }
                }
                #[cfg(not(target_arch = "x86_64"))]
                {
                    kernel()
                }
            }
        }
    };
    (@operator $name:ident, $trait:ident, $method:ident, $assign:ident, $assigned:ident) => {
        impl $trait for $name {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
        impl $assign for $name {
            #[inline(always)]
            fn $assigned(&mut self, other: Self) {
                self.0 = self.0.$method(other.0);
            }
        }
    };
}

lanes!(
    /// Scalar with four lanes, for processors with AVX2 and FMA (or with fused multiply-add in the baseline).
    Lanes4, F64x4, Mask4, 4, "avx2,fma", enter_lanes4, has_fma()
);
lanes!(
    /// Scalar with eight lanes, for processors with AVX-512.
    Lanes8, F64x8, Mask8, 8, "avx512f,avx512dq,avx512vl,avx2,fma", enter_lanes8, has_avx512()
);

#[cfg(test)]
mod tests {
    use super::{Lanes4, Lanes8};
    use crate::spatial::Real;

    fn agrees_with_plain_numbers<L: Real>() {
        let x = |i: usize| 0.37 * i as f64 - 1.1;
        let lanes = L::from_lanes(x);
        let (s, c) = lanes.sin_cos();
        let chosen = L::select(L::less(lanes, L::of(0.0)), -lanes, lanes);
        for i in 0..L::LANES {
            assert!((s.lane(i) - x(i).sin()).abs() < 2.3e-16 && (c.lane(i) - x(i).cos()).abs() < 2.3e-16);
            assert_eq!(chosen.lane(i), x(i).abs());
            assert_eq!(lanes.mul_add(lanes, L::of(1.0)).lane(i), f64::mul_add(x(i), x(i), 1.0));
            assert_eq!(lanes.atan2(L::of(2.0)).lane(i), x(i).atan2(2.0));
        }
        assert!((-L::of(0.0)).lane(1).is_sign_negative() && (-L::of(-0.0)).lane(1).is_sign_positive());
        // rows of every width with gaps between them, gathered and scattered
        for width in 1..20 {
            let rows: Vec<f64> = (0..L::LANES * 25).map(|i| i as f64).collect();
            let (mut lanes, offset) = (vec![L::of(0.0); width], |lane| 3 + 22 * lane);
            L::gather(&rows, offset, &mut lanes);
            for (i, x) in lanes.iter().enumerate() {
                assert!((0..L::LANES).all(|lane| x.lane(lane) == (offset(lane) + i) as f64));
            }
            for count in 1..=L::LANES {
                let mut back = vec![-1.0; rows.len()];
                L::scatter(&lanes, &mut back, count, offset);
                let is_written = |i: usize| i >= 3 && (i - 3) / 22 < count && (i - 3) % 22 < width;
                assert!((0..rows.len()).all(|i| back[i] == if is_written(i) { i as f64 } else { -1.0 }));
            }
        }
        let far = L::from_lanes(|i| if i == 1 { 3.0e7 } else { 0.5 });
        assert_eq!(far.sin_cos().0.lane(1), 3.0e7_f64.sin());
    }

    #[test]
    fn lanes_agree_with_plain_numbers() {
        if Lanes4::is_available() {
            agrees_with_plain_numbers::<Lanes4>();
        }
        if Lanes8::is_available() {
            agrees_with_plain_numbers::<Lanes8>();
        }
    }
}
