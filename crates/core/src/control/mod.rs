//! State in, joint torques out.
//!
//! Built-in laws are plain data, generic over the scalar; [`Controller`] is for the user's own. One law
//! drives all joints, or several [`Control`]s drive groups of them, side by side and one after the other.

mod check;
mod compliance;
mod computed_torque;
mod controller;
mod error;
mod gains;
mod goal;
mod group;
mod joint_space;
mod progress;
mod pseudo_inverse;
mod side_by_side;
mod stack;

pub use check::check_controls;
pub use compliance::Compliance;
pub use computed_torque::{ComputedTorque, ComputedTorqueWork, computed_torque, task_error};
pub use controller::{ControlLaw, Controller, Observation};
pub use error::ControlError;
pub use gains::PerJoint;
pub use goal::{Goal, Miss, Outcome};
pub use group::{Begin, Control, Law};
pub use joint_space::{Interface, JointComputedTorque, JointPid};
pub use stack::Stack;
