//! Recorded forces of a closed loop.

use crate::columns::part_of;
use onorbit_core::number_text::count;
use onorbit_core::simulation::LOOPS;
use pyo3::prelude::*;

/// Recorded forces of a closed loop, with one row for each of the ``T`` rows of the trace.
///
/// The rows of a loop that a capture closes are zero before the capture and after its release.
#[pyclass(name = "LoopTrace", frozen, module = "onorbit_rs")]
pub(crate) struct PyLoopTrace {
    /// Array (T, 11) with all quantities, in the order of ``onorbit_rs.COLUMNS["loops"].parts``.
    #[pyo3(get)]
    values: Py<PyAny>,
}

impl PyLoopTrace {
    pub(crate) fn new(values: Py<PyAny>) -> Self {
        Self { values }
    }
}

#[pymethods]
impl PyLoopTrace {
    /// Force of the loop on its second frame, (T, 3), N, axes of W.
    #[getter]
    fn force<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        part_of(&LOOPS, self.values.bind(py), "force")
    }

    /// Moment of the loop on its second frame about ``point``, (T, 3), N m, axes of W.
    #[getter]
    fn moment<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        part_of(&LOOPS, self.values.bind(py), "moment")
    }

    /// Origin of the loop's joint on its second frame, (T, 3), m, in W.
    #[getter]
    fn point<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        part_of(&LOOPS, self.values.bind(py), "point")
    }

    /// Constraint error of the loop: the distance, m, and the angle, rad, by which it is open, (T, 2).
    #[getter]
    fn opening<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        part_of(&LOOPS, self.values.bind(py), "opening")
    }

    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        self.values.bind(py).len()
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("<LoopTrace: {}>", count(self.__len__(py)?, "row")))
    }
}
