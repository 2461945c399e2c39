//! State of a reference orbit.

use nalgebra::Vector3;

/// State of the reference orbit at one instant, axes of `I`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitState {
    /// Position from the planet's centre, m.
    pub position: Vector3<f64>,
    /// Velocity, m/s.
    pub velocity: Vector3<f64>,
    /// Acceleration, m/s². It differs from gravity at the position if the orbit is not in free fall.
    pub acceleration: Vector3<f64>,
}
