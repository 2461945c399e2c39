//! Controllers: the native laws, Python's own, and which joints each drives.

mod compliance;
mod computed_torque;
mod group;
mod joint;
mod user;

use pyo3::prelude::*;

pub(crate) use computed_torque::PyComputedTorque;
pub(crate) use group::{Robot, control_law};

pub(crate) fn add_classes(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<PyComputedTorque>()?;
    m.add_class::<joint::PyJointComputedTorque>()?;
    m.add_class::<joint::PyJointPid>()?;
    m.add_class::<compliance::PyCompliance>()?;
    m.add_class::<group::PyControl>()?;
    m.add_class::<group::PyGoal>()?;
    m.add_class::<user::PyState>()
}
