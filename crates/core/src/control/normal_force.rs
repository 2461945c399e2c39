//! Normal forces of contacts on the bodies of a robot, as input to control laws.

use crate::spatial::Vec3;

/// Normal force of a contact on a body of the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalForce {
    /// Index of the body.
    pub body: usize,
    /// Index of the body on the other side of the contact; `None` if it belongs to another robot.
    pub other: Option<usize>,
    /// Point at which the force acts, in W, m.
    pub point: Vec3<f64>,
    /// Force on the body, axes of W, N.
    pub force: Vec3<f64>,
}
