//! Slip torques of the engaged brakes of joints.

/// Slip torques of the engaged brakes of a tree.
#[derive(Clone, Debug)]
pub(super) struct EngagedBrakes {
    /// Slip torque of the brake of each joint, N m or N: zero without an engaged brake, infinite if the brake
    /// holds the joint rigidly.
    slip_torque: Vec<f64>,
}

impl EngagedBrakes {
    /// Returns slip torques of zero for `count` joints.
    pub(super) fn none(count: usize) -> Self {
        Self { slip_torque: vec![0.0; count] }
    }

    /// Sets the slip torque of the brake of joint `j`, N m or N; zero disengages the brake.
    pub(super) fn set(&mut self, j: usize, slip_torque: f64) {
        self.slip_torque[j] = slip_torque;
    }

    /// Copies the slip torque of joint `from` in `other` to joint `j`.
    pub(super) fn take(&mut self, j: usize, other: &Self, from: usize) {
        self.slip_torque[j] = other.slip_torque[from];
    }

    /// Returns true if a brake holds joint `j` rigidly.
    #[inline]
    pub(super) fn holds(&self, j: usize) -> bool {
        self.slip_torque[j] == f64::INFINITY
    }

    /// Returns the Coulomb friction of the brake of joint `j`, N m or N: zero without an engaged brake and
    /// for a brake that holds the joint rigidly.
    #[inline]
    pub(super) fn torque(&self, j: usize) -> f64 {
        let torque = self.slip_torque[j];
        if torque.is_finite() { torque } else { 0.0 }
    }
}
