//! Simulation and the run that borrows it, shared by `Simulation` and its steppers.

use crate::errors::{SimulationErrorExt, plain};
use onorbit_core::simulation::{AttachedControl, Checkpoint, Simulation, SingularLoop, Stepper, Trace};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use self_cell::{MutBorrow, self_cell};
use std::ffi::CString;
use std::sync::{Arc, Mutex, MutexGuard, TryLockError};

self_cell!(
    /// Simulation, and the run that borrows it.
    struct Running {
        owner: MutBorrow<Simulation>,
        #[not_covariant]
        dependent: Stepper,
    }
);

/// Simulation without a run, or together with its current run.
enum Slot {
    Idle(Box<Simulation>),
    Running(Box<Running>),
    /// Temporary state while the simulation and its run replace one another.
    Empty,
}

/// Simulation with its current run. `number` counts the runs started so far and identifies the current run.
pub(crate) struct Runs {
    slot: Slot,
    number: u64,
    /// Wall-clock time of the current run so far, s.
    pub(crate) wall_s: f64,
    /// Controls about which the current run has issued a warning.
    warned: Vec<AttachedControl>,
    /// Singular loops about which the current run has issued a warning.
    singular: Vec<SingularLoop>,
}

#[derive(Clone)]
pub(crate) struct SharedRun(Arc<Mutex<Runs>>);

impl SharedRun {
    pub(crate) fn new(simulation: Simulation) -> Self {
        let slot = Slot::Idle(Box::new(simulation));
        Self(Arc::new(Mutex::new(Runs {
            slot,
            number: 0,
            wall_s: 0.0,
            warned: Vec::new(),
            singular: Vec::new(),
        })))
    }

    /// Returns exclusive access to the runs. Raises an error if another thread, or a callback of the run
    /// itself, already has access.
    pub(crate) fn lock(&self, py: Python<'_>) -> PyResult<MutexGuard<'_, Runs>> {
        match self.0.try_lock() {
            Ok(runs) => Ok(runs),
            Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => {
                let message = "this simulation is already in use by another thread or by an \
                               enclosing call; use a second Simulation";
                Err(plain(py, "SimulationError", message))
            }
        }
    }

    /// Ends the current run, starts another run, and returns its number. `streamed` is true if the caller
    /// removes rows during the run.
    pub(crate) fn start(
        &self,
        py: Python<'_>,
        (duration, streamed): (Option<f64>, bool),
        from: Option<(Checkpoint, Vec<Trace>)>,
        wall_s: f64,
    ) -> PyResult<u64> {
        let mut runs = self.lock(py)?;
        runs.release();
        let Slot::Idle(simulation) = std::mem::replace(&mut runs.slot, Slot::Empty) else {
            return Err(plain(
                py,
                "SimulationError",
                "this simulation is unusable after an internal error (panic); create a new Simulation",
            ));
        };
        let running = Running::try_new_or_recover(MutBorrow::new(*simulation), |simulation| {
            let simulation = simulation.borrow_mut();
            match from {
                from if streamed => simulation.start_streaming(duration, from),
                None => simulation.start(duration),
                Some((checkpoint, rows)) => simulation.resume(duration, checkpoint, rows),
            }
        });
        match running {
            Ok(running) => {
                runs.slot = Slot::Running(Box::new(running));
                runs.number += 1;
                runs.wall_s = wall_s;
                runs.warned.clear();
                runs.singular.clear();
                Ok(runs.number)
            }
            Err((simulation, error)) => {
                runs.slot = Slot::Idle(Box::new(simulation.into_inner()));
                Err(error.into_python_with(py, None))
            }
        }
    }
}

impl Runs {
    /// Ends the current run, if there is one.
    fn release(&mut self) {
        self.slot = match std::mem::replace(&mut self.slot, Slot::Empty) {
            Slot::Running(running) => Slot::Idle(Box::new(running.into_owner().into_inner())),
            other => other,
        };
    }

    /// Ends run `number`, if it is the current run.
    pub(crate) fn end(&mut self, number: u64) {
        if self.number == number {
            self.release();
        }
    }

    /// Issues one warning for each control of run `number` that follows a frame to which a capture has
    /// rigidly connected the control's own frame, and one for each singular loop.
    pub(crate) fn warn(&mut self, py: Python<'_>, number: u64) -> PyResult<()> {
        let all = self.with(number, |stepper| stepper.attached_controls()).unwrap_or_default();
        for new in all.into_iter().filter(|attached| !self.warned.contains(attached)).collect::<Vec<_>>() {
            let AttachedControl { control, frame, followed, capture } = &new;
            let message = format!(
                "the control '{control}' moves '{frame}' and follows '{followed}', but the capture \
                 '{capture}' has rigidly connected these two frames, so the control can no longer reduce its \
                 error and its torques may diverge; end the control at the capture, for example with another \
                 control of the same joints that has after='{capture}'"
            );
            self.warned.push(new);
            PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(message)?, 1)?;
        }
        self.warn_of_singular_loops(py, number)
    }

    /// Issues one warning for each closed loop and mimic joint of run `number` whose constraints became
    /// linearly dependent.
    fn warn_of_singular_loops(&mut self, py: Python<'_>, number: u64) -> PyResult<()> {
        let all = self.with(number, |stepper| stepper.singular_loops()).unwrap_or_default();
        for new in all.into_iter().filter(|one| !self.singular.contains(one)).collect::<Vec<_>>() {
            let SingularLoop { system, name, time } = &new;
            let message = format!(
                "the constraints of the loop or mimic joint '{name}' of '{system}' became dependent near t = \
                 {time:.6} s (singular configuration), so the motion may continue on another branch, and \
                 rounding errors may decide on which branch; to avoid this configuration, limit the joints \
                 (enforce_limits) or change the reference"
            );
            self.singular.push(new);
            PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(message)?, 1)?;
        }
        Ok(())
    }

    /// Calls `work` with run `number`. Returns `None` if this run has ended or another run has been started.
    pub(crate) fn with<R>(&mut self, number: u64, work: impl FnOnce(&mut Stepper<'_>) -> R) -> Option<R> {
        match &mut self.slot {
            Slot::Running(running) if self.number == number => {
                Some(running.with_dependent_mut(|_, stepper| work(stepper)))
            }
            _ => None,
        }
    }
}
