//! Controllers: the native law, and Python's own.

use crate::arrays::{Input, array_of, fixed, wrong_shape};
use crate::errors::{IntoPython, plain};
use crate::model::PyModel;
use onorbit_core::control::{ComputedTorque, ControlError, Controller, Observation};
use onorbit_core::model::Model;
use pyo3::prelude::*;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Computed torque on the generalized Jacobian, Eq. (6)-(8) of the OnOrbitROS paper with the exact drift.
///
/// ``tool`` is a frame of ``model``; ``kp`` (1/s²) and ``kd`` (1/s) are numbers, (6,) or (6, 6), position rows first;
/// ``damping`` the singular value of the generalized Jacobian below which its inverse is damped, ``null_space_damping``
/// (1/s) brakes self-motion, ``compensate_environment`` and ``compensate_friction`` make external wrenches and the joints'
/// damping and friction known to the law. Raises ``ControlError``, ``FrameError`` or ``ShapeError``.
#[pyclass(name = "ComputedTorque", frozen, module = "onorbit_rs")]
pub(crate) struct PyComputedTorque {
    pub(crate) law: ComputedTorque,
    model: Arc<Model>,
}

impl PyComputedTorque {
    /// Refuses a robot that the law was not made for.
    pub(crate) fn check_model(&self, py: Python<'_>, model: &Arc<Model>) -> PyResult<()> {
        if Arc::ptr_eq(&self.model, model) || self.model.is_like(model) {
            return Ok(());
        }
        let (own, other) = (self.model.name(), model.name());
        let message = format!(
            "the controller was made for robot '{own}', not for '{other}': make it from the same model"
        );
        Err(plain(py, "ControlError", &message))
    }
}

#[pymethods]
impl PyComputedTorque {
    #[new]
    #[pyo3(signature = (
        model, tool, *, kp=None, kd=None, damping=0.05, null_space_damping=0.0, compensate_environment=true,
        compensate_friction=true,
    ))]
    fn new(
        py: Python<'_>,
        model: &PyModel,
        tool: Any<'_, '_>,
        kp: Option<Any<'_, '_>>,
        kd: Option<Any<'_, '_>>,
        damping: f64,
        null_space_damping: f64,
        compensate_environment: bool,
        compensate_friction: bool,
    ) -> PyResult<Self> {
        let mut law = ComputedTorque::new(model.frame(tool)?, 100.0, 20.0);
        if let Some(kp) = kp {
            law.kp = gains(kp, "kp")?;
        }
        if let Some(kd) = kd {
            law.kd = gains(kd, "kd")?;
        }
        law.damping = damping;
        law.null_space_damping = null_space_damping;
        law.compensate_environment = compensate_environment;
        law.compensate_friction = compensate_friction;
        law.check(&model.model).map_err(|error| error.into_python(py))?;
        Ok(Self { law, model: Arc::clone(&model.model) })
    }
}

/// A number, (6,) or (6, 6).
fn gains(value: Any<'_, '_>, name: &str) -> PyResult<[f64; 36]> {
    if let Ok(gain) = value.extract::<f64>() {
        return Ok(ComputedTorque::diagonal([gain; 6]));
    }
    match Input::new(value, name)?.shape() {
        [6] => Ok(ComputedTorque::diagonal(fixed(value, name, &[6])?)),
        [6, 6] => fixed(value, name, &[6, 6]),
        other => Err(wrong_shape(value.py(), name, "a number, (6,) or (6, 6)", other)),
    }
}

/// What a Python controller is given: fresh arrays, its own to keep.
#[pyclass(name = "State", frozen, get_all, module = "onorbit_rs")]
pub(crate) struct PyState {
    /// Configuration, (nq,).
    q: Py<PyAny>,
    /// Velocity, (nv,).
    v: Py<PyAny>,
    /// Desired pose of the tool in W, (4, 4), or None without a reference.
    reference_pose: Option<Py<PyAny>>,
    /// Desired twist of the tool in W axes, (6,), or None.
    reference_velocity: Option<Py<PyAny>>,
    /// Desired acceleration of the tool in W axes, (6,), or None.
    reference_acceleration: Option<Py<PyAny>>,
}

impl PyState {
    fn new(py: Python<'_>, now: &Observation<'_>) -> Self {
        let array = |shape: &[usize], data: &[f64]| array_of(py, shape, data).into_any().unbind();
        let desired = now.desired.as_ref();
        let pose = |d: &onorbit_core::reference::TaskSample<f64>| d.pose_rows();
        let six = |m: &onorbit_core::spatial::Motion<f64>| {
            let mut out = [0.0; 6];
            m.write(&mut out);
            out
        };
        Self {
            q: array(&[now.q.len()], now.q),
            v: array(&[now.v.len()], now.v),
            reference_pose: desired.map(|d| array(&[4, 4], &pose(d))),
            reference_velocity: desired.map(|d| array(&[6], &six(&d.velocity))),
            reference_acceleration: desired.map(|d| array(&[6], &six(&d.acceleration))),
        }
    }
}

/// A Python object with ``update(t, state) -> tau``, in the native loop.
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

    fn update(&mut self, now: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError> {
        Python::attach(|py| {
            let state = Bound::new(py, PyState::new(py, now))?;
            let result = self.object.bind(py).call_method1("update", (now.time, state))?;
            let torques = Input::new(&result, "the torque returned by update")?;
            if torques.shape() != [tau.len()] {
                let expected = format!("({},), one torque per joint", tau.len());
                return Err(wrong_shape(py, "the torque returned by update", &expected, torques.shape()));
            }
            tau.copy_from_slice(torques.data());
            Ok(())
        })
        .map_err(raised)
    }
}

/// What Python raised, to be raised again as that very object.
fn raised(error: PyErr) -> ControlError {
    ControlError::User(Box::new(error))
}
