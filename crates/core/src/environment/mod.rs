//! Forces and torques of the surroundings on every body.
//!
//! [`Effect`] is the one trait; a new kind of effect is one file and one line here.
//! `W` has inertial axes and its origin on the reference orbit.

pub mod atmosphere;
mod bodies;
mod body_wrench;
mod differential_gravity;
mod drag;
mod eight;
mod eight_bodies;
mod error;
mod gravity_gradient;
mod radiation_pressure;
mod scene;
mod shadow;
pub mod surfaces;
mod wrenches;

pub use bodies::{Bodies, BodyState};
pub use body_wrench::BodyWrench;
pub use differential_gravity::{DifferentialGravity, ReferenceMotion};
pub use drag::Drag;
pub(crate) use eight::on_lanes;
pub(crate) use eight_bodies::BodyMotion;
pub use error::{EnvironmentError, Place};
pub use gravity_gradient::GravityGradient;
pub use radiation_pressure::{RadiationPressure, SHADOW_RADIUS, SOLAR_FLUX};
pub(crate) use scene::Heavens;
pub use scene::{Reference, Scene};
pub use shadow::sunlit;
pub use wrenches::{Wrench, Wrenches};

/// Something that pulls, pushes or turns the bodies of a robot.
///
/// ```
/// use onorbit_core::environment::{Effect, EnvironmentError, Scene, Wrench, Wrenches};
/// use nalgebra::Vector3;
///
/// /// Linear damping towards rest in `W`: every body feels `-c v`.
/// #[derive(Debug)]
/// struct Honey(f64);
///
/// impl Effect for Honey {
///     fn name(&self) -> &str {
///         "honey"
///     }
///     fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
///         for (k, body) in scene.bodies.iter().enumerate() {
///             let force = body.velocity * -self.0;
///             wrenches.add(k, Wrench { force, torque: Vector3::zeros() })?;
///         }
///         Ok(())
///     }
/// }
/// ```
pub trait Effect: Send + Sync + std::fmt::Debug {
    /// Short name, for messages and recorded columns.
    fn name(&self) -> &str;

    /// Instants at which the effect jumps, s of simulation; the integrator stops at each.
    fn event_times(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Whether the effect needs a reference orbit around a planet.
    fn requires_orbit(&self) -> bool {
        false
    }

    /// Whether the effect reads how the bodies move; where none does, the scene leaves that out.
    fn reads_velocities(&self) -> bool {
        true
    }

    /// Whether a reference that carries the robot along has it in its own motion: the share that moves all bodies alike
    /// is then left out.
    fn acts_on_reference(&self) -> bool {
        false
    }

    /// Whether it is all there is of its kind on a body (index): a run refuses another effect of the same name there, which
    /// would count twice.
    fn counts_once_on(&self, _body: usize) -> bool {
        false
    }

    /// Add this effect's wrench on each body to what `wrenches` holds; allocates nothing.
    ///
    /// # Errors
    /// [`EnvironmentError`] where the effect is not defined in this scene.
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError>;
}
