//! Integrators: from the state at the start of a step to the state at its end.
//!
//! 1. The step is taken in a frame that moves with the base's origin as it does at the step's start, so that
//!    everything integrated is robot-sized ([`stages`]).
//! 2. The attitude is the exponential of a rotation vector `θ` since the start, `θ̇ = dexp⁻¹(θ) ω` (Munthe-Kaas);
//!    joints and velocities add.
//! 3. The base's origin follows its acceleration, with Nyström's weights where the method is RK4 ([`rk4`]).
//! 4. Momentum, work and loss are integrated beside the state, from the external wrenches alone.
//! 5. After the step the base twist is projected onto that momentum
//!    ([`System::project_momentum`](super::system::System::project_momentum)).

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
