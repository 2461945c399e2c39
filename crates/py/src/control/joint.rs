//! Laws of single joints.

use crate::arrays::{Input, wrong_shape};
use crate::errors::{IntoPython, fields, raise};
use onorbit_core::control::{Interface, JointComputedTorque, JointPid, PerJoint};
use pyo3::prelude::*;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Joint-space computed torque on the reduced model: the error of every joint obeys ``e'' + kd e' + kp e = 0``, whatever
/// the base does.
///
/// ``kp`` (1/s²) and ``kd`` (1/s) are numbers or one per joint of the group, (k,). With ``compensate_environment`` the law
/// knows the external wrenches. With ``compensate_friction`` it knows the joints' damping, and their drives compensate
/// Coulomb friction at every instant: the error obeys its equation from rest and through reversals, and a joint at its goal
/// (2e-8 rad or m) stays at rest. Raises ``ControlError``.
#[pyclass(name = "JointComputedTorque", frozen, module = "onorbit_rs")]
pub(crate) struct PyJointComputedTorque {
    pub(super) law: JointComputedTorque,
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
        let (kp, kd) = (per_joint(kp, "kp", 100.0)?, per_joint(kd, "kd", 20.0)?);
        let count = one_count(py, &[&kp, &kd])?;
        let law = JointComputedTorque { kp: kp.0, kd: kd.0, compensate_environment, compensate_friction };
        law.check(count).map_err(|error| error.into_python(py))?;
        Ok(Self { law })
    }
}

/// A PID for each joint, as ROS Control has it: ``tau = p e + i ∫e dt + d e'``.
///
/// ``interface`` says what the reference commands: ``position``, ``velocity``, or ``effort`` (its positions are the
/// efforts, N m, and there are no gains). Gains are numbers or (k,), per rad (m) of error, at least one of them given;
/// ``i_limit`` bounds the share of the integral, ``effort_limit`` the whole (the limits of the URDF where None, ``inf`` for
/// none), N m (N). The integral does not grow further into a limit. Friction is not compensated: a joint that sticks waits
/// for the integral. Raises ``ControlError``.
#[pyclass(name = "JointPid", frozen, module = "onorbit_rs")]
pub(crate) struct PyJointPid {
    pub(super) law: JointPid,
    /// Whether the effort limits are those of the robot.
    pub(super) takes_limits: bool,
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
        let lacks_gains = [&p, &i, &d].iter().all(|gain| gain.is_none());
        if lacks_gains && matches!(interface, "position" | "velocity") {
            let message = format!(
                "a PID of interface {interface} without gains does nothing: give 'p', 'i' or 'd', or no controller where \
                 the joints are to be limp"
            );
            return Err(raise(py, "ControlError", &message, &fields!(py, "name": "gains")));
        }
        let interface = match interface {
            "position" => Interface::Position,
            "velocity" => Interface::Velocity,
            "effort" => Interface::Effort,
            other => {
                let message =
                    format!("interface is '{other}'; there are 'position', 'velocity' and 'effort'");
                let fields = fields!(py, "name": "interface", "got": other);
                return Err(raise(py, "ControlError", &message, &fields));
            }
        };
        let takes_limits = effort_limit.is_none();
        let gain = |value, name| per_joint(value, name, 0.0);
        let limit = |value, name| per_joint(value, name, f64::INFINITY);
        let (p, i, d) = (gain(p, "p")?, gain(i, "i")?, gain(d, "d")?);
        let (i_limit, effort_limit) = (limit(i_limit, "i_limit")?, limit(effort_limit, "effort_limit")?);
        let count = one_count(py, &[&p, &i, &d, &i_limit, &effort_limit])?;
        let (p, i, d, i_limit, effort_limit) = (p.0, i.0, d.0, i_limit.0, effort_limit.0);
        let law = JointPid { interface, p, i, d, i_limit, effort_limit };
        law.check(count).map_err(|error| error.into_python(py))?;
        Ok(Self { law, takes_limits })
    }
}

/// A number or (k,), and how many.
pub(super) fn per_joint(value: Option<Any<'_, '_>>, name: &str, default: f64) -> PyResult<(PerJoint, usize)> {
    let Some(value) = value else { return Ok((default.into(), 1)) };
    if let Ok(number) = value.extract::<f64>() {
        return Ok((number.into(), 1));
    }
    let input = Input::new(value, name)?;
    match input.shape() {
        [n] if *n > 0 => Ok((PerJoint::new(input.data().to_vec()), *n)),
        other => Err(wrong_shape(value.py(), name, "a number or (k,), one per joint", other)),
    }
}

/// The number of joints that gains with one entry per joint agree on.
fn one_count(py: Python<'_>, gains: &[&(PerJoint, usize)]) -> PyResult<usize> {
    let mut counts: Vec<usize> = gains.iter().map(|gain| gain.1).filter(|n| *n > 1).collect();
    counts.sort_unstable();
    counts.dedup();
    match counts[..] {
        [] => Ok(1),
        [n] => Ok(n),
        _ => {
            let message = format!("gains have {counts:?} entries, they must be for one number of joints");
            Err(raise(py, "ShapeError", &message, &fields!(py, "name": "gains", "got": counts)))
        }
    }
}
