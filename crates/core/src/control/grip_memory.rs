//! State of a grip between control ticks.

use serde::{Deserialize, Serialize};

/// State of a grip between control ticks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct GripMemory {
    /// True while all fingers touch.
    pub(super) is_closed: bool,
    /// Current desired force `F`, N.
    pub(super) reference: f64,
    /// Integral of the force error times the gain, N.
    pub(super) integral: f64,
    /// Positions of the joints of the group when all fingers touched, rad (m).
    pub(super) held: Vec<f64>,
}

impl GripMemory {
    /// Creates the state of an open gripper with `count` joints.
    pub(super) fn open(count: usize) -> Self {
        Self { held: vec![0.0; count], ..Self::default() }
    }

    /// Returns the number of joints.
    pub(super) fn joints(&self) -> usize {
        self.held.len()
    }

    /// Resets the state to that of a gripper that closes.
    pub(super) fn release(&mut self) {
        (self.is_closed, self.reference, self.integral) = (false, 0.0, 0.0);
    }
}
