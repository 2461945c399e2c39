//! Interface of third bodies.

use super::error::GravityError;
use nalgebra::Vector3;

/// Distant body whose gravity acts on planet and robot, such as the Sun or the Moon.
pub trait ThirdBody: Send + Sync + std::fmt::Debug {
    /// Returns the name for messages.
    fn name(&self) -> &str;

    /// Returns the gravitational parameter, m³/s².
    fn mu(&self) -> f64;

    /// Returns the position at `t` s of simulation from the planet's centre, axes of `I`, m.
    ///
    /// Implementations must be pure functions of `t`, take less than 100 ns and not allocate.
    ///
    /// # Errors
    /// [`GravityError`] where the position is not known.
    fn position(&self, t: f64) -> Result<Vector3<f64>, GravityError>;
}
