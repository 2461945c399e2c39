//! Interface of the effects of the environment.

use super::body_index::BodyIndex;
use super::error::EnvironmentError;
use super::scene::Scene;
use super::wrenches::Wrenches;

/// Effect of the environment: forces and torques on the bodies of robots.
///
/// ```
/// use onorbit_core::environment::{Effect, EnvironmentError, Scene, Wrench, Wrenches};
/// use nalgebra::Vector3;
///
/// /// Linear damping relative to `W`: `F = -c v` on every body.
/// #[derive(Debug)]
/// struct Damping(f64);
///
/// impl Effect for Damping {
///     fn name(&self) -> &str {
///         "damping"
///     }
///     fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
///         for (index, body) in scene.bodies.iter() {
///             let force = body.velocity * -self.0;
///             wrenches.add(index, Wrench { force, torque: Vector3::zeros() })?;
///         }
///         Ok(())
///     }
/// }
/// ```
pub trait Effect: Send + Sync + std::fmt::Debug {
    /// Returns the short name of the effect, which messages and recorded columns use.
    fn name(&self) -> &str;

    /// Returns the simulation times, s, at which the effect is discontinuous. The integrator ends a step
    /// at each of them.
    fn event_times(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Returns true if the effect requires a reference orbit around a planet.
    fn requires_orbit(&self) -> bool {
        false
    }

    /// Returns true if the effect depends on velocities. If no effect does, all velocities in the scene are
    /// zero.
    fn reads_velocities(&self) -> bool {
        true
    }

    /// Returns true if the motion of the reference orbit already includes this effect.
    ///
    /// If so, [`GravityMode::Carried`](super::GravityMode::Carried) removes the common acceleration caused by
    /// the effect.
    fn acts_on_reference(&self) -> bool {
        false
    }

    /// Returns true if the effect may act on bodies of the system with this number in the world. In a run
    /// without any such system, the effect is not evaluated and its event times are ignored.
    fn acts_on(&self, _system: usize) -> bool {
        true
    }

    /// Returns true if a second effect with the same name on `body` would count the force twice. A run with
    /// two such effects on one body is an error.
    fn counts_once_on(&self, _body: BodyIndex) -> bool {
        false
    }

    /// Adds the wrench of this effect on each body to `wrenches`. Implementations must not allocate memory.
    ///
    /// # Errors
    /// [`EnvironmentError`] if the effect is not defined in this scene.
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError>;
}
