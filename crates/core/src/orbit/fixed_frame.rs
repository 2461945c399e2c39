//! Reference orbit at rest in inertial axes.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::error::{finite, positive};
use super::{Orbit, OrbitError, OrbitState, PathFrame};

/// Frame at rest in the inertial frame `I`, such as a laboratory or a frame far from all bodies.
///
/// The frame is not in free fall: around a planet, gravity accelerates the robot relative to the frame. With
/// `gravity_mode` `carried`, only the tidal part of gravity does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedFrame {
    position: Vector3<f64>,
    rot_ip: Matrix3<f64>,
    mu: Option<f64>,
}

impl FixedFrame {
    /// Creates the frame at `position` (m, from the planet's centre, axes of `I`), with the rotation
    /// `attitude` from its axes to `I`, around a planet with gravitational parameter `mu` (m³/s²), or without
    /// a planet if `mu` is `None`.
    ///
    /// # Errors
    /// [`OrbitError::NotFinite`] and [`OrbitError::TooLarge`] for `position`, `attitude` and `mu`, and
    /// [`OrbitError::NotPositive`] for `mu`.
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
