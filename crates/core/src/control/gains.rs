//! Numbers a user gives a law, and what is accepted of them.

use super::error::ControlError;

/// One number for all joints of a group, or one for each.
#[derive(Clone, Debug, PartialEq)]
pub struct PerJoint(Vec<f64>);

impl PerJoint {
    /// These numbers; a single one is for all joints.
    pub fn new(numbers: Vec<f64>) -> Self {
        Self(numbers)
    }

    /// The number of the joint at this place in the group.
    #[inline(always)]
    pub fn at(&self, place: usize) -> f64 {
        if self.0.len() == 1 { self.0[0] } else { self.0[place] }
    }

    /// Whether there is a number other than zero.
    pub(super) fn is_used(&self) -> bool {
        self.0.iter().any(|x| *x != 0.0)
    }

    /// Numbers that are not negative, one or one for each of `count` joints.
    pub(super) fn check(&self, name: &'static str, count: usize) -> Result<(), ControlError> {
        self.check_count(name, count)?;
        check_numbers(name, &self.0)
    }

    /// The same, where infinity means that there is no limit.
    pub(super) fn check_limit(&self, name: &'static str, count: usize) -> Result<(), ControlError> {
        self.check_count(name, count)?;
        match self.0.iter().find(|x| x.is_nan() || **x < 0.0) {
            Some(&value) if value.is_nan() => Err(ControlError::NotFinite { name, value }),
            Some(&value) => Err(ControlError::Negative { name, value }),
            None => Ok(()),
        }
    }

    fn check_count(&self, name: &'static str, count: usize) -> Result<(), ControlError> {
        let got = self.0.len();
        if got == 1 || got == count {
            return Ok(());
        }
        Err(ControlError::WrongLength {
            name,
            expected: format!("1 or {count}, one per joint of the group"),
            got,
        })
    }
}

impl From<f64> for PerJoint {
    fn from(number: f64) -> Self {
        Self(vec![number])
    }
}

/// Finite numbers that are not negative.
pub(super) fn check_numbers(name: &'static str, numbers: &[f64]) -> Result<(), ControlError> {
    if let Some(&value) = numbers.iter().find(|x| !x.is_finite()) {
        return Err(ControlError::NotFinite { name, value });
    }
    check_size(name, numbers)?;
    match numbers.iter().find(|x| **x < 0.0) {
        Some(&value) => Err(ControlError::Negative { name, value }),
        None => Ok(()),
    }
}

/// Largest gain in SI units; motors of robots take 1e-3 to 1e6.
const LARGEST: f64 = 1e20;

fn check_size(name: &'static str, numbers: &[f64]) -> Result<(), ControlError> {
    match numbers.iter().find(|x| x.abs() > LARGEST) {
        Some(&value) => Err(ControlError::TooLarge { name, value, most: LARGEST }),
        None => Ok(()),
    }
}

/// A finite `(6, 6)` gain whose diagonal is not negative.
pub(super) fn check_matrix(name: &'static str, gains: &[f64; 36]) -> Result<(), ControlError> {
    if let Some(&value) = gains.iter().find(|x| !x.is_finite()) {
        return Err(ControlError::NotFinite { name, value });
    }
    check_size(name, gains)?;
    check_numbers(name, &[0, 1, 2, 3, 4, 5].map(|i| gains[7 * i]))
}
