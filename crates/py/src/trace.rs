//! The columns of a run, as read-only views.

use crate::interrupt::abandonable;
use numpy::ndarray::ArrayView;
use numpy::{IxDyn, PyArray, PyArray1, PyArrayDyn, PyArrayMethods};
use onorbit_core::model::Model;
use onorbit_core::number_text::{count, short};
use onorbit_core::simulation::{Trace, certify};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// What a run leaves behind: one row per recorded step, first the initial state, last the end.
///
/// Columns are read-only views, W axes, SI; those a run did not have are None.
#[pyclass(name = "Trace", frozen, module = "onorbit_rs")]
pub(crate) struct PyTrace {
    pub(crate) trace: Trace,
    pub(crate) model: Arc<Model>,
    /// Whether the run came to its end.
    #[pyo3(get)]
    pub(crate) is_complete: bool,
    /// Wall-clock time of the simulation loop, s.
    #[pyo3(get)]
    pub(crate) wall_s: f64,
}

/// Rows of a trace from which on its certificate takes a tenth of a second.
const LONG_TRACE: usize = 1 << 14;

type Column<'py> = Option<Bound<'py, PyArrayDyn<f64>>>;

/// A view of `data` with the trace as its owner.
fn view<'py>(this: &Bound<'py, PyTrace>, data: &[f64], tail: &[usize]) -> PyResult<Column<'py>> {
    if data.is_empty() && !tail.contains(&0) {
        return Ok(None);
    }
    let rows = this.get().trace.rows();
    let shape: Vec<usize> = std::iter::once(rows).chain(tail.iter().copied()).collect();
    let Ok(array) = ArrayView::from_shape(IxDyn(&shape), data) else { return Ok(None) };
    // SAFETY: the columns of a frozen trace are never written nor reallocated, and the view keeps it alive.
    let view = unsafe { PyArray::borrow_from_array(&array, this.clone().into_any()) };
    Ok(Some(view.readwrite().make_nonwriteable().as_any().cast::<PyArrayDyn<f64>>()?.clone()))
}

macro_rules! columns {
    ($($(#[$doc:meta])* $name:ident: |$this:ident| $tail:expr;)*) => {
        #[pymethods]
        impl PyTrace {
            $(
                $(#[$doc])*
                #[getter]
                fn $name<'py>(this: &Bound<'py, Self>) -> PyResult<Column<'py>> {
                    let $this = this.get();
                    view(this, &$this.trace.$name, $tail)
                }
            )*

            /// Names of the columns this run has.
            fn columns(this: &Bound<'_, Self>) -> PyResult<Vec<&'static str>> {
                let mut names = Vec::new();
                $( if Self::$name(this)?.is_some() { names.push(stringify!($name)); } )*
                Ok(names)
            }

            fn __repr__(&self) -> String {
                let end = self.trace.time.last().copied().unwrap_or(0.0);
                let state = if self.is_complete { "complete" } else { "stopped early" };
                format!("<Trace: {} to t = {} s, {state}>", count(self.trace.rows(), "row"), short(end))
            }

            /// The run's conservation certificate: lines (name, value, gate, passed), those that apply to the run.
            ///
            /// Values are relative to scales that do not vanish: see the concepts in the documentation.
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

            /// Names of the joints that a row sees past their position limits, which nothing enforced then.
            fn joint_limits_exceeded(&self) -> Vec<&str> {
                self.trace.limits_exceeded(&self.model)
            }

            /// Tracking errors of several controls by name, desired less actual: (T, 6) of a task, m and rad; (T, k) of k
            /// joints; zeros while the control does not run.
            #[getter]
            fn tracking<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
                let all = PyDict::new(this.py());
                for tracking in &this.get().trace.tracking {
                    all.set_item(&tracking.name, view(this, &tracking.values, &[tracking.width])?)?;
                }
                Ok(all)
            }

            /// Wrench of every effect on every body by the effect's name, (T, bodies, 6): force, N, through the body's centre of
            /// mass and torque, N m, about it, W axes, bodies as in ``model.body_names``; with ``record_wrenches=True``.
            #[getter]
            fn wrenches<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
                let all = PyDict::new(this.py());
                for column in &this.get().trace.wrenches {
                    all.set_item(&column.name, view(this, &column.values, &[column.width / 6, 6])?)?;
                }
                Ok(all)
            }

            /// When the robot had drifted so far from the reference that it was integrated about one of its own, (K,), s.
            #[getter]
            fn rereferenced<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
                PyArray1::from_slice(py, &self.trace.rereferenced)
            }

            /// What came of the goals: dicts of ``name``, ``outcome`` (``succeeded``, ``path_tolerance_violated``,
            /// ``goal_tolerance_violated``, ``unfinished``), ``time`` s, and the ``component`` (a joint, ``position`` or
            /// ``attitude``) and ``error`` that were too large.
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

            /// Number of rows.
            fn __len__(&self) -> usize {
                self.trace.rows()
            }
        }
    };
}

columns! {
    /// Time, (T,), s.
    time: |_t| &[];
    /// Configuration, (T, nq).
    q: |t| &[t.model.nq()];
    /// Velocity, (T, nv).
    v: |t| &[t.model.nv()];
    /// Joint torque held from this row's time to the next step, (T, n), N m.
    tau: |t| &[t.model.joint_count()];
    /// Share of ``tau`` that compensates Coulomb friction, (T, n), N m; where a controller compensates it and
    /// no other engine moves the robot.
    friction_compensation: |t| &[t.model.joint_count().max(1)];
    /// Acceleration just after this row's time, (T, nv).
    acceleration: |t| &[t.model.nv()];
    /// Linear momentum, and angular about the system's centre of mass, (T, 6), kg m/s and kg m²/s, W axes.
    momentum: |_t| &[6];
    /// Integral of external forces and of their moments about the centre of mass, (T, 6), N s and N m s.
    impulse: |_t| &[6];
    /// Kinetic energy in W, (T,), J.
    kinetic_energy: |_t| &[];
    /// Work on the robot in W, (T,), J: of motors and external wrenches, less ``dissipated``.
    work: |_t| &[];
    /// Energy that damping, friction and stops of the joints took, (T,), J.
    dissipated: |_t| &[];
    /// Centre of mass in W, (T, 3), m.
    center_of_mass: |_t| &[3];
    /// Pose of the tool in W, (T, 4, 4), m.
    tool_pose: |_t| &[4, 4];
    /// Desired pose of the tool in W, (T, 4, 4), m.
    reference_pose: |_t| &[4, 4];
    /// Desired less actual position of the tool in W, (T, 3), m.
    position_error: |_t| &[3];
    /// Rotation vector from actual to desired attitude in W axes, (T, 3), rad.
    attitude_error: |_t| &[3];
    /// Position of the base's origin from the planet's centre, inertial axes, (T, 3), m.
    position_eci: |_t| &[3];
    /// Velocity of the base's origin, inertial axes, (T, 3), m/s.
    velocity_eci: |_t| &[3];
    /// Gravity that the reference does not follow and that was left out, inertial axes, (T, 3), m/s²; with
    /// ``gravity_mode="carried"`` around a planet.
    reference_residual: |_t| &[3];
}
