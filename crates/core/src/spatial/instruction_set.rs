//! Which of the processor's instructions the kernels use.

use super::fused::Fused;
use super::lanes::Lanes8;
use std::sync::atomic::{AtomicU8, Ordering};

/// Levels of arithmetic that the kernels are compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum InstructionSet {
    /// What every processor of the family has.
    Baseline = 0,
    /// Fused multiply-add (x86-64: AVX2 and FMA).
    Fused = 1,
    /// 512-bit vectors in batches (x86-64: AVX-512 F, DQ and VL).
    Wide = 2,
}

/// Highest level allowed; all by default.
static ALLOWED: AtomicU8 = AtomicU8::new(u8::MAX);

impl InstructionSet {
    /// All levels, the lowest first.
    pub const ALL: [Self; 3] = [Self::Baseline, Self::Fused, Self::Wide];

    /// The highest level that the processor has and [`InstructionSet::limit`] allows.
    pub fn current() -> Self {
        let allowed = ALLOWED.load(Ordering::Relaxed);
        if allowed >= Self::Wide as u8 && Lanes8::is_available() {
            Self::Wide
        } else if allowed >= Self::Fused as u8 && Fused::is_available() {
            Self::Fused
        } else {
            Self::Baseline
        }
    }

    /// Uses nothing above `level` from now on, in all threads.
    pub fn limit(level: Self) {
        ALLOWED.store(level as u8, Ordering::Relaxed);
    }

    /// The level with this [`name`](Self::name).
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|level| level.name() == name)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::Wide => "avx512",
            Self::Fused if cfg!(target_arch = "x86_64") => "avx2+fma",
            Self::Fused => "fma",
        }
    }
}
