//! The Earth as the inertial axes see it: how it turns.
//!
//! `I` has inertial axes, `F` is fixed in the turning Earth (ITRF, or a stand-in for it).

use nalgebra::{Matrix3, Vector3};

/// Rate of the Earth's rotation, rad/s.
///
/// Source: IERS Conventions (2010), Technical Note 36, equation 5.15: `2π 1.002 737 811 911 354 48` a day of UT1.
pub const ROTATION_RATE: f64 = 7.292_115_146_706_979e-5;

/// The turning Earth during a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Earth {
    angle: f64,
    rate: f64,
}

impl Earth {
    /// An Earth that turns evenly about z of `I`: by `angle`, rad, at the start of the run, at `rate`, rad/s.
    pub fn about_z(angle: f64, rate: f64) -> Self {
        Self { angle, rate }
    }

    /// Takes `I` components to `F` components, at `t` seconds of simulation.
    pub fn rot_fi(&self, t: f64) -> Matrix3<f64> {
        let (s, c) = (self.angle + self.rate * t).sin_cos();
        Matrix3::new(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0)
    }

    /// Angular velocity of `F` in `I`, axes of `I`, rad/s.
    pub fn angular_velocity(&self, _t: f64) -> Vector3<f64> {
        Vector3::z() * self.rate
    }
}
