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

/// Lanes into rows, as many as there are.
#[inline(always)]
pub(super) fn scatter<S: Real>(from: &[S], places: Places, to: &mut [f64]) {
    S::scatter(
        from,
        to,
        places.count,
        #[inline(always)]
        |lane| places.first + lane * places.stride,
    );
}
