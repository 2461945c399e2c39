//! Integrators, which compute the state at the end of a step from the state at its start.
//!
//! Properties of a step:
//!
//! 1. The step is taken in a frame that moves at the velocity that the base's origin has at the start of the
//!    step, so that the integrated velocities are small ([`stages`]).
//! 2. The rotation of the base since the start of the step is the exponential of a rotation vector `θ` with
//!    `θ̇ = dexp⁻¹(θ) ω` (Munthe-Kaas). Joint positions and velocities are integrated component by component.
//! 3. With RK4, the position of the base's origin is integrated from its acceleration with Nyström weights
//!    ([`rk4`]).
//! 4. Momentum, work and dissipated energy are integrated along with the state. The momentum depends on the
//!    external wrenches alone.
//! 5. After the step, the base twist is projected onto that momentum
//!    ([`Tree::project_momentum`](super::tree::Tree::project_momentum)).

mod dormand_prince;
mod integration;
mod rk4;
mod semi_implicit_euler;
mod settings;
mod stages;
mod tableau;
mod tolerance;

pub(crate) use integration::Integration;
pub use settings::Integrator;
pub(crate) use settings::StepSettings;
pub(super) use stages::{FirstStage, Stages, StepEnds};
pub(super) use tolerance::StepControl;
