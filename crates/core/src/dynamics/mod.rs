//! Equations of motion: free functions of a [`Model`](crate::model::Model), its [`Data`] and a state.
//!
//! All recursions run in the axes of the base link B, so the pose of the base affects only results expressed
//! in W. Motions, forces and inertias of a body refer to the origin of the body, which lies on its joint
//! axis; between parent and child they are shifted by the vector from one origin to the other.
//! A function named `*_recursion` requires up-to-date [`kinematics`] in the workspace; the function without
//! this suffix computes the kinematics itself.

mod aba;
mod crba;
mod data;
mod dense;
pub mod derivatives;
mod external;
mod free_floating;
mod jacobian;
mod kinematics;
mod loops;
mod momentum;
mod passes;
mod rnea;
mod subspace;
mod transfer;

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
pub use loops::{
    ClosedLoops, ConstrainedFreeFloating, IndependentJoints, UnsatisfiedConstraints, close_loops,
    close_velocity, closure_errors, constrained_forward_dynamics, constrained_free_floating,
};
pub(crate) use loops::{
    add_leaders, constrained_recursion, length_joints, project_configuration, project_velocity,
    solve_semidefinite,
};
pub use momentum::{
    Momentum, center_of_mass, composite_momentum, kinetic_energy, momentum, projected_base_twist,
};
pub(crate) use momentum::{center_of_mass_b, momentum_energy_com};
pub use rnea::{bias_forces, inverse_dynamics, inverse_dynamics_recursion};
pub use transfer::transfer_state;
