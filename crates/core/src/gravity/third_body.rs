//! Interface of third bodies.

use super::error::GravityError;
use nalgebra::Vector3;

/// Distant body whose gravity acts on the planet and on robots, such as the Sun or the Moon.
pub trait ThirdBody: Send + Sync + std::fmt::Debug {
    /// Returns the name that messages use for the body.
    fn name(&self) -> &str;

    /// Returns the gravitational parameter, m³/s².
    fn mu(&self) -> f64;

    /// Returns the position, m, from the planet's centre at simulation time `t`, s, axes of `I`.
    ///
    /// Implementations must be pure functions of `t`, must take less than 100 ns and must not allocate
    /// memory.
    ///
    /// # Errors
    /// [`GravityError`] if the position is not known at `t`.
    fn position(&self, t: f64) -> Result<Vector3<f64>, GravityError>;
}
