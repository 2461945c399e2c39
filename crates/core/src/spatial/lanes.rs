//! Several states side by side: the scalars of batches.

use super::fused::Fused;
use super::scalar::{FAST_SINE_LIMIT, Real};
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// A truth value per lane, as a bit mask of the whole number.
#[derive(Clone, Copy, Debug)]
pub struct LaneMask<const N: usize>([u64; N]);

macro_rules! lanes {
    ($(#[$doc:meta])* $name:ident, $width:literal, $align:literal, $features:literal, $enter:ident, $available:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[repr(C, align($align))]
        pub struct $name([f64; $width]);

        impl $name {
            /// Whether this processor has the instructions that [`Real::enter`] uses.
            #[inline(always)]
            pub fn is_available() -> bool {
                $available
            }

            #[inline(always)]
            fn map(self, f: impl Fn(f64) -> f64) -> Self {
                let mut out = [0.0; $width];
                for i in 0..$width {
                    out[i] = f(self.0[i]);
                }
                Self(out)
            }

            #[inline(always)]
            fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
                let mut out = [0.0; $width];
                for i in 0..$width {
                    out[i] = f(self.0[i], other.0[i]);
                }
                Self(out)
            }
        }

        impl Default for $name {
            #[inline(always)]
            fn default() -> Self {
                Self([0.0; $width])
            }
        }

        lanes!(@operator $name, Add, add, +);
        lanes!(@operator $name, Sub, sub, -);
        lanes!(@operator $name, Mul, mul, *);
        lanes!(@operator $name, Div, div, /);
        lanes!(@assign $name, AddAssign, add_assign, +);
        lanes!(@assign $name, SubAssign, sub_assign, -);
        lanes!(@assign $name, MulAssign, mul_assign, *);

        impl Neg for $name {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                self.map(|x| -x)
            }
        }

        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = $features)]
        fn $enter<R>(kernel: impl FnOnce() -> R) -> R {
            kernel()
        }

        impl Real for $name {
            type Mask = LaneMask<$width>;
            const LANES: usize = $width;

            #[inline(always)]
            fn of(x: f64) -> Self {
                Self([x; $width])
            }
            #[inline(always)]
            fn from_lanes(f: impl Fn(usize) -> f64) -> Self {
                Self(std::array::from_fn(f))
            }
            #[inline(always)]
            fn lane(self, i: usize) -> f64 {
                self.0[i]
            }
            #[inline(always)]
            fn set_lane(&mut self, i: usize, x: f64) {
                self.0[i] = x;
            }
            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                let mut out = [0.0; $width];
                for i in 0..$width {
                    out[i] = f64::mul_add(self.0[i], a.0[i], b.0[i]);
                }
                Self(out)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                self.map(f64::sqrt)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                self.map(f64::abs)
            }
            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                if self.0.iter().all(|x| x.abs() < FAST_SINE_LIMIT) {
                    super::sine::sin_cos(self)
                } else {
                    (self.map(f64::sin), self.map(f64::cos))
                }
            }
            #[inline(always)]
            fn atan2(self, x: Self) -> Self {
                self.zip(x, f64::atan2)
            }
            #[inline(always)]
            fn less(self, other: Self) -> Self::Mask {
                let mut out = [0; $width];
                for i in 0..$width {
                    out[i] = if self.0[i] < other.0[i] { u64::MAX } else { 0 };
                }
                LaneMask(out)
            }
            #[inline(always)]
            fn select(mask: Self::Mask, a: Self, b: Self) -> Self {
                let mut out = [0.0; $width];
                for i in 0..$width {
                    out[i] = f64::from_bits((a.0[i].to_bits() & mask.0[i]) | (b.0[i].to_bits() & !mask.0[i]));
                }
                Self(out)
            }
            #[inline(always)]
            fn any(mask: Self::Mask) -> bool {
                mask.0.iter().any(|lane| *lane != 0)
            }
            #[inline(always)]
            fn enter<R>(kernel: impl FnOnce() -> R) -> R {
                #[cfg(target_arch = "x86_64")]
                {
                    assert!(Self::is_available(), "lanes entered on a processor without their instructions");
                    // SAFETY: the processor has these features, checked on the line above.
                    unsafe { $enter(kernel) }
                }
                #[cfg(not(target_arch = "x86_64"))]
                {
                    kernel()
                }
            }
        }
    };
    (@operator $name:ident, $trait:ident, $method:ident, $op:tt) => {
        impl $trait for $name {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |a, b| a $op b)
            }
        }
    };
    (@assign $name:ident, $trait:ident, $method:ident, $op:tt) => {
        impl $trait for $name {
            #[inline(always)]
            fn $method(&mut self, other: Self) {
                *self = *self $op other;
            }
        }
    };
}

lanes!(
    /// Four states, for processors with AVX2 and FMA (or fused multiply-add in the baseline).
    Lanes4, 4, 32, "avx2,fma", enter_four, Fused::is_available()
);
lanes!(
    /// Eight states, for processors with AVX-512.
    Lanes8, 8, 64, "avx512f,avx512dq,avx512vl,avx2,fma", enter_eight, has_avx512()
);

#[inline(always)]
fn has_avx512() -> bool {
    #[cfg(target_arch = "x86_64")]
    {
        Fused::is_available()
            && std::arch::is_x86_feature_detected!("avx512f")
            && std::arch::is_x86_feature_detected!("avx512dq")
            && std::arch::is_x86_feature_detected!("avx512vl")
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        false
    }
}

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
        let far = L::from_lanes(|i| if i == 1 { 3.0e7 } else { 0.5 });
        assert_eq!(far.sin_cos().0.lane(1), 3.0e7_f64.sin());
    }

    #[test]
    fn lanes_agree_with_plain_numbers() {
        agrees_with_plain_numbers::<Lanes4>();
        agrees_with_plain_numbers::<Lanes8>();
    }
}
