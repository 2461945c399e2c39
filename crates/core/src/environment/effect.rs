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
    /// Returns the short name for messages and recorded columns.
    fn name(&self) -> &str;

    /// Returns the instants at which the effect is discontinuous, s of simulation; the integrator ends a step at each.
    fn event_times(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Returns true if the effect requires a reference orbit around a planet.
    fn requires_orbit(&self) -> bool {
        false
    }

    /// Returns true if the effect depends on velocities; if no effect does, the scene does not compute them.
    fn reads_velocities(&self) -> bool {
        true
    }

    /// Returns true if the motion of the reference orbit already includes this effect.
    ///
    /// [`GravityMode::Carried`](super::GravityMode::Carried) assumes so, and removes its common acceleration.
    fn acts_on_reference(&self) -> bool {
        false
    }

    /// Returns true if the effect may act on bodies of the system with this number in the world. A run of other systems
    /// does not evaluate it and ignores its instants.
    fn acts_on(&self, _system: usize) -> bool {
        true
    }

    /// Returns true if at most one effect with this name may act on `body`; a second one is rejected.
    fn counts_once_on(&self, _body: BodyIndex) -> bool {
        false
    }

    /// Adds the wrench of this effect on each body to `wrenches`. Must not allocate.
    ///
    /// # Errors
    /// [`EnvironmentError`] where the effect is not defined in this scene.
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError>;
}
