//! Running sums as plain numbers, for checkpoints.

use crate::spatial::Vec3;

/// What a check has gathered so far, as numbers in a fixed order.
pub(super) trait Numbers {
    /// Appends all numbers.
    fn save(&self, to: &mut Vec<f64>);
    /// Takes them back in the same order.
    fn restore(&mut self, from: &mut Restore<'_>);
}

/// Reads saved numbers one after the other; counts those that are missing.
pub(in crate::simulation) struct Restore<'a> {
    rest: std::slice::Iter<'a, f64>,
    pub(super) is_short: bool,
}

impl<'a> Restore<'a> {
    pub(in crate::simulation) fn new(numbers: &'a [f64]) -> Self {
        Self { rest: numbers.iter(), is_short: false }
    }

    pub(in crate::simulation) fn next(&mut self) -> f64 {
        self.is_short |= self.rest.len() == 0;
        self.rest.next().copied().unwrap_or(f64::NAN)
    }

    pub(in crate::simulation) fn vector(&mut self) -> Vec3<f64> {
        Vec3::new(self.next(), self.next(), self.next())
    }

    /// Whether exactly all numbers were read.
    pub(in crate::simulation) fn is_complete(&self) -> bool {
        !self.is_short && self.rest.len() == 0
    }
}
