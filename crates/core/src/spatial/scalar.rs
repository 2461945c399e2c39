//! The scalar that every kernel is generic over.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// A real number, or several side by side: what the equations of motion are written in.
///
/// One state is computed with [`f64`] (any processor) or [`Fused`](super::Fused) (processors with
/// fused multiply-add); batches with lanes of numbers. Branch on structure, never on values:
/// where a value decides, use [`select`](Real::select).
pub trait Real:
    Copy
    + Debug
    + Default
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
{
    /// The outcome of a comparison, one truth value per lane.
    type Mask: Copy;

    /// How many numbers stand side by side.
    const LANES: usize;

    /// The constant `x` in every lane.
    fn of(x: f64) -> Self;

    /// The number `f(i)` in lane `i`.
    fn from_lanes(f: impl Fn(usize) -> f64) -> Self;

    /// The number in lane `i`.
    fn lane(self, i: usize) -> f64;

    /// Puts `x` into lane `i`.
    #[inline(always)]
    fn set_lane(&mut self, i: usize, x: f64) {
        let before = *self;
        *self = Self::from_lanes(|lane| if lane == i { x } else { before.lane(lane) });
    }

    /// Rows into lanes: number `i` of the row that begins at `place(l)` becomes lane `l` of `to[i]`.
    #[inline(always)]
    fn gather(from: &[f64], place: impl Fn(usize) -> usize, to: &mut [Self]) {
        gather_one_by_one(from, place, to);
    }

    /// The first `count` lanes into rows, the way back of [`gather`](Real::gather).
    #[inline(always)]
    fn scatter(from: &[Self], to: &mut [f64], count: usize, place: impl Fn(usize) -> usize) {
        scatter_one_by_one(from, to, count, place);
    }

    /// `self · a + b`, fused where the type's instruction set does it in hardware.
    #[must_use]
    fn mul_add(self, a: Self, b: Self) -> Self;

    /// Square root.
    #[must_use]
    fn sqrt(self) -> Self;

    /// Absolute value.
    #[must_use]
    fn abs(self) -> Self;

    /// Sine and cosine, rad. Errors below 1e-16 up to 1e5 rad.
    fn sin_cos(self) -> (Self, Self);

    /// [`sin_cos`](Real::sin_cos) of many angles, the same bits: several at a time where there is room for it.
    #[inline(always)]
    fn sin_cos_each(angles: &[Self], out: &mut [(Self, Self)]) {
        for (angle, out) in angles.iter().zip(out) {
            *out = angle.sin_cos();
        }
    }

    /// Angle of the point `(x, self)`, rad.
    #[must_use]
    fn atan2(self, x: Self) -> Self;

    /// Where `self < other`.
    fn less(self, other: Self) -> Self::Mask;

    /// `a` where the mask holds, `b` elsewhere.
    #[must_use]
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;

    /// Whether the mask holds in any lane: to leave out work that no lane needs, with the same bits.
    fn any(mask: Self::Mask) -> bool;

    /// Runs `kernel` compiled for the instruction set this scalar stands for.
    ///
    /// The closure and all it calls must be `#[inline(always)]`: what is left out of line is
    /// compiled for the baseline and loses the speed.
    fn enter<R>(kernel: impl FnOnce() -> R) -> R;
}

/// [`Real::gather`] for any number of lanes and any width.
#[inline(always)]
pub(super) fn gather_one_by_one<S: Real>(from: &[f64], place: impl Fn(usize) -> usize, to: &mut [S]) {
    for lane in 0..S::LANES {
        let row = &from[place(lane)..][..to.len()];
        for (to, from) in to.iter_mut().zip(row) {
            to.set_lane(lane, *from);
        }
    }
}

/// [`Real::scatter`] for any number of lanes and any width.
#[inline(always)]
pub(super) fn scatter_one_by_one<S: Real>(
    from: &[S],
    to: &mut [f64],
    count: usize,
    place: impl Fn(usize) -> usize,
) {
    for lane in 0..count {
        let row = &mut to[place(lane)..][..from.len()];
        for (to, from) in row.iter_mut().zip(from) {
            *to = from.lane(lane);
        }
    }
}

/// A [`Real`] that holds a single number, so that it can be read back.
pub trait Scalar: Real {
    /// The number.
    fn value(self) -> f64;
}

/// Beyond this magnitude, rad, the fast reduction of [`sine`](super::sine) loses digits.
pub(super) const FAST_SINE_LIMIT: f64 = 1e5;

impl Real for f64 {
    type Mask = bool;
    const LANES: usize = 1;

    #[inline(always)]
    fn of(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn from_lanes(f: impl Fn(usize) -> f64) -> Self {
        f(0)
    }
    #[inline(always)]
    fn lane(self, _: usize) -> f64 {
        self
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b // not f64::mul_add: without hardware for it that is a library call
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        if f64::abs(self) < FAST_SINE_LIMIT { super::sine::sin_cos(self) } else { f64::sin_cos(self) }
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        f64::atan2(self, x)
    }
    #[inline(always)]
    fn less(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }
    #[inline(always)]
    fn any(mask: bool) -> bool {
        mask
    }
    #[inline(always)]
    fn enter<R>(kernel: impl FnOnce() -> R) -> R {
        kernel()
    }
}

impl Scalar for f64 {
    #[inline(always)]
    fn value(self) -> f64 {
        self
    }
}
