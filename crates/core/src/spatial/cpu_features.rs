//! Detection of the processor's vector instructions.

use std::sync::atomic::{AtomicU8, Ordering};

/// Features of this processor as a sum of the bits below; zero before their detection. They are detected only
/// once, because a detection takes as long as a small kernel.
static FEATURES: AtomicU8 = AtomicU8::new(0);
const DETECTED: u8 = 1;
const FMA: u8 = 2;
const AVX512: u8 = 4;
/// AVX-512 is fast for the kernels of one state, and allowed.
const WIDE_REGISTERS: u8 = 8;

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

/// Returns true if the kernels for one state are to use the 32 registers of AVX-512 instead of the 16 of
/// AVX2. The results have the same bits. Returns false before the detection.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(super) fn has_wide_registers() -> bool {
    FEATURES.load(Ordering::Relaxed) & WIDE_REGISTERS != 0
}

/// Determines whether [`has_wide_registers`] may return true; initially it may.
pub(super) fn allow_wide_registers(is_allowed: bool) {
    let prohibited = if is_allowed { 0 } else { WIDE_REGISTERS };
    FEATURES.store(detect() & !prohibited, Ordering::Relaxed);
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
        let _ = FEATURES.compare_exchange(0, detect(), Ordering::Relaxed, Ordering::Relaxed);
    }
    FEATURES.load(Ordering::Relaxed) & feature != 0
}

#[cfg(target_arch = "x86_64")]
fn detect() -> u8 {
    use std::arch::is_x86_feature_detected as has;
    let fma = has!("avx2") && has!("fma");
    let avx512 = fma && has!("avx512f") && has!("avx512dq") && has!("avx512vl");
    // only processors of AMD have SSE4a; on those of Intel, AVX-512 is slower for one state
    let wide_registers = avx512 && has!("sse4a");
    DETECTED + u8::from(fma) * FMA + u8::from(avx512) * AVX512 + u8::from(wide_registers) * WIDE_REGISTERS
}

#[cfg(not(target_arch = "x86_64"))]
fn detect() -> u8 {
    DETECTED + u8::from(cfg!(target_arch = "aarch64")) * FMA // part of the baseline of aarch64
}
