//! PID controllers of joints.

use super::gains::{one_count, per_joint};
use super::native_law::{Group, NativeLaw};
use crate::errors::{IntoPython, fields, raise};
use crate::pickling::{ConstructorCall, Reduced, call_of};
use onorbit_core::control::{Interface, JointPid, Law, PerJoint};
use pyo3::prelude::*;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// PID controller for each joint, as in ROS Control: ``tau = p e + i ∫e dt + d e'`` with the error ``e`` of
/// the commanded quantity (desired minus actual).
///
/// At least one gain is required, except for the interface ``effort``. While the effort is at its limit, the
/// integral does not grow further in that direction. Friction is not compensated: a joint that sticks does
/// not move until the effort exceeds its static friction.
///
/// Parameters
/// ----------
/// interface : {"position", "velocity", "effort"}
///     Quantity that the reference commands. For ``effort``, the positions of the reference are efforts, N m
///     or N, and no gains may be given.
/// p, i, d : float or (k,) array, optional
///     Proportional, integral and derivative gains; default: 0. For ``position`` they are in N m/rad, N
///     m/(rad s) and N m s/rad, or N/m, N/(m s) and N s/m for prismatic joints; for ``velocity``, they are in
///     these units times s.
/// i_limit : float or (k,) array, optional
///     Limit of the magnitude of the integral term, N m or N; default: no limit.
/// effort_limit : float or (k,) array, optional
///     Limit of the magnitude of the effort, N m or N; ``inf`` for no limit. Default: the effort limits of
///     the robot's joints, if there are any.
///
/// Raises
/// ------
/// ControlError, ShapeError
///     If the interface is unknown, a value is invalid, all gains are missing, or a value has the wrong
///     shape.
#[pyclass(name = "JointPid", frozen, module = "onorbit_rs")]
pub(crate) struct PyJointPid {
    law: JointPid,
    /// True if the effort limits of the robot apply.
    uses_robot_limits: bool,
    constructor_call: ConstructorCall,
}

#[pymethods]
impl PyJointPid {
    #[new]
    #[pyo3(signature = (*, interface="position", p=None, i=None, d=None, i_limit=None, effort_limit=None))]
    fn new(
        py: Python<'_>,
        interface: &str,
        p: Option<Any<'_, '_>>,
        i: Option<Any<'_, '_>>,
        d: Option<Any<'_, '_>>,
        i_limit: Option<Any<'_, '_>>,
        effort_limit: Option<Any<'_, '_>>,
    ) -> PyResult<Self> {
        let constructor_call = call_of!(py, "JointPid", interface, p, i, d, i_limit, effort_limit)?;
        let lacks_gains = [&p, &i, &d].iter().all(|gain| gain.is_none());
        if lacks_gains && matches!(interface, "position" | "velocity") {
            let message = format!(
                "a PID with interface '{interface}' and no gains has no effect; give 'p', 'i' or 'd', or \
                 leave these joints without a controller"
            );
            return Err(raise(py, "ControlError", &message, &fields!(py, "name": "gains")));
        }
        let interface = match interface {
            "position" => Interface::Position,
            "velocity" => Interface::Velocity,
            "effort" => Interface::Effort,
            other => {
                let message =
                    format!("interface is '{other}'; the choices are 'position', 'velocity' and 'effort'");
                let fields = fields!(py, "name": "interface", "got": other);
                return Err(raise(py, "ControlError", &message, &fields));
            }
        };
        let uses_robot_limits = effort_limit.is_none();
        let gain = |value, name| per_joint(value, name, 0.0);
        let limit = |value, name| per_joint(value, name, f64::INFINITY);
        let (p, i, d) = (gain(p, "p")?, gain(i, "i")?, gain(d, "d")?);
        let (i_limit, effort_limit) = (limit(i_limit, "i_limit")?, limit(effort_limit, "effort_limit")?);
        let count = one_count(py, &[&p, &i, &d, &i_limit, &effort_limit])?;
        let (p, i, d, i_limit, effort_limit) = (p.0, i.0, d.0, i_limit.0, effort_limit.0);
        let law = JointPid { interface, p, i, d, i_limit, effort_limit };
        law.check(count).map_err(|error| error.into_python(py))?;
        Ok(Self { law, uses_robot_limits, constructor_call })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        self.constructor_call.reduce(py)
    }
}

impl NativeLaw for PyJointPid {
    fn law(&self, py: Python<'_>, group: &Group<'_, '_>) -> PyResult<Law> {
        let mut law = self.law.clone();
        if self.uses_robot_limits {
            let limit = |j: &usize| group.robot.model.joints()[*j].limits.effort.unwrap_or(f64::INFINITY);
            law.effort_limit = PerJoint::new(group.joints.iter().map(limit).collect());
        }
        Ok(Law::Pid(law, group.joint_path(py)?))
    }
}
