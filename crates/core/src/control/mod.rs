//! State in, joint torques out.
//!
//! Built-in laws are plain data, generic over the scalar; [`Controller`] is for the user's own.

mod computed_torque;
mod controller;
mod error;
mod pseudo_inverse;

pub use computed_torque::{ComputedTorque, ComputedTorqueWork, computed_torque, task_error};
pub use controller::{ControlLaw, Controller, Observation};
pub use error::ControlError;
pub use pseudo_inverse::PseudoInverse;
