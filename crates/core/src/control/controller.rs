//! The controllers a simulation can run.

use super::computed_torque::ComputedTorque;
use super::error::ControlError;
use super::group::{Begin, Control};
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
    /// Joints to drive, by index, in the order of the torques.
    pub joints: &'a [usize],
    /// Where the reference wants the tool, if there is one.
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

    /// Writes the torques of its joints, N m (N), that are held until the next call.
    ///
    /// # Errors
    /// Whatever stops the run.
    fn update(&mut self, now: &Observation<'_>, tau: &mut [f64]) -> Result<(), ControlError>;

    /// What it remembers between calls, for a checkpoint; nothing by default.
    ///
    /// # Errors
    /// What keeps it from being written.
    fn save(&self) -> Result<Vec<u8>, ControlError> {
        Ok(Vec::new())
    }

    /// Takes up what [`Controller::save`] gave.
    ///
    /// # Errors
    /// What does not fit.
    fn load(&mut self, _saved: &[u8]) -> Result<(), ControlError> {
        Ok(())
    }
}

/// What drives the joints.
#[derive(Default)]
pub enum ControlLaw {
    /// Nothing: the joints move freely.
    #[default]
    None,
    /// Task-space computed torque on the generalized Jacobian.
    ComputedTorque(Box<ComputedTorque>),
    /// A user's controller on all joints.
    User(Box<dyn Controller>),
    /// Several controls, each on its own joints, side by side or one after the other.
    Stack(Vec<Control>),
}

impl ControlLaw {
    /// The controls, where there are several.
    pub fn controls(&self) -> &[Control] {
        if let Self::Stack(controls) = self { controls } else { &[] }
    }

    /// Instants at which a control starts or stops, as far as they are known, s.
    pub fn switch_times(&self) -> Vec<f64> {
        let starts = self.controls().iter().filter_map(|control| match control.begin {
            Begin::At(start) => Some(start),
            Begin::After(_) => None,
        });
        let ends = self.controls().iter().map(|control| control.end);
        starts.chain(ends).filter(|t| t.is_finite() && *t > 0.0).collect()
    }

    /// Whether a law compensates Coulomb friction of joints.
    pub fn compensates_friction(&self) -> bool {
        match self {
            Self::ComputedTorque(law) => law.compensate_friction,
            Self::Stack(controls) => controls.iter().any(Control::compensates_friction),
            Self::None | Self::User(_) => false,
        }
    }

    /// Whether one of several controls leads this frame.
    pub fn tracks(&self, tool: Option<usize>) -> bool {
        let leads = |control: &Control| control.task().is_some_and(|(frame, _)| Some(frame) == tool);
        self.controls().iter().any(leads)
    }
}
