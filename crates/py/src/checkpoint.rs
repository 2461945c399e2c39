//! The class `Checkpoint`: the state of a run, with its rows.

use crate::arrays::{Input, array_of, first_row};
use crate::errors::{IntoPython, SimulationErrorExt, fields, plain, raise};
use crate::world::Systems;
use onorbit_core::model::Model;
use onorbit_core::number_text::{count, short};
use onorbit_core::simulation::{
    self, CONTACTS, LOOPS, NamedColumn, SimulationError, Stepper, TRACKING, Trace, WRENCHES,
};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PySlice};
use std::ffi::CString;
use std::time::{Duration, Instant};

/// Number of rows of a streamed run that are read from a checkpoint at once.
const ROWS_AT_ONCE: usize = 1 << 14;

/// State of a run. :meth:`Simulation.run` and :meth:`Simulation.start` resume from it, bit by bit.
///
/// The checkpoint callback of a run receives checkpoints with the rows since the last checkpoint that it
/// accepted. A run can be resumed only from a checkpoint with all rows, by the version of onorbit_rs that
/// wrote it and with the same instruction set (see :func:`build_info`).
///
/// Parameters
/// ----------
/// state : str
///     State of the run without its rows, as JSON.
/// columns : dict of array
///     Array (rows, width) of each column of the trace, by the name of the column and in its unit. In a world
///     of several systems, the names are paths such as ``chaser/q``.
/// wall_s : float
///     Wall-clock time of the simulation loop so far, s.
#[pyclass(name = "Checkpoint", frozen, get_all, module = "onorbit_rs")]
pub(crate) struct PyCheckpoint {
    /// State of the run without its rows, as JSON.
    state: String,
    /// Array (rows, width) of each column of the trace, by the name of the column and in its unit.
    columns: Py<PyDict>,
    /// Wall-clock time of the simulation loop so far, s.
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
    /// Returns the checkpoint of the core, and the rows of the systems. If `is_streamed`, the rows are read in
    /// blocks, and only the first and the last rows remain.
    pub(crate) fn read(
        &self,
        py: Python<'_>,
        systems: &Systems,
        is_streamed: bool,
    ) -> PyResult<(simulation::Checkpoint, Vec<Trace>)> {
        let refuse =
            |error: simulation::CheckpointError| SimulationError::from(error).into_python_with(py, None);
        let checkpoint = simulation::Checkpoint::from_json(&self.state).map_err(refuse)?;
        let named = systems.names.iter().zip(&systems.models);
        let rows = named.map(|(name, model)| {
            let prefix = prefix(name, systems.names.len());
            self.rows_of(py, &prefix, is_streamed.then_some(&**model))
        });
        Ok((checkpoint, rows.collect::<PyResult<_>>()?))
    }

    /// Returns the rows of one system, in the columns whose names begin with `prefix`. If a model is given,
    /// the rows are read in blocks, and only the first and the last rows remain.
    fn rows_of(&self, py: Python<'_>, prefix: &str, streamed: Option<&Model>) -> PyResult<Trace> {
        let (mut rows, columns) = (Trace::default(), self.columns.bind(py));
        for (name, values) in columns {
            let name: String = name.extract()?;
            let Some(name) = name.strip_prefix(prefix) else { continue };
            let kinds = [
                (&TRACKING, &mut rows.tracking),
                (&WRENCHES, &mut rows.wrenches),
                (&CONTACTS, &mut rows.contacts),
                (&LOOPS, &mut rows.loops),
            ];
            for (kind, named) in kinds {
                if let Some(name) = kind.owner_of(name) {
                    let first = values.get_item(PySlice::new(py, 0, 1, 1))?;
                    let width = Input::new(&first, name)?.shape().get(1).copied().unwrap_or(1);
                    named.push(NamedColumn { name: name.to_owned(), width, values: Vec::new() });
                }
            }
        }
        let Some(model) = streamed else {
            for (name, column) in rows.columns_mut() {
                if let Some(values) = columns.get_item(format!("{prefix}{name}"))? {
                    column.extend_from_slice(Input::new(&values, &name)?.data());
                }
            }
            return Ok(rows);
        };
        let most = columns.iter().filter(|(name, _)| name.to_string().starts_with(prefix));
        let most = most.map(|(_, values)| values.len()).collect::<PyResult<Vec<_>>>()?;
        let most = most.into_iter().max().unwrap_or(0);
        for start in (0..most).step_by(ROWS_AT_ONCE) {
            let some = PySlice::new(py, start as isize, (start + ROWS_AT_ONCE) as isize, 1);
            for (name, column) in rows.columns_mut() {
                if let Some(values) = columns.get_item(format!("{prefix}{name}"))? {
                    column.extend_from_slice(Input::new(&values.get_item(&some)?, &name)?.data());
                }
            }
            py.check_signals()?;
            if rows.has_all_values() {
                simulation::drop_checked_rows(&mut rows, 0, model);
            }
        }
        Ok(rows)
    }
}

/// Returns the prefix of the column names of a system in a run of `count` systems; it is empty for a single
/// system.
pub(crate) fn prefix(system: &str, count: usize) -> String {
    if count == 1 { String::new() } else { format!("{system}/") }
}

/// Index of the first row to return: one for all systems, or one per system by name.
pub(crate) enum Since {
    Every(usize),
    Each(Vec<(String, usize)>),
}

impl<'py> FromPyObject<'_, 'py> for Since {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let Ok(by_name) = value.cast::<PyDict>() else { return first_row(&value).map(Self::Every) };
        let pairs = by_name.iter().map(|(name, row)| Ok((name.extract()?, first_row(&row)?)));
        pairs.collect::<PyResult<_>>().map(Self::Each)
    }
}

impl Since {
    /// Returns the index of the first row for each of the systems with these names; systems that are not
    /// named start at row 0.
    pub(crate) fn rows(&self, py: Python<'_>, systems: &Systems) -> PyResult<Vec<usize>> {
        match self {
            Self::Every(row) => Ok(vec![*row; systems.names.len()]),
            Self::Each(pairs) => {
                let mut rows = vec![0; systems.names.len()];
                for (name, row) in pairs {
                    rows[systems.find(py, name)?] = *row;
                }
                Ok(rows)
            }
        }
    }
}

/// Returns the number of rows that each system has recorded so far.
pub(crate) fn row_counts(stepper: &Stepper<'_>, systems: usize) -> Vec<usize> {
    (0..systems).map(|system| stepper.rows(system).rows()).collect()
}

/// Returns the rows of the systems with these names as a dict of columns. The rows of each system start at
/// its index in `since`, which must be at most its number of rows.
pub(crate) fn columns_since<'py>(
    py: Python<'py>,
    stepper: &Stepper<'_>,
    names: &[String],
    since: &[usize],
) -> PyResult<Bound<'py, PyDict>> {
    let columns = PyDict::new(py);
    for (system, (name, &since)) in names.iter().zip(since).enumerate() {
        let (trace, prefix) = (stepper.rows(system), prefix(name, names.len()));
        let rows = trace.rows();
        if since > rows {
            let whose = if names.len() == 1 { "the run".to_owned() } else { format!("system '{name}'") };
            let message =
                format!("since is {since}, but {whose} has {}; give at most this number", count(rows, "row"));
            return Err(raise(py, "InputError", &message, &fields!(py, "name": "since", "got": since)));
        }
        add_columns(py, &columns, &prefix, trace, since)?;
    }
    Ok(columns)
}

/// Adds the rows of a trace, beginning with row `since`, to a dict of columns, with `prefix` before their
/// names.
pub(crate) fn add_columns(
    py: Python<'_>,
    columns: &Bound<'_, PyDict>,
    prefix: &str,
    trace: &Trace,
    since: usize,
) -> PyResult<()> {
    let rows = trace.rows();
    for (name, column) in trace.columns().filter(|(_, column)| !column.is_empty()) {
        let width = column.len() / rows;
        let values = array_of(py, &[rows - since, width], &column[since * width..]);
        columns.set_item(format!("{prefix}{name}"), values)?;
    }
    Ok(())
}

/// Creates a checkpoint of a run with its rows; `since` contains the index of the first row of each system. A
/// controller that cannot be saved is an error.
pub(crate) fn checkpoint_of(
    py: Python<'_>,
    stepper: &Stepper<'_>,
    names: &[String],
    since: &[usize],
    wall_s: f64,
) -> PyResult<PyCheckpoint> {
    let checkpoint = stepper.checkpoint().map_err(|error| match error {
        SimulationError::Control(error) => {
            let reason = error.into_python(py);
            let message = format!(
                "the controller cannot be saved ({reason}); give it the methods get_state() and set_state()"
            );
            let refused = plain(py, "ControlError", &message);
            refused.set_cause(py, Some(reason));
            refused
        }
        error => error.into_python_with(py, None),
    })?;
    let columns = columns_since(py, stepper, names, since)?.unbind();
    Ok(PyCheckpoint { state: checkpoint.to_json(), columns, wall_s })
}

/// Python callback that receives checkpoints at regular intervals of wall-clock time.
pub(crate) struct CheckpointCallback {
    to: Option<Py<PyAny>>,
    /// Names of the systems.
    names: Vec<String>,
    every: Duration,
    last: Instant,
    /// Rows of each system that the callback has accepted.
    rows: Vec<usize>,
}

impl CheckpointCallback {
    pub(crate) fn new(to: Py<PyAny>, names: Vec<String>, every: Duration, rows: Vec<usize>) -> Self {
        Self { to: Some(to), names, every, last: Instant::now(), rows }
    }

    /// Passes a checkpoint to the callback if the interval since the last one has passed.
    pub(crate) fn save_if_due(&mut self, py: Python<'_>, stepper: &Stepper<'_>, wall_s: f64) -> PyResult<()> {
        if self.last.elapsed() < self.every { Ok(()) } else { self.save(py, stepper, wall_s) }
    }

    /// Passes a checkpoint to the callback. If a controller cannot be saved, a warning is issued and the run
    /// continues without checkpoints. If the callback returns False, the next checkpoint contains the same
    /// rows again.
    pub(crate) fn save(&mut self, py: Python<'_>, stepper: &Stepper<'_>, wall_s: f64) -> PyResult<()> {
        let Some(to) = &self.to else { return Ok(()) };
        let checkpoint = match checkpoint_of(py, stepper, &self.names, &self.rows, wall_s) {
            Ok(checkpoint) => checkpoint,
            Err(error) => {
                self.to = None;
                let message = format!("checkpoints are disabled for this run: {}", error.value(py));
                return PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(message)?, 1);
            }
        };
        let answer = to.call1(py, (checkpoint,))?;
        self.last = Instant::now();
        if !answer.bind(py).is(PyBool::new(py, false)) {
            // if the checkpoint was not stored, the next one contains its rows again
            self.rows = row_counts(stepper, self.names.len());
        }
        Ok(())
    }
}
