//! The controllers a simulation can run.

use super::computed_torque::ComputedTorque;
use super::error::ControlError;
use crate::model::Model;
use crate::reference::TaskSample;

/// What a controller sees when it is asked for torques.
#[derive(Clone, Copy, Debug)]
pub struct Observation<'a> {
    /// Time, s.
    pub time: f64,
    /// Configuration, `(nq,)`.
    pub q: &'a [f64],
    /// Velocity, `(nv,)`.
    pub v: &'a [f64],
    /// The robot.
    pub model: &'a Model,
    /// Where the run's reference wants the tool, if it has one.
    pub desired: Option<TaskSample<f64>>,
}

/// A user's controller. A new one is one `impl`.
///
/// ```
/// use onorbit_core::control::{ControlError, Controller, Observation};
///
/// /// Brakes every joint.
/// struct Brake(f64);
///
/// impl Controller for Brake {
///     fn update(&mut self, now: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError> {
///         tau.iter_mut().zip(&now.v[6..]).for_each(|(tau, rate)| *tau = -self.0 * rate);
///         Ok(())
///     }
/// }
/// ```
pub trait Controller: Send {
    /// Called at the start of each run.
    ///
    /// # Errors
    /// What keeps the controller from starting.
    fn reset(&mut self) -> Result<(), ControlError> {
        Ok(())
    }

    /// Writes the joint torques, `(n,)`, N m (N), that are held until the next call.
    ///
    /// # Errors
    /// Whatever stops the run.
    fn update(&mut self, now: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError>;
}

/// What drives the joints.
#[derive(Default)]
pub enum ControlLaw {
    /// Nothing: the joints move freely.
    #[default]
    None,
    /// Task-space computed torque on the generalized Jacobian.
    ComputedTorque(Box<ComputedTorque>),
    /// A user's controller.
    User(Box<dyn Controller>),
}
