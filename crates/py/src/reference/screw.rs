//! References that rotate about a line, with or without translation along it.

use super::{Any, PyReference, pose, timing, vector};
use crate::pickling::call_of;
use onorbit_core::reference::{ReferenceError, Screw};
use pyo3::prelude::*;

/// Rotation of the tool about a line.
///
/// Parameters
/// ----------
/// start_pose : (4, 4) array
///     Initial pose of the tool in ``frame``, m.
/// center : (3,) array
///     Any point of the line, in ``frame``, m.
/// axis : (3,) array
///     Direction of the line, axes of ``frame``, of any length except zero.
/// angle : float
///     Angle of rotation about ``axis``, right-handed, rad.
/// turns : bool
///     If True, the attitude rotates with the position; otherwise it is constant.
/// ramp : float, optional
///     If given, the rate is constant between two ramps, each of which takes this fraction of the duration;
///     otherwise the angle is a quintic polynomial of time.
/// duration, speed, acceleration, angular_speed, angular_acceleration : float, optional
///     Duration or limits, as for :class:`Line`.
/// frame : {"world", "lvlh", "base"} or Target, optional
///     Frame of the reference, or ``"SYSTEM/FRAME"`` (see :class:`Reference`); default: W.
///
/// Raises
/// ------
/// ControlError, InputError, ShapeError
///     If the duration and limits are both given or both missing, a value is invalid, such as a zero
///     ``axis``, or an array has the wrong shape.
#[pyclass(name = "Circle", extends = PyReference, frozen, module = "onorbit_rs")]
pub(super) struct PyCircle;

#[pymethods]
impl PyCircle {
    #[new]
    #[pyo3(signature = (
        start_pose, *, center, axis, angle, turns=true, ramp=None, duration=None, speed=None, acceleration=None,
        angular_speed=None, angular_acceleration=None, frame=None,
    ))]
    fn new(
        py: Python<'_>,
        start_pose: Any<'_, '_>,
        center: Any<'_, '_>,
        axis: Any<'_, '_>,
        angle: f64,
        turns: bool,
        ramp: Option<f64>,
        duration: Option<f64>,
        speed: Option<f64>,
        acceleration: Option<f64>,
        angular_speed: Option<f64>,
        angular_acceleration: Option<f64>,
        frame: Option<Any<'_, '_>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let call = call_of!(
            py,
            "Circle",
            start_pose,
            center,
            axis,
            angle,
            turns,
            ramp,
            duration,
            speed,
            acceleration,
            angular_speed,
            angular_acceleration,
            frame
        )?;
        let limits = [speed, acceleration, angular_speed, angular_acceleration];
        let path = screw(py, start_pose, [center, axis], [angle, 0.0], turns, (ramp, duration, limits))?;
        Ok(PyClassInitializer::from(PyReference::new(py, path, frame, call)?).add_subclass(Self))
    }
}

/// Rotation about a line with translation along it: the exponential of a twist on SE(3).
///
/// Parameters
/// ----------
/// start_pose, center, axis, angle
///     Initial pose, line and angle of rotation, as for :class:`Circle`.
/// advance : float
///     Translation along ``axis`` during the whole motion, m.
/// turns, ramp
///     Options, as for :class:`Circle`.
/// duration, speed, acceleration, angular_speed, angular_acceleration : float, optional
///     Duration or limits, as for :class:`Line`.
/// frame : {"world", "lvlh", "base"} or Target, optional
///     Frame of the reference, or ``"SYSTEM/FRAME"`` (see :class:`Reference`); default: W.
///
/// Raises
/// ------
/// ControlError, InputError, ShapeError
///     As for :class:`Circle`.
#[pyclass(name = "Screw", extends = PyReference, frozen, module = "onorbit_rs")]
pub(super) struct PyScrew;

#[pymethods]
impl PyScrew {
    #[new]
    #[pyo3(signature = (
        start_pose, *, center, axis, angle, advance, turns=true, ramp=None, duration=None, speed=None, acceleration=None,
        angular_speed=None, angular_acceleration=None, frame=None,
    ))]
    fn new(
        py: Python<'_>,
        start_pose: Any<'_, '_>,
        center: Any<'_, '_>,
        axis: Any<'_, '_>,
        angle: f64,
        advance: f64,
        turns: bool,
        ramp: Option<f64>,
        duration: Option<f64>,
        speed: Option<f64>,
        acceleration: Option<f64>,
        angular_speed: Option<f64>,
        angular_acceleration: Option<f64>,
        frame: Option<Any<'_, '_>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let call = call_of!(
            py,
            "Screw",
            start_pose,
            center,
            axis,
            angle,
            advance,
            turns,
            ramp,
            duration,
            speed,
            acceleration,
            angular_speed,
            angular_acceleration,
            frame
        )?;
        let limits = [speed, acceleration, angular_speed, angular_acceleration];
        let path = screw(py, start_pose, [center, axis], [angle, advance], turns, (ramp, duration, limits))?;
        Ok(PyClassInitializer::from(PyReference::new(py, path, frame, call)?).add_subclass(Self))
    }
}

/// Returns the path of a circle or, with an `advance`, m, that is not zero, of a screw.
fn screw(
    py: Python<'_>,
    start_pose: Any<'_, '_>,
    [center, axis]: [Any<'_, '_>; 2],
    [angle, advance]: [f64; 2],
    turns: bool,
    (ramp, duration, limits): (Option<f64>, Option<f64>, [Option<f64>; 4]),
) -> PyResult<Result<Screw, ReferenceError>> {
    let (start, center, axis) = (pose(start_pose)?, vector(center, "center")?, vector(axis, "axis")?);
    let timing = timing::of_task(py, duration, limits)?;
    Ok(Screw::timed(start, center, axis, angle, advance, turns, &timing, ramp))
}
