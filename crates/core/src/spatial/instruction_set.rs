//! Instruction sets of the kernels.

use super::fused::Fused;
use super::lanes::Lanes8;
use std::sync::atomic::{AtomicU8, Ordering};

/// Instruction sets that the kernels are compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum InstructionSet {
    /// Instructions that all processors of the family have.
    Baseline = 0,
    /// Fused multiply-add (x86-64: AVX2 and FMA).
    Fused = 1,
    /// 512-bit vectors in batches (x86-64: AVX-512 F, DQ and VL).
    Wide = 2,
}

/// Highest allowed level; all levels are allowed by default.
static ALLOWED: AtomicU8 = AtomicU8::new(u8::MAX);

impl InstructionSet {
    /// All levels, lowest first.
    pub const ALL: [Self; 3] = [Self::Baseline, Self::Fused, Self::Wide];

    /// Returns the highest level that the processor has and [`InstructionSet::limit`] allows.
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

    /// Limits all threads to `level` from now on.
    pub fn limit(level: Self) {
        ALLOWED.store(level as u8, Ordering::Relaxed);
    }

    /// Returns the level with this [`name`](Self::name).
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|level| level.name() == name)
    }

    /// Returns the name of the level.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::Wide => "avx512",
            Self::Fused if cfg!(target_arch = "x86_64") => "avx2+fma",
            Self::Fused => "fma",
        }
    }
}
