//! References of joints.

use super::{Any, PyJointReference, row, timing};
use crate::arrays::{Input, wrong_shape};
use crate::errors::IntoPython;
use crate::pickling::{ConstructorCall, call_of};
use onorbit_core::reference::{JointHold, JointPath, JointSpline, ReferenceError};
use pyo3::prelude::*;
use std::sync::Arc;

pub(super) fn add_classes(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<PyJointHold>()?;
    m.add_class::<PyJointWaypoints>()?;
    m.add_class::<PyJointSampled>()
}

impl PyJointReference {
    /// Creates the base object of a reference; `constructor_call` is used to pickle it.
    fn new<P: JointPath + 'static>(
        py: Python<'_>,
        path: Result<P, ReferenceError>,
        constructor_call: ConstructorCall,
    ) -> PyResult<Self> {
        Ok(Self { path: Arc::new(path.map_err(|error| error.into_python(py))?), constructor_call })
    }
}

/// Reads a (K, n) array with one row per point and one column per joint. Returns n and the array.
fn table<'py>(value: Any<'_, 'py>, name: &str) -> PyResult<(usize, Input<'py>)> {
    let input = Input::new(value, name)?;
    match *input.shape() {
        [_, n] if n > 0 => Ok((n, input)),
        _ => Err(wrong_shape(
            value.py(),
            name,
            "(K, n) with n at least 1, one row per point and one column per joint",
            input.shape(),
        )),
    }
}

/// Reference that holds constant joint positions.
///
/// Parameters
/// ----------
/// q : (n,) array
///     Joint positions, rad or m.
///
/// Raises
/// ------
/// ControlError, ShapeError
///     If a position is not finite, or ``q`` is not a vector.
#[pyclass(name = "JointHold", extends = PyJointReference, frozen, module = "onorbit_rs")]
pub(super) struct PyJointHold;

#[pymethods]
impl PyJointHold {
    #[new]
    fn new(py: Python<'_>, q: Any<'_, '_>) -> PyResult<PyClassInitializer<Self>> {
        let call = call_of!(py, "JointHold", q)?;
        Ok(PyClassInitializer::from(PyJointReference::new(py, JointHold::new(row(q, "q")?), call)?)
            .add_subclass(Self))
    }
}

/// Twice continuously differentiable path through joint positions, from rest to rest. All joints reach each
/// point at the same time.
///
/// Parameters
/// ----------
/// points : (K, n) array
///     Joint positions, one row per point, rad or m.
/// times : (K,) array, optional
///     Times of the points since the start of the reference, s. By default, the limits determine the times.
///     With stops, each piece takes the shortest time within ``speed`` and ``acceleration``. With
///     ``stops=False``, these times are multiplied by the common factor with which a joint just reaches one
///     of its limits.
/// speed, acceleration : float or (n,) array, optional
///     Limits of the rates, rad/s or m/s, and of the accelerations, rad/s² or m/s². Specify either limits or
///     ``times``.
/// stops : bool
///     If True, the joints stop at every point; if False, the path passes through the points without
///     stopping.
///
/// Raises
/// ------
/// ControlError, ShapeError
///     If times and limits are both given or both missing, if a value is invalid, or if an array has the
///     wrong shape.
#[pyclass(name = "JointWaypoints", extends = PyJointReference, frozen, module = "onorbit_rs")]
pub(super) struct PyJointWaypoints;

#[pymethods]
impl PyJointWaypoints {
    #[new]
    #[pyo3(signature = (points, *, times=None, speed=None, acceleration=None, stops=true))]
    fn new(
        py: Python<'_>,
        points: Any<'_, '_>,
        times: Option<Any<'_, '_>>,
        speed: Option<Any<'_, '_>>,
        acceleration: Option<Any<'_, '_>>,
        stops: bool,
    ) -> PyResult<PyClassInitializer<Self>> {
        let call = call_of!(py, "JointWaypoints", points, times, speed, acceleration, stops)?;
        let (count, points) = table(points, "points")?;
        let timing = timing::of_joints(py, count, times, speed, acceleration)?;
        Ok(PyClassInitializer::from(PyJointReference::new(
            py,
            JointSpline::waypoints(count, points.data(), &timing, stops),
            call,
        )?)
        .add_subclass(Self))
    }

    /// Return a path in which the joints move one after the other, each from rest to rest.
    ///
    /// Parameters
    /// ----------
    /// start : (n,) array
    ///     Initial positions, rad or m.
    /// moves : list of tuple of int and float
    ///     Motions in their order: each is the index of the joint that moves and its new position, rad or m.
    /// times, speed, acceleration
    ///     Times or limits, as in the constructor.
    ///
    /// Returns
    /// -------
    /// JointWaypoints
    ///
    /// Raises
    /// ------
    /// ControlError, ShapeError
    ///     If an index is not that of a joint, or for the reasons stated for the constructor.
    #[staticmethod]
    #[pyo3(signature = (start, moves, *, times=None, speed=None, acceleration=None))]
    fn one_by_one<'py>(
        py: Python<'py>,
        start: Any<'_, 'py>,
        moves: Vec<(usize, f64)>,
        times: Option<Any<'_, 'py>>,
        speed: Option<Any<'_, 'py>>,
        acceleration: Option<Any<'_, 'py>>,
    ) -> PyResult<Bound<'py, Self>> {
        let call = {
            let moves = moves.clone();
            call_of!(py, "JointWaypoints.one_by_one", start, moves, times, speed, acceleration)?
        };
        let start = row(start, "start")?;
        let timing = timing::of_joints(py, start.len(), times, speed, acceleration)?;
        let base = PyJointReference::new(py, JointSpline::one_by_one(&start, &moves, &timing), call)?;
        Bound::new(py, PyClassInitializer::from(base).add_subclass(Self))
    }
}

/// Twice continuously differentiable spline through joint positions at given times.
///
/// Before the first time the joints rest at the first positions, and after the last time at the last
/// positions. The rate therefore jumps at an end at which the rate of the spline is not zero.
///
/// Parameters
/// ----------
/// times : (K,) array
///     Times since the start of the reference, s.
/// positions : (K, n) array
///     Joint positions, one row per time, rad or m.
/// rates : (K, n) array, optional
///     Joint rates, rad/s or m/s; default: those of the spline through the positions.
///
/// Raises
/// ------
/// ControlError, ShapeError
///     If the times do not increase, a number is not finite, or an array has the wrong shape.
#[pyclass(name = "JointSampled", extends = PyJointReference, frozen, module = "onorbit_rs")]
pub(super) struct PyJointSampled;

#[pymethods]
impl PyJointSampled {
    #[new]
    #[pyo3(signature = (times, positions, *, rates=None))]
    fn new(
        py: Python<'_>,
        times: Any<'_, '_>,
        positions: Any<'_, '_>,
        rates: Option<Any<'_, '_>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let call = call_of!(py, "JointSampled", times, positions, rates)?;
        let (times, (count, positions)) = (row(times, "times")?, table(positions, "positions")?);
        let rates = rates.map(|rates| table(rates, "rates")).transpose()?;
        let rates = rates.as_ref().map(|(_, rates)| rates.data());
        Ok(PyClassInitializer::from(PyJointReference::new(
            py,
            JointSpline::sampled(count, &times, positions.data(), rates),
            call,
        )?)
        .add_subclass(Self))
    }
}
