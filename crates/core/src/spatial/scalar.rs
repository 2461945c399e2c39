//! Interface of the scalar types over which all kernels are generic.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// Scalar of the kernels: a real number, or a vector with a number in each lane.
///
/// Single states are computed with [`f64`] (any processor) or [`Fused`](super::Fused) (processors with fused
/// multiply-add), and batches with vectors of several lanes. Kernels may branch on the structure of the model
/// but not on computed values, between which they choose with [`select`](Real::select).
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
    /// Result of a comparison, with one truth value per lane.
    type Mask: Copy;

    /// Number of lanes.
    const LANES: usize;

    /// Creates the scalar with the constant `x` in every lane.
    fn of(x: f64) -> Self;

    /// Creates the scalar with the number `f(i)` in each lane `i`.
    fn from_lanes(f: impl Fn(usize) -> f64) -> Self;

    /// Returns the number in lane `i`.
    fn lane(self, i: usize) -> f64;

    /// Sets lane `i` to `x`.
    #[inline(always)]
    fn set_lane(&mut self, i: usize, x: f64) {
        let before = *self;
        *self = Self::from_lanes(|lane| if lane == i { x } else { before.lane(lane) });
    }

    /// Reads rows into lanes: element `i` of the row that begins at `offset(l)` becomes lane `l` of `to[i]`.
    #[inline(always)]
    fn gather(from: &[f64], offset: impl Fn(usize) -> usize, to: &mut [Self]) {
        gather_each(from, offset, to);
    }

    /// Writes the first `count` lanes to rows. This is the inverse of [`gather`](Real::gather).
    #[inline(always)]
    fn scatter(from: &[Self], to: &mut [f64], count: usize, offset: impl Fn(usize) -> usize) {
        scatter_each(from, to, count, offset);
    }

    /// Returns `self · a + b`, as a fused operation if the instruction set of the type has one.
    #[must_use]
    fn mul_add(self, a: Self, b: Self) -> Self;

    /// Returns the square root.
    #[must_use]
    fn sqrt(self) -> Self;

    /// Returns the absolute value.
    #[must_use]
    fn abs(self) -> Self;

    /// Returns the sine and cosine of an angle in rad, with an absolute error below 2.3e-16 up to 1e5 rad.
    fn sin_cos(self) -> (Self, Self);

    /// Writes to `out` the sines and cosines of many angles, rad, bit-identical to
    /// [`sin_cos`](Real::sin_cos); several are computed at once if possible.
    #[inline(always)]
    fn sin_cos_each(angles: &[Self], out: &mut [(Self, Self)]) {
        for (angle, out) in angles.iter().zip(out) {
            *out = angle.sin_cos();
        }
    }

    /// Returns the angle from the x axis to the point `(x, self)`, rad.
    #[must_use]
    fn atan2(self, x: Self) -> Self;

    /// Returns the mask that is true where `self < other`.
    fn less(self, other: Self) -> Self::Mask;

    /// Returns `a` where the mask is true, `b` elsewhere.
    #[must_use]
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;

    /// Returns true if the mask is true in any lane; used to skip computations that no lane needs.
    fn any(mask: Self::Mask) -> bool;

    /// Runs `kernel`, which solves the same equations for several right-hand sides, with a suitable scalar
    /// type. For [`Fused`](super::Fused), this is a type with several lanes, which holds one right-hand side
    /// per lane. For other scalars, it is `Self`, with one right-hand side at a time.
    #[inline(always)]
    fn solve_columns(kernel: impl ColumnKernel<Self>) {
        kernel.run(
            #[inline(always)]
            |x| x,
        );
    }

    /// Runs `kernel`, compiled for the instruction set of this scalar.
    ///
    /// The closure and all functions that it calls must be `#[inline(always)]`: code that is not inlined is
    /// compiled for the baseline instruction set and is slow.
    fn enter<R>(kernel: impl FnOnce() -> R) -> R;
}

/// Solution of equations with coefficients of type `S` for several right-hand sides
/// ([`Real::solve_columns`]).
pub trait ColumnKernel<S> {
    /// Runs the computation with right-hand sides of type `R`; `lift` converts a coefficient to `R`.
    fn run<R: Real>(self, lift: impl Fn(S) -> R + Copy);
}

/// Implements [`Real::gather`] for any number of lanes and any row length.
#[inline(always)]
pub(super) fn gather_each<S: Real>(from: &[f64], offset: impl Fn(usize) -> usize, to: &mut [S]) {
    for lane in 0..S::LANES {
        let row = &from[offset(lane)..][..to.len()];
        for (to, from) in to.iter_mut().zip(row) {
            to.set_lane(lane, *from);
        }
    }
}

/// Implements [`Real::scatter`] for any number of lanes and any row length.
#[inline(always)]
pub(super) fn scatter_each<S: Real>(
    from: &[S],
    to: &mut [f64],
    count: usize,
    offset: impl Fn(usize) -> usize,
) {
    for lane in 0..count {
        let row = &mut to[offset(lane)..][..from.len()];
        for (to, from) in row.iter_mut().zip(from) {
            *to = from.lane(lane);
        }
    }
}

/// Scalar that holds a single number.
pub trait Scalar: Real {
    /// Returns the number that the scalar holds.
    fn value(self) -> f64;
}
