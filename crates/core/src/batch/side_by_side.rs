//! From rows of numbers to lanes and back.

use crate::spatial::Real;

/// Where the rows of some states lie: the first at `first`, each `stride` numbers after the one before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Places {
    pub(super) first: usize,
    pub(super) stride: usize,
    /// Number of states, at most one per lane.
    pub(super) count: usize,
}

/// Rows into lanes; lanes beyond the last row repeat it.
#[inline(always)]
pub(super) fn gather<S: Real>(from: &[f64], places: Places, to: &mut [S]) {
    let last = places.count - 1;
    S::gather(
        from,
        #[inline(always)]
        |lane| places.first + lane.min(last) * places.stride,
        to,
    );
}

/// Numbers of a wide row that are put together before they go to memory, which is slow where many rows are
/// written at once.
const STRETCH: usize = 64;

/// Stretches of as many rows as there are lanes at most, on the boundaries of registers.
#[repr(align(64))]
struct Stretches([f64; 8 * STRETCH]);

/// Lanes into rows, as many as there are.
#[inline(always)]
pub(super) fn scatter<S: Real>(from: &[S], places: Places, to: &mut [f64]) {
    let Places { first, stride, count } = places;
    if from.len() < STRETCH {
        S::scatter(
            from,
            to,
            count,
            #[inline(always)]
            |lane| first + lane * stride,
        );
        return;
    }
    let mut near = Stretches([0.0; 8 * STRETCH]);
    for (k, numbers) in from.chunks(STRETCH).enumerate() {
        S::scatter(
            numbers,
            &mut near.0,
            count,
            #[inline(always)]
            |lane| lane * STRETCH,
        );
        for lane in 0..count {
            let row = &mut to[first + lane * stride + k * STRETCH..][..numbers.len()];
            row.copy_from_slice(&near.0[lane * STRETCH..][..numbers.len()]);
        }
    }
}
