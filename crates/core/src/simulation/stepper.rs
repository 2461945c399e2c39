//! Stepper, with which a caller advances a run.

use super::checkpoint::Checkpoint;
use super::error::{RunFailure, SimulationError};
use super::recording::Recording;
use super::steps::{Monitor, Steps};
use super::trace::Trace;
use std::ops::ControlFlow;

/// Run that the caller advances; see [`Simulation::start`](super::Simulation::start).
///
/// The steps are those of [`Simulation::run`](super::Simulation::run), independent of the times to which the
/// run is advanced. Among the actions of the caller, only torque commands, wrench commands and triggered
/// events end a step early.
pub struct Stepper<'a> {
    pub(super) groups: Vec<Group<'a>>,
    /// Index of the group of each system, and index of the system in the group.
    pub(super) places: Vec<(usize, usize)>,
    /// Length of a regular step, s.
    time_step: f64,
    status: Status,
}

/// Systems that may interact, and the run of these systems. Systems of different groups never interact.
pub(super) struct Group<'a> {
    pub(super) numbers: Vec<usize>,
    pub(super) run: Box<dyn Steps + 'a>,
}

/// Number of regular steps by which one of several groups advances before the next group advances.
const STEPS_IN_TURN: f64 = 64.0;

/// Accepted rounding error of the time at the end of an advance, as a fraction of `STEPS_IN_TURN` steps.
const TURN_ROUNDING: f64 = 1e-6;

#[derive(Clone, Copy, PartialEq, Eq)]
enum Status {
    Running,
    Failed,
    Finished,
}

impl<'a> Stepper<'a> {
    pub(super) fn new(groups: Vec<Group<'a>>, time_step: f64) -> Self {
        let count = groups.iter().map(|group| group.numbers.len()).sum();
        let mut places = vec![(0, 0); count];
        for (number, group) in groups.iter().enumerate() {
            group.numbers.iter().enumerate().for_each(|(local, &system)| places[system] = (number, local));
        }
        Self { groups, places, time_step, status: Status::Running }
    }

    /// Returns the current time, s.
    pub fn time(&self) -> f64 {
        // times of groups differ only after an advance that the monitor stopped
        self.groups.iter().map(|group| group.run.time()).fold(f64::INFINITY, f64::min)
    }

    /// Returns the planned end of the run, s; `None` for an open-ended run.
    pub fn duration(&self) -> Option<f64> {
        self.groups[0].run.duration()
    }

    /// Advances the run by `dt`, s.
    ///
    /// # Errors
    /// [`SimulationError::NotPositive`] for `dt` that is not positive and finite, and the errors of
    /// [`Stepper::advance_to`].
    pub fn advance(&mut self, dt: f64) -> Result<(), SimulationError> {
        self.advance_to(self.time_after(dt)?)
    }

    /// Returns the current time plus `dt`, s.
    ///
    /// # Errors
    /// [`SimulationError::NotPositive`] for `dt` that is not positive and finite.
    pub fn time_after(&self, dt: f64) -> Result<f64, SimulationError> {
        SimulationError::check_positive("dt", dt)?;
        Ok(self.time() + dt)
    }

    /// Advances the run to the time `t`, s. If `t` is within a step, the state at `t` is computed by dense
    /// output or by a shorter trial step, and the step itself is computed in a later advance.
    ///
    /// # Errors
    /// [`SimulationError::TimeNotFinite`], [`SimulationError::PastTime`] and [`SimulationError::AfterEnd`]
    /// for an invalid `t`, [`SimulationError::Earth`] if the orientation data of the Earth do not cover `t`,
    /// and [`SimulationError::Ended`] if the run has ended; the run does not change. Any other error, such as
    /// [`SimulationError::Diverged`], ends the run.
    pub fn advance_to(&mut self, t: f64) -> Result<(), SimulationError> {
        self.advance_until(t, &mut |_| ControlFlow::Continue(())).map(|_| ())
    }

    /// Advances the run like [`Stepper::advance_to`], but stops at the time passed to the monitor if the
    /// monitor returns `Break`. Returns `Break` if the monitor has stopped the advance.
    ///
    /// # Errors
    /// The errors of [`Stepper::advance_to`].
    pub fn advance_until(
        &mut self,
        t: f64,
        monitor: Monitor<'_>,
    ) -> Result<ControlFlow<()>, SimulationError> {
        self.check()?;
        self.groups.iter().try_for_each(|group| group.run.check_time(t))?;
        let result = self.advance_groups(t, monitor);
        self.ended_by(result)
    }

    /// Advances all groups to `t`, s. Several groups advance in turn, by [`STEPS_IN_TURN`] regular steps
    /// each.
    fn advance_groups(&mut self, t: f64, monitor: Monitor<'_>) -> Result<ControlFlow<()>, SimulationError> {
        if let [group] = &mut self.groups[..] {
            return group.run.advance_to(t, monitor);
        }
        let turn = STEPS_IN_TURN * self.time_step;
        // because of rounding, the end of an advance may be slightly later than the step that ends there
        let mut turns = (self.time() / turn + TURN_ROUNDING).floor();
        loop {
            turns += 1.0;
            let next = (turns * turn).min(t);
            for group in self.groups.iter_mut().filter(|group| group.run.time() < next) {
                let _ = group.run.advance_to(next, &mut |_| ControlFlow::Continue(()))?;
            }
            if next >= t {
                return Ok(ControlFlow::Continue(()));
            }
            if monitor(next).is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
    }

    /// Writes the configuration, `(nq,)`, m and rad, and the velocity, `(nv,)`, m/s and rad/s, of the system
    /// with index `system` at the current time to `q` and `v`.
    ///
    /// # Errors
    /// The errors of a step, which end the run; [`SimulationError::Ended`] if the run has ended.
    pub fn read_state(&mut self, system: usize, q: &mut [f64], v: &mut [f64]) -> Result<(), SimulationError> {
        self.check()?;
        let (group, system) = self.places[system];
        let result = self.groups[group].run.read_state(system, q, v);
        self.ended_by(result)
    }

    /// Sets the joint torques `tau`, `(n,)`, N m or N, of the system with index `system`, which are held from
    /// the current time on. `None` leaves the torque of a joint unchanged. The current step ends at the
    /// current time.
    ///
    /// # Errors
    /// [`SimulationError::WrongLength`] and [`SimulationError::NotFinite`] for `tau`,
    /// [`SimulationError::CommandedJoint`] for a joint of an active control, and [`SimulationError::Ended`]
    /// if the run has ended; the run does not change. The errors of a step end the run.
    pub fn command(&mut self, system: usize, tau: &[Option<f64>]) -> Result<(), SimulationError> {
        self.check()?;
        let (run, system) = self.run_of(system);
        run.check_command(system, tau)?;
        let result = run.command(system, tau);
        self.ended_by(result)
    }

    /// Returns a checkpoint of the run. To resume the run,
    /// [`Simulation::resume`](super::Simulation::resume) requires this checkpoint and the rows of each
    /// system, which [`Stepper::rows`] returns.
    ///
    /// # Errors
    /// The error of a user-defined controller whose state cannot be saved, and [`SimulationError::Ended`] if
    /// the run has ended; the run does not change.
    pub fn checkpoint(&self) -> Result<Checkpoint, SimulationError> {
        self.check()?;
        let groups = self.groups.iter().map(|group| group.run.checkpoint());
        Ok(Checkpoint::new(groups.collect::<Result<_, _>>()?))
    }

    /// Returns the rows of the system with index `system` recorded so far. A row at the current time is not
    /// included.
    pub fn rows(&self, system: usize) -> &Trace {
        let (group, system) = self.places[system];
        self.groups[group].run.rows(system)
    }

    /// Removes the recorded rows of each system except the first one and the last `keep`, which limits the
    /// memory of a long run. The motion does not change.
    ///
    /// A later checkpoint can be resumed only together with the removed rows. The certificate omits the
    /// checks that compare successive steps, unless they are evaluated during the run.
    pub fn drop_rows(&mut self, keep: usize) {
        self.groups.iter_mut().for_each(|group| group.run.drop_rows(keep, false));
    }

    /// Removes the recorded rows of each system except the first one and the last `keep` (at least 16), like
    /// [`Stepper::drop_rows`], after adding them to the checks of the certificate. The certificate is that of
    /// a run that keeps all rows, to the last bit.
    pub fn drop_checked_rows(&mut self, keep: usize) {
        self.groups.iter_mut().for_each(|group| group.run.drop_rows(keep, true));
    }

    /// Returns the recording of the run as if it ended now, with a last row at the current time.
    ///
    /// # Errors
    /// The errors of a step, which end the run; [`SimulationError::Ended`] if the run has ended.
    pub fn recording(&mut self) -> Result<Recording, SimulationError> {
        self.check()?;
        let parts: Result<Vec<_>, _> = self.groups.iter_mut().map(|group| group.run.recording()).collect();
        let parts = self.ended_by(parts)?;
        Ok(Recording::of(self.groups.iter().map(|group| &group.numbers[..]).zip(parts)))
    }

    /// Returns the row of each system at the current time, as if the run ended now. Earlier rows are not
    /// copied, so the cost does not depend on their number.
    ///
    /// # Errors
    /// The errors of [`Stepper::recording`].
    pub fn present_rows(&mut self) -> Result<Vec<Trace>, SimulationError> {
        self.check()?;
        let parts: Result<Vec<_>, _> = self.groups.iter_mut().map(|group| group.run.present_rows()).collect();
        let mut parts = self.ended_by(parts)?;
        Ok(self.places.iter().map(|(group, system)| std::mem::take(&mut parts[*group][*system])).collect())
    }

    /// Ends the run at the current time and returns its recording. After an error, the recording contains the
    /// rows before the error.
    ///
    /// # Errors
    /// The error that occurs when the last row is computed, with the rows before that row;
    /// [`SimulationError::Ended`] if the run has already been finished.
    pub fn finish(&mut self) -> Result<Recording, RunFailure> {
        let last_row = match self.status {
            Status::Running => self.groups.iter_mut().try_for_each(|group| group.run.record_current_time()),
            Status::Failed => Ok(()),
            Status::Finished => Err(SimulationError::Ended),
        };
        self.status = Status::Finished;
        let parts = self.groups.iter_mut().map(|group| (&group.numbers[..], group.run.take_rows()));
        let recording = Recording::of(parts);
        match last_row {
            Ok(()) => Ok(recording),
            Err(error) => Err(RunFailure { error, recording: Box::new(recording) }),
        }
    }

    /// Returns true if the run has ended, by an error or by [`Stepper::finish`].
    pub fn has_ended(&self) -> bool {
        self.status != Status::Running
    }

    /// Returns true if an error has ended the run, in which case [`Stepper::finish`] returns the rows before
    /// the error.
    pub fn has_failed(&self) -> bool {
        self.status == Status::Failed
    }

    /// Returns the run of the group of a system, and the index of the system in the group.
    pub(super) fn run_of(&mut self, system: usize) -> (&mut (dyn Steps + 'a), usize) {
        let (group, system) = self.places[system];
        (&mut *self.groups[group].run, system)
    }

    pub(super) fn check(&self) -> Result<(), SimulationError> {
        if self.status == Status::Running { Ok(()) } else { Err(SimulationError::Ended) }
    }

    /// Marks the run as failed if `result` is an error.
    pub(super) fn ended_by<T>(&mut self, result: Result<T, SimulationError>) -> Result<T, SimulationError> {
        if result.is_err() {
            self.status = Status::Failed;
        }
        result
    }
}
