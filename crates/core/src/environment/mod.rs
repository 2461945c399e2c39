//! Forces and torques of the space environment on every body.
//!
//! | equation | file, function |
//! |-|-|
//! | `F = m [g(r) - r̈_ref]`; only the tide in [`GravityMode::Carried`] | `differential_gravity.rs`, `add` |
//! | `T = (3μ/r³) r̂ × I r̂` for a point mass, `T_i = -ε_ijk (I G)_jk` for any field | `gravity_gradient.rs`, `add`, `torque` |
//! | `F = -½ ρ C_D A (n·u)₊ u` on a face | `surfaces/face.rs` `add_drag`, `sums.rs` `wrench`, `surface_block.rs` `drag` |
//! | `F = -P A cos θ [(1 - ρs) ŝ + 2 (ρs cos θ + ρd/3) n]` on a face | `surfaces/face.rs` `add_pressure`, `sums.rs` `wrench` |
//!
//! The symbols are defined at [`DifferentialGravity`], [`GravityGradient`], [`Drag`] and
//! [`RadiationPressure`].
//!
//! [`Effect`] is the trait that each effect implements. To add an effect, add a file and a line in this
//! module. `W` has inertial axes, and its origin is on the reference orbit.

pub mod atmosphere;
mod bodies;
mod body_block;
mod body_index;
mod body_wrench;
mod differential_gravity;
mod drag;
mod effect;
mod error;
mod gravity_gradient;
mod radiation_pressure;
mod scene;
mod shadow;
mod soa;
mod surface_lanes;
pub mod surfaces;
mod wrenches;

pub use bodies::Bodies;
pub(crate) use body_block::BodyMotion;
pub use body_block::BodyState;
pub use body_index::BodyIndex;
pub use body_wrench::BodyWrench;
pub use differential_gravity::{DifferentialGravity, GravityMode};
pub use drag::Drag;
pub use effect::Effect;
pub use error::{EnvironmentError, ScenePoint, UserError};
pub use gravity_gradient::GravityGradient;
pub use radiation_pressure::{RadiationPressure, SHADOW_RADIUS, SOLAR_FLUX};
pub(crate) use scene::Ephemeris;
pub use scene::{Reference, Scene};
pub use shadow::sunlit;
pub(crate) use soa::on_lanes;
pub use wrenches::{Wrench, Wrenches};
