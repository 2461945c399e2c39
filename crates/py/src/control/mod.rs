//! Controllers: control laws of the core, Python controllers, and controls of groups of joints.
//!
//! `docs/howto/controller.md`, "Add a law to the engine", lists all places that a new law requires.

mod compliance;
mod computed_torque;
#[allow(clippy::module_inception)] // the file of `Control`
mod control;
mod external;
mod gains;
mod grip_force;
mod internal_force;
mod joint_computed_torque;
mod joint_pid;
mod native_law;
mod user;

use pyo3::prelude::*;

use compliance::PyCompliance;
pub(crate) use computed_torque::PyComputedTorque;
pub(crate) use control::controls_of;
use external::PyExternal;
use grip_force::PyGripForce;
use joint_computed_torque::PyJointComputedTorque;
use joint_pid::PyJointPid;
pub(crate) use native_law::Robot;
use native_law::{LawOf, law_of};

/// Functions that read the control laws of the core, one per Python class.
const LAWS: [LawOf; 6] = [
    law_of::<PyComputedTorque>,
    law_of::<PyJointComputedTorque>,
    law_of::<PyJointPid>,
    law_of::<PyCompliance>,
    law_of::<PyGripForce>,
    law_of::<PyExternal>,
];

pub(crate) fn add_classes(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<PyComputedTorque>()?;
    m.add_class::<PyJointComputedTorque>()?;
    m.add_class::<PyJointPid>()?;
    m.add_class::<PyCompliance>()?;
    m.add_class::<PyGripForce>()?;
    m.add_class::<PyExternal>()?;
    m.add_class::<control::PyControl>()?;
    m.add_class::<control::PyGoal>()?;
    m.add_class::<internal_force::PyInternalForce>()?;
    m.add_class::<user::PyState>()
}
