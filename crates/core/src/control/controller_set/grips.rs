//! Contact forces that the grip-force laws use.

use super::ControllerSet;
use crate::control::error::ControlError;
use crate::control::fingers::Finger;
use crate::control::normal_force::NormalForce;
use crate::model::Model;
use crate::spatial::Scalar;

impl<S: Scalar> ControllerSet<'_, S> {
    /// Returns true if any of the laws uses the normal forces of contacts.
    pub fn uses_normal_forces(&self) -> bool {
        self.controls.iter().any(|control| control.law.grip().is_some())
    }

    /// Returns the list of the normal forces of all contacts on the robot, which the caller replaces by those
    /// of the current time. The next evaluation then recomputes the tracking errors.
    pub fn normal_forces_mut(&mut self) -> &mut Vec<NormalForce> {
        self.evaluated_at = f64::NAN;
        &mut self.normal_forces
    }

    /// Checks that a contact may exert a normal force on every finger of the grip-force laws. `touching` has
    /// the indices of the bodies on which contacts may exert normal forces.
    ///
    /// # Errors
    /// [`ControlError::FingerWithoutContact`] for the first finger without a contact.
    pub fn check_fingers(&self, model: &Model, touching: &[usize]) -> Result<(), ControlError> {
        for (control, state) in self.controls.iter().zip(&self.states) {
            let is_bare = |finger: &&Finger| !touching.iter().any(|&body| finger.moves(body, model));
            if let Some(finger) = state.fingers.iter().find(is_bare) {
                let joint = model.joints()[finger.joint].name.clone();
                return Err(ControlError::FingerWithoutContact { control: control.name.clone(), joint });
            }
        }
        Ok(())
    }
}
