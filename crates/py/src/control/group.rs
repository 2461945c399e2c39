//! Which law drives which joints, and when.

use super::compliance::PyCompliance;
use super::computed_torque::{PyComputedTorque, same_robot};
use super::joint::{PyJointComputedTorque, PyJointPid, per_joint};
use super::user::PythonController;
use crate::errors::{IntoPython, plain};
use crate::reference;
use onorbit_core::control::{Begin, Control, ControlError, ControlLaw, Goal, Law, PerJoint};
use onorbit_core::model::Model;
use onorbit_core::orbit::Orbit;
use pyo3::prelude::*;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// What a control is to achieve, after the joint trajectory controller of ROS.
///
/// ``tolerance`` at the end of the reference and ``path_tolerance`` on the way (none where None): for a task (m, rad), for
/// joints a number or (k,); ``time`` s allowed after the end (any where None). What came of it is in ``trace.results``.
#[pyclass(name = "Goal", frozen, module = "onorbit_rs")]
pub(crate) struct PyGoal {
    goal: Goal,
}

#[pymethods]
impl PyGoal {
    #[new]
    #[pyo3(signature = (*, tolerance, path_tolerance=None, time=None))]
    fn new(tolerance: Any<'_, '_>, path_tolerance: Option<Any<'_, '_>>, time: Option<f64>) -> PyResult<Self> {
        let (tolerance, _) = per_joint(Some(tolerance), "tolerance", 0.0)?;
        let path = path_tolerance.map(|path| per_joint(Some(path), "path_tolerance", 0.0)).transpose()?;
        Ok(Self { goal: Goal { path: path.map(|path| path.0), tolerance, time } })
    }
}

/// One of several controllers of a robot: which joints, how, from when to when.
///
/// ``controller`` is a law or an object with ``update(t, state) -> tau (k,)``; ``reference`` what it tracks, on its own clock
/// from its start; ``joints`` names (all where None); ``tool`` the frame of an object's reference (the simulation's where
/// None). It runs from ``start`` to ``end`` s, or from when the control named ``after`` has decided its goal or ended; with
/// ``starts_at_present`` its reference is moved to begin where the robot is then. Joints that no control drives move freely.
#[pyclass(name = "Control", frozen, module = "onorbit_rs")]
pub(crate) struct PyControl {
    controller: Py<PyAny>,
    reference: Option<Py<PyAny>>,
    joints: Option<Vec<String>>,
    tool: Option<String>,
    name: Option<String>,
    start: f64,
    end: f64,
    after: Option<String>,
    goal: Option<Py<PyGoal>>,
    starts_at_present: bool,
}

#[pymethods]
impl PyControl {
    #[new]
    #[pyo3(signature = (
        controller, *, reference=None, joints=None, tool=None, name=None, start=0.0, end=None, after=None, goal=None,
        starts_at_present=false,
    ))]
    fn new(
        controller: Py<PyAny>,
        reference: Option<Py<PyAny>>,
        joints: Option<Vec<String>>,
        tool: Option<String>,
        name: Option<String>,
        start: f64,
        end: Option<f64>,
        after: Option<String>,
        goal: Option<Py<PyGoal>>,
        starts_at_present: bool,
    ) -> Self {
        let end = end.unwrap_or(f64::INFINITY);
        Self { controller, reference, joints, tool, name, start, end, after, goal, starts_at_present }
    }
}

/// What controls are bound to.
pub(crate) struct Robot<'a> {
    pub(crate) model: &'a Arc<Model>,
    pub(crate) orbit: Option<&'a Arc<dyn Orbit>>,
    pub(crate) tool: Option<usize>,
}

/// What drives the joints: one controller with the reference of the run, or a list of controls.
pub(crate) fn control_law(
    controller: Any<'_, '_>,
    reference: Option<Any<'_, '_>>,
    robot: &Robot<'_>,
) -> PyResult<ControlLaw> {
    let py = controller.py();
    if let Ok(law) = controller.cast::<PyComputedTorque>()
        && reference.is_none_or(|reference| !reference::is_of_joints(reference))
    {
        law.get().check_model(py, robot.model)?;
        return Ok(ControlLaw::ComputedTorque(Box::new(law.get().law.clone())));
    }
    if is_native(controller) {
        let joints: Vec<usize> = (0..robot.model.joint_count()).collect();
        let law = law_of(controller, reference, &joints, robot.tool, robot)?;
        return Ok(ControlLaw::Stack(vec![Control::new("control", joints, law)]));
    }
    if controller.hasattr("update")? {
        return Ok(ControlLaw::User(Box::new(PythonController { object: controller.clone().unbind() })));
    }
    let Ok(items) = controller.try_iter() else { return Err(no_controller(controller)) };
    if reference.is_some() {
        let message = "several controls have their own references: give each Control its 'reference'";
        return Err(plain(py, "ControlError", message));
    }
    let items = items.map(|item| one_control(item?)).collect::<PyResult<Vec<_>>>()?;
    let names: Vec<String> = items
        .iter()
        .enumerate()
        .map(|(i, c)| c.get().name.clone().unwrap_or(format!("control_{i}")))
        .collect();
    let controls = items.iter().zip(&names).map(|(item, name)| item.get().bind(py, name, &names, robot));
    Ok(ControlLaw::Stack(controls.collect::<PyResult<_>>()?))
}

fn one_control(item: Bound<'_, PyAny>) -> PyResult<Bound<'_, PyControl>> {
    item.cast_into::<PyControl>().map_err(|error| no_controller(&error.into_inner()))
}

impl PyControl {
    fn bind(&self, py: Python<'_>, name: &str, names: &[String], robot: &Robot<'_>) -> PyResult<Control> {
        let joints = match &self.joints {
            None => (0..robot.model.joint_count()).collect(),
            Some(joints) => joints
                .iter()
                .map(|joint| robot.model.joint(joint).map_err(|error| error.into_python(py)))
                .collect::<PyResult<Vec<_>>>()?,
        };
        let tool = match &self.tool {
            None => robot.tool,
            Some(tool) => Some(robot.model.frame(tool).map_err(|error| error.into_python(py))?),
        };
        let reference = self.reference.as_ref().map(|reference| reference.bind(py));
        let law = law_of(self.controller.bind(py), reference, &joints, tool, robot)?;
        let begin = match &self.after {
            None => Begin::At(self.start),
            Some(after) => Begin::After(names.iter().position(|other| other == after).ok_or_else(|| {
                let (control, after) = (name.to_owned(), after.clone());
                ControlError::NoSuchControl { control, after }.into_python(py)
            })?),
        };
        let goal = self.goal.as_ref().map(|goal| goal.get().goal.clone());
        let (end, starts_at_present) = (self.end, self.starts_at_present);
        Ok(Control { begin, end, goal, starts_at_present, ..Control::new(name, joints, law) })
    }
}

fn is_native(controller: Any<'_, '_>) -> bool {
    controller.is_instance_of::<PyComputedTorque>()
        || controller.is_instance_of::<PyJointComputedTorque>()
        || controller.is_instance_of::<PyJointPid>()
        || controller.is_instance_of::<PyCompliance>()
}

/// The law inside a Python object, with what it tracks.
fn law_of(
    controller: Any<'_, '_>,
    reference: Option<Any<'_, '_>>,
    joints: &[usize],
    tool: Option<usize>,
    robot: &Robot<'_>,
) -> PyResult<Law> {
    let py = controller.py();
    let needed = || {
        let message = "the controller tracks something but has no reference: give it one, such as a Hold or a JointHold";
        plain(py, "ControlError", message)
    };
    let task = || reference::extract(reference.ok_or_else(needed)?, robot.orbit);
    let path = || reference::extract_joints(reference.ok_or_else(needed)?);
    if let Ok(law) = controller.cast::<PyComputedTorque>() {
        law.get().check_model(py, robot.model)?;
        return Ok(Law::TaskComputedTorque(Box::new(law.get().law.clone()), task()?));
    }
    if let Ok(law) = controller.cast::<PyCompliance>() {
        same_robot(py, &law.get().model, robot.model)?;
        return Ok(Law::Compliance(Box::new(law.get().law.clone()), task()?));
    }
    if let Ok(law) = controller.cast::<PyJointComputedTorque>() {
        return Ok(Law::JointComputedTorque(law.get().law.clone(), path()?));
    }
    if let Ok(pid) = controller.cast::<PyJointPid>() {
        let mut law = pid.get().law.clone();
        if pid.get().takes_limits {
            let limit = |j: &usize| robot.model.joints()[*j].limits.effort.unwrap_or(f64::INFINITY);
            law.effort_limit = PerJoint::new(joints.iter().map(limit).collect());
        }
        return Ok(Law::Pid(law, path()?));
    }
    if !controller.hasattr("update")? {
        return Err(no_controller(controller));
    }
    let tracked = match (reference, tool) {
        (None, _) => None,
        (Some(reference), Some(tool)) => Some((tool, reference::extract(reference, robot.orbit)?)),
        (Some(_), None) => {
            let message = "a controller with a reference needs the frame it is for: name the 'tool'";
            return Err(plain(py, "ControlError", message));
        }
    };
    Ok(Law::User(Box::new(PythonController { object: controller.clone().unbind() }), tracked))
}

fn no_controller(controller: Any<'_, '_>) -> PyErr {
    let message = "controller has no method update(t, state); give a law such as ComputedTorque, derive from \
                   Controller, or list several Control";
    plain(controller.py(), "ControlError", message)
}
