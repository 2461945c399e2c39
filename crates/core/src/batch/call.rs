//! Inputs and outputs of a kernel call.

use super::kernels::Kernel;
use crate::model::Model;

/// Input array with one row per state.
#[derive(Clone, Copy, Debug)]
pub struct Rows<'a> {
    /// Values of all rows, one row after the other.
    pub data: &'a [f64],
    /// Number of values in a row.
    pub width: usize,
}

/// Output array with one row per state; the rows follow each other.
pub type RowsMut<'a> = &'a mut [f64];

/// External wrenches on the body of a frame, in frame axes about the frame origin, N and N m, linear first.
#[derive(Clone, Copy, Debug)]
pub struct Wrenches<'a> {
    /// Index of the frame.
    pub frame: usize,
    /// One wrench for all states, (6,), or one per state, (B, 6).
    pub rows: &'a [f64],
}

/// Kernel that is evaluated, with the robot and the inputs.
#[derive(Clone, Copy)]
pub(super) struct Call<'a> {
    pub(super) kernel: Kernel,
    pub(super) model: &'a Model,
    pub(super) inputs: &'a [Rows<'a>],
    pub(super) external: &'a [Wrenches<'a>],
}

impl Call<'_> {
    /// Returns the number of states, which is the number of rows of the first input.
    pub(super) fn count(&self) -> usize {
        self.inputs[0].data.len() / self.inputs[0].width.max(1)
    }
}
