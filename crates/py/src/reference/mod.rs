//! References that tools and joints track.

mod frame;
mod hold;
mod joint;
mod line;
mod line_parabola;
mod pose_spline;
mod screw;
mod timing;

pub(crate) use frame::{Around, moving_frame};

use crate::arrays::{Input, fixed, fresh, times, type_name, wrong_shape, zeros};
use crate::errors::{IntoPython, fields, raise};
use crate::orbit::PyOrbit;
use crate::pickling::{ConstructorCall, Reduced};
use nalgebra::Vector3;
use numpy::PyArrayDyn;
use onorbit_core::reference::{
    Hold, JointPath, JointReference, ReferenceError, TaskPath, TaskReference, joint_table, task_table,
};
use pyo3::prelude::*;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;
type Arrays<'py> = (Bound<'py, PyArrayDyn<f64>>, Bound<'py, PyArrayDyn<f64>>, Bound<'py, PyArrayDyn<f64>>);

pub(crate) fn add_classes(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<PyReference>()?;
    m.add_class::<PyJointReference>()?;
    m.add_class::<frame::PyTarget>()?;
    m.add_class::<hold::PyHold>()?;
    m.add_class::<line_parabola::PyLineParabola>()?;
    m.add_class::<line::PyLine>()?;
    m.add_class::<screw::PyCircle>()?;
    m.add_class::<screw::PyScrew>()?;
    m.add_class::<pose_spline::PyWaypoints>()?;
    m.add_class::<pose_spline::PySampled>()?;
    joint::add_classes(m)
}

/// Base class of references of a tool. A reference is a pose, with velocity and acceleration, as a function
/// of time.
///
/// The pose is relative to the reference's ``frame``, and moves with this frame: ``"world"``, ``"lvlh"`` (the
/// local frame of the simulation's orbit), ``"base"`` (the robot's base), a :class:`Target`, or a frame
/// ``"SYSTEM/FRAME"`` of another system of the same world.
#[pyclass(name = "Reference", subclass, frozen, module = "onorbit_rs")]
pub(crate) struct PyReference {
    path: Arc<dyn TaskPath>,
    frame: frame::Frame,
    constructor_call: ConstructorCall,
}

#[pymethods]
impl PyReference {
    /// Time from the start of the reference until it is at rest in its frame, s; 0 for a constant pose.
    #[getter]
    fn duration(&self) -> f64 {
        self.path.duration()
    }

    /// Return the pose, velocity and acceleration in the frame of the reference.
    ///
    /// Parameters
    /// ----------
    /// t : float or (T,) array
    ///     Time since the start of the reference, s.
    ///
    /// Returns
    /// -------
    /// pose : (4, 4) or (T, 4, 4) array
    ///     Homogeneous transform from tool axes to the axes of the frame, m.
    /// velocity, acceleration : (6,) or (T, 6) array
    ///     Linear, then angular components: m/s and rad/s, or m/s² and rad/s².
    fn sample<'py>(&self, py: Python<'py>, t: Any<'_, 'py>) -> PyResult<Arrays<'py>> {
        let reference = TaskReference { path: Arc::clone(&self.path), frame: Default::default() };
        table(py, &reference, true, t)
    }

    /// Return the pose, velocity and acceleration in W.
    ///
    /// The reference starts at simulation time zero.
    ///
    /// Parameters
    /// ----------
    /// t : float or (T,) array
    ///     Time since the start of the reference, s.
    /// orbit : Orbit, optional
    ///     Reference orbit; required for a reference in the frame ``"lvlh"``.
    ///
    /// Returns
    /// -------
    /// pose, velocity, acceleration
    ///     Arrays as for :meth:`sample`, but in W and its axes.
    ///
    /// Raises
    /// ------
    /// ControlError
    ///     If the reference is relative to the base or to another system, because its pose in W then depends
    ///     on the run, or if the reference is in the frame ``"lvlh"`` and ``orbit`` is missing.
    #[pyo3(signature = (t, *, orbit=None))]
    fn in_world<'py>(
        &self,
        py: Python<'py>,
        t: Any<'_, 'py>,
        orbit: Option<&Bound<'py, PyOrbit>>,
    ) -> PyResult<Arrays<'py>> {
        let message = "the reference is in a frame of another system, so its pose in W depends on the run; use \
            sample for the pose in that frame";
        if let frame::Frame::System(path) = &self.frame {
            return Err(raise(py, "ControlError", message, &fields!(py, "name": "frame", "got": path)));
        }
        let orbit = orbit.map(|orbit| &orbit.get().orbit);
        let reference = self.bind(py, &Around { orbit, ..Around::default() })?;
        if reference.is_relative_to_base() {
            let message = "the reference is relative to the robot's base, so its pose in W depends on the \
            state of the robot; use sample for the pose relative to the base";
            return Err(raise(py, "ControlError", message, &fields!(py, "name": "frame", "got": "base")));
        }
        table(py, &reference, false, t)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        self.constructor_call.reduce(py)
    }
}

impl PyReference {
    /// Creates the base object of a reference; `constructor_call` is used to pickle it.
    fn new<P: TaskPath + 'static>(
        py: Python<'_>,
        path: Result<P, ReferenceError>,
        frame: Option<Any<'_, '_>>,
        constructor_call: ConstructorCall,
    ) -> PyResult<Self> {
        let path = path.map_err(|error| error.into_python(py))?;
        Ok(Self { path: Arc::new(path), frame: frame::Frame::of(frame)?, constructor_call })
    }

    /// Returns the reference of the core, whose frame may refer to the orbit and the systems in `around`.
    fn bind(&self, py: Python<'_>, around: &Around<'_>) -> PyResult<TaskReference> {
        Ok(TaskReference { path: Arc::clone(&self.path), frame: self.frame.bind(py, around)? })
    }
}

/// Base class of references of joints. A reference consists of joint positions, rates and accelerations as
/// functions of time.
#[pyclass(name = "JointReference", subclass, frozen, module = "onorbit_rs")]
pub(crate) struct PyJointReference {
    path: Arc<dyn JointPath>,
    constructor_call: ConstructorCall,
}

#[pymethods]
impl PyJointReference {
    /// Time from the start of the reference until it is at rest, s; 0 for constant positions.
    #[getter]
    fn duration(&self) -> f64 {
        self.path.duration()
    }

    /// Return positions, rates and accelerations of the joints.
    ///
    /// Parameters
    /// ----------
    /// t : float or (T,) array
    ///     Time since the start of the reference, s.
    ///
    /// Returns
    /// -------
    /// q, rates, accelerations : (n,) or (T, n) array
    ///     Positions, rad or m; rates, rad/s or m/s; accelerations, rad/s² or m/s².
    fn sample<'py>(&self, py: Python<'py>, t: Any<'_, 'py>) -> PyResult<Arrays<'py>> {
        let (times, shape) = times(t)?;
        let dims: Vec<usize> = shape.into_iter().chain([self.path.count()]).collect();
        let (q, v, a) = (zeros(py, &dims)?, zeros(py, &dims)?, zeros(py, &dims)?);
        joint_table(&*self.path, &times, [fresh(&q), fresh(&v), fresh(&a)])
            .map_err(|error| error.into_python(py))?;
        Ok((q, v, a))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        self.constructor_call.reduce(py)
    }
}

/// Samples a reference of a tool at one time or at many times, s, in its own frame or in W.
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

/// Returns the reference of a tool for a Python object of the class `Reference`. Its frame is resolved in
/// `around`; any other object is an error.
pub(crate) fn extract(value: Any<'_, '_>, around: &Around<'_>) -> PyResult<TaskReference> {
    match value.cast::<PyReference>() {
        Ok(reference) => reference.get().bind(value.py(), around),
        Err(_) => Err(no_reference(value, "Reference, such as Hold or LineParabola")),
    }
}

/// Returns the reference of joints for a Python object of the class `JointReference`; any other object is an
/// error.
pub(crate) fn extract_joints(value: Any<'_, '_>) -> PyResult<JointReference> {
    match value.cast::<PyJointReference>() {
        Ok(reference) => Ok(Arc::clone(&reference.get().path)),
        Err(_) => Err(no_reference(value, "JointReference, such as JointHold or JointWaypoints")),
    }
}

/// Returns the error for an object that is not a reference.
fn no_reference(value: Any<'_, '_>, expected: &str) -> PyErr {
    let py = value.py();
    let got = type_name(value);
    let message = format!("reference is of type {got}; expected a {expected}");
    raise(py, "DtypeError", &message, &fields!(py, "name": "reference", "expected": expected, "got": got))
}

/// Reads a vector of three finite numbers.
fn vector(value: Any<'_, '_>, name: &str) -> PyResult<Vector3<f64>> {
    Ok(fixed::<3>(value, name, &[3])?.into())
}

/// Reads the argument `pose`, a (4, 4) homogeneous transform, m.
fn pose(value: Any<'_, '_>) -> PyResult<Hold> {
    let rows = fixed::<16>(value, "pose", &[4, 4])?;
    let mut poses = Hold::from_rows(&[rows]).map_err(|error| error.into_python(value.py()))?;
    Ok(poses.remove(0))
}

/// Reads the argument `poses`, (K, 4, 4) homogeneous transforms, m.
fn poses(value: Any<'_, '_>) -> PyResult<Vec<Hold>> {
    let input = Input::new(value, "poses")?;
    let [_, 4, 4] = input.shape() else {
        return Err(wrong_shape(value.py(), "poses", "(K, 4, 4)", input.shape()));
    };
    Hold::from_rows(input.data().as_chunks().0).map_err(|error| error.into_python(value.py()))
}

/// Reads an array (K,) of numbers.
fn row(value: Any<'_, '_>, name: &str) -> PyResult<Vec<f64>> {
    let input = Input::new(value, name)?;
    match input.shape() {
        [_] => Ok(input.data().to_vec()),
        other => Err(wrong_shape(value.py(), name, "(K,)", other)),
    }
}
