//! Conversion between rows of numbers and vectors with SIMD lanes.

use crate::spatial::Real;

/// Memory layout of a group of states: row k begins at index `first + k · stride`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strides {
    pub(super) first: usize,
    pub(super) stride: usize,
    /// Number of states, at most one per lane.
    pub(super) count: usize,
}

/// Loads rows into lanes: `to[i]` holds entry `i` of every row. Lanes without a state repeat the last row.
#[inline(always)]
pub(super) fn gather<S: Real>(from: &[f64], strides: Strides, to: &mut [S]) {
    let last = strides.count - 1;
    S::gather(
        from,
        #[inline(always)]
        |lane| strides.first + lane.min(last) * strides.stride,
        to,
    );
}

/// Length of the blocks in which wide rows are written. Because writing to many rows at once is slow, each
/// block is first assembled in a buffer.
const BLOCK: usize = 64;

/// Buffer for one block of each row, with up to eight lanes, aligned to a vector register.
#[repr(align(64))]
struct BlockBuffer([f64; 8 * BLOCK]);

/// Writes lanes to rows: entry `i` of the row of a state is its lane of `from[i]`. Lanes without a state are
/// not written. This is the inverse of [`gather`].
#[inline(always)]
pub(super) fn scatter<S: Real>(from: &[S], strides: Strides, to: &mut [f64]) {
    let Strides { first, stride, count } = strides;
    if from.len() < BLOCK {
        S::scatter(
            from,
            to,
            count,
            #[inline(always)]
            |lane| first + lane * stride,
        );
        return;
    }
    let mut buffer = BlockBuffer([0.0; 8 * BLOCK]);
    for (k, numbers) in from.chunks(BLOCK).enumerate() {
        S::scatter(
            numbers,
            &mut buffer.0,
            count,
            #[inline(always)]
            |lane| lane * BLOCK,
        );
        for lane in 0..count {
            let row = &mut to[first + lane * stride + k * BLOCK..][..numbers.len()];
            row.copy_from_slice(&buffer.0[lane * BLOCK..][..numbers.len()]);
        }
    }
}
