//! Controllers written in Python.

use crate::arrays::{Input, array_of, type_name, wrong_shape};
use onorbit_core::control::{ControlError, Controller, Observation};
use pyo3::call::PyCallArgs;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// State passed to a Python controller. Its arrays are copies.
#[pyclass(name = "State", frozen, get_all, module = "onorbit_rs")]
pub(crate) struct PyState {
    /// Configuration, (nq,), m and rad.
    q: Py<PyAny>,
    /// Velocity, (nv,), m/s and rad/s.
    v: Py<PyAny>,
    /// Names of the joints of the control, in the order of the torques.
    joints: Vec<String>,
    /// Desired pose of the tool, (4, 4), m: relative to the base for a reference in the frame ``"base"``,
    /// otherwise in W. None without a reference.
    reference_pose: Option<Py<PyAny>>,
    /// Desired twist of the tool, (6,), linear part first, m/s and rad/s, in the frame of ``reference_pose``.
    /// None without a reference.
    reference_velocity: Option<Py<PyAny>>,
    /// Desired acceleration of the tool, (6,), linear part first, m/s² and rad/s², in the frame of
    /// ``reference_pose``. None without a reference.
    reference_acceleration: Option<Py<PyAny>>,
}

impl PyState {
    fn new(py: Python<'_>, observation: &Observation<'_>) -> Self {
        let array = |shape: &[usize], data: &[f64]| array_of(py, shape, data).into_any().unbind();
        let desired = observation.desired.as_ref();
        let pose = |d: &onorbit_core::reference::TaskSample<f64>| d.pose_rows();
        let six = |m: &onorbit_core::spatial::Motion<f64>| {
            let mut out = [0.0; 6];
            m.write(&mut out);
            out
        };
        Self {
            q: array(&[observation.q.len()], observation.q),
            v: array(&[observation.v.len()], observation.v),
            joints: observation.joints.iter().map(|&i| observation.model.joints()[i].name.clone()).collect(),
            reference_pose: desired.map(|d| array(&[4, 4], &pose(d))),
            reference_velocity: desired.map(|d| array(&[6], &six(&d.velocity))),
            reference_acceleration: desired.map(|d| array(&[6], &six(&d.acceleration))),
        }
    }
}

/// Controller of the core that calls the method `update(t, state)` of a Python object.
pub(crate) struct PythonController {
    pub(crate) object: Py<PyAny>,
}

impl Controller for PythonController {
    fn reset(&mut self) -> Result<(), ControlError> {
        Python::attach(|py| match self.object.bind(py).getattr_opt("reset") {
            Ok(Some(reset)) => reset.call0().map(|_| ()),
            Ok(None) => Ok(()),
            Err(error) => Err(error),
        })
        .map_err(raised)
    }

    fn update(&mut self, observation: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError> {
        Python::attach(|py| {
            let state = Bound::new(py, PyState::new(py, observation))?;
            let result = self.object.bind(py).call_method1("update", (observation.time, state))?;
            let name = format!("the torque returned by {}.update", type_name(self.object.bind(py)));
            let torques = Input::new(&result, &name)?;
            if torques.shape() != [tau.len()] {
                let expected = format!("({},), one torque per joint", tau.len());
                return Err(wrong_shape(py, &name, &expected, torques.shape()));
            }
            tau.copy_from_slice(torques.data());
            Ok(())
        })
        .map_err(raised)
    }

    fn save(&self) -> Result<Vec<u8>, ControlError> {
        Python::attach(|py| {
            let state = self.call(py, "get_state", ())?;
            plain_data(py)?.call_method1("encode", (state,))?.extract()
        })
        .map_err(raised)
    }

    fn load(&mut self, saved: &[u8]) -> Result<(), ControlError> {
        Python::attach(|py| {
            let state = plain_data(py)?.call_method1("decode", (PyBytes::new(py, saved),))?;
            self.call(py, "set_state", (state,)).map(|_| ())
        })
        .map_err(raised)
    }
}

impl PythonController {
    /// Calls a method of the object or, if the object has no such method, that of the Python class
    /// `Controller`.
    fn call<'py>(&self, py: Python<'py>, name: &str, arguments: impl PyCallArgs<'py>) -> PyResult<Py<PyAny>> {
        let object = self.object.bind(py);
        let method = match object.getattr_opt(name)? {
            Some(method) => method,
            None => {
                let base =
                    py.import("onorbit_rs.simulation.controller")?.getattr("Controller")?.getattr(name)?;
                base.call_method1("__get__", (object,))?
            }
        };
        method.call1(arguments).map(Bound::unbind)
    }
}

/// Returns the Python module that encodes the state of a controller as bytes and decodes it.
fn plain_data(py: Python<'_>) -> PyResult<Bound<'_, PyModule>> {
    py.import("onorbit_rs.simulation.controller_state")
}

/// Wraps a Python exception as an error, so that the same object is raised again later.
fn raised(error: PyErr) -> ControlError {
    ControlError::User(Box::new(error))
}
