//! Runs that are advanced step by step.

use crate::arrays::constant;
use crate::checkpoint::{PyCheckpoint, Since, checkpoint_of, columns_since, row_counts};
use crate::errors::{SimulationErrorExt, plain};
use crate::interrupt::{PACE, period};
use crate::run_failure::{interrupted, run_failure};
use crate::shared_run::{Runs, SharedRun};
use crate::torques::torques;
use crate::world::{PyEventRecord, PySystemStepper, Systems};
use numpy::PyArrayDyn;
use onorbit_core::number_text::short;
use onorbit_core::simulation::{Recording, RunFailure, SimulationError, Stepper};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ops::ControlFlow;
use std::sync::{Arc, MutexGuard};
use std::time::{Duration, Instant};

/// Callback at regular intervals of wall-clock time, which receives the run and its wall-clock time so far, s.
type Pause<'a> = &'a mut dyn FnMut(Python<'_>, &mut Stepper<'_>, f64) -> PyResult<()>;

/// Run that is advanced step by step, as returned by :meth:`Simulation.start`.
///
/// ``advance`` and ``advance_to`` do not change the motion: the steps are those of :meth:`Simulation.run`. If
/// the current time lies within a step, the state is computed by dense output (adaptive steps) or by a shorter
/// step; the whole step is taken later.
#[pyclass(name = "Stepper", frozen, module = "onorbit_rs")]
pub(crate) struct PyStepper {
    run: SharedRun,
    number: u64,
    systems: Arc<Systems>,
}

#[pymethods]
impl PyStepper {
    /// Current time, s.
    #[getter]
    fn time(&self, py: Python<'_>) -> PyResult<f64> {
        self.with(py, |stepper| stepper.time())
    }

    /// Planned end of the run, s; None without one.
    #[getter]
    fn duration(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        self.with(py, |stepper| stepper.duration())
    }

    /// Configuration at the current time, a read-only (nq,) array: base position in W, m; base quaternion xyzw;
    /// joint positions, rad or m.
    #[getter]
    fn q<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.state(py, self.only("q")?).map(|(q, _)| constant(py, &q))
    }

    /// Velocity at the current time, a read-only (nv,) array: base twist in base axes, m/s and rad/s; joint
    /// rates, rad/s or m/s.
    #[getter]
    fn v<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.state(py, self.only("v")?).map(|(_, v)| constant(py, &v))
    }

    /// Advance the run by a time interval.
    ///
    /// Parameters
    /// ----------
    /// dt : float
    ///     Simulated time, s; must be positive.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     If ``dt`` is not positive and finite, or leads past the planned end; the run is unchanged.
    /// RunInterrupted
    ///     At Ctrl-C, at a step before the requested time; ``trace`` holds the rows so far, and the run can
    ///     be advanced further.
    /// SimulationError
    ///     If the run diverges; ``trace`` holds the rows so far, and the run has ended.
    fn advance(&self, py: Python<'_>, dt: f64) -> PyResult<()> {
        let mut runs = self.run.lock(py)?;
        let after = runs.with(self.number, |stepper| stepper.time_after(dt)).ok_or_else(|| ended(py))?;
        let t = after.map_err(|error| error.into_python_with(py, None))?;
        self.advance_locked(py, &mut runs, t, None, &mut |py, _, _| py.check_signals())
    }

    /// Advance the run to a given time.
    ///
    /// Parameters
    /// ----------
    /// t : float
    ///     Time, s, not before the current time.
    /// wall_s : float, optional
    ///     Wall-clock time after which the call returns early, at the end of a step, s. Default: no limit.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     If ``t`` is not finite, in the past, or after the planned end; the run is unchanged.
    /// RunInterrupted
    ///     At Ctrl-C, at a step before the requested time; ``trace`` holds the rows so far, and the run can
    ///     be advanced further.
    /// SimulationError
    ///     If the run diverges; ``trace`` holds the rows so far, and the run has ended.
    #[pyo3(signature = (t, *, wall_s=None))]
    fn advance_to(&self, py: Python<'_>, t: f64, wall_s: Option<f64>) -> PyResult<()> {
        let limit = wall_s.map(|seconds| period(py, "wall_s", seconds)).transpose()?;
        let mut runs = self.run.lock(py)?;
        self.advance_locked(py, &mut runs, t, limit, &mut |py, _, _| py.check_signals())
    }

    /// Set the joint torques, which are held from the current time until the next command.
    ///
    /// The current time becomes the end of a step. The trace is bit-identical to that of a run whose controller
    /// returns the same torques at the same times; with an adaptive integrator, the lengths of the steps before
    /// these times may differ.
    ///
    /// Parameters
    /// ----------
    /// tau : (n,) array or dict of float
    ///     Torques of all joints, or torques by joint name, N m (N for a prismatic joint). Joints that are not
    ///     named keep their torques.
    ///
    /// Raises
    /// ------
    /// ShapeError
    ///     If the array does not have one entry per joint.
    /// InputError
    ///     If a torque is not finite, or a name is not that of a joint.
    /// ControlError
    ///     If an active controller drives one of the joints.
    fn command(&self, tau: &Bound<'_, PyAny>) -> PyResult<()> {
        let system = self.only("command")?;
        self.command_system(system, tau)
    }

    /// Trigger an event that happens on command, at the current time.
    ///
    /// The current time becomes the end of a step; the event happens at the start of the next one.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     Name of the event.
    ///
    /// Raises
    /// ------
    /// WorldError
    ///     If there is no such event, it has happened, or it does not happen on command; the run is unchanged.
    fn trigger(&self, py: Python<'_>, name: &str) -> PyResult<()> {
        self.try_with(py, |stepper| stepper.trigger(name))
    }

    /// Events of the world in the steps that are complete, in order of time; those of the current step follow at its end.
    #[getter]
    fn events(&self, py: Python<'_>) -> PyResult<Vec<PyEventRecord>> {
        self.with(py, |stepper| self.systems.events(stepper))
    }

    /// Return the view of the system with this name.
    ///
    /// Raises
    /// ------
    /// WorldError
    ///     If there is no such system.
    fn __getitem__(this: &Bound<'_, Self>, name: &str) -> PyResult<PySystemStepper> {
        let system = this.get().systems.find(this.py(), name)?;
        Ok(PySystemStepper { stepper: this.clone().unbind(), system })
    }

    /// Return the trace so far, with its last row at the current time.
    ///
    /// Returns
    /// -------
    /// Trace or WorldTrace
    ///     A copy, which does not change when the run continues.
    fn trace(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let recording = self.try_with(py, |stepper| stepper.recording())?;
        let wall_s = self.run.lock(py)?.wall_s;
        let is_complete = self.with(py, |stepper| Some(stepper.time()) == stepper.duration())?;
        self.systems.wrap(py, recording, is_complete, wall_s)
    }

    /// End the run at the current time and return its trace, without copying the rows.
    ///
    /// Returns
    /// -------
    /// Trace or WorldTrace
    fn finish(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let is_complete =
            self.with(py, |stepper| stepper.duration().is_none_or(|end| stepper.time() == end))?;
        self.end(py, &mut self.run.lock(py)?, is_complete)
    }

    /// Return the rows recorded so far as columns, without a row at the current time.
    ///
    /// Parameters
    /// ----------
    /// since : int or dict of int, optional
    ///     First row to return; in a world, systems may record different numbers of rows: a dict has the first row
    ///     by the name of the system (default: 0).
    ///
    /// Returns
    /// -------
    /// dict of array
    ///     Rows (k, width) of each column of the trace by its name, in the unit of the column. In a world of several
    ///     systems, the names are paths such as ``chaser/q``.
    #[pyo3(signature = (since=Since::Every(0)), text_signature = "($self, since=0)")]
    fn columns(&self, py: Python<'_>, since: Since) -> PyResult<Py<PyDict>> {
        let since = since.rows(py, &self.systems)?;
        let columns = self.with(py, |stepper| match stepper.has_ended() {
            true => Err(ended(py)),
            false => columns_since(py, stepper, &self.systems.names, &since),
        })??;
        Ok(columns.unbind())
    }

    /// Return a checkpoint, from which :meth:`Simulation.start` resumes with identical bits.
    ///
    /// Parameters
    /// ----------
    /// since : int or dict of int, optional
    ///     First row of ``columns``, as for :meth:`columns`; a checkpoint can be resumed only if it contains all rows.
    ///
    /// Returns
    /// -------
    /// Checkpoint
    ///
    /// Raises
    /// ------
    /// ControlError
    ///     If the state of a Python controller cannot be saved; the run is unchanged.
    #[pyo3(signature = (since=Since::Every(0)), text_signature = "($self, since=0)")]
    fn checkpoint(&self, py: Python<'_>, since: Since) -> PyResult<PyCheckpoint> {
        let wall_s = self.run.lock(py)?.wall_s;
        let since = since.rows(py, &self.systems)?;
        self.with(py, |stepper| checkpoint_of(py, stepper, &self.systems.names, &since, wall_s))?
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let text = self.with(py, |stepper| match stepper.duration() {
            Some(end) => format!("<Stepper: at t = {} s of {} s>", short(stepper.time()), short(end)),
            None => format!("<Stepper: at t = {} s>", short(stepper.time())),
        });
        Ok(text.unwrap_or_else(|_| "<Stepper: ended or in use>".to_owned()))
    }
}

impl PyStepper {
    pub(crate) fn new(run: SharedRun, number: u64, systems: Arc<Systems>) -> Self {
        Self { run, number, systems }
    }

    /// Returns the number of the only system, whose attribute `what` was asked for.
    fn only(&self, what: &str) -> PyResult<usize> {
        self.systems.only("stepper", what).map(|()| 0)
    }

    /// Sets the torques of a system.
    pub(crate) fn command_system(&self, system: usize, tau: &Bound<'_, PyAny>) -> PyResult<()> {
        let torques = torques(&self.systems.models[system], tau)?;
        self.try_with(tau.py(), |stepper| stepper.command(system, &torques))
    }

    /// Runs to the end and returns the whole trace; `pause` is called at intervals.
    pub(crate) fn run_to_end(&self, py: Python<'_>, duration: f64, pause: Pause<'_>) -> PyResult<Py<PyAny>> {
        let mut runs = self.run.lock(py)?;
        if let Err(error) = self.advance_locked(py, &mut runs, duration, None, pause) {
            runs.end(self.number);
            return Err(error);
        }
        self.end(py, &mut runs, true)
    }

    /// Ends the run and returns its trace.
    fn end(&self, py: Python<'_>, runs: &mut MutexGuard<'_, Runs>, is_complete: bool) -> PyResult<Py<PyAny>> {
        let finished = runs.with(self.number, |stepper| py.detach(|| stepper.finish()));
        let wall_s = runs.wall_s;
        runs.end(self.number);
        match finished.ok_or_else(|| ended(py))? {
            Ok(recording) => self.systems.wrap(py, recording, is_complete, wall_s),
            Err(RunFailure { error, recording }) => Err(self.ended_early(py, error, *recording, wall_s)),
        }
    }

    /// Advances in slices of wall-clock time, without the GIL.
    fn advance_locked(
        &self,
        py: Python<'_>,
        runs: &mut MutexGuard<'_, Runs>,
        t: f64,
        limit: Option<Duration>,
        pause: Pause<'_>,
    ) -> PyResult<()> {
        let (start, wall_before) = (Instant::now(), runs.wall_s);
        let slice = limit.map_or(PACE, |limit| limit.min(PACE));
        loop {
            let wall_s = wall_before + start.elapsed().as_secs_f64();
            let advanced = runs.with(self.number, |stepper| {
                let result = py.detach(|| {
                    let from = Instant::now();
                    stepper.advance_until(t, &mut |_| match from.elapsed() < slice {
                        true => ControlFlow::Continue(()),
                        false => ControlFlow::Break(()),
                    })
                });
                match result {
                    Ok(ControlFlow::Continue(())) => Ok(true),
                    Ok(ControlFlow::Break(())) => match pause(py, stepper, wall_s) {
                        Ok(()) => Ok(limit.is_some_and(|limit| start.elapsed() >= limit)),
                        Err(error) => Err(self.stopped(py, stepper, error, wall_s)),
                    },
                    Err(error) => Err(self.failed(py, stepper, error, wall_s)),
                }
            });
            runs.wall_s = wall_before + start.elapsed().as_secs_f64();
            let is_done = advanced.ok_or_else(|| ended(py))?;
            runs.warn(py, self.number)?;
            if is_done? {
                return Ok(());
            }
        }
    }

    /// Returns the exception for an error of the core, with the rows of the run if the error ended it.
    fn failed(
        &self,
        py: Python<'_>,
        stepper: &mut Stepper<'_>,
        error: SimulationError,
        wall_s: f64,
    ) -> PyErr {
        if !stepper.has_failed() {
            return error.into_python_with(py, None);
        }
        let recording = stepper.finish().unwrap_or_default();
        self.ended_early(py, error, recording, wall_s)
    }

    /// Returns the exception for an error that ended the run, with its rows.
    fn ended_early(
        &self,
        py: Python<'_>,
        error: SimulationError,
        recording: Recording,
        wall_s: f64,
    ) -> PyErr {
        let last = recording.systems.first().and_then(|trace| trace.time.last().copied());
        run_failure(py, error, last, self.systems.wrap(py, recording, false, wall_s).ok())
    }

    /// Returns the exception for a signal or an error of a callback between two steps.
    fn stopped(&self, py: Python<'_>, stepper: &mut Stepper<'_>, error: PyErr, wall_s: f64) -> PyErr {
        let time = stepper.time();
        match stepper.recording() {
            Ok(recording) => {
                interrupted(py, error, time, self.systems.wrap(py, recording, false, wall_s).ok())
            }
            Err(failure) => self.failed(py, stepper, failure, wall_s),
        }
    }

    fn with<R>(&self, py: Python<'_>, work: impl FnOnce(&mut Stepper<'_>) -> R) -> PyResult<R> {
        self.run.lock(py)?.with(self.number, work).ok_or_else(|| ended(py))
    }

    /// Returns the number of rows that each system has recorded so far.
    pub(crate) fn row_counts(&self, py: Python<'_>) -> PyResult<Vec<usize>> {
        self.with(py, |stepper| row_counts(stepper, self.systems.names.len()))
    }

    /// Calls `work`, in which a Python controller may run, and converts its error.
    fn try_with<R>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Stepper<'_>) -> Result<R, SimulationError>,
    ) -> PyResult<R> {
        let mut runs = self.run.lock(py)?;
        let wall_s = runs.wall_s;
        let result = runs.with(self.number, |stepper| {
            work(stepper).map_err(|error| self.failed(py, stepper, error, wall_s))
        });
        result.ok_or_else(|| ended(py))?
    }

    /// Returns the configuration and the velocity of a system at the current time.
    pub(crate) fn state(&self, py: Python<'_>, system: usize) -> PyResult<(Vec<f64>, Vec<f64>)> {
        let model = &self.systems.models[system];
        let (mut q, mut v) = (vec![0.0; model.nq()], vec![0.0; model.nv()]);
        self.try_with(py, |stepper| stepper.read_state(system, &mut q, &mut v))?;
        Ok((q, v))
    }
}

/// Returns the error of a stepper whose run has ended.
fn ended(py: Python<'_>) -> PyErr {
    let message = "the run has ended; start a new one (a simulation has one run at a time)";
    plain(py, "SimulationError", message)
}
