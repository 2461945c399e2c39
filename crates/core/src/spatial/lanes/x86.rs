//! Vector registers of x86-64.
//!
//! Values of intrinsic register types stay in registers when they are passed from body to body, whereas LLVM
//! would copy arrays through memory.
#![allow(unsafe_code)] // intrinsics are unsafe, because each requires an instruction set

use std::arch::x86_64 as x86;

macro_rules! register {
    (
        $(#[$doc:meta])* $name:ident, $width:literal, $register:ident, $mask:ty,
        |$a:ident, $b:ident, $c:ident| add $add:expr, sub $sub:expr, mul $mul:expr, div $div:expr,
        mul_add $mul_add:expr, sqrt $sqrt:expr, abs $abs:expr, less $less:expr,
        select($held:ident) $select:expr, any $any:expr, all $all:expr
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        #[repr(transparent)]
        pub(super) struct $name(x86::$register);

        // SAFETY (for all functions below): lanes are used only inside `Real::enter`, where the processor is
        // known to have these instructions, and a register has the memory layout of an array.
        impl $name {
            #[inline(always)]
            pub(super) fn from_array(x: [f64; $width]) -> Self {
                Self(unsafe { std::mem::transmute::<[f64; $width], x86::$register>(x) })
            }
            #[inline(always)]
            pub(super) fn to_array(self) -> [f64; $width] {
                unsafe { std::mem::transmute::<x86::$register, [f64; $width]>(self.0) }
            }
            register!(@two $add, add, $a, $b);
            register!(@two $sub, sub, $a, $b);
            register!(@two $mul, mul, $a, $b);
            register!(@two $div, div, $a, $b);
            #[inline(always)]
            pub(super) fn mul_add(self, b: Self, c: Self) -> Self {
                let ($a, $b, $c) = (self.0, b.0, c.0);
                Self(unsafe { $mul_add })
            }
            #[inline(always)]
            pub(super) fn sqrt(self) -> Self {
                let $a = self.0;
                Self(unsafe { $sqrt })
            }
            #[inline(always)]
            pub(super) fn abs(self) -> Self {
                let $a = self.0;
                Self(unsafe { $abs })
            }
            #[inline(always)]
            pub(super) fn less(self, b: Self) -> $mask {
                let ($a, $b) = (self.0, b.0);
                unsafe { $less }
            }
            #[inline(always)]
            pub(super) fn select($held: $mask, a: Self, b: Self) -> Self {
                let ($a, $b) = (a.0, b.0);
                Self(unsafe { $select })
            }
            #[inline(always)]
            pub(super) fn any($held: $mask) -> bool {
                $any
            }
            #[inline(always)]
            pub(super) fn all($held: $mask) -> bool {
                $all
            }
        }
    };
    (@two $op:expr, $name:ident, $a:ident, $b:ident) => {
        #[inline(always)]
        pub(super) fn $name(self, b: Self) -> Self {
            let ($a, $b) = (self.0, b.0);
            Self(unsafe { $op })
        }
    };
}

pub(super) type Mask4 = x86::__m256d;
pub(super) type Mask8 = x86::__mmask8;

register!(
    /// Register of four numbers (AVX2 and FMA).
    F64x4, 4, __m256d, Mask4,
    |a, b, c| add x86::_mm256_add_pd(a, b), sub x86::_mm256_sub_pd(a, b), mul x86::_mm256_mul_pd(a, b),
    div x86::_mm256_div_pd(a, b), mul_add x86::_mm256_fmadd_pd(a, b, c), sqrt x86::_mm256_sqrt_pd(a),
    abs x86::_mm256_andnot_pd(x86::_mm256_set1_pd(-0.0), a), less x86::_mm256_cmp_pd::<{ x86::_CMP_LT_OQ }>(a, b),
    select(held) x86::_mm256_blendv_pd(b, a, held), any unsafe { x86::_mm256_movemask_pd(held) } != 0,
    all unsafe { x86::_mm256_movemask_pd(held) } == 0b1111
);
register!(
    /// Register of eight numbers (AVX-512).
    F64x8, 8, __m512d, Mask8,
    |a, b, c| add x86::_mm512_add_pd(a, b), sub x86::_mm512_sub_pd(a, b), mul x86::_mm512_mul_pd(a, b),
    div x86::_mm512_div_pd(a, b), mul_add x86::_mm512_fmadd_pd(a, b, c), sqrt x86::_mm512_sqrt_pd(a),
    abs x86::_mm512_abs_pd(a), less x86::_mm512_cmp_pd_mask::<{ x86::_CMP_LT_OQ }>(a, b),
    select(held) x86::_mm512_mask_blend_pd(held, b, a), any held != 0, all held == u8::MAX
);

impl F64x4 {
    /// Returns the transpose: lane `j` of register `i` becomes lane `i` of register `j`.
    #[inline(always)]
    pub(super) fn transpose(rows: [Self; 4]) -> [Self; 4] {
        let [a, b, c, d] = rows.map(|row| row.0);
        // SAFETY: as for the functions above.
        let columns = unsafe {
            use x86::{
                _mm256_permute2f128_pd as halves, _mm256_unpackhi_pd as odd, _mm256_unpacklo_pd as even,
            };
            let (ab, cd) = ((even(a, b), odd(a, b)), (even(c, d), odd(c, d)));
            [
                halves::<0x20>(ab.0, cd.0),
                halves::<0x20>(ab.1, cd.1),
                halves::<0x31>(ab.0, cd.0),
                halves::<0x31>(ab.1, cd.1),
            ]
        };
        columns.map(Self)
    }
}

impl F64x8 {
    /// Returns the transpose: lane `j` of register `i` becomes lane `i` of register `j`.
    #[inline(always)]
    pub(super) fn transpose(rows: [Self; 8]) -> [Self; 8] {
        let [a, b, c, d, e, f, g, h] = rows.map(|row| row.0);
        // SAFETY: as for the functions above.
        let columns = unsafe {
            use x86::{_mm512_shuffle_f64x2 as pairs, _mm512_unpackhi_pd as odd, _mm512_unpacklo_pd as even};
            // select the pairs of lanes 0 and 2 (0x88), or 1 and 3 (0xdd), of both registers
            let (ab, cd, ef, gh) = (even(a, b), even(c, d), even(e, f), even(g, h));
            let (x0, x2) = (pairs::<0x88>(ab, cd), pairs::<0xdd>(ab, cd));
            let (y0, y2) = (pairs::<0x88>(ef, gh), pairs::<0xdd>(ef, gh));
            let (ab, cd, ef, gh) = (odd(a, b), odd(c, d), odd(e, f), odd(g, h));
            let (x1, x3) = (pairs::<0x88>(ab, cd), pairs::<0xdd>(ab, cd));
            let (y1, y3) = (pairs::<0x88>(ef, gh), pairs::<0xdd>(ef, gh));
            [
                pairs::<0x88>(x0, y0),
                pairs::<0x88>(x1, y1),
                pairs::<0x88>(x2, y2),
                pairs::<0x88>(x3, y3),
                pairs::<0xdd>(x0, y0),
                pairs::<0xdd>(x1, y1),
                pairs::<0xdd>(x2, y2),
                pairs::<0xdd>(x3, y3),
            ]
        };
        columns.map(Self)
    }
}
