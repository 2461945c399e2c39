//! Joint control that follows external commands.

use super::gains::{one_count, per_joint};
use super::native_law::{Group, NativeLaw};
use crate::errors::{IntoPython, fields, plain, raise};
use crate::pickling::{ConstructorCall, Reduced, call_of};
use onorbit_core::control::{External, JointComputedTorque, Law, OnTimeout};
use pyo3::prelude::*;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Joint control that follows external commands, which are sent with :meth:`Stepper.send` and
/// :meth:`Stepper.send_trajectory`.
///
/// A command is held until the next command. If a command has positions or velocities, the torque is that of
/// :class:`JointComputedTorque` plus the commanded effort. A command of positions without velocities means
/// that the joints rest there; a command of velocities without positions causes no position error. If a
/// command has only efforts, they are the torques. Before the first command, the joints hold their initial
/// positions if ``kp`` is positive for all of them. Otherwise they come to rest if ``kd`` is positive for all
/// of them, and have no torque if it is not.
///
/// Parameters
/// ----------
/// kp : float or (k,) array
///     Position gain of the ``k`` joints, 1/s², such as 100; required for commands of positions and for
///     trajectories.
/// kd : float or (k,) array
///     Rate gain of the ``k`` joints, 1/s, such as 20; required for commands of velocities.
/// timeout : float, optional
///     Time after the last command, or after the end of the last trajectory, at which ``on_timeout`` applies,
///     s; default: never.
/// on_timeout : {"hold", "damp", "zero"}
///     Behaviour after the timeout. ``hold``: the joints rest at the commanded positions or, after a command
///     without positions, at their positions at the timeout. ``damp``: ``kd`` brings the joints to rest.
///     ``zero``: the joints have no torque.
/// compensate_environment : bool
///     If True, the wrenches of the environment are compensated while positions or velocities are commanded.
/// compensate_friction : bool
///     If True, friction is compensated as by :class:`JointComputedTorque` while positions or velocities are
///     commanded.
///
/// Raises
/// ------
/// ControlError, ShapeError
///     If a gain, the timeout or ``on_timeout`` is invalid, ``on_timeout`` requires a gain that is zero, or a
///     gain has the wrong shape.
#[pyclass(name = "External", frozen, module = "onorbit_rs")]
pub(crate) struct PyExternal {
    law: External,
    constructor_call: ConstructorCall,
}

#[pymethods]
impl PyExternal {
    #[new]
    #[pyo3(signature = (
        kp=None, kd=None, *, timeout=None, on_timeout="hold", compensate_environment=true, compensate_friction=true,
    ), text_signature = "(kp=0.0, kd=0.0, *, timeout=None, on_timeout='hold', compensate_environment=True, \
       compensate_friction=True)")]
    fn new(
        py: Python<'_>,
        kp: Option<Any<'_, '_>>,
        kd: Option<Any<'_, '_>>,
        timeout: Option<f64>,
        on_timeout: &str,
        compensate_environment: bool,
        compensate_friction: bool,
    ) -> PyResult<Self> {
        let constructor_call = call_of!(
            py,
            "External",
            kp,
            kd,
            timeout,
            on_timeout,
            compensate_environment,
            compensate_friction
        )?;
        let (kp, kd) = (per_joint(kp, "kp", 0.0)?, per_joint(kd, "kd", 0.0)?);
        let count = one_count(py, &[&kp, &kd])?;
        let law = JointComputedTorque { kp: kp.0, kd: kd.0, compensate_environment, compensate_friction };
        let mut law = External::new(law);
        law.timeout = timeout;
        law.on_timeout = match on_timeout {
            "hold" => OnTimeout::Hold,
            "damp" => OnTimeout::Damp,
            "zero" => OnTimeout::Zero,
            other => {
                let message = format!("on_timeout is '{other}'; the choices are 'hold', 'damp' and 'zero'");
                let fields = fields!(py, "name": "on_timeout", "got": other);
                return Err(raise(py, "ControlError", &message, &fields));
            }
        };
        law.check(count).map_err(|error| error.into_python(py))?;
        Ok(Self { law, constructor_call })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        self.constructor_call.reduce(py)
    }
}

impl NativeLaw for PyExternal {
    fn law(&self, py: Python<'_>, group: &Group<'_, '_>) -> PyResult<Law> {
        if group.reference.is_some() {
            let message = "a reference is given to an External controller, which gets its motion from \
                           commands; omit the reference, or use JointComputedTorque";
            return Err(plain(py, "ControlError", message));
        }
        Ok(Law::External(Box::new(self.law.clone())))
    }
}
