//! Modes of the joints (sticking, slipping or resting at a stop), and the instants within a step at which a
//! mode changes.

mod engaged_brakes;
mod impacts;
mod joint_friction;
mod joint_modes;
mod margins;
mod step_method;

pub(super) use joint_modes::{AT_LIMIT, JointModes, SavedModes};
pub(crate) use step_method::StepMethod;
