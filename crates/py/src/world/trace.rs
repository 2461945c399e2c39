//! The class `WorldTrace`: the result of a run of several systems.

use super::event_record::PyEventRecord;
use super::systems::{attribute_of_systems, find};
use crate::arrays::array_of;
use crate::trace::PyTrace;
use numpy::PyArrayDyn;
use onorbit_core::number_text::{count, short};
use onorbit_core::simulation::{Check, EventRecord, GroupBalance, WorldRows, world_rows};
use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::OnceLock;

/// Result of a run of a world: the traces of its systems, its events, and its momentum and energy.
///
/// ``trace["chaser"]`` is the :class:`Trace` of a system, with all of its rows. The columns of the world have
/// only the rows at times that all systems recorded. Systems that may interact, for example because events
/// may connect them or because they may touch, form a group and have the same rows. Systems of different
/// groups share the multiples of ``record_every`` steps and the end of the run, but the rows at events,
/// impacts and control ticks are those of one group. If only some systems have a row both before and after an
/// event, the row of the world is the one after the event.
#[pyclass(name = "WorldTrace", frozen, module = "onorbit_rs")]
pub(crate) struct PyWorldTrace {
    names: Vec<String>,
    traces: Vec<Py<PyTrace>>,
    records: Vec<EventRecord>,
    groups: Vec<GroupBalance>,
    /// Columns of the world, which are computed on first use.
    rows: OnceLock<WorldRows>,
    /// True if the run reached its end.
    #[pyo3(get)]
    is_complete: bool,
    /// Wall-clock time of the simulation loop, s.
    #[pyo3(get)]
    wall_s: f64,
}

impl PyWorldTrace {
    pub(super) fn new(
        names: Vec<String>,
        traces: Vec<Py<PyTrace>>,
        (records, groups): (Vec<EventRecord>, Vec<GroupBalance>),
        (is_complete, wall_s): (bool, f64),
    ) -> Self {
        Self { names, traces, records, groups, rows: OnceLock::new(), is_complete, wall_s }
    }

    /// Returns the columns of the world, which the first call computes.
    fn rows(&self) -> &WorldRows {
        self.rows.get_or_init(|| {
            let pairs = self.traces.iter().map(|trace| (&trace.get().trace, &*trace.get().model));
            world_rows(&pairs.collect::<Vec<_>>())
        })
    }

    fn column<'py>(&self, py: Python<'py>, values: &[f64], width: usize) -> Bound<'py, PyArrayDyn<f64>> {
        let rows = self.rows().rows();
        if width == 1 { array_of(py, &[rows], values) } else { array_of(py, &[rows, width], values) }
    }
}

#[pymethods]
impl PyWorldTrace {
    /// Return the trace of a system.
    ///
    /// Raises
    /// ------
    /// WorldError
    ///     If there is no such system.
    fn __getitem__(&self, py: Python<'_>, name: &str) -> PyResult<Py<PyTrace>> {
        Ok(self.traces[find(py, &self.names, name)?].clone_ref(py))
    }

    fn __getattr__(&self, py: Python<'_>, name: &str) -> PyResult<Py<PyAny>> {
        let owns = self.traces.first().is_some_and(|trace| trace.bind(py).hasattr(name).unwrap_or(false));
        Err(if owns {
            attribute_of_systems(&self.names, "trace", name)
        } else {
            PyAttributeError::new_err(format!(
                "the trace of a world has no attribute '{name}'; the traces of its systems are trace['{}']",
                self.names.join("'], trace['")
            ))
        })
    }

    /// Names of the systems.
    #[getter]
    fn names(&self) -> Vec<String> {
        self.names.clone()
    }

    /// Events that happened, in order of time.
    #[getter]
    fn events(&self) -> Vec<PyEventRecord> {
        self.records.iter().map(|record| PyEventRecord::of(record, &self.names)).collect()
    }

    /// Distances and forces of the contacts: one :class:`ContactTrace` by the name of each contact. Its rows
    /// are those of the trace of the system that is the first side of the contact.
    #[getter]
    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for trace in &self.traces {
            let own = trace.bind(py).getattr("contacts")?;
            all.update(own.cast::<PyDict>()?.as_mapping())?;
        }
        Ok(all)
    }

    /// Times of the rows that all systems recorded, (T,), s.
    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<f64>> {
        self.column(py, &self.rows().time, 1)
    }

    /// Linear momentum of all systems, N s, and their angular momentum about the common centre of mass,
    /// N m s, axes of W, (T, 6).
    #[getter]
    fn momentum<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<f64>> {
        self.column(py, &self.rows().momentum, 6)
    }

    /// Kinetic energy of all systems, (T,), J.
    #[getter]
    fn kinetic_energy<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<f64>> {
        self.column(py, &self.rows().kinetic_energy, 1)
    }

    /// Return the certificate of the world: checks of the momentum and energy of each group of systems that
    /// may interact, and checks of each event.
    ///
    /// Returns
    /// -------
    /// list of tuple
    ///     ``(name, value, gate, passed)`` for each check, where ``gate`` is the largest accepted value. The
    ///     name of a check begins with the names of the systems of the group, or with the name of the event.
    ///     The certificate of one system is ``trace[name].certificate()``.
    fn certificate(&self) -> Vec<(String, f64, f64, bool)> {
        let mut all = Vec::new();
        let mut add =
            |whose: &str, checks: Vec<Check>| {
                let rows = checks.into_iter();
                all.extend(rows.map(|check| {
                    (format!("{whose}/{}", check.name), check.value, check.gate, check.passed())
                }));
            };
        for group in &self.groups {
            let names: Vec<&str> = group.systems.iter().map(|system| self.names[*system].as_str()).collect();
            add(&names.join("+"), group.checks());
        }
        self.records.iter().for_each(|record| add(&record.name, record.checks()));
        all
    }

    /// Return the number of rows that all systems have in common.
    fn __len__(&self) -> usize {
        self.rows().rows()
    }

    fn __repr__(&self) -> String {
        let end = self.rows().time.last().copied().unwrap_or(0.0);
        let state = if self.is_complete { "complete" } else { "stopped early" };
        let events = count(self.records.len(), "event");
        format!("<WorldTrace of {}: to t = {} s, {events}, {state}>", self.names.join(", "), short(end))
    }
}
