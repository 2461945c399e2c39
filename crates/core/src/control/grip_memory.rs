//! State of a grip-force law between control ticks.

use serde::{Deserialize, Serialize};

/// State of a grip-force law between control ticks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct GripMemory {
    /// True while all fingers touch the object.
    pub(super) is_closed: bool,
    /// Current desired force `F`, N.
    pub(super) reference: f64,
    /// Integral of the force error over time, multiplied by the gain `i`, N.
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

    /// Resets the state to that of a gripper whose fingers do not all touch the object.
    pub(super) fn release(&mut self) {
        (self.is_closed, self.reference, self.integral) = (false, 0.0, 0.0);
    }
}
