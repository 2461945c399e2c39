//! Checks accumulated over the rows of a trace.

use super::attitude::Attitude;
use super::balance::Balance;
use super::base_rows::Residuals;
use super::center_of_mass::CenterOfMass;
use crate::model::Model;

/// Sums and maxima over the rows of a trace, from which the certificate is computed.
///
/// A run that removes rows from its trace keeps the sums over these rows here.
#[derive(Clone, Debug)]
pub struct RowChecks {
    pub(super) balance: Balance,
    pub(super) center: CenterOfMass,
    pub(super) residuals: Residuals,
    pub(super) attitude: Attitude,
    /// True if no external wrench has acted in these rows.
    pub(super) is_free: bool,
    /// Largest opening of a closed loop or deviation of a mimic joint from its leader, m or rad; `None`
    /// without loops and mimic joints.
    pub(super) opening: Option<f64>,
    /// Smallest and largest position of each joint, rad or m.
    pub(super) joints: Vec<(f64, f64)>,
    /// Number of rows that were removed from the trace.
    removed: usize,
}

impl RowChecks {
    /// Creates the sums and maxima before any row is added.
    pub(super) fn new(model: &Model) -> Self {
        Self {
            balance: Balance::default(),
            center: CenterOfMass::default(),
            residuals: Residuals::default(),
            attitude: Attitude::default(),
            is_free: true,
            opening: None,
            joints: vec![(f64::INFINITY, f64::NEG_INFINITY); model.joint_count()],
            removed: 0,
        }
    }

    /// Returns these sums with the number of removed rows increased by `count`.
    pub(crate) fn with_removed(mut self, count: usize) -> Self {
        self.removed += count;
        self
    }

    /// Returns the number of rows that were removed from the trace.
    pub(crate) fn rows(&self) -> usize {
        self.removed
    }

    /// Returns the smallest and largest position of joint `j`, rad or m.
    pub(crate) fn joint_range(&self, j: usize) -> (f64, f64) {
        self.joints[j]
    }
}
