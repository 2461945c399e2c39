//! A reference that stands still in inertial axes.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::error::{finite, positive};
use super::{Orbit, OrbitError, OrbitState, PathFrame};

/// A place and an attitude, both at rest in `I`: a laboratory, a frame far from everything.
///
/// Around a planet it does not fall, so gravity pulls the robot away from it, unless the robot is carried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedFrame {
    position: Vector3<f64>,
    rot_ip: Matrix3<f64>,
    mu: Option<f64>,
}

impl FixedFrame {
    /// At `position` (m) with axes turned by `attitude`, around a planet of parameter `mu` (m³/s²) or none.
    ///
    /// # Errors
    /// [`OrbitError::NotFinite`] and [`OrbitError::NotPositive`].
    pub fn new(
        position: Vector3<f64>,
        attitude: UnitQuaternion<f64>,
        mu: Option<f64>,
    ) -> Result<Self, OrbitError> {
        position.iter().try_for_each(|&x| finite("position", x).map(drop))?;
        attitude.coords.iter().try_for_each(|&x| finite("attitude", x).map(drop))?;
        mu.map(|mu| positive("mu", mu)).transpose()?;
        Ok(Self { position, rot_ip: attitude.to_rotation_matrix().into_inner(), mu })
    }
}

impl Orbit for FixedFrame {
    fn mu(&self) -> Option<f64> {
        self.mu
    }

    fn state(&self, t: f64) -> Result<OrbitState, OrbitError> {
        finite("time", t)?;
        let zero = Vector3::zeros();
        Ok(OrbitState { position: self.position, velocity: zero, acceleration: zero })
    }

    fn frame(&self, _t: f64) -> Result<PathFrame, OrbitError> {
        Ok(PathFrame { rot_ip: self.rot_ip, rate_p: Vector3::zeros() })
    }
}
