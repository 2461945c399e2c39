//! A tool on a spring and a damper.

use super::computed_torque::gains;
use crate::errors::IntoPython;
use crate::model::PyModel;
use onorbit_core::control::Compliance;
use onorbit_core::model::Model;
use pyo3::prelude::*;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// The tool hangs on a spring and a damper: ``tau = Jg^T (K e + D e') - k N qdot``. Nothing weighs anything in orbit, so
/// nothing is compensated and the law is passive. Nor is friction compensated, which may hold the tool off its goal.
///
/// ``stiffness`` (N/m, N m/rad) and ``damping`` (N s/m, N m s/rad) are numbers, (6,) or (6, 6), position rows first;
/// ``null_space_damping`` (N m s/rad) brakes what the tool does not feel. Held torques bear a damping of about twice the
/// tool's inertia over the control period. Raises ``ControlError``, ``FrameError`` or ``ShapeError``.
#[pyclass(name = "Compliance", frozen, module = "onorbit_rs")]
pub(crate) struct PyCompliance {
    pub(super) law: Compliance,
    pub(super) model: Arc<Model>,
}

#[pymethods]
impl PyCompliance {
    #[new]
    #[pyo3(signature = (model, tool, *, stiffness, damping, null_space_damping=0.0))]
    fn new(
        py: Python<'_>,
        model: &PyModel,
        tool: Any<'_, '_>,
        stiffness: Any<'_, '_>,
        damping: Any<'_, '_>,
        null_space_damping: f64,
    ) -> PyResult<Self> {
        let frame = model.frame(tool)?;
        let (stiffness, damping) = (gains(stiffness, "stiffness")?, gains(damping, "damping")?);
        let law = Compliance { frame, stiffness, damping, null_space_damping };
        law.check().map_err(|error| error.into_python(py))?;
        Ok(Self { law, model: Arc::clone(&model.model) })
    }
}
