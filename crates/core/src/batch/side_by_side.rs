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
    let width = to.len();
    for lane in 0..S::LANES {
        let row = &from[places.first + lane.min(places.count - 1) * places.stride..][..width];
        for (to, from) in to.iter_mut().zip(row) {
            to.set_lane(lane, *from);
        }
    }
}

/// Lanes into rows, as many as there are.
#[inline(always)]
pub(super) fn scatter<S: Real>(from: &[S], places: Places, to: &mut [f64]) {
    for lane in 0..places.count {
        let row = &mut to[places.first + lane * places.stride..][..from.len()];
        for (to, from) in row.iter_mut().zip(from) {
            *to = from.lane(lane);
        }
    }
}
