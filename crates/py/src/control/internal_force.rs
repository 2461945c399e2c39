//! Commanded internal forces of closed loops.

use crate::arrays::fixed;
use crate::pickling::{ConstructorCall, Reduced};
use onorbit_core::control::InternalForce;
use pyo3::prelude::*;
use pyo3::types::PyDict;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Force that a control commands a closed loop to transmit, such as the force with which two hands squeeze a
/// load.
///
/// Force and moment act on the second body of the loop. They are expressed in the axes of the loop's joint on
/// its first frame, and the moment is about the origin of this joint. For a capture that closes a loop, they
/// are the wrench of the capturing frame on the captured system, in the axes of the captured frame about its
/// origin; ``trace.loops`` records the same wrench in the axes of W. The torques that produce an internal
/// force do not move the robot.
///
/// Parameters
/// ----------
/// loop : str
///     Name of a loop of the robot, or of the capture that closes it. While the loop is not closed, the force
///     has no effect.
/// force : (3,) array, optional
///     Force, N. Default: the force is not commanded and results from the joint torques with the least norm.
/// moment : (3,) array, optional
///     Moment, N m. Default: the moment is not commanded and results from the joint torques with the least
///     norm.
///
/// Raises
/// ------
/// InputError, ShapeError
///     If a number is not finite, or an array has the wrong shape.
#[pyclass(name = "InternalForce", frozen, module = "onorbit_rs", eq)]
#[derive(Clone, PartialEq)]
pub(crate) struct PyInternalForce {
    pub(super) force: InternalForce,
}

#[pymethods]
impl PyInternalForce {
    #[new]
    #[pyo3(signature = (r#loop, *, force=None, moment=None))]
    fn new(r#loop: &str, force: Option<Any<'_, '_>>, moment: Option<Any<'_, '_>>) -> PyResult<Self> {
        let read =
            |part: Option<Any<'_, '_>>, name| part.map(|part| fixed::<3>(part, name, &[3])).transpose();
        let (force, moment) = (read(force, "force")?, read(moment, "moment")?);
        Ok(Self { force: InternalForce { closure: r#loop.to_owned(), force, moment } })
    }

    /// Name of the loop, or of the capture that closes it.
    #[getter]
    fn r#loop(&self) -> &str {
        &self.force.closure
    }

    /// Force, N; None if it is not commanded.
    #[getter]
    fn force(&self) -> Option<[f64; 3]> {
        self.force.force
    }

    /// Moment, N m; None if it is not commanded.
    #[getter]
    fn moment(&self) -> Option<[f64; 3]> {
        self.force.moment
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let keywords = PyDict::new(py);
        keywords.set_item("force", self.force.force)?;
        keywords.set_item("moment", self.force.moment)?;
        ConstructorCall::new("InternalForce", (&self.force.closure,), &keywords)?.reduce(py)
    }
}
