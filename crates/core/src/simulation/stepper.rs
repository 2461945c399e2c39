//! Stepper: a run that the caller advances.

use super::checkpoint::Checkpoint;
use super::error::{RunFailure, SimulationError};
use super::only::{only, only_mut};
use super::run_state::RunState;
use super::trace::Trace;
use crate::spatial::Scalar;
use std::ops::ControlFlow;

/// Callback that receives the time reached, s, at intervals during an advance. Returning `Break` stops the advance at
/// the end of the current step.
pub type Monitor<'a> = &'a mut dyn FnMut(f64) -> ControlFlow<()>;

/// A run that the caller advances; see [`Simulation::start`](super::Simulation::start).
///
/// The steps are those of [`Simulation::run`](super::Simulation::run), regardless of the times to which the run is
/// advanced.
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

/// Interface of a run, independent of its scalar type.
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
    /// Adds a row at the current time.
    fn record_current_time(&mut self) -> Result<(), SimulationError>;
    /// Removes and returns the rows recorded so far, with the error estimates and the outcomes of goals.
    fn take_rows(&mut self) -> Trace;
}

impl<'a> Stepper<'a> {
    pub(super) fn new(run: impl Steps + 'a) -> Self {
        Self { run: Box::new(run), status: Status::Running }
    }

    /// Returns the current time, s.
    pub fn time(&self) -> f64 {
        self.run.time()
    }

    /// Returns the planned end of the run, s; `None` for an open-ended run.
    pub fn duration(&self) -> Option<f64> {
        self.run.duration()
    }

    /// Advances the run by `dt`, s.
    ///
    /// # Errors
    /// [`SimulationError::NotPositive`], and the errors of [`Stepper::advance_to`].
    pub fn advance(&mut self, dt: f64) -> Result<(), SimulationError> {
        self.advance_to(self.time_after(dt)?)
    }

    /// Returns the current time plus `dt`, s.
    ///
    /// # Errors
    /// [`SimulationError::NotPositive`].
    pub fn time_after(&self, dt: f64) -> Result<f64, SimulationError> {
        SimulationError::check_positive("dt", dt)?;
        Ok(self.time() + dt)
    }

    /// Advances the run to the time `t`, s. If `t` lies within a step, the state at `t` comes from dense output or
    /// from a shorter trial step, and the step itself is taken by a later advance.
    ///
    /// # Errors
    /// [`SimulationError::NotPositive`], [`SimulationError::PastTime`], [`SimulationError::AfterEnd`], and
    /// [`SimulationError::Earth`] if the orientation data of the Earth do not cover `t`, leave the run unchanged. Every
    /// other error, such as [`SimulationError::Diverged`], ends the run.
    pub fn advance_to(&mut self, t: f64) -> Result<(), SimulationError> {
        self.advance_until(t, &mut |_| ControlFlow::Continue(())).map(|_| ())
    }

    /// Advances the run like [`Stepper::advance_to`], but stops at the end of a step if the monitor returns `Break`.
    ///
    /// # Errors
    /// The errors of [`Stepper::advance_to`].
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

    /// Writes the configuration `(nq,)` and the velocity `(nv,)` at the current time to `q` and `v`.
    ///
    /// # Errors
    /// The errors of a step, which end the run; [`SimulationError::Ended`] if the run has ended.
    pub fn read_state(&mut self, q: &mut [f64], v: &mut [f64]) -> Result<(), SimulationError> {
        self.check()?;
        let result = self.run.read_state(q, v);
        self.ended_by(result)
    }

    /// Sets the joint torques `tau`, `(n,)`, N m (N), which are held from the current time on; `None` leaves the
    /// torque of a joint unchanged. The current step ends at the current time.
    ///
    /// # Errors
    /// [`SimulationError::WrongLength`], [`SimulationError::NotFinite`] and, for a joint of an active control,
    /// [`SimulationError::CommandedJoint`] leave the run unchanged. The errors of a step end the run.
    pub fn command(&mut self, tau: &[Option<f64>]) -> Result<(), SimulationError> {
        self.check()?;
        self.run.check_command(tau)?;
        let result = self.run.command(tau);
        self.ended_by(result)
    }

    /// Returns a checkpoint, from which the run can be resumed together with the rows of [`Stepper::rows`].
    ///
    /// # Errors
    /// The error of a user-defined controller whose state cannot be saved; it leaves the run unchanged.
    pub fn checkpoint(&self) -> Result<Checkpoint, SimulationError> {
        self.check()?;
        self.run.checkpoint()
    }

    /// Returns the rows recorded so far, which do not include a row at the current time.
    pub fn rows(&self) -> &Trace {
        self.run.rows()
    }

    /// Returns the trace that the run would have if it ended now, with the last row at the current time.
    ///
    /// # Errors
    /// The errors of a step, which end the run; [`SimulationError::Ended`] if the run has ended.
    pub fn trace(&mut self) -> Result<Trace, SimulationError> {
        self.check()?;
        let result = self.run.trace();
        self.ended_by(result)
    }

    /// Ends the run at the current time and returns its trace; after an error, the trace has the rows recorded before
    /// it.
    ///
    /// # Errors
    /// An error in computing the last row, with the rows before it; [`SimulationError::Ended`] if called a second time.
    pub fn finish(&mut self) -> Result<Trace, RunFailure> {
        let last_row = match self.status {
            Status::Running => self.run.record_current_time(),
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

    /// Returns true if an error has ended the run; [`Stepper::finish`] then returns the rows recorded before the
    /// error.
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
        self.cut_at_current_time()?;
        let (set, system) =
            (&mut only_mut(&mut self.systems).controllers.set, only_mut(&mut self.equations.trees));
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

    fn record_current_time(&mut self) -> Result<(), SimulationError> {
        RunState::record_current_time(self)
    }

    fn take_rows(&mut self) -> Trace {
        self.conclude();
        std::mem::take(&mut only_mut(&mut self.systems).recorder.trace)
    }
}
