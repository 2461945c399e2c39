//! Constant wrench on a body.

use super::{Any, Kind, PyEffect};
use crate::arrays::vector;
use crate::errors::{IntoPython, fields};
use onorbit_core::environment::BodyWrench;
use pyo3::prelude::*;

/// Constant wrench on a body during an interval of time.
///
/// Steps end exactly at ``start`` and ``end``.
///
/// Parameters
/// ----------
/// body : str
///     Name of a link or frame; in a world of several systems, the path ``SYSTEM/LINK``. The wrench acts at
///     the origin of this frame and is expressed in its axes.
/// force : (3,) array, optional
///     Force, N; default: 0.
/// torque : (3,) array, optional
///     Torque, N m; default: 0.
/// start : float, optional
///     Simulation time at which the wrench begins, s; default: the beginning of the run.
/// end : float, optional
///     Simulation time at which the wrench ends, s; default: the end of the run.
///
/// Raises
/// ------
/// EffectError, InputError, ShapeError
///     If the interval is empty, or a vector is not finite or has the wrong shape.
#[pyclass(name = "BodyWrench", extends = PyEffect, frozen, module = "onorbit_rs")]
pub(super) struct PyBodyWrench;

#[pymethods]
impl PyBodyWrench {
    #[new]
    #[pyo3(signature = (body, *, force=None, torque=None, start=None, end=None))]
    fn new(
        py: Python<'_>,
        body: String,
        force: Option<Any<'_, '_>>,
        torque: Option<Any<'_, '_>>,
        start: Option<f64>,
        end: Option<f64>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let keywords = fields!(py, "body": &body, "start": start, "end": end);
        let (start, end) = (start.unwrap_or(f64::NEG_INFINITY), end.unwrap_or(f64::INFINITY));
        let (force, torque) = (vector(force, "force", [0.0; 3])?, vector(torque, "torque", [0.0; 3])?);
        // the checks do not depend on the body
        BodyWrench::new(0, force, torque)
            .and_then(|wrench| wrench.during(start, end))
            .map_err(|error| error.into_python(py))?;
        keywords.set_item("force", force.as_slice())?;
        keywords.set_item("torque", torque.as_slice())?;
        let kind = Kind::BodyWrench { frame: body, force, torque, start, end };
        Ok(PyEffect::new(kind, "BodyWrench", &keywords)?.add_subclass(Self))
    }
}
