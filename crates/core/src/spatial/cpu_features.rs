//! Detection of the processor's vector instructions.

use std::sync::LazyLock;

/// Features of this processor. They are detected only once, because a detection takes as long as a small
/// kernel.
static DETECTED: LazyLock<Features> = LazyLock::new(Features::detect);

struct Features {
    fma: bool,
    avx512: bool,
}

impl Features {
    #[cfg(target_arch = "x86_64")]
    fn detect() -> Self {
        use std::arch::is_x86_feature_detected as has;
        let fma = has!("avx2") && has!("fma");
        Self { fma, avx512: fma && has!("avx512f") && has!("avx512dq") && has!("avx512vl") }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn detect() -> Self {
        Self { fma: cfg!(target_arch = "aarch64"), avx512: false } // fma is part of the baseline of aarch64
    }
}

/// Returns true if the processor has fused multiply-add (on x86-64: AVX2 and FMA).
#[inline(always)]
pub(super) fn has_fma() -> bool {
    DETECTED.fma
}

/// Returns true if the processor has AVX-512 F, DQ and VL, and if [`has_fma`] is true.
#[inline(always)]
pub(super) fn has_avx512() -> bool {
    DETECTED.avx512
}
