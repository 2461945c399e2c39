//! The class `Trace`, whose columns are read-only views.

use crate::contact::PyContactTrace;
use crate::interrupt::abandonable;
use crate::recorded_loop::PyLoopTrace;
use crate::world::PyEventRecord;
use numpy::ndarray::ArrayView;
use numpy::{IxDyn, PyArray, PyArray1, PyArrayDyn, PyArrayMethods};
use onorbit_core::model::Model;
use onorbit_core::number_text::{count, short};
use onorbit_core::simulation::{COLUMNS, CONTACTS, Condition, EventRecord, LOOPS, Trace, WRENCHES, certify};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Result of a run, with one row per recorded step. The first row is the initial state, and the last row is
/// the final state.
///
/// The columns are read-only views in SI units; a column that does not apply to the run is None.
/// ``onorbit_rs.COLUMNS`` describes the shape, unit, frame and meaning of each column.
#[pyclass(name = "Trace", frozen, module = "onorbit_rs")]
pub(crate) struct PyTrace {
    pub(crate) trace: Trace,
    pub(crate) model: Arc<Model>,
    /// Events that concern the system, and the names of all systems.
    pub(crate) events: Vec<EventRecord>,
    pub(crate) names: Arc<[String]>,
    /// True if the run reached its end.
    #[pyo3(get)]
    pub(crate) is_complete: bool,
    /// Wall-clock time of the simulation loop, s.
    #[pyo3(get)]
    pub(crate) wall_s: f64,
}

/// Smallest number of rows for which the certificate is computed on a separate thread; from this size on,
/// the computation takes more than a tenth of a second.
const LONG_TRACE: usize = 1 << 14;

type Column<'py> = Option<Bound<'py, PyArrayDyn<f64>>>;

/// Returns a read-only view of a column with the shape `row` of each row; `None` if the run did not record
/// the column.
fn view<'py>(this: &Bound<'py, PyTrace>, data: &[f64], row: &[usize]) -> PyResult<Column<'py>> {
    let shape: Vec<usize> = std::iter::once(this.get().trace.rows()).chain(row.iter().copied()).collect();
    let Ok(array) = ArrayView::from_shape(IxDyn(&shape), data) else { return Ok(None) };
    // SAFETY: the columns of a frozen trace are never written or reallocated, and the view keeps the trace
    // alive.
    let view = unsafe { PyArray::borrow_from_array(&array, this.clone().into_any()) };
    Ok(Some(view.readwrite().make_nonwriteable().as_any().cast::<PyArrayDyn<f64>>()?.clone()))
}

/// Returns the view of the column `name` of the table; `None` if the run did not record the column.
fn described<'py>(this: &Bound<'py, PyTrace>, name: &str, data: &[f64]) -> PyResult<Column<'py>> {
    let column = COLUMNS.iter().find(|column| column.name == name).expect("every field is in the table");
    let row = column.row_shape(&this.get().model);
    // a robot without joints has torque columns of width zero
    let is_recorded = !data.is_empty() || (column.condition == Condition::Always && row.contains(&0));
    if is_recorded { view(this, data, &row) } else { Ok(None) }
}

/// Declares the methods of the class, among them a getter for each row of the table of columns.
macro_rules! getters {
    ($($name:ident ($($axis:tt),+), $unit:literal, $frame:literal, $condition:ident, $parts:ident,
        $meaning:literal;)+) => {
        #[pymethods]
        impl PyTrace {
            $(
                #[doc = concat!($meaning, " Shape ", stringify!(($($axis),+)), ", unit ", $unit, ".")]
                #[getter]
                fn $name<'py>(this: &Bound<'py, Self>) -> PyResult<Column<'py>> {
                    described(this, stringify!($name), &this.get().trace.$name)
                }
            )+

            /// Return the names of the columns that the run recorded, except ``tracking``, ``wrenches``,
            /// ``contacts``, ``loops`` and ``rereferenced``.
            ///
            /// Returns
            /// -------
            /// list of str
            ///     Names in the order of ``onorbit_rs.COLUMNS``.
            fn columns(this: &Bound<'_, Self>) -> PyResult<Vec<&'static str>> {
                let mut names = Vec::new();
                $( if Self::$name(this)?.is_some() { names.push(stringify!($name)); } )+
                Ok(names)
            }

            fn __repr__(&self) -> String {
                let end = self.trace.time.last().copied().unwrap_or(0.0);
                let state = if self.is_complete { "complete" } else { "stopped early" };
                format!("<Trace: {} to t = {} s, {state}>", count(self.trace.rows(), "row"), short(end))
            }

            /// Return the conservation certificate of the run.
            ///
            /// Returns
            /// -------
            /// list of tuple
            ///     ``(name, value, gate, passed)`` for each check that applies to the run; ``gate`` is the
            ///     largest accepted value. Values are relative to nonzero scales and dimensionless, except
            ///     angles in rad, whose names end in ``_rad``, and ``loop_opening``, in m or rad.
            fn certificate(this: &Bound<'_, Self>) -> PyResult<Vec<(&'static str, f64, f64, bool)>> {
                let of = |this: &PyTrace| certify(&this.model, &this.trace).checks();
                let (own, shared) = (this.get(), this.clone().unbind());
                let checks = if own.trace.rows() < LONG_TRACE {
                    this.py().detach(|| of(own))
                } else {
                    abandonable(this.py(), move || of(shared.get()))?
                };
                Ok(checks.iter().map(|check| (check.name, check.value, check.gate, check.passed())).collect())
            }

            /// Return the names of the joints that exceed their position limits in any row by more than 1e-9
            /// rad or m.
            ///
            /// Returns
            /// -------
            /// list of str
            ///     Names; empty if no joint exceeds a limit.
            fn joint_limits_exceeded(&self) -> Vec<&str> {
                self.trace.limits_exceeded(&self.model)
            }

            /// Tracking errors (desired minus actual) by the name of the control: (T, 6) for a tool, m and rad;
            /// (T, k) for k joints, rad or m (rad/s or m/s for a :class:`JointPid` with the interface
            /// ``velocity``); or (T, 1) for a :class:`GripForce`, N. They are zero while the control is inactive.
            #[getter]
            fn tracking<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
                let all = PyDict::new(this.py());
                for tracking in &this.get().trace.tracking {
                    all.set_item(&tracking.name, view(this, &tracking.values, &[tracking.width])?)?;
                }
                Ok(all)
            }

            /// Wrenches by the name of the effect, (T, bodies, 6), W axes: the force on each body, N, which
            /// acts at its centre of mass, and the torque about its centre of mass, N m. Bodies are in the
            /// order of ``model.body_names``. Empty unless ``record_wrenches=True``.
            #[getter]
            fn wrenches<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
                let (all, row) = (PyDict::new(this.py()), WRENCHES.row_shape(&this.get().model));
                for column in &this.get().trace.wrenches {
                    all.set_item(&column.name, view(this, &column.values, &row)?)?;
                }
                Ok(all)
            }

            /// Distances and forces of the contacts whose first side is this system: one
            /// :class:`ContactTrace` by the name of each contact.
            #[getter]
            fn contacts<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
                let (all, row) = (PyDict::new(this.py()), CONTACTS.row_shape(&this.get().model));
                for column in &this.get().trace.contacts {
                    let values = view(this, &column.values, &row)?.into_pyobject(this.py())?.unbind();
                    all.set_item(&column.name, PyContactTrace::new(values.into_any()))?;
                }
                Ok(all)
            }

            /// Forces of the closed loops whose first frame belongs to the system: one :class:`LoopTrace` by
            /// the name of each loop, or of the capture that closes it.
            #[getter]
            fn loops<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
                let (all, row) = (PyDict::new(this.py()), LOOPS.row_shape(&this.get().model));
                for column in &this.get().trace.loops {
                    let values = view(this, &column.values, &row)?.into_pyobject(this.py())?.unbind();
                    all.set_item(&column.name, PyLoopTrace::new(values.into_any()))?;
                }
                Ok(all)
            }

            /// Events that concern the system, in order of time: those of its brakes and contacts, and the
            /// captures and releases in which it is one of the two systems. Empty for a run without a world.
            #[getter]
            fn events(&self) -> Vec<PyEventRecord> {
                self.events.iter().map(|record| PyEventRecord::of(record, &self.names)).collect()
            }

            /// Times at which integration continued about a new reference orbit, because the robot had
            /// drifted too far from the previous reference orbit: (K,), s.
            #[getter]
            fn rereferenced<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
                PyArray1::from_slice(py, &self.trace.rereferenced)
            }

            /// Outcomes of the goals, one dict for each.
            ///
            /// ``name`` is the name of the control, and ``outcome`` is ``succeeded``,
            /// ``path_tolerance_violated``, ``goal_tolerance_violated`` or ``unfinished``. ``time`` is the
            /// simulation time of the decision, s (None if unfinished). ``component`` is the joint,
            /// ``position``, ``attitude`` or ``force`` whose error was too large, and ``error`` is this error,
            /// m or rad (m/s or rad/s if rates are commanded; N for ``force``). Both have the value None unless
            /// a tolerance was violated.
            #[getter]
            fn results<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
                let all = self.trace.results.iter().map(|result| {
                    let dict = PyDict::new(py);
                    dict.set_item("name", &result.name)?;
                    dict.set_item("outcome", result.outcome.name())?;
                    dict.set_item("time", result.outcome.time())?;
                    dict.set_item("component", &result.component)?;
                    dict.set_item("error", result.outcome.miss().map(|miss| miss.error))?;
                    Ok(dict)
                });
                all.collect()
            }

            /// Return the number of rows.
            fn __len__(&self) -> usize {
                self.trace.rows()
            }
        }
    };
}

onorbit_core::trace_columns!(getters);
