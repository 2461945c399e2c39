//! Controllers: joint torques from the state of the robot.
//!
//! A run has a list of [`Control`]s. Each is a [`Law`] for a group of joints during an interval of time. Laws
//! are plain data; users implement [`Controller`] for their own laws. A [`ControllerSet`] evaluates the list.

mod check;
mod compliance;
mod computed_torque;
#[allow(clippy::module_inception)] // the file of `Control`
mod control;
mod control_law;
mod control_state;
mod controller;
mod controller_set;
mod driven_torques;
mod error;
mod external;
mod external_command;
mod finger_loops;
mod fingers;
mod gains;
mod goal;
mod grip_force;
mod grip_memory;
mod hybrid_dynamics;
mod internal_force;
mod joint_computed_torque;
mod joint_pid;
mod known_tree;
mod law;
mod looped_dynamics;
mod normal_force;
mod observation;
mod pseudo_inverse;

pub use check::check_controls;
pub use compliance::Compliance;
pub use computed_torque::{ComputedTorque, ComputedTorqueWork, computed_torque, task_error};
pub use control::{Begin, Control, LoadFrame};
pub use control_law::Interface;
pub use control_state::ControlMemory;
pub use controller::Controller;
pub use controller_set::ControllerSet;
pub use error::ControlError;
pub use external::{External, OnTimeout};
pub use external_command::{ExternalCommand, JointTrajectory, Setpoint};
pub(crate) use finger_loops::FingerLoops;
pub(crate) use fingers::{Finger, fingers_of};
pub use gains::PerJoint;
pub use goal::{Goal, Miss, Outcome};
pub use grip_force::GripForce;
pub use internal_force::InternalForce;
pub use joint_computed_torque::JointComputedTorque;
pub use joint_pid::JointPid;
pub use known_tree::KnownTree;
pub use law::Law;
pub use normal_force::NormalForce;
pub use observation::Observation;
