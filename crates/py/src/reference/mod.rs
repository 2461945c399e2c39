//! References for a tool and for joints.

mod frame;
mod joint;
mod task;
mod timing;

use crate::arrays::{Input, fixed, fresh, type_name, wrong_shape, zeros};
use crate::errors::{IntoPython, fields, raise};
use crate::orbit::{PyOrbit, times};
use numpy::PyArrayDyn;
use onorbit_core::orbit::Orbit;
use onorbit_core::reference::{
    Hold, JointPath, JointReference, TaskPath, TaskReference, joint_table, task_table,
};
use pyo3::prelude::*;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;
type Arrays<'py> = (Bound<'py, PyArrayDyn<f64>>, Bound<'py, PyArrayDyn<f64>>, Bound<'py, PyArrayDyn<f64>>);

pub(crate) fn add_classes(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<PyReference>()?;
    m.add_class::<PyJointReference>()?;
    m.add_class::<frame::PyTarget>()?;
    task::add_classes(m)?;
    joint::add_classes(m)
}

/// What a frame of the robot follows: a pose with its velocity and acceleration over time, in the axes of ``frame``:
/// ``"world"``, ``"lvlh"`` (of the simulation's orbit), ``"base"`` (relative to the robot's base) or a :class:`Target`.
#[pyclass(name = "Reference", subclass, frozen, module = "onorbit_rs")]
pub(crate) struct PyReference {
    path: Arc<dyn TaskPath>,
    frame: frame::Frame,
}

#[pymethods]
impl PyReference {
    /// When it comes to rest in its frame, s since it began; 0 for one that never moves.
    #[getter]
    fn duration(&self) -> f64 {
        self.path.duration()
    }

    /// Pose (4, 4), velocity (6,) and acceleration (6,) at ``t`` s in the axes of its own frame, linear first; for (T,)
    /// times (T, 4, 4), (T, 6), (T, 6).
    fn sample<'py>(&self, py: Python<'py>, t: Any<'_, 'py>) -> PyResult<Arrays<'py>> {
        let reference = TaskReference { path: Arc::clone(&self.path), frame: Default::default() };
        table(py, &reference, true, t)
    }

    /// As :meth:`sample` in W axes; ``orbit`` is needed in the frame of one. Not for one relative to the base.
    #[pyo3(signature = (t, *, orbit=None))]
    fn in_world<'py>(
        &self,
        py: Python<'py>,
        t: Any<'_, 'py>,
        orbit: Option<&Bound<'py, PyOrbit>>,
    ) -> PyResult<Arrays<'py>> {
        let reference = self.bind(py, orbit.map(|orbit| &orbit.get().orbit))?;
        if reference.is_relative_to_base() {
            let message = "the reference is relative to the robot's base, W knows it only with a robot";
            return Err(raise(py, "ControlError", message, &fields!(py, "name": "frame", "got": "base")));
        }
        table(py, &reference, false, t)
    }
}

impl PyReference {
    fn bind(&self, py: Python<'_>, orbit: Option<&Arc<dyn Orbit>>) -> PyResult<TaskReference> {
        Ok(TaskReference { path: Arc::clone(&self.path), frame: self.frame.bind(py, orbit)? })
    }
}

/// What joints follow: positions, rates and accelerations over time.
#[pyclass(name = "JointReference", subclass, frozen, module = "onorbit_rs")]
pub(crate) struct PyJointReference {
    path: Arc<dyn JointPath>,
}

#[pymethods]
impl PyJointReference {
    /// When it comes to rest, s since it began; 0 for one that never moves.
    #[getter]
    fn duration(&self) -> f64 {
        self.path.duration()
    }

    /// Positions, rates and accelerations (n,) at ``t`` s; for (T,) times (T, n) each.
    fn sample<'py>(&self, py: Python<'py>, t: Any<'_, 'py>) -> PyResult<Arrays<'py>> {
        let (times, shape) = times(t)?;
        let dims: Vec<usize> = shape.into_iter().chain([self.path.count()]).collect();
        let (q, v, a) = (zeros(py, &dims)?, zeros(py, &dims)?, zeros(py, &dims)?);
        joint_table(&*self.path, &times, [fresh(&q), fresh(&v), fresh(&a)])
            .map_err(|error| error.into_python(py))?;
        Ok((q, v, a))
    }
}

fn table<'py>(
    py: Python<'py>,
    reference: &TaskReference,
    in_own_frame: bool,
    t: Any<'_, 'py>,
) -> PyResult<Arrays<'py>> {
    let (times, shape) = times(t)?;
    let with = |tail: &[usize]| shape.iter().chain(tail).copied().collect::<Vec<usize>>();
    let (poses, v, a) = (zeros(py, &with(&[4, 4]))?, zeros(py, &with(&[6]))?, zeros(py, &with(&[6]))?);
    let out = [fresh(&poses), fresh(&v), fresh(&a)];
    task_table(reference, in_own_frame, &times, out).map_err(|error| error.into_python(py))?;
    Ok((poses, v, a))
}

/// The reference of a frame inside a Python object; one in the frame of the orbit flies on `orbit`.
pub(crate) fn extract(value: Any<'_, '_>, orbit: Option<&Arc<dyn Orbit>>) -> PyResult<TaskReference> {
    match value.cast::<PyReference>() {
        Ok(reference) => reference.get().bind(value.py(), orbit),
        Err(_) => Err(no_reference(value, "Reference, such as Hold or LineParabola")),
    }
}

/// The reference of joints inside a Python object.
pub(crate) fn extract_joints(value: Any<'_, '_>) -> PyResult<JointReference> {
    match value.cast::<PyJointReference>() {
        Ok(reference) => Ok(Arc::clone(&reference.get().path)),
        Err(_) => Err(no_reference(value, "JointReference, such as JointHold or JointWaypoints")),
    }
}

/// Whether a Python object is the reference of joints.
pub(crate) fn is_of_joints(value: Any<'_, '_>) -> bool {
    value.is_instance_of::<PyJointReference>()
}

fn no_reference(value: Any<'_, '_>, expected: &str) -> PyErr {
    let py = value.py();
    let got = type_name(value);
    let message = format!("reference is of type {got}, a {expected} is needed");
    raise(py, "DtypeError", &message, &fields!(py, "name": "reference", "expected": expected, "got": got))
}

/// A (4, 4) pose.
fn pose(value: Any<'_, '_>) -> PyResult<Hold> {
    let rows = fixed::<16>(value, "pose", &[4, 4])?;
    let mut poses = Hold::from_rows(&[rows]).map_err(|error| error.into_python(value.py()))?;
    Ok(poses.remove(0))
}

/// Poses (K, 4, 4).
fn poses(value: Any<'_, '_>) -> PyResult<Vec<Hold>> {
    let input = Input::new(value, "poses")?;
    let [_, 4, 4] = input.shape() else {
        return Err(wrong_shape(value.py(), "poses", "(K, 4, 4)", input.shape()));
    };
    Hold::from_rows(input.data().as_chunks().0).map_err(|error| error.into_python(value.py()))
}

/// Numbers (K,).
fn row(value: Any<'_, '_>, name: &str) -> PyResult<Vec<f64>> {
    let input = Input::new(value, name)?;
    match input.shape() {
        [_] => Ok(input.data().to_vec()),
        other => Err(wrong_shape(value.py(), name, "(K,)", other)),
    }
}
