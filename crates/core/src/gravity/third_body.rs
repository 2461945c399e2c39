//! Bodies beyond the planet.

use super::GravityError;
use nalgebra::Vector3;

/// A body that pulls from afar, on planet and robot alike: the Sun, the Moon.
pub trait ThirdBody: Send + Sync + std::fmt::Debug {
    /// Its name, for messages.
    fn name(&self) -> &str;

    /// Its gravitational parameter, m³/s².
    fn mu(&self) -> f64;

    /// Where it is at `t` seconds of simulation, from the planet's centre, axes of `I`: m.
    ///
    /// The same answer at every call, cheap (below 100 ns) and without allocating.
    ///
    /// # Errors
    /// [`GravityError`] where its place is not known.
    fn position(&self, t: f64) -> Result<Vector3<f64>, GravityError>;
}
