//! Rotation rate of the Earth, and rotations of axes about x and z.

use nalgebra::Matrix3;

/// Rate of the Earth's rotation, rad/s.
///
/// Source: IERS Conventions (2010), Technical Note 36, equation 5.15: `2π 1.002 737 811 911 354 48` per day
/// of UT1.
pub const ROTATION_RATE: f64 = 7.292_115_146_706_979e-5;

/// Returns the matrix that converts components to axes rotated by `angle` (rad) about x.
pub(super) fn r1(angle: f64) -> Matrix3<f64> {
    let (s, c) = angle.sin_cos();
    Matrix3::new(1.0, 0.0, 0.0, 0.0, c, s, 0.0, -s, c)
}

/// Returns the matrix that converts components to axes rotated by `angle` (rad) about z.
pub(super) fn r3(angle: f64) -> Matrix3<f64> {
    let (s, c) = angle.sin_cos();
    Matrix3::new(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0)
}
