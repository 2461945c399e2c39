//! Frames of a robot.

use crate::spatial::{Mat3, Vec3};

/// Named frame fixed to a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Name of a link, or of a frame that was added to a link.
    pub name: String,
    /// Index of the body.
    pub body: usize,
    /// Rotation from frame axes to body axes.
    pub rot_kf: Mat3<f64>,
    /// Position of the frame origin in body axes, m.
    pub pos_kf: Vec3<f64>,
}
