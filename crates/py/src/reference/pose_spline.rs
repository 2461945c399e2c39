//! Splines through poses.

use super::{Any, PyReference, poses, row, timing};
use crate::arrays::{Input, wrong_shape};
use crate::pickling::call_of;
use onorbit_core::reference::PoseSpline;
use pyo3::prelude::*;

/// Twice continuously differentiable path through poses, from rest to rest.
///
/// Parameters
/// ----------
/// poses : (K, 4, 4) array
///     Poses of the tool in ``frame``, m.
/// times : (K,) array, optional
///     Times of the poses since the start of the reference, s. By default, the limits determine the times.
///     With stops, each piece takes the shortest time within the limits. With ``stops=False``, these times
///     are multiplied by the common factor with which the motion just reaches one of the limits.
/// speed, acceleration, angular_speed, angular_acceleration : float, optional
///     Limits as for :class:`Line`. Specify either limits or ``times``.
/// stops : bool
///     If True, the tool stops at every pose; if False, the path passes through the poses without stopping.
/// frame : {"world", "lvlh", "base"} or Target, optional
///     Frame of the reference, or ``"SYSTEM/FRAME"`` (see :class:`Reference`); default: W.
///
/// Raises
/// ------
/// ControlError, InputError, ShapeError
///     If times and limits are both given or both missing, a value is invalid, or an array has the wrong
///     shape.
#[pyclass(name = "Waypoints", extends = PyReference, frozen, module = "onorbit_rs")]
pub(super) struct PyWaypoints;

#[pymethods]
impl PyWaypoints {
    #[new]
    #[pyo3(signature = (
        poses, *, times=None, speed=None, acceleration=None, angular_speed=None, angular_acceleration=None, stops=true,
        frame=None,
    ))]
    fn new(
        py: Python<'_>,
        poses: Any<'_, '_>,
        times: Option<Any<'_, '_>>,
        speed: Option<f64>,
        acceleration: Option<f64>,
        angular_speed: Option<f64>,
        angular_acceleration: Option<f64>,
        stops: bool,
        frame: Option<Any<'_, '_>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let call = call_of!(
            py,
            "Waypoints",
            poses,
            times,
            speed,
            acceleration,
            angular_speed,
            angular_acceleration,
            stops,
            frame
        )?;
        let times = times.map(|times| row(times, "times")).transpose()?;
        let limits = [speed, acceleration, angular_speed, angular_acceleration];
        let timing = timing::of_task(py, times, limits)?;
        let path = PoseSpline::waypoints(&self::poses(poses)?, &timing, stops);
        Ok(PyClassInitializer::from(PyReference::new(py, path, frame, call)?).add_subclass(Self))
    }
}

/// Twice continuously differentiable spline through poses at given times.
///
/// Before the first time, the first pose is held; after the last time, the last pose is held.
///
/// Parameters
/// ----------
/// times : (K,) array
///     Times since the start of the reference, s.
/// poses : (K, 4, 4) array
///     Poses of the tool in ``frame``, m.
/// velocities : (K, 6) array, optional
///     Velocities, axes of ``frame``, linear first, m/s and rad/s; default: those of the spline through the
///     poses.
/// frame : {"world", "lvlh", "base"} or Target, optional
///     Frame of the reference, or ``"SYSTEM/FRAME"`` (see :class:`Reference`); default: W.
///
/// Raises
/// ------
/// ControlError, InputError, ShapeError
///     If the times do not increase, a value is invalid, or an array has the wrong shape.
#[pyclass(name = "Sampled", extends = PyReference, frozen, module = "onorbit_rs")]
pub(super) struct PySampled;

#[pymethods]
impl PySampled {
    #[new]
    #[pyo3(signature = (times, poses, *, velocities=None, frame=None))]
    fn new(
        py: Python<'_>,
        times: Any<'_, '_>,
        poses: Any<'_, '_>,
        velocities: Option<Any<'_, '_>>,
        frame: Option<Any<'_, '_>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let call = call_of!(py, "Sampled", times, poses, velocities, frame)?;
        let velocities = velocities.map(|value| Input::new(value, "velocities")).transpose()?;
        if let Some(input) = &velocities
            && !matches!(input.shape(), [_, 6])
        {
            return Err(wrong_shape(py, "velocities", "(K, 6)", input.shape()));
        }
        let velocities = velocities.as_ref().map(Input::data);
        let path = PoseSpline::sampled(&row(times, "times")?, &self::poses(poses)?, velocities);
        Ok(PyClassInitializer::from(PyReference::new(py, path, frame, call)?).add_subclass(Self))
    }
}
