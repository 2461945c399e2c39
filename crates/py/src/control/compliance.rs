//! Compliance control of a tool.

use super::gains::gains;
use super::native_law::{Group, NativeLaw, same_robot};
use crate::errors::IntoPython;
use crate::model::PyModel;
use crate::pickling::{ConstructorCall, Reduced, call_of};
use onorbit_core::control::{Compliance, Law};
use onorbit_core::model::Model;
use pyo3::prelude::*;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Compliance control of a tool by a virtual spring and damper: ``tau = Jg^T (K e + D e') - k N qdot``.
///
/// ``Jg`` is the generalized Jacobian of the tool, ``e`` and ``e'`` are its pose and velocity errors (desired
/// minus actual), ``qdot`` are the joint rates, and ``N`` is the projection on joint rates that do not move
/// the tool. The law is passive, and in free fall there is no gravity load to compensate. Friction is not
/// compensated and may prevent the tool from reaching its goal. Because torques are held between control
/// ticks, the motion is unstable if the damping exceeds about twice the inertia of the tool divided by the
/// control period.
///
/// Parameters
/// ----------
/// model : Model
///     Robot.
/// tool : str
///     Frame of the robot to which the spring is attached.
/// stiffness : float, (6,) or (6, 6) array
///     Stiffness ``K`` of the spring, linear rows first, N/m and N m/rad.
/// damping : float, (6,) or (6, 6) array
///     Damping ``D`` of the damper, linear rows first, N s/m and N m s/rad.
/// null_space_damping : float
///     Damping coefficient ``k`` of joint motion that does not move the tool, N m s/rad.
///
/// Raises
/// ------
/// ControlError, FrameError, ShapeError
///     If a gain is invalid, if the frame does not exist, or if a gain has the wrong shape.
#[pyclass(name = "Compliance", frozen, module = "onorbit_rs")]
pub(crate) struct PyCompliance {
    law: Compliance,
    model: Arc<Model>,
    constructor_call: ConstructorCall,
}

#[pymethods]
impl PyCompliance {
    #[new]
    #[pyo3(signature = (model, tool, *, stiffness, damping, null_space_damping=0.0))]
    fn new(
        py: Python<'_>,
        model: &Bound<'_, PyModel>,
        tool: Any<'_, '_>,
        stiffness: Any<'_, '_>,
        damping: Any<'_, '_>,
        null_space_damping: f64,
    ) -> PyResult<Self> {
        let constructor_call =
            call_of!(py, "Compliance", model, tool, stiffness, damping, null_space_damping)?;
        let model = model.get();
        let frame = model.frame(tool)?;
        let (stiffness, damping) = (gains(stiffness, "stiffness")?, gains(damping, "damping")?);
        let law = Compliance { frame, stiffness, damping, null_space_damping };
        law.check().map_err(|error| error.into_python(py))?;
        Ok(Self { law, model: Arc::clone(&model.model), constructor_call })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        self.constructor_call.reduce(py)
    }
}

impl NativeLaw for PyCompliance {
    fn law(&self, py: Python<'_>, group: &Group<'_, '_>) -> PyResult<Law> {
        same_robot(py, &self.model, group.robot.model)?;
        Ok(Law::Compliance(Box::new(self.law.clone()), group.task(py)?))
    }
}
