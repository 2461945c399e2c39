//! Joint-space computed torque.

use super::gains::{one_count, per_joint};
use super::native_law::{Group, NativeLaw};
use crate::errors::IntoPython;
use crate::pickling::{ConstructorCall, Reduced, call_of};
use onorbit_core::control::{JointComputedTorque, Law};
use pyo3::prelude::*;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Joint-space computed torque on the reduced model.
///
/// If all external wrenches and friction are compensated, the error ``e`` of each joint (desired minus actual
/// position) obeys ``e'' + kd e' + kp e = 0`` for any motion of the base. The torques of springs at the
/// joints are always compensated.
///
/// Parameters
/// ----------
/// kp : float or (k,) array, optional
///     Position gain of the ``k`` joints, 1/s²; default: 100.
/// kd : float or (k,) array, optional
///     Rate gain of the ``k`` joints, 1/s; default: 20.
/// compensate_environment : bool
///     If True, the wrenches of the environment are compensated.
/// compensate_friction : bool
///     If True, the viscous damping of the joints is compensated, and the joint drives compensate Coulomb
///     friction at every instant: the error obeys its equation from rest and through reversals, and a joint
///     at its goal (within 2e-8 rad or m) stays at rest.
///
/// Raises
/// ------
/// ControlError, ShapeError
///     If a gain is invalid or has the wrong shape.
#[pyclass(name = "JointComputedTorque", frozen, module = "onorbit_rs")]
pub(crate) struct PyJointComputedTorque {
    law: JointComputedTorque,
    constructor_call: ConstructorCall,
}

#[pymethods]
impl PyJointComputedTorque {
    #[new]
    #[pyo3(signature = (*, kp=None, kd=None, compensate_environment=true, compensate_friction=true))]
    fn new(
        py: Python<'_>,
        kp: Option<Any<'_, '_>>,
        kd: Option<Any<'_, '_>>,
        compensate_environment: bool,
        compensate_friction: bool,
    ) -> PyResult<Self> {
        let constructor_call =
            call_of!(py, "JointComputedTorque", kp, kd, compensate_environment, compensate_friction)?;
        let (kp, kd) = (per_joint(kp, "kp", 100.0)?, per_joint(kd, "kd", 20.0)?);
        let count = one_count(py, &[&kp, &kd])?;
        let law = JointComputedTorque { kp: kp.0, kd: kd.0, compensate_environment, compensate_friction };
        law.check(count).map_err(|error| error.into_python(py))?;
        Ok(Self { law, constructor_call })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        self.constructor_call.reduce(py)
    }
}

impl NativeLaw for PyJointComputedTorque {
    fn law(&self, py: Python<'_>, group: &Group<'_, '_>) -> PyResult<Law> {
        Ok(Law::JointComputedTorque(self.law.clone(), group.joint_path(py)?))
    }
}
