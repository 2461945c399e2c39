//! Numbers of eight bodies side by side: what effects load onto the lanes of the processor.

use crate::spatial::{Lanes8, Real, Vec3};

/// As many bodies as the widest lanes hold.
pub(crate) const WIDTH: usize = Lanes8::LANES;

/// One number of each of eight bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(64))]
pub(crate) struct Eight([f64; WIDTH]);

impl Eight {
    /// The number `f(i)` of body `i`.
    pub(super) fn of(f: impl Fn(usize) -> f64) -> Self {
        Self(std::array::from_fn(f))
    }

    /// One vector of each body.
    pub(super) fn vectors(f: impl Fn(usize) -> Vec3<f64>) -> Vec3<Self> {
        Vec3 { x: Self::of(|i| f(i).x), y: Self::of(|i| f(i).y), z: Self::of(|i| f(i).z) }
    }

    /// The number of one body.
    pub(super) fn get(&self, i: usize) -> f64 {
        self.0[i]
    }

    /// `Σ aᵢ bᵢ`, in four sums.
    pub(super) fn dot(&self, other: &Self) -> f64 {
        let pair = |i: usize| self.0[i] * other.0[i] + self.0[i + WIDTH / 2] * other.0[i + WIDTH / 2];
        (pair(0) + pair(1)) + (pair(2) + pair(3))
    }

    /// As many numbers as `S` has lanes, from number `offset` on.
    #[inline(always)]
    pub(super) fn load<S: Real>(&self, offset: usize) -> S {
        let numbers = &self.0[offset..][..S::LANES];
        S::from_lanes(|i| numbers[i])
    }

    /// The way back.
    #[inline(always)]
    pub(super) fn store<S: Real>(&mut self, offset: usize, lanes: S) {
        for (i, to) in self.0[offset..][..S::LANES].iter_mut().enumerate() {
            *to = lanes.lane(i);
        }
    }
}

/// The way back for a vector.
#[inline(always)]
pub(super) fn store<S: Real>(rows: &mut Vec3<Eight>, offset: usize, lanes: Vec3<S>) {
    rows.x.store(offset, lanes.x);
    rows.y.store(offset, lanes.y);
    rows.z.store(offset, lanes.z);
}

/// Compiles a kernel for several numbers of lanes, and runs it with as many as `count` bodies fill and the processor has.
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
