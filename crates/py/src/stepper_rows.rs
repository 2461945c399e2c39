//! Methods of the class `Stepper` that return or delete recorded rows.

use crate::arrays::array_of;
use crate::checkpoint::{Since, add_columns, columns_since, prefix};
use crate::stepper::PyStepper;
use crate::stepper_advance::ended;
use onorbit_core::simulation::world_rows_between;
use pyo3::prelude::*;
use pyo3::types::PyDict;

#[pymethods]
impl PyStepper {
    /// Return the rows recorded so far as columns, without a row at the current time.
    ///
    /// Parameters
    /// ----------
    /// since : int or dict of int, optional
    ///     Index of the first row, at most the number of rows; default: 0. In a world, also a dict by system.
    ///
    /// Returns
    /// -------
    /// dict of array
    ///     Array (rows, width) of each column of the trace, by the name of the column and in its unit. In a
    ///     world of several systems, the names are paths such as ``chaser/q``.
    #[pyo3(signature = (since=Since::Every(0)), text_signature = "($self, since=0)")]
    fn columns(&self, py: Python<'_>, since: Since) -> PyResult<Py<PyDict>> {
        let since = since.rows(py, &self.systems)?;
        let columns = self.with(py, |stepper| match stepper.has_ended() {
            true => Err(ended(py)),
            false => columns_since(py, stepper, &self.systems.names, &since),
        })??;
        Ok(columns.unbind())
    }

    /// Return the row at the current time as columns, as if the run ended now. The cost does not depend on
    /// the number of rows of the run.
    ///
    /// Returns
    /// -------
    /// dict of array
    ///     Columns (1, width), named as those of :meth:`columns`.
    fn present(&self, py: Python<'_>) -> PyResult<Py<PyDict>> {
        let rows = self.try_with(py, |stepper| stepper.present_rows())?;
        let columns = PyDict::new(py);
        for (name, row) in self.systems.names.iter().zip(&rows) {
            add_columns(py, &columns, &prefix(name, rows.len()), row, 0)?;
        }
        Ok(columns.unbind())
    }

    /// Return the momentum and energy of all systems in an interval of time, as in :class:`WorldTrace`.
    ///
    /// Parameters
    /// ----------
    /// since, until : float
    ///     Interval ``since <= t < until``, s. The rows of all systems in this interval must be in memory.
    ///
    /// Returns
    /// -------
    /// dict of array
    ///     ``time``, (T,), s; ``momentum``, (T, 6), N s and N m s; ``kinetic_energy``, (T,), J.
    fn world_columns(&self, py: Python<'_>, since: f64, until: f64) -> PyResult<Py<PyDict>> {
        let rows = self.with(py, |stepper| {
            let pairs = self.systems.models.iter().enumerate();
            let pairs = pairs.map(|(system, model)| (stepper.rows(system), &**model));
            world_rows_between(&pairs.collect::<Vec<_>>(), since, until)
        })?;
        let (columns, count) = (PyDict::new(py), rows.rows());
        columns.set_item("time", array_of(py, &[count], &rows.time))?;
        columns.set_item("momentum", array_of(py, &[count, 6], &rows.momentum))?;
        columns.set_item("kinetic_energy", array_of(py, &[count], &rows.kinetic_energy))?;
        Ok(columns.unbind())
    }

    /// Delete all recorded rows but the first and the last ones, which limits the memory of a long run.
    ///
    /// The motion does not change. A later checkpoint can be resumed only together with the deleted rows. If
    /// every step is recorded and ``checked`` is False, the certificate omits the checks that compare
    /// successive steps.
    ///
    /// Parameters
    /// ----------
    /// keep : int
    ///     Number of last rows of each system that are kept; at least 16 if ``checked``.
    /// checked : bool
    ///     If True, the rows are checked before they are deleted, which takes some microseconds per row, and
    ///     the certificate is that of a run that keeps all rows.
    #[pyo3(signature = (keep, *, checked=false))]
    fn drop_rows(&self, py: Python<'_>, keep: usize, checked: bool) -> PyResult<()> {
        self.with(py, |stepper| match checked {
            true => stepper.drop_checked_rows(keep),
            false => stepper.drop_rows(keep),
        })
    }
}
