//! Functions that advance and end the run of a stepper.

use crate::checkpoint::row_counts;
use crate::errors::{SimulationErrorExt, plain};
use crate::interrupt::PACE;
use crate::run_failure::{interrupted, run_failure};
use crate::shared_run::{Runs, SharedRun};
use crate::stepper::PyStepper;
use crate::world::Systems;
use onorbit_core::simulation::{Recording, RunFailure, SimulationError, Stepper};
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::sync::{Arc, MutexGuard};
use std::time::{Duration, Instant};

/// Callback that a run calls at regular intervals of wall-clock time. It receives the run and its wall-clock
/// time so far, s.
pub(crate) type Pause<'a> = &'a mut dyn FnMut(Python<'_>, &mut Stepper<'_>, f64) -> PyResult<()>;

impl PyStepper {
    pub(crate) fn new(run: SharedRun, number: u64, systems: Arc<Systems>) -> Self {
        Self { run, number, systems }
    }

    /// Returns the index of the only system, or an error in which `what` names the requested attribute.
    pub(crate) fn only(&self, what: &str) -> PyResult<usize> {
        self.systems.only("stepper", what).map(|()| 0)
    }

    pub(crate) fn with<R>(&self, py: Python<'_>, work: impl FnOnce(&mut Stepper<'_>) -> R) -> PyResult<R> {
        self.run.lock(py)?.with(self.number, work).ok_or_else(|| ended(py))
    }

    /// Calls `work` with the run, and converts its error. `work` may call Python controllers.
    pub(crate) fn try_with<R>(
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

    /// Advances the run to `duration`, s, ends it, and returns the whole trace. `pause` is called at regular
    /// intervals of wall-clock time. An error ends the run.
    pub(crate) fn run_to_end(&self, py: Python<'_>, duration: f64, pause: Pause<'_>) -> PyResult<Py<PyAny>> {
        let mut runs = self.run.lock(py)?;
        if let Err(error) = self.advance_locked(py, &mut runs, duration, None, pause) {
            runs.end(self.number);
            return Err(error);
        }
        self.end(py, &mut runs, true)
    }

    /// Ends the run and returns its trace. `is_complete` states whether the run reached its end.
    pub(crate) fn end(
        &self,
        py: Python<'_>,
        runs: &mut MutexGuard<'_, Runs>,
        is_complete: bool,
    ) -> PyResult<Py<PyAny>> {
        let finished = runs.with(self.number, |stepper| py.detach(|| stepper.finish()));
        let wall_s = runs.wall_s;
        runs.end(self.number);
        match finished.ok_or_else(|| ended(py))? {
            Ok(recording) => self.systems.wrap(py, recording, is_complete, wall_s),
            Err(RunFailure { error, recording }) => Err(self.ended_early(py, error, *recording, wall_s)),
        }
    }

    /// Advances the run without the GIL to simulation time `t`, s, or until the wall-clock time `limit` has
    /// passed. Calls `pause` at regular intervals of wall-clock time; an error of `pause` stops the advance.
    pub(crate) fn advance_locked(
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

    /// Returns the exception for an error of the core. If the error ended the run, the trace so far is
    /// attached to the exception.
    pub(crate) fn failed(
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

    /// Returns the exception for an error that ended the run, with the trace of the recorded rows.
    pub(crate) fn ended_early(
        &self,
        py: Python<'_>,
        error: SimulationError,
        recording: Recording,
        wall_s: f64,
    ) -> PyErr {
        let last = recording.systems.first().and_then(|trace| trace.time.last().copied());
        run_failure(py, error, last, self.systems.wrap(py, recording, false, wall_s).ok())
    }

    /// Returns the exception for a signal, or for an error of a callback, between two steps.
    pub(crate) fn stopped(
        &self,
        py: Python<'_>,
        stepper: &mut Stepper<'_>,
        error: PyErr,
        wall_s: f64,
    ) -> PyErr {
        let time = stepper.time();
        match stepper.recording() {
            Ok(recording) => {
                interrupted(py, error, time, self.systems.wrap(py, recording, false, wall_s).ok())
            }
            Err(failure) => self.failed(py, stepper, failure, wall_s),
        }
    }

    /// Returns the number of rows that each system has recorded so far.
    pub(crate) fn row_counts(&self, py: Python<'_>) -> PyResult<Vec<usize>> {
        self.with(py, |stepper| row_counts(stepper, self.systems.names.len()))
    }

    /// Returns the configuration (m and rad) and the velocity (m/s and rad/s) of a system at the current
    /// time.
    pub(crate) fn state(&self, py: Python<'_>, system: usize) -> PyResult<(Vec<f64>, Vec<f64>)> {
        let model = &self.systems.models[system];
        let (mut q, mut v) = (vec![0.0; model.nq()], vec![0.0; model.nv()]);
        self.try_with(py, |stepper| stepper.read_state(system, &mut q, &mut v))?;
        Ok((q, v))
    }
}

/// Returns the error of a stepper whose run has ended.
pub(crate) fn ended(py: Python<'_>) -> PyErr {
    let message = "the run has ended, or another run of the same simulation was started; start a new run";
    plain(py, "SimulationError", message)
}
