//! Recorded distances and forces of a contact.

use crate::columns::part_of;
use onorbit_core::number_text::count;
use onorbit_core::simulation::CONTACTS;
use pyo3::prelude::*;

/// Recorded distances and forces of a contact, with one row for each of the ``T`` rows of the trace.
///
/// The forces between two rows may be much larger than in the rows, because an impact can be shorter than the
/// interval between them. With ``record_every=1``, every step is a row while bodies touch.
#[pyclass(name = "ContactTrace", frozen, module = "onorbit_rs")]
pub(crate) struct PyContactTrace {
    /// Array (T, 19) with all quantities, in the order of ``onorbit_rs.COLUMNS["contacts"].parts``.
    #[pyo3(get)]
    values: Py<PyAny>,
}

impl PyContactTrace {
    pub(crate) fn new(values: Py<PyAny>) -> Self {
        Self { values }
    }
}

#[pymethods]
impl PyContactTrace {
    /// Smallest distance between the two sides, (T,), m; minus the depth of the overlap if they overlap.
    #[getter]
    fn gap<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        part_of(&CONTACTS, self.values.bind(py), "gap")
    }

    /// Force on the second side, (T, 3), N, axes of W.
    #[getter]
    fn force<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        part_of(&CONTACTS, self.values.bind(py), "force")
    }

    /// Point at which the force acts, (T, 3), m, in W; without a force, midway between the nearest points of
    /// both sides. If several pairs of convex pieces touch, it is that of the pair with the smallest gap.
    #[getter]
    fn point<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        part_of(&CONTACTS, self.values.bind(py), "point")
    }

    /// Unit normal from the first side to the second, (T, 3), axes of W.
    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        part_of(&CONTACTS, self.values.bind(py), "normal")
    }

    /// Magnitude of the sliding velocity at ``point``, (T,), m/s.
    #[getter]
    fn slip<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        part_of(&CONTACTS, self.values.bind(py), "sliding_speed")
    }

    /// Power that the contact removes from the motion and stores or dissipates, (T,), W.
    #[getter]
    fn power<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        part_of(&CONTACTS, self.values.bind(py), "power")
    }

    /// Elastic energy stored in the contact, (T,), J.
    #[getter]
    fn elastic<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        part_of(&CONTACTS, self.values.bind(py), "elastic")
    }

    /// Energy that the contact has dissipated since the start of the run, (T,), J. It decreases, and may become
    /// negative, if the elastic energy of contacts between polyhedra changes discontinuously; see the limits of
    /// contacts in the documentation.
    #[getter]
    fn dissipated<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        part_of(&CONTACTS, self.values.bind(py), "dissipated")
    }

    /// Impulse of the contact on the second side since the start of the run, (T, 3), N s, axes of W.
    #[getter]
    fn impulse<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        part_of(&CONTACTS, self.values.bind(py), "impulse")
    }

    /// Number of times that the sides have touched since the start of the run, (T,).
    #[getter]
    fn touches<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        part_of(&CONTACTS, self.values.bind(py), "touches")
    }

    /// Largest normal force since the start of the run, (T,), N, including the steps between two rows.
    #[getter]
    fn largest_force<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        part_of(&CONTACTS, self.values.bind(py), "largest_force")
    }

    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        self.values.bind(py).len()
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("<ContactTrace: {}>", count(self.__len__(py)?, "row")))
    }
}
