//! Interface of user-defined controllers.

use super::control_law::{ControlLaw, EffortInput, EffortWork};
use super::error::ControlError;
use super::observation::Observation;
use crate::model::Model;

/// Interface of a user-defined controller, which computes the torques of its joints at each control tick.
///
/// ```
/// use onorbit_core::control::{ControlError, Controller, Observation};
///
/// /// Damps every joint.
/// struct Damper(f64);
///
/// impl Controller for Damper {
///     fn update(&mut self, now: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError> {
///         tau.iter_mut().zip(&now.v[6..]).for_each(|(tau, rate)| *tau = -self.0 * rate);
///         Ok(())
///     }
/// }
/// ```
pub trait Controller: Send {
    /// Prepares the controller for a run; called at the start of each run.
    ///
    /// # Errors
    /// [`ControlError`] if the controller cannot start; the error ends the run.
    fn reset(&mut self) -> Result<(), ControlError> {
        Ok(())
    }

    /// Writes the torques of the joints of the control, `(k,)`, N m (N), which are held until the next call.
    ///
    /// # Errors
    /// [`ControlError`] if the torques cannot be computed; the error ends the run, and so do torques that are
    /// not finite.
    fn update(&mut self, now: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError>;

    /// Returns the state that the controller keeps between calls, for a checkpoint. By default there is none.
    ///
    /// # Errors
    /// [`ControlError`] if the state cannot be written.
    fn save(&self) -> Result<Vec<u8>, ControlError> {
        Ok(Vec::new())
    }

    /// Restores a state that [`Controller::save`] returned.
    ///
    /// # Errors
    /// [`ControlError`] if the state does not belong to this controller.
    fn load(&mut self, _saved: &[u8]) -> Result<(), ControlError> {
        Ok(())
    }
}

impl ControlLaw for Box<dyn Controller> {
    fn check_group(&self, _: &str, _: &[usize], _: &Model) -> Result<(), ControlError> {
        Ok(())
    }

    fn efforts(
        &mut self,
        input: &EffortInput<'_>,
        _: EffortWork<'_>,
        tau: &mut [f64],
    ) -> Result<(), ControlError> {
        let Observation { time, model, joints, .. } = input.observation;
        self.update(&input.observation, tau)?;
        if let Some(place) = tau.iter().position(|tau| !tau.is_finite()) {
            let (control, joint) = (input.control.to_owned(), model.joints()[joints[place]].name.clone());
            return Err(ControlError::UserTorque { control, joint, time, value: tau[place] });
        }
        Ok(())
    }

    fn reset(&mut self) -> Result<(), ControlError> {
        (**self).reset()
    }

    fn save(&self) -> Result<Vec<u8>, ControlError> {
        (**self).save()
    }

    fn load(&mut self, saved: &[u8]) -> Result<(), ControlError> {
        (**self).load(saved)
    }
}
