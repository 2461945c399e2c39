//! References for joints.

use super::{Any, PyJointReference, row, timing};
use crate::arrays::{Input, wrong_shape};
use crate::errors::IntoPython;
use onorbit_core::reference::{JointHold, JointPath, JointSpline, ReferenceError};
use pyo3::prelude::*;
use std::sync::Arc;

pub(super) fn add_classes(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<PyJointHold>()?;
    m.add_class::<PyJointWaypoints>()?;
    m.add_class::<PyJointSampled>()
}

fn based<P: JointPath + 'static>(
    py: Python<'_>,
    path: Result<P, ReferenceError>,
) -> PyResult<PyJointReference> {
    Ok(PyJointReference { path: Arc::new(path.map_err(|error| error.into_python(py))?) })
}

/// (K, n) numbers.
fn table<'py>(value: Any<'_, 'py>, name: &str) -> PyResult<(usize, Input<'py>)> {
    let input = Input::new(value, name)?;
    match *input.shape() {
        [_, n] if n > 0 => Ok((n, input)),
        _ => Err(wrong_shape(value.py(), name, "(K, n), one row per point", input.shape())),
    }
}

/// Hold joint positions ``q`` (n,), rad or m.
#[pyclass(name = "JointHold", extends = PyJointReference, frozen, module = "onorbit_rs")]
pub(super) struct PyJointHold;

#[pymethods]
impl PyJointHold {
    #[new]
    fn new(py: Python<'_>, q: Any<'_, '_>) -> PyResult<PyClassInitializer<Self>> {
        Ok(PyClassInitializer::from(based(py, JointHold::new(row(q, "q")?))?).add_subclass(Self))
    }
}

/// Quintics from rest to rest through joint positions ``points`` (K, n), rad or m, all joints together.
///
/// Either ``times`` (K,) s, or limits ``speed`` and ``acceleration``, one number or (n,), kept everywhere and reached by a
/// joint in each piece (with ``stops=False``, which passes through the points, somewhere).
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
        let (count, points) = table(points, "points")?;
        let timing = timing::of_joints(py, count, times, speed, acceleration)?;
        Ok(PyClassInitializer::from(based(py, JointSpline::waypoints(count, points.data(), &timing, stops))?)
            .add_subclass(Self))
    }

    /// From ``start`` (n,) one joint after the other: ``moves`` lists (joint's index, its new position), each from rest
    /// to rest; ``times`` or limits as in the constructor.
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
        let start = row(start, "start")?;
        let timing = timing::of_joints(py, start.len(), times, speed, acceleration)?;
        let base = based(py, JointSpline::one_by_one(&start, &moves, &timing))?;
        Bound::new(py, PyClassInitializer::from(base).add_subclass(Self))
    }
}

/// A motion of joints sampled at ``times`` (K,) s: ``positions`` (K, n), ``rates`` (K, n) where known.
///
/// The C² spline through them; before and after, the ends are held.
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
        let (times, (count, positions)) = (row(times, "times")?, table(positions, "positions")?);
        let rates = rates.map(|rates| table(rates, "rates")).transpose()?;
        let rates = rates.as_ref().map(|(_, rates)| rates.data());
        Ok(PyClassInitializer::from(based(py, JointSpline::sampled(count, &times, positions.data(), rates))?)
            .add_subclass(Self))
    }
}
