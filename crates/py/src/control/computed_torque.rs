//! Task-space computed torque.

use crate::arrays::{Input, fixed, wrong_shape};
use crate::errors::{IntoPython, plain};
use crate::model::PyModel;
use onorbit_core::control::ComputedTorque;
use onorbit_core::model::Model;
use pyo3::prelude::*;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Computed torque on the generalized Jacobian, Eq. (6)-(8) of the OnOrbitROS paper with the exact drift.
///
/// ``tool`` is a frame of ``model``; ``kp`` (1/s²) and ``kd`` (1/s) are numbers, (6,) or (6, 6), position rows first;
/// ``damping`` the singular value of the generalized Jacobian below which its inverse is damped, ``null_space_damping``
/// (1/s) brakes self-motion. With ``compensate_environment`` the law knows the external wrenches. With
/// ``compensate_friction`` it knows the joints' damping, and their drives compensate Coulomb friction at every instant:
/// joints move as if they had none, from rest and through reversals, and those at their goal (2e-8 rad or m) stay at rest.
/// Raises ``ControlError``, ``FrameError`` or ``ShapeError``.
#[pyclass(name = "ComputedTorque", frozen, module = "onorbit_rs")]
pub(crate) struct PyComputedTorque {
    pub(crate) law: ComputedTorque,
    model: Arc<Model>,
}

impl PyComputedTorque {
    /// Refuses a robot that the law was not made for.
    pub(crate) fn check_model(&self, py: Python<'_>, model: &Arc<Model>) -> PyResult<()> {
        same_robot(py, &self.model, model)
    }
}

/// Refuses a robot that a law was not made for.
pub(super) fn same_robot(py: Python<'_>, own: &Arc<Model>, model: &Arc<Model>) -> PyResult<()> {
    if Arc::ptr_eq(own, model) || own.is_like(model) {
        return Ok(());
    }
    let (own, other) = (own.name(), model.name());
    let message =
        format!("the controller was made for robot '{own}', not for '{other}': make it from the same model");
    Err(plain(py, "ControlError", &message))
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
pub(super) fn gains(value: Any<'_, '_>, name: &str) -> PyResult<[f64; 36]> {
    if let Ok(gain) = value.extract::<f64>() {
        return Ok(ComputedTorque::diagonal([gain; 6]));
    }
    match Input::new(value, name)?.shape() {
        [6] => Ok(ComputedTorque::diagonal(fixed(value, name, &[6])?)),
        [6, 6] => fixed(value, name, &[6, 6]),
        other => Err(wrong_shape(value.py(), name, "a number, (6,) or (6, 6)", other)),
    }
}
