//! Force, moment, point and opening of one closed loop in a row of a trace.

/// Force, moment, point and opening of one closed loop at the time of a row of the trace.
pub(super) struct LoopRow {
    /// Index of the tree.
    pub(super) tree: usize,
    /// Index of the loop among the closures of the tree.
    pub(super) closure: usize,
    /// Values in the order of the parts of [`LOOPS`](super::LOOPS).
    pub(super) values: [f64; 11],
}
