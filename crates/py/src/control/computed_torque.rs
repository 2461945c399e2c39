//! Task-space computed torque.

use super::gains::gains;
use super::native_law::{Group, NativeLaw, same_robot};
use crate::errors::IntoPython;
use crate::model::PyModel;
use crate::pickling::{ConstructorCall, Reduced, call_of};
use onorbit_core::control::{ComputedTorque, Law};
use onorbit_core::model::Model;
use pyo3::prelude::*;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Task-space computed torque with the generalized Jacobian.
///
/// The tool's acceleration is ``ẍ = ẍd + kd (ẋd - ẋ) + kp (xd - x)`` with the desired pose ``xd`` and the
/// actual pose ``x``, away from singularities of the generalized Jacobian. This is Eq. (6)-(8) of the
/// OnOrbitROS paper (cited in ``docs/concepts/control.md``), with the exact drift. The torques of springs at
/// the joints are always compensated.
///
/// Parameters
/// ----------
/// model : Model
///     Robot.
/// tool : str
///     Frame of the robot that tracks the reference.
/// kp : float, (6,) or (6, 6) array, optional
///     Position gain, linear rows first, 1/s²; default: 100.
/// kd : float, (6,) or (6, 6) array, optional
///     Velocity gain, linear rows first, 1/s; default: 20.
/// damping : float
///     Threshold for the damping of the inverse of the generalized Jacobian ``Jg``. The inverse is damped
///     while ``tr[(Jg Jgᵀ)⁻¹]^(-1/2)``, a lower bound of the smallest singular value of ``Jg``, is below this
///     value.
/// null_space_damping : float
///     Damping rate of joint motion that does not move the tool, 1/s.
/// compensate_environment : bool
///     If True, the wrenches of the environment are compensated.
/// compensate_friction : bool
///     If True, the viscous damping of the joints is compensated, and the joint drives compensate Coulomb
///     friction at every instant: joints move as if they had no friction, from rest and through reversals,
///     and joints at their goal (within 2e-8 rad or m) stay at rest.
///
/// Raises
/// ------
/// ControlError, FrameError, ShapeError
///     If a gain is invalid or has the wrong shape, if the frame does not exist, or if fewer than six joints
///     move the frame.
#[pyclass(name = "ComputedTorque", frozen, module = "onorbit_rs")]
pub(crate) struct PyComputedTorque {
    pub(crate) law: ComputedTorque,
    model: Arc<Model>,
    constructor_call: ConstructorCall,
}

impl PyComputedTorque {
    /// Returns an error if `model` is not the robot for which this law was constructed.
    pub(crate) fn check_model(&self, py: Python<'_>, model: &Arc<Model>) -> PyResult<()> {
        same_robot(py, &self.model, model)
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
        model: &Bound<'_, PyModel>,
        tool: Any<'_, '_>,
        kp: Option<Any<'_, '_>>,
        kd: Option<Any<'_, '_>>,
        damping: f64,
        null_space_damping: f64,
        compensate_environment: bool,
        compensate_friction: bool,
    ) -> PyResult<Self> {
        let constructor_call = call_of!(
            py,
            "ComputedTorque",
            model,
            tool,
            kp,
            kd,
            damping,
            null_space_damping,
            compensate_environment,
            compensate_friction
        )?;
        let model = model.get();
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
        Ok(Self { law, model: Arc::clone(&model.model), constructor_call })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        self.constructor_call.reduce(py)
    }
}

impl NativeLaw for PyComputedTorque {
    fn law(&self, py: Python<'_>, group: &Group<'_, '_>) -> PyResult<Law> {
        same_robot(py, &self.model, group.robot.model)?;
        Ok(Law::TaskComputedTorque(Box::new(self.law.clone()), group.task(py)?))
    }
}
