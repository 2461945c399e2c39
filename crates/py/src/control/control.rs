//! The classes `Control` and `Goal`: control laws with their joints, references, goals and times.

use super::LAWS;
use super::gains::per_joint;
use super::internal_force::PyInternalForce;
use super::native_law::{Group, Robot};
use super::user::PythonController;
use crate::arrays::{list_of, names_in, text, type_name};
use crate::errors::{IntoPython, plain};
use crate::pickling::{ConstructorCall, Reduced, call_of};
use crate::reference;
use onorbit_core::control::{Begin, Control, ControlError, Goal, Law, LoadFrame};
use pyo3::prelude::*;
use pyo3::types::PyDict;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Tolerances with which a control must follow its reference, as in the joint trajectory controller of ROS.
///
/// The goal fails if an error exceeds ``path_tolerance`` before the end of the reference. After the end, the
/// goal is reached as soon as all errors are within ``tolerance``, and fails after ``time``. The outcome is
/// stored in ``trace.results``. After a failure, the control holds the current pose or joint positions;
/// commanded rates become zero, and a :class:`GripForce` continues unchanged.
///
/// Parameters
/// ----------
/// tolerance : float or array
///     Permitted error after the end of the reference: a number for all components; for a tool, an array with
///     the distance (m) and the angle (rad); or for the ``k`` joints of the control, an array (k,), rad or m
///     (rad/s or m/s if the reference commands rates). For a :class:`GripForce`, the permitted error of the
///     force, N.
/// path_tolerance : float or array, optional
///     Permitted error during the motion, in the same form as ``tolerance``; default: unlimited.
/// time : float, optional
///     Time allowed after the end of the reference, s; default: unlimited.
///
/// Raises
/// ------
/// ShapeError
///     If a tolerance is neither a number nor a vector.
#[pyclass(name = "Goal", frozen, module = "onorbit_rs")]
pub(crate) struct PyGoal {
    goal: Goal,
    constructor_call: ConstructorCall,
}

#[pymethods]
impl PyGoal {
    #[new]
    #[pyo3(signature = (*, tolerance, path_tolerance=None, time=None))]
    fn new(
        py: Python<'_>,
        tolerance: Any<'_, '_>,
        path_tolerance: Option<Any<'_, '_>>,
        time: Option<f64>,
    ) -> PyResult<Self> {
        let constructor_call = call_of!(py, "Goal", tolerance, path_tolerance, time)?;
        let (tolerance, _) = per_joint(Some(tolerance), "tolerance", 0.0)?;
        let path = path_tolerance.map(|path| per_joint(Some(path), "path_tolerance", 0.0)).transpose()?;
        Ok(Self { goal: Goal { path: path.map(|path| path.0), tolerance, time }, constructor_call })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        self.constructor_call.reduce(py)
    }
}

/// Controller of some or all joints of a robot, with its reference and the interval in which it is active.
///
/// Joints that belong to no control have no motor torque, unless :meth:`Stepper.command` sets one.
///
/// Parameters
/// ----------
/// controller : control law or object
///     Control law, or an object whose method ``update(t, state)`` returns the torques of the ``k`` joints,
///     (k,), N m or N.
/// reference : Reference or JointReference, optional
///     Reference that the controller tracks. It starts when the control starts.
/// joints : list of str, optional
///     Names of the joints; default: all.
/// tool : str, optional
///     Frame that tracks the reference of a Python controller; default: the ``tool`` of the simulation.
/// name : str, optional
///     Name of the control in the trace and the results; default: ``control_`` followed by its index in the
///     list.
/// start : float
///     Simulation time at which the control starts, s; ignored if ``after`` is given.
/// end : float, optional
///     Simulation time at which the control ends, s; default: the end of the run.
/// after : str, optional
///     Name of another control or of an event of the world. The control starts when the goal of the other
///     control is decided or the other control ends, or when the event happens. A control that an event
///     starts replaces the controls that are active on its joints.
/// goal : Goal, optional
///     Tolerances of the goal; default: none, so the goal is never decided.
/// starts_at_present : bool
///     If True, the reference is shifted so that it begins at the current pose or joint positions.
/// load : str, optional
///     Frame of a captured system, ``SYSTEM/FRAME``, to which the reference applies instead of the tool. The
///     tool must hold the body of this frame while the control is active, and the ``knows`` of the robot's
///     :class:`System` must contain the captured system.
/// internal_forces : list of InternalForce
///     Forces that closed loops transmit while the control is active. They require a law that commands
///     accelerations, such as :class:`ComputedTorque` or :class:`JointComputedTorque`. Default: none.
///
/// Raises
/// ------
/// DtypeError
///     If ``joints`` is not a list of names, ``after`` or ``load`` is not a name, or ``internal_forces`` is
///     not a list of :class:`InternalForce`.
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
    load: Option<String>,
    internal_forces: Vec<PyInternalForce>,
}

#[pymethods]
impl PyControl {
    #[new]
    #[pyo3(signature = (
        controller, *, reference=None, joints=None, tool=None, name=None, start=0.0, end=None, after=None, goal=None,
        starts_at_present=false, load=None, internal_forces=None,
    ))]
    fn new(
        controller: Py<PyAny>,
        reference: Option<Py<PyAny>>,
        joints: Option<Any<'_, '_>>,
        tool: Option<String>,
        name: Option<String>,
        start: f64,
        end: Option<f64>,
        after: Option<Any<'_, '_>>,
        goal: Option<Py<PyGoal>>,
        starts_at_present: bool,
        load: Option<Any<'_, '_>>,
        internal_forces: Option<Any<'_, '_>>,
    ) -> PyResult<Self> {
        let expected = "internal forces, such as [oo.InternalForce('grasp', force=[20, 0, 0])]";
        let forces =
            internal_forces.map(|forces| list_of::<PyInternalForce>(forces, "internal_forces", expected));
        let forces = forces.transpose()?.unwrap_or_default();
        let internal_forces = forces.into_iter().map(|force| force.get().clone()).collect();
        let joints =
            joints.map(|joints| names_in(joints, "joints", "names of joints", "elbow")).transpose()?;
        let after = after
            .map(|after| text(after, "after", "the name of a control or of an event (str)"))
            .transpose()?;
        let end = end.unwrap_or(f64::INFINITY);
        Ok(Self {
            controller,
            reference,
            joints,
            tool,
            name,
            start,
            end,
            after,
            goal,
            starts_at_present,
            load: load
                .map(|load| text(load, "load", "a frame of another system, SYSTEM/FRAME (str)"))
                .transpose()?,
            internal_forces,
        })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let keywords = PyDict::new(py);
        keywords.set_item("reference", &self.reference)?;
        keywords.set_item("joints", &self.joints)?;
        keywords.set_item("tool", &self.tool)?;
        keywords.set_item("name", &self.name)?;
        keywords.set_item("start", self.start)?;
        keywords.set_item("end", self.end)?;
        keywords.set_item("after", &self.after)?;
        keywords.set_item("goal", &self.goal)?;
        keywords.set_item("starts_at_present", self.starts_at_present)?;
        keywords.set_item("load", &self.load)?;
        keywords.set_item("internal_forces", self.internal_forces.clone())?;
        ConstructorCall::new("Control", (&self.controller,), &keywords)?.reduce(py)
    }
}

/// Returns the controls of a run. `controller` is a single controller, which uses the reference of the run,
/// or a list of `Control`.
pub(crate) fn controls_of(
    controller: Any<'_, '_>,
    reference: Option<Any<'_, '_>>,
    robot: &Robot<'_>,
) -> PyResult<Vec<Control>> {
    let py = controller.py();
    let joints: Vec<usize> = (0..robot.model.joint_count()).collect();
    if let Some(law) = law_of(controller, reference, &joints, robot.tool, robot)? {
        let has_column = !matches!(law, Law::TaskComputedTorque(..) | Law::User(..));
        return Ok(vec![Control { has_column, ..Control::on_all_joints(robot.model, law) }]);
    }
    let Ok(items) = controller.try_iter() else { return Err(no_controller(controller)) };
    if reference.is_some() {
        let message = "a reference is given with a list of controls, which have no common reference; \
                       give each Control its own 'reference'";
        return Err(plain(py, "ControlError", message));
    }
    let items =
        items.enumerate().map(|(index, item)| one_control(index, item?)).collect::<PyResult<Vec<_>>>()?;
    let names: Vec<String> = items
        .iter()
        .enumerate()
        .map(|(i, c)| c.get().name.clone().unwrap_or(format!("control_{i}")))
        .collect();
    items.iter().zip(&names).map(|(item, name)| item.get().bind(py, name, &names, robot)).collect()
}

/// Returns the entry with index `index` of a list of controls. An entry that is not a `Control` is an error.
fn one_control(index: usize, item: Bound<'_, PyAny>) -> PyResult<Bound<'_, PyControl>> {
    item.cast_into::<PyControl>().map_err(|error| {
        let item = error.into_inner();
        let message = format!(
            "entry {index} of the list of controls is of type {}; each entry must be a Control, such as \
             oo.Control(oo.JointPid(), reference=…)",
            type_name(&item)
        );
        plain(item.py(), "ControlError", &message)
    })
}

impl PyControl {
    /// Returns the control of the core with the names of joints, frames, events and other controls resolved.
    /// `names` are the names of all controls of the robot.
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
        let controller = self.controller.bind(py);
        let law =
            law_of(controller, reference, &joints, tool, robot)?.ok_or_else(|| no_controller(controller))?;
        let begin = match &self.after {
            None => Begin::At(self.start),
            Some(after) => {
                let control = names.iter().position(|other| other == after).map(Begin::After);
                let event =
                    || robot.around.events.iter().position(|event| event == after).map(Begin::AfterEvent);
                control.or_else(event).ok_or_else(|| {
                    let (control, after) = (name.to_owned(), after.clone());
                    ControlError::NoSuchControl { control, after }.into_python(py)
                })?
            }
        };
        let goal = self.goal.as_ref().map(|goal| goal.get().goal.clone());
        let (end, starts_at_present) = (self.end, self.starts_at_present);
        let internal_forces = self.internal_forces.iter().map(|force| force.force.clone()).collect();
        let load = self.load.as_ref().map(|path| {
            let moving = reference::moving_frame(py, "the load is", path, robot.around.systems)?;
            Ok::<_, PyErr>(LoadFrame { system: moving.system, frame: moving.frame })
        });
        let load = load.transpose()?;
        let control = Control::new(name, joints, law);
        Ok(Control { begin, end, goal, starts_at_present, load, internal_forces, ..control })
    }
}

/// Returns the control law for a Python object and its reference; `None` if the object is not a controller.
fn law_of(
    controller: Any<'_, '_>,
    reference: Option<Any<'_, '_>>,
    joints: &[usize],
    tool: Option<usize>,
    robot: &Robot<'_>,
) -> PyResult<Option<Law>> {
    let group = Group { reference, joints, robot };
    if let Some(law) = LAWS.iter().find_map(|law_of| law_of(controller, &group)) {
        return law.map(Some);
    }
    if !controller.hasattr("update")? {
        return Ok(None);
    }
    let tracked = match (reference, tool) {
        (None, _) => None,
        (Some(reference), Some(tool)) => Some((tool, reference::extract(reference, &robot.around)?)),
        (Some(_), None) => {
            let message = "a Python controller has a reference, but no frame that tracks it; give tool, the \
                           name of a frame";
            return Err(plain(controller.py(), "ControlError", message));
        }
    };
    Ok(Some(Law::User(Box::new(PythonController { object: controller.clone().unbind() }), tracked)))
}

/// Returns the error for an object that is not a controller.
fn no_controller(controller: Any<'_, '_>) -> PyErr {
    let got = type_name(controller);
    let message = format!(
        "controller is of type {got}, which has no method update(t, state); give a controller such as \
         ComputedTorque, an object derived from Controller, or a list of Control objects"
    );
    plain(controller.py(), "ControlError", &message)
}
