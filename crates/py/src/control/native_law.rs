//! Interface between the Python class of a control law and the controls of a run.

use crate::errors::plain;
use crate::reference::{self, Around};
use onorbit_core::control::Law;
use onorbit_core::model::Model;
use onorbit_core::reference::{JointReference, TaskReference};
use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::pyclass::boolean_struct::True;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Robot to which controls belong, with the index of its tool's frame and the objects to which controls may
/// refer.
pub(crate) struct Robot<'a> {
    pub(crate) model: &'a Arc<Model>,
    pub(crate) tool: Option<usize>,
    pub(crate) around: Around<'a>,
}

/// Reference, joints (by index) and robot of a control, from which its law is created.
pub(super) struct Group<'a, 'py> {
    pub(super) reference: Option<Any<'a, 'py>>,
    pub(super) joints: &'a [usize],
    pub(super) robot: &'a Robot<'a>,
}

impl Group<'_, '_> {
    /// Returns the reference as a reference of a tool.
    pub(super) fn task(&self, py: Python<'_>) -> PyResult<TaskReference> {
        reference::extract(self.required(py)?, &self.robot.around)
    }

    /// Returns the reference as a reference of joints.
    pub(super) fn joint_path(&self, py: Python<'_>) -> PyResult<JointReference> {
        reference::extract_joints(self.required(py)?)
    }

    fn required(&self, py: Python<'_>) -> PyResult<Any<'_, '_>> {
        let message = "a controller is given without the reference that it tracks; give reference, such as a \
                       Hold or a JointHold";
        self.reference.ok_or_else(|| plain(py, "ControlError", message))
    }
}

/// Python class of a control law that the core implements.
pub(super) trait NativeLaw: PyClass<Frozen = True> + Sync {
    /// Creates the law for the joints and the reference of a control.
    fn law(&self, py: Python<'_>, group: &Group<'_, '_>) -> PyResult<Law>;
}

/// Function that creates the law of a control if the controller is an instance of a certain class, and
/// otherwise returns `None`.
pub(super) type LawOf = fn(Any<'_, '_>, &Group<'_, '_>) -> Option<PyResult<Law>>;

/// Implements [`LawOf`] for the class `L`.
pub(super) fn law_of<L: NativeLaw>(controller: Any<'_, '_>, group: &Group<'_, '_>) -> Option<PyResult<Law>> {
    Some(controller.cast::<L>().ok()?.get().law(controller.py(), group))
}

/// Returns an error if `model` is not the robot `own` for which a law was constructed.
pub(super) fn same_robot(py: Python<'_>, own: &Arc<Model>, model: &Arc<Model>) -> PyResult<()> {
    if Arc::ptr_eq(own, model) || own.is_like(model) {
        return Ok(());
    }
    let (own, other) = (own.name(), model.name());
    let message = if own == other {
        format!(
            "the controller was constructed from another model of robot '{own}', with other frames or joints; \
             construct the controller from the model of the run"
        )
    } else {
        format!(
            "the controller belongs to robot '{own}', but the robot of the run is '{other}'; construct the \
             controller from the model of the run"
        )
    };
    Err(plain(py, "ControlError", &message))
}
