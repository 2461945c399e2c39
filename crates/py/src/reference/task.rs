//! References for a tool.

use super::frame::Frame;
use super::{Any, PyReference, pose, poses, row, timing};
use crate::arrays::{Input, fixed, wrong_shape};
use crate::errors::IntoPython;
use nalgebra::Vector3;
use onorbit_core::reference::{
    Line, LineParabola, PoseSpline, ReferenceError, Screw, TaskPath, TimeLaw, Timing,
};
use pyo3::prelude::*;
use std::sync::Arc;

pub(super) fn add_classes(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<PyHold>()?;
    m.add_class::<PyLineParabola>()?;
    m.add_class::<PyLine>()?;
    m.add_class::<PyCircle>()?;
    m.add_class::<PyScrew>()?;
    m.add_class::<PyWaypoints>()?;
    m.add_class::<PySampled>()
}

fn based<P: TaskPath + 'static>(
    py: Python<'_>,
    path: Result<P, ReferenceError>,
    frame: Option<Any<'_, '_>>,
) -> PyResult<PyReference> {
    let path = path.map_err(|error| error.into_python(py))?;
    Ok(PyReference { path: Arc::new(path), frame: Frame::of(frame)? })
}

fn vector(value: Any<'_, '_>, name: &str) -> PyResult<Vector3<f64>> {
    Ok(fixed::<3>(value, name, &[3])?.into())
}

/// Hold a ``pose`` (4, 4).
#[pyclass(name = "Hold", extends = PyReference, frozen, module = "onorbit_rs")]
pub(super) struct PyHold;

#[pymethods]
impl PyHold {
    #[new]
    #[pyo3(signature = (pose, *, frame=None))]
    fn new(
        py: Python<'_>,
        pose: Any<'_, '_>,
        frame: Option<Any<'_, '_>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        Ok(PyClassInitializer::from(based(py, Ok(self::pose(pose)?), frame)?).add_subclass(Self))
    }
}

/// ``p(t) = p0 + s d + s (1 - s) h`` with ``s`` the quintic from 0 to 1 over ``duration`` s, attitude held.
///
/// ``start_pose`` (4, 4); ``displacement`` ``d`` (3,) m; ``height`` ``h`` (3,) m, a quarter of it is reached half way.
#[pyclass(name = "LineParabola", extends = PyReference, frozen, module = "onorbit_rs")]
pub(super) struct PyLineParabola;

#[pymethods]
impl PyLineParabola {
    #[new]
    #[pyo3(signature = (start_pose, *, displacement, duration, height=None, frame=None))]
    fn new(
        py: Python<'_>,
        start_pose: Any<'_, '_>,
        displacement: Any<'_, '_>,
        duration: f64,
        height: Option<Any<'_, '_>>,
        frame: Option<Any<'_, '_>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let start = pose(start_pose)?;
        let displacement = vector(displacement, "displacement")?;
        let height = height.map_or(Ok(Vector3::zeros()), |value| vector(value, "height"))?;
        Ok(PyClassInitializer::from(based(
            py,
            LineParabola::from_pose(start, displacement, height, duration),
            frame,
        )?)
        .add_subclass(Self))
    }
}

/// Straight from ``start_pose`` to ``end_pose`` (4, 4), from rest to rest; the attitude on the geodesic of SO(3).
///
/// Takes ``duration`` s, or as long as the limits on ``speed`` m/s, ``acceleration`` m/s², ``angular_speed`` rad/s and
/// ``angular_acceleration`` rad/s² ask for.
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
        let (start, end) = (pose(start_pose)?, pose(end_pose)?);
        let limits = [speed, acceleration, angular_speed, angular_acceleration];
        let line = match timing::of_task(py, duration, limits)? {
            Timing::Given(duration) => TimeLaw::quintic(duration).map(|law| Line::new(start, &end, law)),
            Timing::Limits(limits) => Line::within(start, &end, &limits),
        };
        Ok(PyClassInitializer::from(based(py, line, frame)?).add_subclass(Self))
    }
}

/// Round the line through ``center`` (3,) m along ``axis`` (3,) by ``angle`` rad, from ``start_pose`` (4, 4).
///
/// The attitude turns along, or is held with ``turns=False``. ``duration`` or limits as for :class:`Line`; the quintic, or
/// with ``ramp`` a constant rate between two ramps, each that share of the duration.
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
        let limits = [speed, acceleration, angular_speed, angular_acceleration];
        let path = screw(py, start_pose, [center, axis], [angle, 0.0], turns, (ramp, duration, limits))?;
        Ok(PyClassInitializer::from(based(py, path, frame)?).add_subclass(Self))
    }
}

/// As :class:`Circle`, while it advances by ``advance`` m along the axis: the exponential of a twist on SE(3).
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
        let limits = [speed, acceleration, angular_speed, angular_acceleration];
        let path = screw(py, start_pose, [center, axis], [angle, advance], turns, (ramp, duration, limits))?;
        Ok(PyClassInitializer::from(based(py, path, frame)?).add_subclass(Self))
    }
}

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

/// Quintics from rest to rest through ``poses`` (K, 4, 4), twice continuously differentiable.
///
/// Either ``times`` (K,) s, or limits as for :class:`Line`, kept everywhere and reached in each piece (with
/// ``stops=False``, which passes through the poses, somewhere).
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
        let times = times.map(|times| row(times, "times")).transpose()?;
        let limits = [speed, acceleration, angular_speed, angular_acceleration];
        let timing = timing::of_task(py, times, limits)?;
        Ok(PyClassInitializer::from(based(
            py,
            PoseSpline::waypoints(&self::poses(poses)?, &timing, stops),
            frame,
        )?)
        .add_subclass(Self))
    }
}

/// A motion sampled at ``times`` (K,) s: ``poses`` (K, 4, 4), ``velocities`` (K, 6) where known, linear first.
///
/// The C² spline through them; before and after, the ends are held.
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
        let velocities = velocities.map(|value| Input::new(value, "velocities")).transpose()?;
        if let Some(input) = &velocities
            && !matches!(input.shape(), [_, 6])
        {
            return Err(wrong_shape(py, "velocities", "(K, 6)", input.shape()));
        }
        let velocities = velocities.as_ref().map(Input::data);
        let path = PoseSpline::sampled(&row(times, "times")?, &self::poses(poses)?, velocities);
        Ok(PyClassInitializer::from(based(py, path, frame)?).add_subclass(Self))
    }
}
