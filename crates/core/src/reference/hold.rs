//! Reference that holds a constant pose.

use super::error::check_numbers;
use super::{ReferenceError, TaskPath, TaskSample};
use crate::spatial::{Mat3, Vec3};
use nalgebra::{Isometry3, Matrix3, Rotation3, UnitQuaternion, Vector3};

/// Constant pose in the frame of the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Hold {
    pub(super) rot_fd: Mat3<f64>,
    pub(super) pos_f: Vec3<f64>,
}

impl Hold {
    /// Creates a reference at the constant pose `(rot_fd, pos_f)`, m, in the frame of the reference.
    ///
    /// # Errors
    /// [`ReferenceError::NotFinite`] for numbers that are not finite or exceed 1e60 in magnitude;
    /// [`ReferenceError::NotARotation`] for `rot_fd`.
    pub fn new(rot_fd: Matrix3<f64>, pos_f: Vector3<f64>) -> Result<Self, ReferenceError> {
        check_numbers("pose", rot_fd.iter().chain(&pos_f))?;
        let error = (rot_fd.transpose() * rot_fd - Matrix3::identity()).amax();
        if error > 1e-6 || rot_fd.determinant() < 0.0 {
            return Err(ReferenceError::NotARotation {
                error: error.max((rot_fd.determinant() - 1.0).abs()),
            });
        }
        Ok(Self { rot_fd: rot_fd.into(), pos_f: pos_f.into() })
    }

    /// Returns the pose as an isometry.
    pub fn isometry(&self) -> Isometry3<f64> {
        let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(
            self.rot_fd.to_nalgebra(),
        ));
        Isometry3::from_parts(self.pos_f.to_nalgebra().into(), rotation)
    }
}

impl TaskPath for Hold {
    fn sample(&self, _: f64) -> TaskSample<f64> {
        TaskSample::at_rest(self.rot_fd, self.pos_f)
    }

    fn duration(&self) -> f64 {
        0.0
    }
}
