//! Advances a run step by step from outside.

use super::checkpoint::Checkpoint;
use super::error::{RunFailure, SimulationError};
use super::only::{only, only_mut};
use super::run_state::RunState;
use super::trace::Trace;
use crate::spatial::Scalar;
use std::ops::ControlFlow;

/// Called at intervals with the time reached, s; `Break` stops the advance at a cut.
pub type Monitor<'a> = &'a mut dyn FnMut(f64) -> ControlFlow<()>;

/// A run that is advanced from outside: [`Simulation::start`](super::Simulation::start).
///
/// Its steps are those of [`Simulation::run`](super::Simulation::run), whatever the times to which it is advanced.
pub struct Stepper<'a> {
    run: Box<dyn Steps + 'a>,
    status: Status,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Status {
    Running,
    Failed,
    Finished,
}

/// A run with any scalar.
pub(super) trait Steps: Send {
    fn time(&self) -> f64;
    fn duration(&self) -> Option<f64>;
    fn check_time(&self, t: f64) -> Result<(), SimulationError>;
    fn advance_to(&mut self, t: f64, monitor: Monitor<'_>) -> Result<ControlFlow<()>, SimulationError>;
    fn read_state(&mut self, q: &mut [f64], v: &mut [f64]) -> Result<(), SimulationError>;
    fn check_command(&self, tau: &[Option<f64>]) -> Result<(), SimulationError>;
    fn command(&mut self, tau: &[Option<f64>]) -> Result<(), SimulationError>;
    fn checkpoint(&self) -> Result<Checkpoint, SimulationError>;
    fn rows(&self) -> &Trace;
    fn trace(&mut self) -> Result<Trace, SimulationError>;
    /// Adds a row at the present time.
    fn record_present(&mut self) -> Result<(), SimulationError>;
    /// Takes the rows so far, with what is known only during the run.
    fn take_rows(&mut self) -> Trace;
}

impl<'a> Stepper<'a> {
    pub(super) fn new(run: impl Steps + 'a) -> Self {
        Self { run: Box::new(run), status: Status::Running }
    }

    /// Returns the present time, s.
    pub fn time(&self) -> f64 {
        self.run.time()
    }

    /// Returns the planned end of the run, s.
    pub fn duration(&self) -> Option<f64> {
        self.run.duration()
    }

    /// Advances by `dt`, s.
    ///
    /// # Errors
    /// [`SimulationError::NotPositive`], and those of [`Stepper::advance_to`].
    pub fn advance(&mut self, dt: f64) -> Result<(), SimulationError> {
        self.advance_to(self.time_after(dt)?)
    }

    /// Returns the time after a further `dt`, s.
    ///
    /// # Errors
    /// [`SimulationError::NotPositive`].
    pub fn time_after(&self, dt: f64) -> Result<f64, SimulationError> {
        SimulationError::check_positive("dt", dt)?;
        Ok(self.time() + dt)
    }

    /// Advances to the time `t`, s. If it lies within a step, the state there comes from dense output or from a shorter
    /// step, and the step is taken later.
    ///
    /// # Errors
    /// [`SimulationError::NotPositive`], [`SimulationError::PastTime`], [`SimulationError::AfterEnd`] and an Earth that
    /// does not cover `t`: the run stays as it was. Every other error, such as [`SimulationError::Diverged`], ends it.
    pub fn advance_to(&mut self, t: f64) -> Result<(), SimulationError> {
        self.advance_until(t, &mut |_| ControlFlow::Continue(())).map(|_| ())
    }

    /// As [`Stepper::advance_to`]; stops earlier, at a cut, if the monitor breaks.
    ///
    /// # Errors
    /// Those of [`Stepper::advance_to`].
    pub fn advance_until(
        &mut self,
        t: f64,
        monitor: Monitor<'_>,
    ) -> Result<ControlFlow<()>, SimulationError> {
        self.check()?;
        self.run.check_time(t)?;
        let result = self.run.advance_to(t, monitor);
        self.ended_by(result)
    }

    /// Writes configuration `(nq,)` and velocity `(nv,)` at the present time.
    ///
    /// # Errors
    /// Those of a step, and [`SimulationError::Ended`] after one of them.
    pub fn read_state(&mut self, q: &mut [f64], v: &mut [f64]) -> Result<(), SimulationError> {
        self.check()?;
        let result = self.run.read_state(q, v);
        self.ended_by(result)
    }

    /// Holds these torques, `(n,)`, N m (N), from now on; `None` leaves a joint as it is. The present time becomes a cut.
    ///
    /// # Errors
    /// [`SimulationError::WrongLength`], [`SimulationError::NotFinite`] and, for a joint of an active control,
    /// [`SimulationError::CommandedJoint`]: the run stays as it was. Errors of a step end it.
    pub fn command(&mut self, tau: &[Option<f64>]) -> Result<(), SimulationError> {
        self.check()?;
        self.run.check_command(tau)?;
        let result = self.run.command(tau);
        self.ended_by(result)
    }

    /// Returns the state of the run, from which another one can resume together with the rows of
    /// [`Stepper::rows`].
    ///
    /// # Errors
    /// Those of a user's controller that cannot be saved; the run stays as it was.
    pub fn checkpoint(&self) -> Result<Checkpoint, SimulationError> {
        self.check()?;
        self.run.checkpoint()
    }

    /// Returns the rows recorded so far; the present time is not among them.
    pub fn rows(&self) -> &Trace {
        self.run.rows()
    }

    /// Returns the trace as if the run ended at the present time, at which it has its last row.
    ///
    /// # Errors
    /// Those of a step, and [`SimulationError::Ended`] after one of them.
    pub fn trace(&mut self) -> Result<Trace, SimulationError> {
        self.check()?;
        let result = self.run.trace();
        self.ended_by(result)
    }

    /// Ends the run at the present time and returns its trace; after an error, the rows up to it.
    ///
    /// # Errors
    /// Those of the last row, with the rows before it, and [`SimulationError::Ended`] at the second call.
    pub fn finish(&mut self) -> Result<Trace, RunFailure> {
        let last_row = match self.status {
            Status::Running => self.run.record_present(),
            Status::Failed => Ok(()),
            Status::Finished => Err(SimulationError::Ended),
        };
        self.status = Status::Finished;
        let trace = self.run.take_rows();
        match last_row {
            Ok(()) => Ok(trace),
            Err(error) => Err(RunFailure { error, trace: Box::new(trace) }),
        }
    }

    /// Returns true if the run has ended, by an error or by [`Stepper::finish`].
    pub fn has_ended(&self) -> bool {
        self.status != Status::Running
    }

    /// Returns true if an error has ended the run; [`Stepper::finish`] then returns the rows up to it.
    pub fn has_failed(&self) -> bool {
        self.status == Status::Failed
    }

    fn check(&self) -> Result<(), SimulationError> {
        if self.status == Status::Running { Ok(()) } else { Err(SimulationError::Ended) }
    }

    /// Marks the run as failed if `result` is an error.
    fn ended_by<T>(&mut self, result: Result<T, SimulationError>) -> Result<T, SimulationError> {
        if result.is_err() {
            self.status = Status::Failed;
        }
        result
    }
}

impl<S: Scalar> Steps for RunState<'_, S> {
    fn time(&self) -> f64 {
        self.time
    }

    fn duration(&self) -> Option<f64> {
        self.schedule.duration()
    }

    fn check_time(&self, t: f64) -> Result<(), SimulationError> {
        if !t.is_finite() {
            return Err(SimulationError::NotPositive { name: "t", value: t });
        }
        if self.schedule.is_later(self.time, t) {
            return Err(SimulationError::PastTime { t, time: self.time });
        }
        if let Some(end) = self.duration().filter(|end| self.schedule.is_later(t, *end)) {
            return Err(SimulationError::AfterEnd { t, end });
        }
        if let Some(earth) = &self.earth {
            earth.covers(t)?;
        }
        Ok(())
    }

    fn advance_to(&mut self, t: f64, monitor: Monitor<'_>) -> Result<ControlFlow<()>, SimulationError> {
        RunState::advance_to(self, t, monitor)
    }

    fn read_state(&mut self, q: &mut [f64], v: &mut [f64]) -> Result<(), SimulationError> {
        RunState::read_state(self, q, v)
    }

    fn check_command(&self, tau: &[Option<f64>]) -> Result<(), SimulationError> {
        let place = only(self.layout.systems());
        let (got, expected) = (tau.len(), place.joints.len());
        if got != expected {
            return Err(SimulationError::WrongLength { name: "tau", expected, got });
        }
        let set = &only(&self.systems).controllers.set;
        for (index, value) in tau.iter().enumerate().filter_map(|(j, tau)| Some((j, (*tau)?))) {
            if !value.is_finite() {
                return Err(SimulationError::NotFinite { name: "tau", index, value });
            }
            if let Some(control) = set.driver_of(index, self.time) {
                let (joint, control) = (place.joints[index].clone(), control.name.clone());
                return Err(SimulationError::CommandedJoint { joint, control });
            }
        }
        Ok(())
    }

    fn command(&mut self, tau: &[Option<f64>]) -> Result<(), SimulationError> {
        self.cut_at_present()?;
        let (set, system) =
            (&mut only_mut(&mut self.systems).controllers.set, only_mut(&mut self.equations.systems));
        set.command(tau);
        for (j, tau) in tau.iter().enumerate() {
            // a control may have become active in the step that ended here
            if let Some(tau) = tau.filter(|_| set.driver_of(j, self.time).is_none()) {
                system.command[j] = S::of(tau);
            }
        }
        Ok(())
    }

    fn checkpoint(&self) -> Result<Checkpoint, SimulationError> {
        RunState::checkpoint(self)
    }

    fn rows(&self) -> &Trace {
        &only(&self.systems).recorder.trace
    }

    fn trace(&mut self) -> Result<Trace, SimulationError> {
        RunState::trace(self)
    }

    fn record_present(&mut self) -> Result<(), SimulationError> {
        RunState::record_present(self)
    }

    fn take_rows(&mut self) -> Trace {
        self.conclude();
        std::mem::take(&mut only_mut(&mut self.systems).recorder.trace)
    }
}
