//! Which of the processor's instructions the kernels use.

use super::fused::Fused;
use std::sync::atomic::{AtomicU8, Ordering};

/// Levels of arithmetic that the kernels are compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum InstructionSet {
    /// What every processor of the family has.
    Baseline = 0,
    /// Fused multiply-add (x86-64: AVX2 and FMA).
    Fused = 1,
}

/// Highest level allowed; all by default.
static ALLOWED: AtomicU8 = AtomicU8::new(u8::MAX);

impl InstructionSet {
    /// The highest level that the processor has and [`InstructionSet::limit`] allows.
    pub fn current() -> Self {
        let is_allowed = ALLOWED.load(Ordering::Relaxed) >= Self::Fused as u8;
        if is_allowed && Fused::is_available() { Self::Fused } else { Self::Baseline }
    }

    /// Uses nothing above `level` from now on, in all threads.
    pub fn limit(level: Self) {
        ALLOWED.store(level as u8, Ordering::Relaxed);
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::Fused if cfg!(target_arch = "x86_64") => "avx2+fma",
            Self::Fused => "fma",
        }
    }
}
