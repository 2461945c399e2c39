//! Staying where one is.

use super::{ReferenceError, TaskSample};
use crate::spatial::{Mat3, Real, Vec3};
use nalgebra::{Matrix3, Vector3};

/// A pose in W that does not change.
#[derive(Clone, Debug, PartialEq)]
pub struct Hold {
    pub(super) rot_wd: Mat3<f64>,
    pub(super) pos_w: Vec3<f64>,
}

impl Hold {
    /// Holds the pose `(rot_wd, pos_w)`; m.
    ///
    /// # Errors
    /// [`ReferenceError::NotFinite`], [`ReferenceError::NotARotation`].
    pub fn new(rot_wd: Matrix3<f64>, pos_w: Vector3<f64>) -> Result<Self, ReferenceError> {
        if !rot_wd.iter().chain(pos_w.iter()).all(|x| x.is_finite()) {
            return Err(ReferenceError::NotFinite { name: "pose" });
        }
        let error = (rot_wd.transpose() * rot_wd - Matrix3::identity()).amax();
        if error > 1e-6 || rot_wd.determinant() < 0.0 {
            return Err(ReferenceError::NotARotation {
                error: error.max((rot_wd.determinant() - 1.0).abs()),
            });
        }
        Ok(Self { rot_wd: rot_wd.into(), pos_w: pos_w.into() })
    }

    /// The pose, at rest.
    #[inline(always)]
    pub fn sample<S: Real>(&self) -> TaskSample<S> {
        TaskSample::at_rest(Mat3::of(&self.rot_wd), Vec3::of(&self.pos_w))
    }
}
