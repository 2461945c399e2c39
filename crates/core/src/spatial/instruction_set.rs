//! Instruction sets for which the kernels are compiled.

use super::cpu_features::allow_wide_registers;
use super::fused::Fused;
use super::lanes::Lanes8;
use std::sync::atomic::{AtomicU8, Ordering};

/// Instruction set for which the kernels are compiled; a higher level includes the lower ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum InstructionSet {
    /// Instructions that every processor of the architecture has.
    Baseline = 0,
    /// Fused multiply-add (x86-64: AVX2 and FMA).
    Fused = 1,
    /// 512-bit vectors in batch computations (x86-64: AVX-512 F, DQ and VL) and, on processors of AMD, their
    /// 32 registers in kernels for one state.
    Wide = 2,
}

/// Highest allowed level; initially all levels are allowed.
static ALLOWED: AtomicU8 = AtomicU8::new(u8::MAX);

impl InstructionSet {
    /// All levels, lowest first.
    pub const ALL: [Self; 3] = [Self::Baseline, Self::Fused, Self::Wide];

    /// Returns the highest level that the processor supports and that [`InstructionSet::limit`] allows.
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

    /// Limits the level used by all threads to at most `level`, until the next call.
    pub fn limit(level: Self) {
        ALLOWED.store(level as u8, Ordering::Relaxed);
        allow_wide_registers(level >= Self::Wide);
    }

    /// Returns the level with the given [`name`](Self::name); `None` if there is none.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|level| level.name() == name)
    }

    /// Returns the name by which users refer to the level.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::Wide => "avx512",
            Self::Fused if cfg!(target_arch = "x86_64") => "avx2+fma",
            Self::Fused => "fma",
        }
    }
}
