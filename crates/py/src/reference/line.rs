//! References along a straight line from rest to rest.

use super::{Any, PyReference, pose, timing};
use crate::pickling::call_of;
use onorbit_core::reference::{Line, TimeLaw, Timing};
use pyo3::prelude::*;

/// Straight line from rest to rest. The attitude changes by the shortest rotation, about a fixed axis.
///
/// Parameters
/// ----------
/// start_pose, end_pose : (4, 4) array
///     Initial and final pose of the tool in ``frame``, m.
/// duration : float, optional
///     Duration, s. Default: the shortest duration within the limits below, of which at least one is then
///     required.
/// speed, acceleration : float, optional
///     Limits of the speed and acceleration of the tool's origin, m/s and m/s².
/// angular_speed, angular_acceleration : float, optional
///     Limits of the angular velocity and acceleration, rad/s and rad/s². Limits cannot be combined with
///     ``duration``.
/// frame : {"world", "lvlh", "base"} or Target, optional
///     Frame of the reference, or ``"SYSTEM/FRAME"`` (see :class:`Reference`); default: W.
///
/// Raises
/// ------
/// ControlError, InputError, ShapeError
///     If the duration and limits are both given or both missing, a value is invalid, or an array has the
///     wrong shape.
#[pyclass(name = "Line", extends = PyReference, frozen, module = "onorbit_rs")]
pub(super) struct PyLine;

#[pymethods]
impl PyLine {
    #[new]
    #[pyo3(signature = (
        start_pose, end_pose, *, duration=None, speed=None, acceleration=None, angular_speed=None,
        angular_acceleration=None, frame=None,
    ))]
    fn new(
        py: Python<'_>,
        start_pose: Any<'_, '_>,
        end_pose: Any<'_, '_>,
        duration: Option<f64>,
        speed: Option<f64>,
        acceleration: Option<f64>,
        angular_speed: Option<f64>,
        angular_acceleration: Option<f64>,
        frame: Option<Any<'_, '_>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let call = call_of!(
            py,
            "Line",
            start_pose,
            end_pose,
            duration,
            speed,
            acceleration,
            angular_speed,
            angular_acceleration,
            frame
        )?;
        let (start, end) = (pose(start_pose)?, pose(end_pose)?);
        let limits = [speed, acceleration, angular_speed, angular_acceleration];
        let line = match timing::of_task(py, duration, limits)? {
            Timing::Given(duration) => TimeLaw::quintic(duration).map(|law| Line::new(start, &end, law)),
            Timing::Limits(limits) => Line::within(start, &end, &limits),
        };
        Ok(PyClassInitializer::from(PyReference::new(py, line, frame, call)?).add_subclass(Self))
    }
}
