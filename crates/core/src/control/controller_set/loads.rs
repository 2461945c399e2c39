//! Loads that controls move, and internal forces that they command.

use super::ControllerSet;
use crate::control::control::{Control, LoadFrame};
use crate::control::control_state::ControlState;
use crate::control::error::ControlError;
use crate::model::Model;
use crate::spatial::{Mat3, Scalar, Vec3};

impl<S: Scalar> ControllerSet<'_, S> {
    /// Sets the pose of the tracked frame in the frame of the load for each control with a load. `pose`
    /// returns this pose from the index of the tracked frame and the frame of the load, or `None` if the
    /// tracked frame does not hold the load.
    pub fn set_loads(&mut self, pose: impl Fn(usize, LoadFrame) -> Option<(Mat3<f64>, Vec3<f64>)>) {
        for (control, state) in self.controls.iter().zip(&mut self.states) {
            let tracked = control.law.task().zip(control.load);
            state.tool_in_load = tracked.and_then(|((frame, _), load)| pose(frame, load));
        }
        self.evaluated_at = f64::NAN;
    }

    /// Returns an error if an active control moves a load that its tracked frame does not hold at `t`, s.
    pub(super) fn check_loads(&self, t: f64) -> Result<(), ControlError> {
        let lacks = |(control, state): &(&Control, &ControlState)| {
            control.load.is_some() && state.tool_in_load.is_none() && state.is_running()
        };
        match self.controls.iter().zip(&self.states).find(lacks) {
            Some((control, _)) => Err(ControlError::LoadNotHeld { control: control.name.clone(), time: t }),
            None => Ok(()),
        }
    }

    /// Checks the internal forces that the controls command. `captures` are the names of the captures that
    /// may close a loop.
    ///
    /// # Errors
    /// [`ControlError`] for a loop that does not exist, a component along which the loop transmits no force
    /// or moment, and numbers that are not finite or exceed 1e20 in magnitude.
    pub fn check_internal_forces(&self, model: &Model, captures: &[String]) -> Result<(), ControlError> {
        for control in self.controls.iter() {
            for force in &control.internal_forces {
                force.check(&control.name, model, captures)?;
            }
        }
        Ok(())
    }
}
