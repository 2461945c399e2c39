//! Equations of motion: free functions over a [`Model`](crate::model::Model), its [`Data`] and a
//! state.
//!
//! All recursions run in the axes of the base link B, so the base's pose drops out of everything but what is asked for
//! in W. The motions, forces and inertias of a body are about its own origin, which lies on its joint's axis; between
//! neighbours they are shifted by the vector from one origin to the other.
//! A `*_recursion` expects [`kinematics`] to have run; the functions without that ending run it.

mod aba;
mod crba;
mod data;
mod dense;
pub mod derivatives;
mod external;
mod free_floating;
mod jacobian;
mod kinematics;
mod momentum;
mod rnea;
mod subspace;
mod walk;

pub(crate) use aba::locked_dynamics_recursion;
pub use aba::{forward_dynamics, forward_dynamics_recursion};
pub use crba::mass_matrix;
pub use data::{BodyData, Data};
pub use external::{FrameWrench, apply_external};
pub use free_floating::{
    FreeFloating, base_relative_frame, free_floating, free_floating_frame, free_floating_recursion,
};
pub use jacobian::{frame_acceleration, frame_drift, frame_jacobian};
pub(crate) use kinematics::base_rotation;
pub use kinematics::{FramePose, frame_pose, frame_velocity, kinematics, positions};
pub use momentum::{Momentum, base_twist, center_of_mass, composite_momentum, kinetic_energy, momentum};
pub(crate) use momentum::{center_of_mass_b, motion_of_whole};
pub use rnea::{bias_forces, inverse_dynamics, inverse_dynamics_recursion};
