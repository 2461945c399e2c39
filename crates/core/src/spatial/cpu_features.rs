//! Detection of the processor's vector instructions.

use std::sync::atomic::{AtomicU8, Ordering};

/// Features of this processor as a sum of the bits below; zero before their detection. They are detected only
/// once, because a detection takes as long as a small kernel.
static FEATURES: AtomicU8 = AtomicU8::new(0);
const DETECTED: u8 = 1;
const FMA: u8 = 2;
const AVX512: u8 = 4;

/// Returns true if the processor has fused multiply-add (on x86-64: AVX2 and FMA).
#[inline(always)]
pub(super) fn has_fma() -> bool {
    has(FMA)
}

/// Returns true if the processor has AVX-512 F, DQ and VL, and if [`has_fma`] is true.
#[inline(always)]
pub(super) fn has_avx512() -> bool {
    has(AVX512)
}

/// Returns true if the processor has a feature. Because every kernel calls this function, it takes only two
/// instructions for a feature that is known to be present.
#[inline(always)]
fn has(feature: u8) -> bool {
    FEATURES.load(Ordering::Relaxed) & feature != 0 || has_detected(feature)
}

/// Detects the features unless they are known, and returns true if `feature` is among them.
#[cold]
#[inline(never)]
fn has_detected(feature: u8) -> bool {
    if FEATURES.load(Ordering::Relaxed) == 0 {
        FEATURES.store(DETECTED | detect(), Ordering::Relaxed);
    }
    FEATURES.load(Ordering::Relaxed) & feature != 0
}

#[cfg(target_arch = "x86_64")]
fn detect() -> u8 {
    use std::arch::is_x86_feature_detected as has;
    let fma = has!("avx2") && has!("fma");
    let avx512 = fma && has!("avx512f") && has!("avx512dq") && has!("avx512vl");
    u8::from(fma) * FMA + u8::from(avx512) * AVX512
}

#[cfg(not(target_arch = "x86_64"))]
fn detect() -> u8 {
    u8::from(cfg!(target_arch = "aarch64")) * FMA // part of the baseline of aarch64
}
