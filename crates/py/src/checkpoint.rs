//! Where a run stands, for Python to keep and to go on from.

use crate::arrays::{Input, array_of};
use crate::errors::{IntoPython, SimulationErrorExt};
use onorbit_core::number_text::{count, short};
use onorbit_core::simulation::{self, Moment, NamedColumn, SimulationError, Trace};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict};
use std::ffi::CString;
use std::time::{Duration, Instant};

/// Where a run stands between two steps: :meth:`Simulation.run` goes on from one with the same bits.
///
/// ``state`` is text with every number to its last bit; ``columns`` maps the trace's names to rows (k, width): those since
/// the last checkpoint where a run hands one out, all of them where a run goes on from one; ``wall_s`` is the time that
/// the simulation loop has taken so far.
#[pyclass(name = "Checkpoint", frozen, get_all, module = "onorbit_rs")]
pub(crate) struct PyCheckpoint {
    /// Everything of the run that its rows do not hold, as text (JSON).
    state: String,
    /// Rows of each column of the trace by its name, each (k, width), in the column's unit.
    columns: Py<PyDict>,
    /// Time that the simulation loop has taken so far, s.
    pub(crate) wall_s: f64,
}

#[pymethods]
impl PyCheckpoint {
    #[new]
    #[pyo3(signature = (state, columns, *, wall_s=0.0))]
    fn new(state: String, columns: Py<PyDict>, wall_s: f64) -> Self {
        Self { state, columns, wall_s }
    }

    fn __repr__(&self) -> String {
        match simulation::Checkpoint::from_json(&self.state) {
            Ok(checkpoint) => {
                format!(
                    "<Checkpoint: t = {} s, {}>",
                    short(checkpoint.time()),
                    count(checkpoint.rows(), "row")
                )
            }
            Err(_) => "<Checkpoint: unreadable>".to_owned(),
        }
    }
}

impl PyCheckpoint {
    /// What the core goes on from.
    pub(crate) fn read(&self, py: Python<'_>) -> PyResult<(simulation::Checkpoint, Trace)> {
        let refuse =
            |error: simulation::CheckpointError| SimulationError::from(error).into_python_with(py, None);
        let checkpoint = simulation::Checkpoint::from_json(&self.state).map_err(refuse)?;
        let (mut rows, columns) = (Trace::default(), self.columns.bind(py));
        for (name, values) in columns {
            let name: String = name.extract()?;
            for (kind, named) in [("tracking_", &mut rows.tracking), ("wrench_", &mut rows.wrenches)] {
                if let Some(name) = name.strip_prefix(kind) {
                    let width = Input::new(&values, name)?.shape().get(1).copied().unwrap_or(1);
                    named.push(NamedColumn { name: name.to_owned(), width, values: Vec::new() });
                }
            }
        }
        for (name, column) in rows.columns_mut() {
            if let Some(values) = columns.get_item(&*name)? {
                column.extend_from_slice(Input::new(&values, &name)?.data());
            }
        }
        Ok((checkpoint, rows))
    }
}

/// Hands checkpoints to Python at a steady wall-clock pace.
pub(crate) struct Keeper {
    to: Option<Py<PyAny>>,
    every: Duration,
    last: Instant,
    rows: usize,
    wall_before: f64,
    start: Instant,
}

impl Keeper {
    /// `rows` and `wall_before` belong to an earlier part of the run.
    pub(crate) fn new(to: Option<Py<PyAny>>, every: Duration, rows: usize, wall_before: f64) -> Self {
        let now = Instant::now();
        Self { to, every, last: now, rows, wall_before, start: now }
    }

    /// Time of the simulation loop so far, s.
    pub(crate) fn wall(&self) -> f64 {
        self.wall_before + self.start.elapsed().as_secs_f64()
    }

    /// Hands one out if it is due.
    pub(crate) fn keep_if_due(&mut self, py: Python<'_>, now: &Moment<'_>) -> PyResult<()> {
        if self.last.elapsed() < self.every { Ok(()) } else { self.keep(py, now) }
    }

    /// Hands one out.
    pub(crate) fn keep(&mut self, py: Python<'_>, now: &Moment<'_>) -> PyResult<()> {
        let Some(to) = &self.to else { return Ok(()) };
        let checkpoint = match now.checkpoint() {
            Ok(checkpoint) => checkpoint,
            Err(error) => {
                self.to = None; // the run matters more than a way to go on with it
                let message = format!(
                    "no checkpoints of this run: its controller cannot be saved ({}); give it get_state() and set_state()",
                    error.into_python(py)
                );
                return PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(message)?, 1);
            }
        };
        let (columns, rows) = (PyDict::new(py), now.trace.rows());
        for (name, column) in now.trace.columns().filter(|(_, column)| !column.is_empty()) {
            let width = column.len() / rows;
            let since = &column[self.rows * width..];
            columns.set_item(name, array_of(py, &[rows - self.rows, width], since))?;
        }
        let state = checkpoint.to_json();
        let checkpoint = PyCheckpoint { state, columns: columns.unbind(), wall_s: self.wall() };
        let answer = to.call1(py, (checkpoint,))?;
        self.last = Instant::now();
        if !answer.bind(py).is(PyBool::new(py, false)) {
            self.rows = rows; // where it was not kept, its rows come again with the next
        }
        Ok(())
    }
}
