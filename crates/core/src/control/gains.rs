//! Gains of control laws, and their checks.

use super::error::ControlError;

/// Parameter of the joints of a group: one number for all joints, or one number per joint.
#[derive(Clone, Debug, PartialEq)]
pub struct PerJoint(Vec<f64>);

impl PerJoint {
    /// Creates a parameter with one number per joint; a single number applies to all joints.
    pub fn new(numbers: Vec<f64>) -> Self {
        Self(numbers)
    }

    /// Returns the number for the joint at index `place` in the group.
    #[inline(always)]
    pub fn at(&self, place: usize) -> f64 {
        if self.0.len() == 1 { self.0[0] } else { self.0[place] }
    }

    /// Returns true if any of the numbers differs from zero.
    pub(super) fn is_used(&self) -> bool {
        self.0.iter().any(|x| *x != 0.0)
    }

    /// Returns true if all numbers are positive.
    pub(super) fn is_positive(&self) -> bool {
        self.0.iter().all(|x| *x > 0.0)
    }

    /// Checks that there is one number, or one for each of `count` joints, and that all numbers are finite,
    /// not negative and at most [`LARGEST`].
    pub(super) fn check(&self, name: &'static str, count: usize) -> Result<(), ControlError> {
        self.check_count(name, count)?;
        check_numbers(name, &self.0)
    }

    /// Checks that there is one number, or one for each of `count` joints, and that all numbers are finite,
    /// not zero and at most [`LARGEST`] in magnitude.
    pub(super) fn check_signed(&self, name: &'static str, count: usize) -> Result<(), ControlError> {
        self.check_count(name, count)?;
        check_size(name, &self.0)?;
        if self.0.contains(&0.0) { Err(ControlError::Zero { name }) } else { Ok(()) }
    }

    /// Checks that there is one limit, or one for each of `count` components, and that no limit is negative
    /// or NaN. Infinity means no limit.
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
            // the error of a tool has two components
            expected: match count {
                1 => "1, for the only joint of the group or for the grip force".to_owned(),
                2 => "1 for all, or 2: one per joint of the group, or one for the position and one for the \
                      attitude of a tool"
                    .to_owned(),
                _ => format!("1 for all, or {count}: one per joint of the group"),
            },
            got,
        })
    }
}

impl From<f64> for PerJoint {
    fn from(number: f64) -> Self {
        Self(vec![number])
    }
}

/// Checks that the numbers are finite, not negative and at most [`LARGEST`].
pub(super) fn check_numbers(name: &'static str, numbers: &[f64]) -> Result<(), ControlError> {
    check_size(name, numbers)?;
    match numbers.iter().find(|x| **x < 0.0) {
        Some(&value) => Err(ControlError::Negative { name, value }),
        None => Ok(()),
    }
}

/// Largest accepted gain, SI units; typical gains of robots are 1e-3 to 1e6.
const LARGEST: f64 = 1e20;

/// Checks that the numbers are finite and that their magnitude does not exceed [`LARGEST`].
pub(super) fn check_size(name: &'static str, numbers: &[f64]) -> Result<(), ControlError> {
    if let Some(&value) = numbers.iter().find(|x| !x.is_finite()) {
        return Err(ControlError::NotFinite { name, value });
    }
    match numbers.iter().find(|x| x.abs() > LARGEST) {
        Some(&value) => Err(ControlError::TooLarge { name, value, most: LARGEST }),
        None => Ok(()),
    }
}

/// Checks that the entries of a `(6, 6)` gain are finite and at most [`LARGEST`] in magnitude, and that its
/// diagonal has no negative entry.
pub(super) fn check_matrix(name: &'static str, gains: &[f64; 36]) -> Result<(), ControlError> {
    check_size(name, gains)?;
    check_numbers(name, &[0, 1, 2, 3, 4, 5].map(|i| gains[7 * i]))
}
