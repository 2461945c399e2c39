//! Structure of arrays: columns with the values of eight bodies, which effects load onto SIMD lanes.

use crate::spatial::{Lanes8, Real, Vec3};

/// Number of rows of a column, which is the number of lanes of the widest SIMD type.
pub(crate) const WIDTH: usize = Lanes8::LANES;

/// Column with one number for each of eight bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(64))]
pub(crate) struct Column8([f64; WIDTH]);

impl Column8 {
    /// Creates the column with `f(i)` in row `i`.
    pub(super) fn of(f: impl Fn(usize) -> f64) -> Self {
        Self(std::array::from_fn(f))
    }

    /// Creates three columns with the components of `f(i)` in row `i`.
    pub(super) fn vectors(f: impl Fn(usize) -> Vec3<f64>) -> Vec3<Self> {
        Vec3 { x: Self::of(|i| f(i).x), y: Self::of(|i| f(i).y), z: Self::of(|i| f(i).z) }
    }

    /// Returns the number in row `i`.
    pub(super) fn get(&self, i: usize) -> f64 {
        self.0[i]
    }

    /// Returns `Σ aᵢ bᵢ`, computed as four partial sums.
    pub(super) fn dot(&self, other: &Self) -> f64 {
        let pair = |i: usize| self.0[i] * other.0[i] + self.0[i + WIDTH / 2] * other.0[i + WIDTH / 2];
        (pair(0) + pair(1)) + (pair(2) + pair(3))
    }

    /// Loads the numbers of consecutive rows, one per lane of `S`, starting at row `offset`.
    #[inline(always)]
    pub(super) fn load<S: Real>(&self, offset: usize) -> S {
        let numbers = &self.0[offset..][..S::LANES];
        S::from_lanes(|i| numbers[i])
    }

    /// Stores the lanes in consecutive rows, starting at row `offset`.
    #[inline(always)]
    pub(super) fn store<S: Real>(&mut self, offset: usize, lanes: S) {
        for (i, to) in self.0[offset..][..S::LANES].iter_mut().enumerate() {
            *to = lanes.lane(i);
        }
    }
}

/// Stores vectors, one per lane, in consecutive rows of three columns, starting at row `offset`.
#[inline(always)]
pub(super) fn store<S: Real>(columns: &mut Vec3<Column8>, offset: usize, lanes: Vec3<S>) {
    columns.x.store(offset, lanes.x);
    columns.y.store(offset, lanes.y);
    columns.z.store(offset, lanes.z);
}

/// Compiles a kernel for several numbers of lanes, and runs the version that is best for `count` bodies on
/// this processor.
macro_rules! on_lanes {
    ($count:expr, $lanes:ident => $kernel:expr) => {{
        use $crate::spatial::{Fused, InstructionSet, Lanes4, Lanes8};
        macro_rules! with {
            ($type:ty) => {{
                type $lanes = $type;
                $kernel
            }};
        }
        match (InstructionSet::current(), $count) {
            (InstructionSet::Baseline, _) => with!(f64),
            (_, 0..2) => with!(Fused),
            (InstructionSet::Fused, _) | (_, 2..5) => with!(Lanes4),
            (InstructionSet::Wide, _) => with!(Lanes8),
        }
    }};
}
pub(crate) use on_lanes;
