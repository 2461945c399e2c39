//! Control law that grips an object with a given force.

use super::gains::{one_count, per_joint};
use super::native_law::{Group, NativeLaw};
use crate::errors::{IntoPython, plain};
use crate::pickling::{ConstructorCall, Reduced, call_of};
use onorbit_core::control::{GripForce, Law, PerJoint};
use pyo3::prelude::*;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Controller that closes the fingers of a gripper until they touch an object, and then grips it with a given
/// force.
///
/// The grip force is the mean of the normal forces on the fingers, which the contacts of the world exert. A
/// finger consists of the links moved by a joint of the group, or by a joint that mimics one of these joints.
/// At least one contact must involve each finger. Until all fingers touch, each joint follows its closing rate
/// ``r``: ``tau = d (r - v)``, with the joint rate ``v``. Then the desired force ``F`` increases to ``force``,
/// and ``tau = L (F + ∫ i (F - N) dt) - d v - p x``, with the measured grip force ``N`` and the lever ``L`` of
/// the joint, which follows from the points and normals of the contacts. ``x`` is the displacement of the joint
/// since all fingers touched, without its component along the closing motion. If a finger loses contact, the
/// gripper closes at its closing rate again.
///
/// The control has no reference. Its column in ``trace.tracking``, (T, 1), contains the error of the force,
/// ``force - N``, in N. The tolerance of a :class:`Goal` is in N as well; the goal cannot be reached before the
/// desired force equals ``force``.
///
/// Parameters
/// ----------
/// force : float
///     Desired mean normal force per finger, N. Prismatic joints must be able to exert it within their effort
///     limits.
/// closing_rate : float or (k,) array
///     Rates of the joints until all fingers touch, rad/s or m/s; their signs are those of the closing
///     motion.
/// damping : float or (k,) array
///     Damping ``d``, N m s/rad or N s/m; must be positive.
/// ramp : float
///     Time in which the desired force would increase from zero to ``force``, s.
/// integral : float
///     Gain ``i`` of the integral of the force error, 1/s. While an effort is at its limit, the integral does
///     not increase further (anti-windup).
/// stiffness : float or (k,) array, optional
///     Stiffness ``p``, N m/rad or N/m, which keeps independent joints from moving together with the object;
///     default: 0.
/// effort_limit : float or (k,) array, optional
///     Limit of the magnitude of the effort, N m or N; ``inf`` for no limit. Default: the effort limits of
///     the robot's joints, if there are any.
///
/// Raises
/// ------
/// ControlError, ShapeError
///     If a value is invalid or has the wrong shape.
#[pyclass(name = "GripForce", frozen, module = "onorbit_rs")]
pub(crate) struct PyGripForce {
    law: GripForce,
    /// True if the effort limits of the robot apply.
    uses_robot_limits: bool,
    constructor_call: ConstructorCall,
}

#[pymethods]
impl PyGripForce {
    #[new]
    #[pyo3(signature = (
        force, *, closing_rate, damping, ramp=0.5, integral=5.0, stiffness=None, effort_limit=None,
    ))]
    fn new(
        py: Python<'_>,
        force: f64,
        closing_rate: Any<'_, '_>,
        damping: Any<'_, '_>,
        ramp: f64,
        integral: f64,
        stiffness: Option<Any<'_, '_>>,
        effort_limit: Option<Any<'_, '_>>,
    ) -> PyResult<Self> {
        let constructor_call =
            call_of!(py, "GripForce", force, closing_rate, damping, ramp, integral, stiffness, effort_limit)?;
        let uses_robot_limits = effort_limit.is_none();
        let closing_rate = per_joint(Some(closing_rate), "closing_rate", 0.0)?;
        let damping = per_joint(Some(damping), "damping", 0.0)?;
        let stiffness = per_joint(stiffness, "stiffness", 0.0)?;
        let effort_limit = per_joint(effort_limit, "effort_limit", f64::INFINITY)?;
        let count = one_count(py, &[&closing_rate, &damping, &stiffness, &effort_limit])?;
        let (closing_rate, damping) = (closing_rate.0, damping.0);
        let (stiffness, effort_limit) = (stiffness.0, effort_limit.0);
        let law = GripForce { force, closing_rate, ramp, integral, damping, stiffness, effort_limit };
        law.check(count).map_err(|error| error.into_python(py))?;
        Ok(Self { law, uses_robot_limits, constructor_call })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        self.constructor_call.reduce(py)
    }
}

impl NativeLaw for PyGripForce {
    fn law(&self, py: Python<'_>, group: &Group<'_, '_>) -> PyResult<Law> {
        if group.reference.is_some() {
            let message = "a GripForce controls a force and tracks no reference; omit the reference";
            return Err(plain(py, "ControlError", message));
        }
        let mut law = self.law.clone();
        if self.uses_robot_limits {
            let limit = |j: &usize| group.robot.model.joints()[*j].limits.effort.unwrap_or(f64::INFINITY);
            law.effort_limit = PerJoint::new(group.joints.iter().map(limit).collect());
        }
        Ok(Law::Grip(Box::new(law)))
    }
}
