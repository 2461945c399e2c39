//! Scalar with fused multiply-add, for processors with AVX2 and FMA. On some processors with AVX-512, its
//! kernels use the registers of AVX-512; the results have the same bits.

use super::cpu_features::has_fma;
#[cfg(target_arch = "x86_64")]
use super::cpu_features::has_wide_registers;
use super::lanes::Lanes4;
use super::scalar::{ColumnKernel, Real, Scalar};
use super::sine::{FAST_SINE_LIMIT, sin_cos};
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// Scalar `f64` whose [`mul_add`](Real::mul_add) compiles to one instruction.
///
/// It must be used inside [`Real::enter`], on a processor for which [`Fused::is_available`] returns true; on
/// other x86-64 processors `enter` panics. Outside `enter`, the results are the same, but their computation
/// is slow.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
#[repr(transparent)]
pub struct Fused(pub f64);

impl Fused {
    /// Returns true if this processor supports the instructions that [`Real::enter`] uses.
    #[inline(always)]
    pub fn is_available() -> bool {
        has_fma()
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn enter_fused<R>(kernel: impl FnOnce() -> R) -> R {
    kernel()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma")]
fn enter_wide_registers<R>(kernel: impl FnOnce() -> R) -> R {
    kernel()
}

macro_rules! operator {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for Fused {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0 $op other.0)
            }
        }
    };
}
operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

macro_rules! assign {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for Fused {
            #[inline(always)]
            fn $method(&mut self, other: Self) {
                self.0 $op other.0;
            }
        }
    };
}
assign!(AddAssign, add_assign, +=);
assign!(SubAssign, sub_assign, -=);
assign!(MulAssign, mul_assign, *=);

impl Neg for Fused {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Real for Fused {
    type Mask = bool;
    const LANES: usize = 1;

    #[inline(always)]
    fn of(x: f64) -> Self {
        Self(x)
    }
    #[inline(always)]
    fn from_lanes(f: impl Fn(usize) -> f64) -> Self {
        Self(f(0))
    }
    #[inline(always)]
    fn lane(self, _: usize) -> f64 {
        self.0
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        Self(f64::mul_add(self.0, a.0, b.0))
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
        if self.0.abs() < FAST_SINE_LIMIT {
            sin_cos(self)
        } else {
            let (s, c) = self.0.sin_cos();
            (Self(s), Self(c))
        }
    }
    #[inline(always)]
    fn sin_cos_each(angles: &[Self], out: &mut [(Self, Self)]) {
        if !Self::is_available() {
            angles.iter().zip(out).for_each(|(angle, out)| *out = angle.sin_cos());
            return;
        }
        for (angles, out) in angles.chunks(4).zip(out.chunks_mut(4)) {
            let (s, c) = Lanes4::from_lanes(|i| angles.get(i).map_or(0.0, |x| x.0)).sin_cos();
            for (i, out) in out.iter_mut().enumerate() {
                *out = (Self(s.lane(i)), Self(c.lane(i)));
            }
        }
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        Self(self.0.atan2(x.0))
    }
    #[inline(always)]
    fn less(self, other: Self) -> bool {
        self.0 < other.0
    }
    #[inline(always)]
    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }
    #[inline(always)]
    fn any(mask: bool) -> bool {
        mask
    }
    #[inline(always)]
    fn solve_columns(kernel: impl ColumnKernel<Self>) {
        kernel.run(
            #[inline(always)]
            |x: Self| Lanes4::of(x.0),
        );
    }
    #[inline(always)]
    fn enter<R>(kernel: impl FnOnce() -> R) -> R {
        #[cfg(target_arch = "x86_64")]
        {
            if has_wide_registers() {
                // SAFETY: the processor has all features of AVX-512 that the entry point requires.
                return unsafe { enter_wide_registers(kernel) };
            }
            assert!(Self::is_available(), "fused kernels require a processor with AVX2 and FMA");
            // SAFETY: the assertion above guarantees that the processor has both features.
            unsafe { enter_fused(kernel) }
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            kernel()
        }
    }
}

impl Scalar for Fused {
    #[inline(always)]
    fn value(self) -> f64 {
        self.0
    }
}
